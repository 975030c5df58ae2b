// The part of a record's page that belongs to its method: fields of damage with their captions. Private to this room.
#pragma once

#include <string>
#include <vector>

#include "common/picture/canvas.hpp"
#include "common/record/record.hpp"

namespace fracfarm::picture {

// Of curves and marks.
inline constexpr Colour blue{31, 107, 184}, orange{226, 116, 14}, green{44, 145, 72}, purple{130, 84, 176}, red{201, 42, 42},
    brown{140, 86, 60}, pink{220, 110, 170};

inline constexpr int page_margin = 28, panel_gap = 14, panels_across = 6, panel_width = 186, scale_room = 62, caption_height = 24;
inline constexpr int page_width = 2 * page_margin + panels_across * panel_width + (panels_across - 1) * panel_gap + scale_room;

struct EnergyCurve {
  std::string_view column, name;
  Colour colour;
  bool even_if_small = false;  // else a curve that would lie on the axis is left out, and its name with it
};

struct MethodPage {
  std::string_view method;
  int (*height)(const Record&);                             // of its panels, captions included
  void (*draw)(Canvas& page, const Record& record, int y);  // y: their upper edge
  std::string (*body)(const Record&);                       // what is drawn, in words: size and resolution
  Canvas (*field)(const Record& record, const std::vector<float>& damage, int width);
  std::vector<EnergyCurve> energies;
};

MethodPage phase_field_page();  // phase_field_panels.cpp
MethodPage fdem_page();         // fdem_panels.cpp

std::string in_units(double value, std::string_view unit);  // 3 digits
std::string failure_caption(const Record& record);

// At most `count` frames that divide the time from the start to the failure (or to the last frame) evenly.
std::vector<std::size_t> chosen_frames(const Record& record, int count);

}  // namespace fracfarm::picture
