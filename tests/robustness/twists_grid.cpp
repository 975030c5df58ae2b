#include <nlohmann/json.hpp>

#include "tests/robustness/twists.hpp"

namespace fracfarm::robustness {
namespace {

using nlohmann::json;

double cell_of(const json& scene) {
  const double width = number_at(scene, "/domain/width"), across = number_at(scene, "/phase_field/cells/0");
  return across > 0 && width > 0 ? width / across : 0.25 / 127.0;
}

void set_cells(json& scene, int across, int up, double aspect = 1.0) {
  const double h = cell_of(scene);
  scene["phase_field"]["cells"] = {across, up};
  scene["domain"] = {{"width", across * h}, {"height", up * h * aspect}};
}

void one_row(json& scene, Draw& draw) { set_cells(scene, draw.integer(1, 64), 1); }
void one_column(json& scene, Draw& draw) { set_cells(scene, 1, draw.integer(1, 64)); }
void few_cells(json& scene, Draw& draw) { set_cells(scene, draw.integer(1, 4), draw.integer(1, 4)); }
void lanes_edge(json& scene, Draw& draw) {
  static constexpr int counts[]{6, 7, 8, 9, 14, 15, 16, 17, 31, 32, 33, 63, 64};
  set_cells(scene, draw.pick(counts), draw.pick(counts));
}
void flat_cells(json& scene, Draw& draw) {
  set_cells(scene, draw.integer(4, 32), draw.integer(4, 32), draw.chance(0.5) ? draw.uniform(0.1, 1.0) : draw.uniform(1.0, 10.0));
}
void absurd_cells(json& scene, Draw& draw) {
  static const json values[]{0, -1, 1e9, 100000, 2.5, "many", json::array(), nullptr, 4000000000u, true};
  if (draw.chance(0.5)) scene["phase_field"]["cells"] = {draw.pick(values), draw.pick(values)};
}

void tiny_domain(json& scene, Draw& draw) { resize(scene, draw.log_uniform(1e-5, 1e-2)); }
void huge_domain(json& scene, Draw& draw) { resize(scene, draw.log_uniform(1e2, 1e4)); }
void domain_limits(json& scene, Draw& draw) {
  static constexpr double sizes[]{1e-6, 1e3, 0.99e-6, 1.01e3, 0.0, -0.1};
  const double size = draw.pick(sizes), width = number_at(scene, "/domain/width");
  if (size > 0.0 && width > 0.0) resize(scene, size / width);
  scene["domain"] = {{"width", size}, {"height", size}};
}

json layer_material(Draw& draw, double contrast) {
  const double young = 1e9 * draw.log_uniform(1.0, contrast);
  return {{"density", draw.log_uniform(500.0, 2e4)},
          {"young", young},
          {"poisson", draw.uniform(0.0, 0.45)},
          {"Gc", draw.log_uniform(1.0, 1e5)},
          {"characteristic_width", draw.log_uniform(1e-3, 1e-2)}};
}

json layers(int count, double height, Draw& draw, double contrast) {
  json list = json::array();
  for (int k = 0; k < count; ++k) {
    json layer{{"material", layer_material(draw, contrast)}};
    if (k + 1 < count) layer["below"] = height * (k + 1) / count;
    list.push_back(layer);
  }
  return {{"layers", list}};
}

// As many layers as rows of elements, or more: each element row its own.
void element_layers(json& scene, Draw& draw) {
  const int up = std::clamp(static_cast<int>(number_at(scene, "/phase_field/cells/1")), 1, 64);
  scene["material"] = layers(draw.chance(0.7) ? up : 3 * up, number_at(scene, "/domain/height"), draw, 1e3);
}
void contrasting_layers(json& scene, Draw& draw) {
  scene["material"] = layers(draw.integer(2, 4), number_at(scene, "/domain/height"), draw, draw.log_uniform(1e2, 1e6));
}
// Layers thinner than any element, which no row of elements may see.
void sliver_layers(json& scene, Draw& draw) {
  const double height = number_at(scene, "/domain/height");
  scene["material"] = {{"layers",
                        {{{"below", height * 0.4}, {"material", "pbx"}},
                         {{"below", height * (0.4 + draw.log_uniform(1e-15, 1e-3))}, {"material", layer_material(draw, 1e4)}},
                         {{"material", "shale"}}}}};
}
void wrong_layers(json& scene, Draw& draw) {
  const double height = number_at(scene, "/domain/height");
  const json wrong[]{
      {{"layers", json::array()}},
      {{"layers", {{{"material", "pbx"}}, {{"material", "shale"}}}}},
      {{"layers", {{{"below", height}, {"material", "pbx"}}, {{"material", "shale"}}}}},
      {{"layers", {{{"below", -height}, {"material", "pbx"}}, {{"material", "shale"}}}}},
      {{"layers",
        {{{"below", 0.3 * height}, {"material", "pbx"}}, {{"below", 0.2 * height}, {"material", "pbx"}}, {{"material", "shale"}}}}}};
  scene["material"] = draw.pick(wrong);
}

constexpr Twist table[]{
    {"one_row", one_row},
    {"one_column", one_column},
    {"few_cells", few_cells},
    {"lanes_edge", lanes_edge},
    {"flat_cells", flat_cells},
    {"absurd_cells", absurd_cells},
    {"tiny_domain", tiny_domain},
    {"huge_domain", huge_domain},
    {"domain_limits", domain_limits},
    {"element_layers", element_layers},
    {"contrasting_layers", contrasting_layers},
    {"sliver_layers", sliver_layers},
    {"wrong_layers", wrong_layers},
};

}  // namespace

std::span<const Twist> grid_twists() { return table; }

}  // namespace fracfarm::robustness
