// The same patterns at twice, once and half the element size, on several meshes each: does the body answer alike (stiffness, peak), and how
// do the times and the cracks move (seed paper, figure 12).
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "common/base/exit_code.hpp"
#include "common/base/terminal.hpp"
#include "tests/studies/fdem_study.hpp"
#include "tests/studies/studies.hpp"

namespace fracfarm::studies {
namespace {

struct MeshCase {
  Case which;
  double size = 0.0;  // m
  int seed = 1;       // of the mesh
  std::string trouble;
  std::size_t triangles = 0;
  double stiffness = 0.0, peak = 0.0, drop = 0.0, length = 0.0, cpu_s = 0.0;  // Pa, Pa, s, m, s
  std::array<double, direction_bins> directions{};
};

void solve_case(MeshCase& one, const FdemMeshQuestion& question) {
  Scene scene = fdem_scene(one.which, question.choice.seed);
  scene.fdem.element_size = one.size, scene.fdem.mesh_seed = static_cast<std::uint64_t>(one.seed);
  const FdemRun run = run_fdem(scene);
  one.trouble = run.trouble.empty() && !run.drop10 ? "no stress drop" : run.trouble;
  if (!one.trouble.empty()) return;
  one.triangles = run.layout.mesh.triangles.size();
  one.stiffness = stiffness_of(run, scene), one.peak = run.peak, one.drop = *run.drop10, one.cpu_s = run.cpu_s;
  one.length = broken_by(run, run.last_time).length;
  one.directions = directions_by(run, run.last_time);
}

using Get = double (*)(const MeshCase&);

// Each pattern's mean over meshes of one size, over that of the middle size: mean over patterns, largest distance from 1, and the largest
// (most - least) / mean over the meshes of one pattern.
struct Moved {
  double mean = 0.0, farthest = 0.0, scatter = 0.0;
};

Spread over_meshes(const std::vector<MeshCase>& cases, const Case& which, double size, Get get) {
  std::vector<double> values;
  for (const MeshCase& c : cases)
    if (c.trouble.empty() && c.which.material == which.material && c.which.pattern == which.pattern && c.size == size)
      values.push_back(get(c));
  return spread_of(values);
}

Moved moved(const std::vector<MeshCase>& cases, const FdemMeshQuestion& question, const std::string& material, double size, Get get) {
  Moved m;
  for (int pattern = 1; pattern <= question.choice.patterns; ++pattern) {
    const Case which{material, "uniaxial", pattern};
    const Spread here = over_meshes(cases, which, size, get), middle = over_meshes(cases, which, question.sizes[1], get);
    const double ratio = middle.mean > 0.0 ? here.mean / middle.mean : 0.0;
    m.mean += ratio / question.choice.patterns;
    m.farthest = std::max(m.farthest, std::abs(ratio - 1.0));
    m.scatter = std::max(m.scatter, here.mean > 0.0 ? (here.most - here.least) / here.mean : 0.0);
  }
  return m;
}

constexpr std::pair<const char*, Get> figures[]{{"stiffness", [](const MeshCase& c) { return c.stiffness; }},
                                                {"peak", [](const MeshCase& c) { return c.peak; }},
                                                {"drop10", [](const MeshCase& c) { return c.drop; }},
                                                {"broken length", [](const MeshCase& c) { return c.length; }}};

std::string directions_text(const std::vector<MeshCase>& cases, const std::string& material, double size) {
  std::string text;
  for (std::size_t bin = 0; bin < direction_bins; ++bin) {
    std::vector<double> shares;
    for (const MeshCase& c : cases)
      if (c.trouble.empty() && c.which.material == material && c.size == size) shares.push_back(c.directions[bin]);
    text += fmt::format("{}{:.0f}", bin ? " " : "", 100.0 * spread_of(shares).mean);
  }
  return text;
}

void print_text(const std::vector<MeshCase>& cases, const FdemMeshQuestion& question) {
  std::vector<std::vector<std::string>> rows{{"material", "h mm", "triangles"}};
  for (const auto& [name, get] : figures) rows[0].push_back(name);
  rows[0].insert(rows[0].end(), {"directions %", "CPU s", "trouble"});
  for (const std::string& material : question.choice.materials)
    for (const double size : question.sizes) {
      std::vector<double> cpu, triangles;
      std::size_t troubles = 0;
      for (const MeshCase& c : cases)
        if (c.which.material == material && c.size == size)
          cpu.push_back(c.cpu_s), triangles.push_back(static_cast<double>(c.triangles)), troubles += !c.trouble.empty();
      rows.push_back({material, fmt::format("{:.2g}", 1e3 * size), fmt::format("{:.0f}", spread_of(triangles).mean)});
      for (const auto& [name, get] : figures) {
        const Moved m = moved(cases, question, material, size, get);
        rows.back().push_back(fmt::format("{:.3f} ({:.1f}; {:.1f})", m.mean, 100.0 * m.farthest, 100.0 * m.scatter));
      }
      rows.back().insert(rows.back().end(),
                         {directions_text(cases, material, size), fmt::format("{:.2f}", spread_of(cpu).mean), std::to_string(troubles)});
    }
  fmt::print(
      "each figure over that of the middle size, mean over patterns (largest distance from 1 of a pattern in %; largest spread over the "
      "meshes\nof a pattern in %); directions: shares of the broken length around 0, 30, 60, 90, 120, 150 degrees\n{}\n",
      table_text(rows));
}

void print_json(const std::vector<MeshCase>& cases) {
  using Json = nlohmann::ordered_json;
  Json list = Json::array();
  for (const MeshCase& c : cases)
    list.push_back({{"material", c.which.material},
                    {"pattern", c.which.pattern},
                    {"element_size", c.size},
                    {"mesh_seed", c.seed},
                    {"trouble", c.trouble},
                    {"triangles", c.triangles},
                    {"stiffness", c.stiffness},
                    {"peak", c.peak},
                    {"drop10", c.drop},
                    {"broken_length", c.length},
                    {"directions", c.directions},
                    {"cpu_s", c.cpu_s}});
  fmt::print("{}\n", Json{{"schema", "fracfarm.study.fdem_mesh/1"}, {"runs", list}}.dump(2));
}

}  // namespace

int fdem_mesh(const FdemMeshQuestion& question) {
  std::vector<MeshCase> cases;
  for (const Case& which : cases_of(question.choice))
    for (const double size : question.sizes)
      for (int seed = 1; seed <= question.meshes; ++seed) cases.push_back({which, size, seed, "", 0, 0, 0, 0, 0, 0, {}});
  for_all(cases.size(), question.choice.jobs, [&](std::size_t k) { solve_case(cases[k], question); });
  question.json ? print_json(cases) : print_text(cases, question);
  bool within = true;
  for (const std::string& material : question.choice.materials)
    for (const double size : question.sizes)
      for (const auto& [name, get] : {figures[0], figures[1]})
        within = within && moved(cases, question, material, size, get).farthest <= question.bulk_limit;
  return within ? exit_ok : exit_failed;
}

}  // namespace fracfarm::studies
