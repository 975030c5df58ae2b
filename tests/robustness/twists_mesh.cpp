// FDEM's own twists: what makes slivers, settings past any sense, layers, odd bodies.
#include <nlohmann/json.hpp>

#include "tests/robustness/twists.hpp"

namespace fracfarm::robustness {
namespace {

using nlohmann::json;

struct Body {
  double width, height, h;
};

Body body_of(const json& scene) {
  return {number_at(scene, "/domain/width"), number_at(scene, "/domain/height"), number_at(scene, "/fdem/element_size")};
}

json& cracks_of(json& scene) {
  json& cracks = scene["cracks"];
  if (!cracks.is_array()) cracks = json::array();
  return cracks;
}

constexpr double near_misses[]{0.0, 1e-15, 1e-9, 1e-4, 0.01, 0.05, 0.1, 0.2, 0.3, 0.45, 0.5, 0.55, 0.8, 1.0, 1.3};  // of an element

// Ends that stop just before, on or just behind another crack.
void near_misses_of_ends(json& scene, Draw& draw) {
  const Body b = body_of(scene);
  const double z = draw.uniform(0.2, 0.8) * b.height;
  cracks_of(scene).push_back({0.2 * b.width, z, 0.8 * b.width, z});
  for (int k = draw.integer(1, 8); k > 0; --k) {
    const double x = draw.uniform(0.15, 0.85) * b.width, end = z + draw.sign() * draw.pick(near_misses) * b.h;
    scene["cracks"].push_back({x, end + draw.sign() * draw.uniform(0.1, 0.4) * b.height, x + draw.uniform(-1.0, 1.0) * b.h, end});
  }
}

// Crossings at angles that no triangle can fill.
void shallow_crossings(json& scene, Draw& draw) {
  const Body b = body_of(scene);
  const double x = 0.5 * b.width, z = draw.uniform(0.3, 0.7) * b.height, reach = draw.uniform(0.1, 0.4) * b.width;
  for (int k = draw.integer(2, 6); k > 0; --k) {
    const double rise = draw.sign() * draw.log_uniform(1e-12, 0.3) * reach;
    cracks_of(scene).push_back({x - reach, z - rise, x + reach, z + rise});
  }
}

void ends_near_sides(json& scene, Draw& draw) {
  const Body b = body_of(scene);
  for (int k = draw.integer(1, 6); k > 0; --k) {
    const double gap = draw.pick(near_misses) * b.h, z = draw.uniform(0.0, 1.0) * b.height, x = draw.uniform(0.0, 1.0) * b.width;
    const json ends[]{{gap, z, 0.4 * b.width, z},
                      {x, gap, x, 0.4 * b.height},
                      {0.1 * b.width, gap, 0.9 * b.width, gap},
                      {b.width - gap, 0.1 * b.height, b.width - gap, 0.8 * b.height}};
    cracks_of(scene).push_back(draw.pick(ends));
  }
}

// A lattice of cracks as fine as the mesh: hardly an edge is whole.
void nothing_whole(json& scene, Draw& draw) {
  const Body b = body_of(scene);
  const double step = draw.uniform(0.9, 2.5) * b.h;
  for (double x = step; x < b.width && cracks_of(scene).size() < 400; x += step) scene["cracks"].push_back({x, 0.0, x, b.height});
  for (double z = step; z < b.height && cracks_of(scene).size() < 400; z += step) scene["cracks"].push_back({0.0, z, b.width, z});
}

void a_fan(json& scene, Draw& draw) {
  const Body b = body_of(scene);
  const int blades = draw.integer(3, 40);
  for (int k = 0; k < blades; ++k) {
    const double angle = 3.141592653589793 * k / blades, reach = draw.uniform(0.5, 12.0) * b.h;
    cracks_of(scene).push_back(
        {0.5 * b.width, 0.5 * b.height, 0.5 * b.width + reach * std::cos(angle), 0.5 * b.height + reach * std::sin(angle)});
  }
}

void settings(json& scene, Draw& draw) {
  json& fdem = scene["fdem"];
  for (int k = draw.integer(1, 4); k > 0; --k) switch (draw.integer(0, 7)) {
      case 0:
        fdem["penalty"] = draw.log_uniform(0.1, 1e4);
        break;
      case 1:
        fdem["viscosity"] = draw.chance(0.3) ? 0.0 : draw.log_uniform(1e-3, 10.0);
        break;
      case 2:
        fdem["contact_penalty"] = draw.log_uniform(1e-3, 1e3);
        break;
      case 3:
        fdem["softening"] = "linear";
        break;
      case 4:
        fdem["tier"] = draw.chance(0.6) ? "reference" : "screening";
        break;
      case 5:
        fdem["precision"] = draw.chance(0.5) ? "double" : "float";
        break;
      case 6:
        fdem["mesh_seed"] = draw.integer(0, 1 << 30);
        break;
      default:
        fdem["element_size"] = body_of(scene).h * draw.uniform(0.6, 2.0);
    }
}
void past_the_bound(json& scene, Draw& draw) { scene["fdem"]["dt_fraction"] = draw.uniform(0.8, 1.5); }
void step_in_seconds(json& scene, Draw& draw) {
  scene["fdem"].erase("dt_fraction");
  scene["fdem"]["dt"] = draw.log_uniform(1e-9, 1e-5);
}
void absurd_settings(json& scene, Draw& draw) {
  static constexpr const char* keys[]{"penalty", "viscosity", "contact_penalty", "dt_fraction", "dt", "element_size"};
  static constexpr double values[]{0.0, -1.0, 1e300, -1e300, 5e-324, 1e6, 1e-30, 10.0, 0.1};
  scene["fdem"][draw.pick(keys)] = draw.pick(values);
}
void no_such_mesh(json& scene, Draw& draw) {
  scene["fdem"]["mesh_file"] = "no/such/mesh.msh";
  if (draw.chance(0.6)) scene["fdem"]["mesh_sha256"] = std::string(64, 'a');
}

json some_material(Draw& draw) {
  static constexpr const char* names[]{"pbx", "pbx5", "shale", "tungsten"};
  return draw.pick(names);
}
json own_material(Draw& draw, double wildness) {
  const double ft = 1e6 * draw.log_uniform(1.0, 1e2 * wildness), G = 10.0 * draw.log_uniform(1.0, 1e3 * wildness);
  return {{"density", draw.log_uniform(1e3, 2e4)},
          {"young", draw.log_uniform(1e9 / wildness, 4e11 * wildness)},
          {"poisson", draw.uniform(0.0, 0.45)},
          {"Gc", 100.0},
          {"characteristic_width", 0.004},
          {"friction", draw.uniform(0.0, 1.0)},
          {"tensile_strength", ft},
          {"shear_strength", ft * draw.log_uniform(0.3, 10.0)},
          {"GI", G},
          {"GII", G * draw.log_uniform(0.3, 10.0)}};
}
void own(json& scene, Draw& draw) { scene["material"] = own_material(draw, 1.0); }
void wild(json& scene, Draw& draw) { scene["material"] = own_material(draw, draw.log_uniform(1.0, 1e4)); }
// Past every range that a body could have.
void absurd_cohesion(json& scene, Draw& draw) {
  scene["material"] = own_material(draw, 1.0);
  static constexpr const char* keys[]{"friction", "tensile_strength", "shear_strength", "GI", "GII", "density", "young"};
  static constexpr double values[]{0.0, -1.0, 5e-324, 1e-300, 1e-30, 1e-6, 1e15, 1e30, 1e300};
  for (int k = draw.integer(1, 3); k > 0; --k) scene["material"][draw.pick(keys)] = draw.pick(values);
}

// Layers at any height: through cracks, along them, thinner than an element.
void layered(json& scene, Draw& draw) {
  const Body b = body_of(scene);
  json list = json::array();
  double below = 0.0;
  for (int k = draw.integer(1, 4); k > 0; --k) {
    below += draw.chance(0.3) ? draw.pick(near_misses) * b.h : draw.uniform(0.05, 0.3) * b.height;
    list.push_back({{"below", below}, {"material", draw.chance(0.7) ? some_material(draw) : own_material(draw, 10.0)}});
  }
  list.push_back({{"material", some_material(draw)}});
  scene["material"] = {{"layers", list}};
  if (draw.chance(0.3)) cracks_of(scene).push_back({0.1 * b.width, below, 0.9 * b.width, below + draw.pick(near_misses) * b.h});
}

void resized(json& scene, double factor) {
  resize(scene, factor);
  scene["fdem"]["element_size"] = body_of(scene).h * factor;
}
void tiny_body(json& scene, Draw& draw) { resized(scene, draw.log_uniform(1e-4, 1e-2)); }
void huge_body(json& scene, Draw& draw) { resized(scene, draw.log_uniform(1e2, 1e5)); }
void odd_aspect(json& scene, Draw& draw) {
  const Body b = body_of(scene);
  const double factor = draw.log_uniform(2.0, 8.0);
  scene["domain"] = draw.chance(0.5) ? json{{"width", b.width * factor}, {"height", 5.0 * b.h}}
                                     : json{{"width", 5.0 * b.h}, {"height", b.height * factor}};
}
void few_elements(json& scene, Draw& draw) {
  const Body b = body_of(scene);
  scene["domain"] = {{"width", draw.uniform(3.5, 8.0) * b.h}, {"height", draw.uniform(3.5, 8.0) * b.h}};
}
void too_fine(json& scene, Draw& draw) { scene["fdem"]["element_size"] = body_of(scene).h * draw.log_uniform(1e-9, 1e-3); }
void too_coarse(json& scene, Draw& draw) { scene["fdem"]["element_size"] = body_of(scene).width * draw.log_uniform(0.1, 1e3); }
void to_the_pick(json& scene, Draw& draw) { scene["time"]["stop"] = draw.chance(0.5) ? "failure" : "drop10"; }

constexpr Twist table[]{
    {"near_misses_of_ends", near_misses_of_ends},
    {"shallow_crossings", shallow_crossings},
    {"ends_near_sides", ends_near_sides},
    {"nothing_whole", nothing_whole},
    {"a_fan", a_fan},
    {"settings", settings},
    {"past_the_bound", past_the_bound},
    {"step_in_seconds", step_in_seconds},
    {"absurd_settings", absurd_settings},
    {"no_such_mesh", no_such_mesh},
    {"own", own},
    {"wild", wild},
    {"absurd_cohesion", absurd_cohesion},
    {"layered", layered},
    {"tiny_body", tiny_body},
    {"huge_body", huge_body},
    {"odd_aspect", odd_aspect},
    {"few_elements", few_elements},
    {"too_fine", too_fine},
    {"too_coarse", too_coarse},
    {"to_the_pick", to_the_pick},
};

}  // namespace

std::span<const Twist> mesh_twists() { return table; }

}  // namespace fracfarm::robustness
