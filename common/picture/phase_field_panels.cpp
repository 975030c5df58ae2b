// Panels of the phase field: initial pattern, a few frames and the field at failure in one row.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/picture/panels.hpp"
#include "common/picture/plot.hpp"

namespace fracfarm::picture {
namespace {

double width_of(const Record& r) { return r.phase_field.x.back() - r.phase_field.x.front(); }
double height_of(const Record& r) { return r.phase_field.z.back() - r.phase_field.z.front(); }

// A strip thinner than a line of text or taller than the page helps nobody.
int proportionate(const Record& r, int width) {
  return static_cast<int>(std::clamp(std::lround(width * height_of(r) / width_of(r)), 24L, 3L * width));
}

Canvas field_of(const Record& r, const std::vector<float>& psi, int width) {
  const Field field{psi, static_cast<int>(r.phase_field.x.size()), static_cast<int>(r.phase_field.z.size())};
  return draw_field(field, width, proportionate(r, width));
}

void draw_panel(Canvas& page, const Record& r, const std::vector<float>& psi, Box place, const std::string& caption) {
  page.text(place.x, place.y + 16, caption);
  page.place(field_of(r, psi, panel_width), place.x, place.y + caption_height);
  page.frame({place.x - 1, place.y + caption_height - 1, panel_width + 2, proportionate(r, panel_width) + 2}, grey);
}

void draw_panels(Canvas& page, const Record& r, int y) {
  const auto place = [&](int number) { return Box{page_margin + number * (panel_width + panel_gap), y, 0, 0}; };
  int number = 0;
  draw_panel(page, r, r.phase_field.psi_initial, place(number++), "initial");
  for (std::size_t frame : chosen_frames(r, panels_across - 2))
    draw_panel(page, r, r.phase_field.psi[frame], place(number++), in_units(r.phase_field.time[frame], "s"));
  draw_panel(page, r, r.phase_field.psi_failure, place(panels_across - 1), failure_caption(r));
  draw_colour_scale(page, {page_width - page_margin - scale_room + 18, y + caption_height, 14, proportionate(r, panel_width)}, "ψ");
}

std::string body_of(const Record& r) {
  return fmt::format("{:.3g} m × {:.3g} m, {} × {} nodes", width_of(r), height_of(r), r.phase_field.x.size(), r.phase_field.z.size());
}

}  // namespace

MethodPage phase_field_page() {
  return {"phase_field",
          [](const Record& r) { return caption_height + proportionate(r, panel_width); },
          draw_panels,
          body_of,
          field_of,
          {{"external_work", "external work", black, true},
           {"elastic_energy", "elastic", blue, true},
           {"kinetic_energy", "kinetic", orange, true},
           {"released_energy", "released", green, true},
           {"energy_residual", "residual", red, true}}};
}

}  // namespace fracfarm::picture
