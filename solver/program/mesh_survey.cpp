#include "solver/program/mesh_survey.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/base/clock.hpp"
#include "common/base/exit_code.hpp"
#include "common/base/terminal.hpp"
#include "common/base/text.hpp"
#include "common/scene/pattern.hpp"
#include "solver/fdem/mesh/gate.hpp"

namespace fracfarm {
namespace {

using Json = nlohmann::ordered_json;

constexpr double crack_reach = 1.0;  // of an element: how far repair may lead a crack from where it was drawn
constexpr double patience_s = 2.0;

struct Findings {
  std::vector<double> triangles, edges, edge_length, heights, angles, seconds;
  double area_error = 0.0;
  long moved = 0, trimmed = 0, extended = 0, merged = 0;
  std::vector<std::pair<int, std::string>> refused, bad;  // pattern and why
};

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

double at_share(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

double mean_edge(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const auto& [a, b] : mesh.edge_nodes) {
    const auto &p = mesh.nodes[static_cast<std::size_t>(a)], &q = mesh.nodes[static_cast<std::size_t>(b)];
    sum += std::hypot(q[0] - p[0], q[1] - p[1]);
  }
  return sum / static_cast<double>(mesh.edge_nodes.size());
}

void look_at(int id, const fdem::MeshChoice& choice, Findings& found) {
  const double before = thread_cpu_s();
  const fdem::MeshResult made = fdem::make_mesh(choice);
  found.seconds.push_back(thread_cpu_s() - before);
  if (!made) return void(found.refused.emplace_back(id, made.error()));
  fdem::MeshReport again;
  if (std::string why = fdem::gate(made->mesh, choice, again); !why.empty()) found.bad.emplace_back(id, std::move(why));
  if (std::string why = fdem::strayed_crack(made->mesh, choice, crack_reach * choice.element_size); !why.empty())
    found.bad.emplace_back(id, std::move(why));
  found.triangles.push_back(static_cast<double>(made->mesh.triangles.size()));
  found.edges.push_back(static_cast<double>(made->mesh.edge_nodes.size()));
  found.edge_length.push_back(mean_edge(made->mesh));
  found.heights.push_back(again.smallest_height);
  found.angles.push_back(again.smallest_angle);
  found.area_error = std::max(found.area_error, again.area_error);
  found.moved += made->report.moved;
  found.trimmed += made->report.trimmed;
  found.extended += made->report.extended;
  found.merged += made->report.merged;
}

Findings look_at_all(const MeshSurvey& survey) {
  Findings found;
  SystemClock clock;
  ProgressLine line;
  const double start = clock.monotonic_s();
  for (int id = 1; id <= survey.patterns; ++id) {
    fdem::MeshChoice choice;
    choice.element_size = survey.element_size;
    choice.seed = static_cast<std::uint64_t>(id);
    choice.cracks = draw_pattern(survey.set, survey.seed, static_cast<std::uint64_t>(id));
    look_at(id, choice, found);
    if (const double elapsed = clock.monotonic_s() - start; elapsed > patience_s)
      line.show(fmt::format("{} of {} meshes  {} left", id, survey.patterns, duration_text(elapsed / id * (survey.patterns - id))));
  }
  return found;
}

Json listed(const std::vector<std::pair<int, std::string>>& rows) {
  Json list = Json::array();
  for (const auto& [id, why] : rows) list.push_back({{"pattern", id}, {"reason", why}});
  return list;
}

void print_json(const MeshSurvey& survey, const Findings& f) {
  const auto spread = [](const std::vector<double>& values) {
    return Json{{"mean", mean(values)}, {"least", at_share(values, 0)}, {"median", at_share(values, 0.5)}, {"most", at_share(values, 1)}};
  };
  const Json out{{"schema", "fracfarm.mesh_survey/1"},
                 {"patterns", survey.patterns},
                 {"set", survey.set == CrackSet::oblique ? "oblique" : "orthogonal"},
                 {"element_size", survey.element_size},
                 {"refused", listed(f.refused)},
                 {"bad", listed(f.bad)},
                 {"triangles", spread(f.triangles)},
                 {"edges", spread(f.edges)},
                 {"edge_length", spread(f.edge_length)},
                 {"smallest_height", spread(f.heights)},
                 {"smallest_angle", spread(f.angles)},
                 {"largest_area_error", f.area_error},
                 {"repairs", {{"moved", f.moved}, {"trimmed", f.trimmed}, {"extended", f.extended}, {"merged", f.merged}}},
                 {"cpu_seconds", spread(f.seconds)}};
  fmt::print("{}\n", out.dump(2));
}

void print_words(const MeshSurvey& survey, const Findings& f) {
  std::vector<std::vector<std::string>> rows{{"quantity", "mean", "least", "most"}};
  const auto row = [&](std::string name, const std::vector<double>& values, double scale) {
    rows.push_back({std::move(name), fmt::format("{:.4g}", scale * mean(values)), fmt::format("{:.4g}", scale * at_share(values, 0)),
                    fmt::format("{:.4g}", scale * at_share(values, 1))});
  };
  row("triangles", f.triangles, 1);
  row("inner edges", f.edges, 1);
  row("mean edge, mm", f.edge_length, 1e3);
  row("smallest height, mm", f.heights, 1e3);
  row("smallest angle, degrees", f.angles, 1);
  row("CPU time, ms", f.seconds, 1e3);
  fmt::print("{}", table_text(rows));
  fmt::print("{} patterns, {} refused ({:.2g} %), largest error of area {:.1e}; {} moved, {} trimmed, {} extended, {} merged\n",
             survey.patterns, f.refused.size(), 100.0 * static_cast<double>(f.refused.size()) / survey.patterns, f.area_error, f.moved,
             f.trimmed, f.extended, f.merged);
  for (const auto& [id, why] : f.refused) fmt::print("  pattern {}: {}\n", id, why);
  for (const auto& [id, why] : f.bad) fmt::print("{} pattern {} passed: {}\n", ink("error:", Ink::red, stdout), id, why);
}

}  // namespace

int survey_meshes(const MeshSurvey& survey) {
  const Findings found = look_at_all(survey);
  survey.json ? print_json(survey, found) : print_words(survey, found);
  return found.bad.empty() ? exit_ok : exit_failed;
}

}  // namespace fracfarm
