// Panels of an FDEM run: the initial mesh beside the one at failure, and a row of frames below.
#include <fmt/format.h>

#include <algorithm>

#include "common/picture/mesh_picture.hpp"
#include "common/picture/panels.hpp"

namespace fracfarm::picture {
namespace {

constexpr int key_room = 130;
constexpr int large_width = (page_width - 2 * page_margin - key_room - 2 * panel_gap) / 2;
constexpr int small_width = (page_width - 2 * page_margin - (panels_across - 1) * panel_gap) / panels_across;

Canvas field_of(const Record& r, const std::vector<float>& damage, int width) { return draw_mesh(r.fdem.mesh, damage, width); }

// A mesh's picture has its own height; that of an empty one is quickly known.
int height_at(const Record& r, int width) {
  TriangleMesh bare;
  bare.nodes = r.fdem.mesh.nodes;
  return draw_mesh(bare, {}, width).height();
}

int rows_height(const Record& r) { return 2 * caption_height + height_at(r, large_width) + panel_gap + height_at(r, small_width); }

void draw_panel(Canvas& page, const Canvas& drawn, int x, int y, const std::string& caption) {
  page.text(x, y + 16, caption);
  page.place(drawn, x, y + caption_height);
  page.frame({x - 1, y + caption_height - 1, drawn.width() + 2, drawn.height() + 2}, grey);
}

std::string count_of_broken(const std::vector<float>& damage) {
  return fmt::format("{} edges broken", std::count(damage.begin(), damage.end(), 1.0f));
}

void draw_panels(Canvas& page, const Record& r, int y) {
  const FdemFrames& f = r.fdem;
  draw_panel(page, field_of(r, f.damage_initial, large_width), page_margin, y, "initial");
  draw_panel(page, field_of(r, f.damage_failure, large_width), page_margin + large_width + panel_gap, y,
             failure_caption(r) + " · " + count_of_broken(f.damage_failure));
  draw_mesh_key(page, {page_width - page_margin - key_room + 10, y + caption_height, key_room, 0});
  const int below = y + caption_height + height_at(r, large_width) + panel_gap;
  int x = page_margin;
  for (std::size_t frame : chosen_frames(r, panels_across)) {
    draw_panel(page, field_of(r, f.damage[frame], small_width), x, below, in_units(f.time[frame], "s"));
    x += small_width + panel_gap;
  }
}

std::string body_of(const Record& r) {
  const TriangleMesh& mesh = r.fdem.mesh;
  double across = 0.0, up = 0.0;
  for (const auto& [x, z] : mesh.nodes) across = std::max(across, x), up = std::max(up, z);
  return fmt::format("{:.3g} m × {:.3g} m, {} triangles, {} edges", across, up, mesh.triangles.size(), mesh.edge_nodes.size());
}

}  // namespace

MethodPage fdem_page() {
  return {"fdem",
          rows_height,
          draw_panels,
          body_of,
          field_of,
          {{"external_work", "work", black},
           {"elastic_energy", "elastic", blue},
           {"kinetic_energy", "kinetic", orange},
           {"fracture_energy", "fracture", green},
           {"viscous_energy", "viscous", purple},
           {"plastic_energy", "plastic", brown},
           {"friction_energy", "friction", grey},
           {"contact_energy", "contact", pink},
           {"energy_residual", "residual", red}}};
}

}  // namespace fracfarm::picture
