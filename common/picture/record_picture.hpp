// Pictures of a record: what `fracfarm show -o` and the report draw. The one file of this room that knows records.
#pragma once

#include "common/picture/canvas.hpp"
#include "common/record/record.hpp"

namespace fracfarm::picture {

// Initial pattern, a few frames, the field at failure, stress and energy over time, and a title that says what it is.
Canvas draw_record(const Record& record);

}  // namespace fracfarm::picture
