#include <nlohmann/json.hpp>

#include "tests/robustness/twists.hpp"

namespace fracfarm::robustness {
namespace {

using nlohmann::json;

struct Box {
  double width, height, hx, hz;
  int across, up;
};

Box box_of(const json& scene) {
  Box box{number_at(scene, "/domain/width"), number_at(scene, "/domain/height"), 0, 0, 1, 1};
  box.across = std::max(1, static_cast<int>(number_at(scene, "/phase_field/cells/0")));
  box.up = std::max(1, static_cast<int>(number_at(scene, "/phase_field/cells/1")));
  if (const double h = number_at(scene, "/fdem/element_size"); h > 0.0 && std::max(box.width, box.height) < 1e3 * h)
    box.across = std::max(1, static_cast<int>(box.width / h)), box.up = std::max(1, static_cast<int>(box.height / h));
  box.hx = box.width / box.across, box.hz = box.height / box.up;
  return box;
}

json& cracks_of(json& scene) {
  json& cracks = scene["cracks"];
  if (!cracks.is_array()) cracks = json::array();
  return cracks;
}

// A crack and its neighbours at 0, one rounding error, ... four cells.
void near_overlap(json& scene, Draw& draw) {
  const Box b = box_of(scene);
  const double z = draw.uniform(0.2, 0.8) * b.height, x = draw.uniform(0.0, 0.5) * b.width, end = x + draw.uniform(0.1, 0.5) * b.width;
  cracks_of(scene).push_back({x, z, end, z});
  for (int k = draw.integer(1, 8); k > 0; --k) {
    static constexpr double gaps[]{0.0, 1e-18, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3, 0.1, 0.5, 0.999999999, 1.0, 1.000000001, 2.0, 4.0};
    const double gap = draw.sign() * draw.pick(gaps) * b.hz, shift = draw.sign() * draw.pick(gaps) * b.hx;
    scene["cracks"].push_back({x + shift, z + gap, end + shift, z + gap});
  }
}

void along_edges(json& scene, Draw& draw) {
  const Box b = box_of(scene);
  static constexpr double offsets[]{0.0, 0.0, 1e-17, -1e-17, 1e-9, -1e-9};
  const double dx = draw.pick(offsets) * b.width, dz = draw.pick(offsets) * b.height;
  const json sides[]{{0.0, dz, b.width, dz},
                     {0.0, b.height + dz, b.width, b.height + dz},
                     {dx, 0.0, dx, b.height},
                     {b.width + dx, 0.0, b.width + dx, b.height}};
  for (const json& side : sides)
    if (draw.chance(0.6)) cracks_of(scene).push_back(side);
}

void on_grid_lines(json& scene, Draw& draw) {
  const Box b = box_of(scene);
  for (int k = draw.integer(1, 10); k > 0; --k) {
    const int i = draw.integer(0, b.across), j = draw.integer(0, b.up), n = draw.integer(1, 6);
    const double x = i * b.hx, z = j * b.hz, reach = n * b.hx, rise = n * b.hz;
    const int way = draw.integer(0, 2);
    cracks_of(scene).push_back({x, z, way == 1 ? x : x + reach, way == 0 ? z : z + rise});
  }
}

void all_broken(json& scene, Draw& draw) {
  const Box b = box_of(scene);
  json& cracks = cracks_of(scene);
  for (int j = 0; j < b.up && j < 200; ++j) cracks.push_back({0.0, (j + 0.5) * b.hz, b.width, (j + 0.5) * b.hz});
  for (int k = draw.integer(0, 300); k > 0; --k)
    cracks.push_back({draw.uniform(0, b.width), draw.uniform(0, b.height), draw.uniform(0, b.width), draw.uniform(0, b.height)});
}

// Every node held but those along one row or column.
void nearly_all_broken(json& scene, Draw& draw) {
  const Box b = box_of(scene);
  const int spared = draw.integer(0, b.up - 1);
  for (int j = 0; j < b.up && j < 200; ++j)
    if (std::abs(j - spared) > 1) cracks_of(scene).push_back({0.0, (j + 0.5) * b.hz, b.width, (j + 0.5) * b.hz});
}

void dense_cracks(json& scene, Draw& draw) {
  const Box b = box_of(scene);
  for (int k = draw.integer(30, 300); k > 0; --k) {
    const double x = draw.uniform(-0.1, 1.1) * b.width, z = draw.uniform(-0.1, 1.1) * b.height,
                 length = draw.log_uniform(1e-3, 0.3) * b.width;
    const double angle = draw.uniform(0.0, 6.2831853);
    cracks_of(scene).push_back({x, z, x + length * std::cos(angle), z + length * std::sin(angle)});
  }
}

void needle_cracks(json& scene, Draw& draw) {
  const Box b = box_of(scene);
  for (int k = draw.integer(1, 20); k > 0; --k) {
    const double x = draw.uniform(0.0, b.width), z = draw.uniform(0.0, b.height), length = draw.log_uniform(1e-18, 1e-3);
    cracks_of(scene).push_back({x, z, x + length, z + draw.sign() * length});
  }
}

void outside(json& scene, Draw& draw) {
  const Box b = box_of(scene);
  const double far = draw.log_uniform(1.0, 1e4);
  cracks_of(scene).push_back({-far, draw.uniform(-1, 2) * b.height, far, draw.uniform(-1, 2) * b.height});
  cracks_of(scene).push_back({b.width * 1.5, 0.0, b.width * 2.5, b.height});
}

void through_from_the_start(json& scene, Draw& draw) {
  const Box b = box_of(scene);
  const double z = draw.uniform(0.0, 1.0) * b.height;
  cracks_of(scene).push_back({-1.0, z, b.width + 1.0, z});
}

void star(json& scene, Draw& draw) {
  const Box b = box_of(scene);
  const double x = 0.5 * b.width, z = 0.5 * b.height, length = draw.uniform(0.1, 0.8) * b.width;
  for (int k = 0; k < 12; ++k)
    cracks_of(scene).push_back({x, z, x + length * std::cos(k * 0.5235987755982988), z + length * std::sin(k * 0.5235987755982988)});
}

void diagonal(json& scene, Draw& draw) {
  const Box b = box_of(scene);
  const double reach = draw.uniform(0.3, 1.0);
  cracks_of(scene).push_back({0.0, 0.0, reach * b.width, reach * b.height});
  if (draw.chance(0.5)) cracks_of(scene).push_back({0.0, b.height, b.width, 0.0});
}

constexpr Twist table[]{
    {"near_overlap", near_overlap},
    {"along_edges", along_edges},
    {"on_grid_lines", on_grid_lines},
    {"all_broken", all_broken},
    {"nearly_all_broken", nearly_all_broken},
    {"dense_cracks", dense_cracks},
    {"needle_cracks", needle_cracks},
    {"outside", outside},
    {"through_from_the_start", through_from_the_start},
    {"star", star},
    {"diagonal", diagonal},
};

}  // namespace

std::span<const Twist> crack_twists() { return table; }

}  // namespace fracfarm::robustness
