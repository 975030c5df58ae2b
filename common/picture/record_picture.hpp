// Pictures of a record: what `fracfarm show -o` and the report draw. This file and the panels of the methods are what knows records here.
#pragma once

#include "common/picture/canvas.hpp"
#include "common/record/record.hpp"

namespace fracfarm::picture {

// Initial pattern, a few frames, the damage at failure, stress and energy over time, and a title that says what it is. A method that has no
// frames gets the curves alone.
Canvas draw_record(const Record& record);

// One field of damage of the record, as its method draws it; as high as the body asks.
Canvas draw_damage(const Record& record, const std::vector<float>& damage, int width);

}  // namespace fracfarm::picture
