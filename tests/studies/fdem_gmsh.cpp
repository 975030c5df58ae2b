// The same bodies on our meshes and on gmsh's: is the mean response of a body that of its mesher? Another mesh of our own says how much of
// a difference any other mesh makes. Needs the program gmsh.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "common/base/atomic_file.hpp"
#include "common/base/exit_code.hpp"
#include "common/base/hash.hpp"
#include "common/base/terminal.hpp"
#include "solver/fdem/mesh/scene_mesh.hpp"
#include "tests/studies/fdem_study.hpp"
#include "tests/studies/studies.hpp"

namespace fracfarm::studies {
namespace {

namespace fs = std::filesystem;

constexpr double gmsh_size = 1.07;  // of the element size: what is asked for comes out 5 to 9 % shorter
constexpr std::uintmax_t most_bytes = std::uintmax_t{1} << 28;

// The body with our repaired cracks as lines in it, for a mesh by gmsh's Delaunay algorithm.
std::string geo_text(const Scene& scene, const std::vector<Segment>& cracks) {
  std::string text = fmt::format("SetFactory(\"OpenCASCADE\");\nRectangle(1) = {{0, 0, 0, {}, {}}};\n", scene.width, scene.height);
  for (std::size_t i = 0; i < cracks.size(); ++i)
    text += fmt::format("Point({}) = {{{}, {}, 0}};\nPoint({}) = {{{}, {}, 0}};\nLine({}) = {{{}, {}}};\n", 1000 + 2 * i, cracks[i].x0,
                        cracks[i].z0, 1001 + 2 * i, cracks[i].x1, cracks[i].z1, 1000 + i, 1000 + 2 * i, 1001 + 2 * i);
  if (!cracks.empty())
    text += fmt::format("BooleanFragments{{ Surface{{1}}; Delete; }}{{ Line{{1000:{}}}; Delete; }}\n", 999 + cracks.size());
  return text + fmt::format("Mesh.MeshSizeMin = {0};\nMesh.MeshSizeMax = {0};\nMesh.MeshSizeFromPoints = 0;\nMesh.Algorithm = 5;\n",
                            gmsh_size * scene.fdem.element_size);
}

// Empty, or why there is no such mesh.
std::string mesh_by_gmsh(Scene& scene, const fs::path& folder, const std::string& name) {
  const fdem::MeshResult ours = make_mesh(fdem::mesh_choice(scene));
  if (!ours) return "refused: " + ours.error();
  const fs::path geo = folder / (name + ".geo"), msh = folder / (name + ".msh");
  if (const Result<void> written = write_atomically(geo, geo_text(scene, ours->cracks)); !written) return written.error().message;
  const std::string command = fmt::format("gmsh -2 -v 0 -format msh22 -o '{}' '{}'", msh.string(), geo.string());
  if (std::system(command.c_str()) != 0) return "gmsh failed, or is not installed";
  const Result<std::string> bytes = read_file(msh, most_bytes);
  if (!bytes) return bytes.error().message;
  scene.cracks = ours->cracks, scene.fdem.mesh_file = msh.string(), scene.fdem.mesh_sha256 = sha256_hex(*bytes);
  return {};
}

struct Answer {
  std::string trouble;
  std::size_t triangles = 0;
  std::array<double, 5> figures{};  // Pa, Pa, s, 1, m
};
constexpr std::array<const char*, 5> names{"stiffness", "peak", "drop10", "broken edges", "broken length"};

struct GmshCase {
  Case which;
  Answer ours, another, gmsh;
};

Answer answer_of(const Scene& scene) {
  const FdemRun run = run_fdem(scene);
  Answer a;
  a.trouble = run.trouble.empty() && !run.drop10 ? "no stress drop" : run.trouble;
  if (!a.trouble.empty()) return a;
  const Broken broken = broken_by(run, run.last_time);
  a.triangles = run.layout.mesh.triangles.size();
  a.figures = {stiffness_of(run, scene), run.peak, *run.drop10, static_cast<double>(broken.edges), broken.length};
  return a;
}

GmshCase solve_case(const Case& which, const FdemGmshQuestion& question, const fs::path& folder) {
  Scene scene = fdem_scene(which, question.choice.seed);
  GmshCase one{which, answer_of(scene), {}, {}};
  Scene other = scene;
  other.fdem.mesh_seed += 1;
  one.another = answer_of(other);
  const std::string why = mesh_by_gmsh(scene, folder, fmt::format("{}-{}", which.material, which.pattern));
  one.gmsh = why.empty() ? answer_of(scene) : Answer{why, 0, {}};
  return one;
}

struct Apart {
  double mean = 0.0, most = 0.0;  // of the differences with their sign; of their sizes
  std::size_t runs = 0, troubles = 0;
};

Apart apart(const std::vector<GmshCase>& cases, const std::string& material, Answer GmshCase::*mesh, std::size_t figure) {
  Apart a;
  for (const GmshCase& one : cases) {
    if (one.which.material != material) continue;
    const Answer& answer = one.*mesh;
    ++a.runs;
    if (!answer.trouble.empty() || !one.ours.trouble.empty()) {
      ++a.troubles;
      continue;
    }
    const double change = answer.figures[figure] / one.ours.figures[figure] - 1.0;
    a.mean += change, a.most = std::max(a.most, std::abs(change));
  }
  if (a.runs > a.troubles) a.mean /= static_cast<double>(a.runs - a.troubles);
  return a;
}

struct Kind {
  std::string_view name;
  Answer GmshCase::*mesh;
};
constexpr Kind kinds[]{{"gmsh", &GmshCase::gmsh}, {"ours, another seed", &GmshCase::another}};

double triangles_of(const std::vector<GmshCase>& cases, const std::string& material, Answer GmshCase::*mesh) {
  std::vector<double> counts;
  for (const GmshCase& one : cases)
    if (one.which.material == material && (one.*mesh).trouble.empty()) counts.push_back(static_cast<double>((one.*mesh).triangles));
  return spread_of(counts).mean;
}

void print_text(const std::vector<GmshCase>& cases, const FdemGmshQuestion& question) {
  std::vector<std::vector<std::string>> rows{{"material", "mesh", "patterns", "triangles"}};
  for (const char* name : names) rows[0].push_back(fmt::format("{} %", name));
  for (const std::string& material : question.choice.materials)
    for (const Kind& kind : kinds) {
      const Apart first = apart(cases, material, kind.mesh, 0);
      rows.push_back({material, std::string(kind.name), fmt::format("{} of {}", first.runs - first.troubles, first.runs),
                      fmt::format("{:.0f}", triangles_of(cases, material, kind.mesh))});
      for (std::size_t figure = 0; figure < names.size(); ++figure) {
        const Apart a = apart(cases, material, kind.mesh, figure);
        rows.back().push_back(fmt::format("{:+.2f} ({:.2f})", 100.0 * a.mean, 100.0 * a.most));
      }
    }
  fmt::print("against our mesh of seed 1: mean over patterns with its sign (largest size)\n{}\n", table_text(rows));
  for (const GmshCase& one : cases)
    for (const Answer* a : {&one.ours, &one.another, &one.gmsh})
      if (!a->trouble.empty()) fmt::print("{} {}: {}\n", one.which.material, one.which.pattern, a->trouble);
}

nlohmann::ordered_json json_of(const Answer& a) {
  nlohmann::ordered_json out{{"triangles", a.triangles}, {"trouble", a.trouble}};
  for (std::size_t figure = 0; figure < names.size(); ++figure) out[names[figure]] = a.figures[figure];
  return out;
}

void print_json(const std::vector<GmshCase>& cases) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const GmshCase& one : cases)
    list.push_back({{"material", one.which.material},
                    {"pattern", one.which.pattern},
                    {"ours", json_of(one.ours)},
                    {"another", json_of(one.another)},
                    {"gmsh", json_of(one.gmsh)}});
  fmt::print("{}\n", nlohmann::ordered_json{{"schema", "fracfarm.study.fdem_gmsh/1"}, {"cases", list}}.dump(2));
}

}  // namespace

int fdem_gmsh(const FdemGmshQuestion& question) {
  const fs::path folder = question.folder.empty() ? fs::temp_directory_path() / fmt::format("fracfarm-gmsh-{}", question.choice.seed)
                                                  : fs::path(question.folder);
  fs::create_directories(folder);
  const std::vector<Case> cases = cases_of(question.choice);
  std::vector<GmshCase> solved(cases.size());
  for_all(cases.size(), question.choice.jobs, [&](std::size_t k) { solved[k] = solve_case(cases[k], question, folder); });
  question.json ? print_json(solved) : print_text(solved, question);
  bool within = true;
  for (const std::string& material : question.choice.materials)
    for (std::size_t figure = 0; figure < 3; ++figure) {
      const Apart a = apart(solved, material, &GmshCase::gmsh, figure);
      within = within && a.troubles == 0 && std::abs(a.mean) <= question.bulk_limit;
    }
  return within ? exit_ok : exit_failed;
}

}  // namespace fracfarm::studies
