// What the rules of content.cpp are made of: the tables by method, and the rules that hold for every method. Private to the rules.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/record/record.hpp"
#include "common/record/rounding.hpp"
#include "common/scene/scene.hpp"

namespace fracfarm::content {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double psi_spacing = 1.0 / (1 << psi_fraction_bits);  // of stored values

struct Context {
  const Record& record;
  const std::optional<Scene>& scene;      // nothing where the text is not a scene
  bool damage_in_range = false;           // every damage field: most rules about it need no second look
  std::vector<std::int32_t> broken_from;  // FDEM: by edge the first frame that has it broken, the number of frames where none has
};

// A number that may be at most its limit; infinity where it cannot be worked out.
struct Rule {
  std::string_view name;
  std::string_view meaning;
  double limit;
  double (*value)(const Context&);
};

std::span<const Rule> phase_field_rules();
std::span<const Rule> fdem_rules();

// Empty where sizes fit together and what is counted by another dataset lies within it, else what does not, in words.
std::string broken_fields(const PhaseFieldFrames& frames);
std::string broken_fields(const FdemFrames& frames);

// Of every method.
double series_not_finite(const Context& c);  // numbers of the series and of the summary, a count
double series_times(const Context& c);
double frame_times(const Context& c, const std::vector<double>& time);
double scene_differences(const Context& c);
double wrong_key(const Context& c);
double wrong_ledger(const Context& c);
double open_ledger(const Context& c);
double residual_difference(const Context& c);
double peak_difference(const Context& c, double cells);  // across the smaller side of the body
double judgement_differences(const Context& c);

// The damage of a run as its method keeps it: at the start, the frames in order, and at the failure.
struct DamageHistory {
  const std::vector<double>& time;
  const std::vector<std::vector<float>>& frames;
  const std::vector<float>& initial;
  const std::vector<float>& failure;
};
double largest_healing(const Context& c, const DamageHistory& damage);

const FailureTime* candidate(const Record& record, std::string_view rule);
double seconds_apart(const Context& c, std::string_view rule, const std::optional<double>& again);

std::size_t count_not_finite(std::span<const double> values);

// Of a mesh, whose indices broken_fields() found to lie within it.
double outside_domain(const Context& c);    // largest distance of a node from the scene's rectangle, over the element size
double turned_triangles(const Context& c);  // count of those that are not counter-clockwise or have no area
double area_difference(const Context& c);   // of the triangles' sum from the rectangle, relative
double unmatched_edges(const Context& c);   // count of edges that do not part the two triangles they name, and of sides without an edge
double crack_distance(const Context& c);    // largest between the cracks of the scene and those of the mesh, over the element size

}  // namespace fracfarm::content
