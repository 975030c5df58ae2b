// The edge of FDEM's time step: predicted (the mesh's bound, printed before a run) against observed (bisection on short free vibrations),
// over penalty, viscosity and smallest height; and what a real run past the edge does: how soon it alarms, and what solve() makes of it.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>

#include "common/base/atomic_file.hpp"
#include "common/base/exit_code.hpp"
#include "common/base/terminal.hpp"
#include "common/picture/plot.hpp"
#include "solver/fdem/fdem.hpp"
#include "solver/fdem/mesh/scene_mesh.hpp"
#include "tests/studies/fdem_study.hpp"
#include "tests/studies/squeeze.hpp"
#include "tests/studies/studies.hpp"

namespace fracfarm::studies {
namespace {

// One setting of the map, and its two edges.
struct Point {
  std::string material, axis;  // which of the three below is varied
  FdemTier tier = FdemTier::fast;
  double penalty = 10.0, viscosity = 0.1, height = 1.0;  // height: smallest of the mesh, of its own smallest
  double smallest_height = 0.0;                          // m
  double predicted = 0.0, observed = 0.0;                // s
};

constexpr int vibration_steps = 600;
constexpr int sample_every = 20;
constexpr double small_strain = 1e-6;
constexpr double map_side = 0.06;  // m

// A free plate with one crack, stretched by a hair and let go: what it has is all that it may ever have.
Scene free_plate(const Point& point) {
  Scene scene = fdem_scene({point.material, "uniaxial", 1}, 2026, point.tier);
  scene.width = scene.height = map_side;
  scene.cracks = {{0.015, 0.031, 0.042, 0.031}};
  for (auto& side : scene.loads) side.clear();
  scene.initial.strain = {0.0, small_strain, 0.0};
  scene.fdem.penalty = point.penalty, scene.fdem.viscosity = point.viscosity;
  return scene;
}

TriangleMesh mesh_of_point(const Scene& scene, Point& point) {
  TriangleMesh mesh = std::move((*fdem::mesh_of(scene))->mesh);
  const double own = smallest_height(mesh);
  if (point.height < 1.0) squeeze(mesh, point.height * own);
  point.smallest_height = smallest_height(mesh);
  return mesh;
}

bool grows(const Scene& scene, const TriangleMesh& mesh, double dt) {
  const std::unique_ptr<MeshSimulation> body = make_fdem(scene, mesh);
  if (!body->start(dt)) return true;
  const auto energy = [&](long long n) {
    const SampleRow row = body->sample(n, dt);
    return row.kinetic_energy + row.elastic_energy;
  };
  const double at_start = energy(0);
  for (long long n = 0; n < vibration_steps; ++n) {
    if (!body->step(n, dt)) return true;
    if ((n + 1) % sample_every == 0 && !(energy(n + 1) <= 1.05 * at_start)) return true;
  }
  return false;
}

void find_edges(Point& point) {
  const Scene scene = free_plate(point);
  const TriangleMesh mesh = mesh_of_point(scene, point);
  point.predicted = make_fdem(scene, mesh)->stable_dt();
  double low = 0.7, high = 1.4;  // of the prediction
  if (grows(scene, mesh, low * point.predicted)) high = low, low = 0.1;
  while (high - low > 0.004) {
    const double middle = 0.5 * (low + high);
    (grows(scene, mesh, middle * point.predicted) ? high : low) = middle;
  }
  point.observed = 0.5 * (low + high) * point.predicted;
}

std::vector<Point> map_points(const std::vector<std::string>& materials) {
  std::vector<Point> points;
  for (const std::string& material : materials) {
    for (const double penalty : {4.0, 6.0, 10.0, 20.0, 50.0, 100.0})
      points.push_back({material, "penalty", FdemTier::fast, penalty, 0.1, 1.0});
    points.push_back({material, "penalty", FdemTier::reference, 100.0, 0.1, 1.0});
    for (const double viscosity : {0.0, 0.03, 0.1, 0.3, 1.0})
      points.push_back({material, "viscosity", FdemTier::fast, 10.0, viscosity, 1.0});
    for (const double height : {1.0, 0.6, 0.3, 0.15, 0.05}) points.push_back({material, "height", FdemTier::fast, 10.0, 0.1, height});
  }
  return points;
}

// A run of the dataset past the edge.
struct Past {
  Case which;
  double fraction = 0.0;           // of the edge
  std::optional<double> alarm_at;  // s, of the first trial
  long long steps = 0;             // until then
  std::string kind;                // what the alarm saw
  std::size_t alarms = 0;
  std::string then;  // how solve() ended
};

Past run_past(const Case& which, double fraction, const FdemStabilityQuestion& question) {
  Past past{which, fraction, {}, 0, {}, 0, {}};
  Scene scene = fdem_scene(which, question.choice.seed);
  scene.stop = Stop::horizon;
  scene.horizon = scene.frame_interval = question.past_horizon;
  scene.fdem.dt_fraction = fraction;
  const FdemRun run = run_fdem(scene);
  past.alarms = run.notes.size();
  past.then = !run.trouble.empty() ? run.trouble.substr(0, 60)
              : run.notes.empty()  ? "no alarm"
                                   : run.notes.back().substr(0, run.notes.back().find(" after"));
  const std::string evidence = run.notes.empty() ? run.trouble : run.notes.front();
  static const std::regex when("after: (.*) at step ([0-9]+), ([-+0-9.e]+) s");
  std::smatch found;
  if (std::regex_search(evidence, found, when)) {
    past.kind = found[1].str().substr(0, found[1].str().find(" at step"));
    past.steps = std::stoll(found[2]), past.alarm_at = std::stod(found[3]);
  }
  return past;
}

std::string tier_word(FdemTier tier) { return tier == FdemTier::reference ? "reference" : "fast"; }

void print_text(const std::vector<Point>& points, const std::vector<Past>& pasts) {
  std::vector<std::vector<std::string>> rows{
      {"material", "varied", "tier", "penalty", "viscosity", "smallest height mm", "predicted ns", "observed ns", "observed / predicted"}};
  for (const Point& p : points)
    rows.push_back({p.material, p.axis, tier_word(p.tier), fmt::format("{}", p.penalty), fmt::format("{}", p.viscosity),
                    fmt::format("{:.3f}", 1e3 * p.smallest_height), fmt::format("{:.2f}", 1e9 * p.predicted),
                    fmt::format("{:.2f}", 1e9 * p.observed), fmt::format("{:.3f}", p.observed / p.predicted)});
  fmt::print("edge of the step of a free plate of {} m\n{}\n", map_side, table_text(rows));
  std::vector<std::vector<std::string>> past_rows{
      {"material", "pattern", "dt of the edge", "alarm at us", "step", "what it saw", "alarms", "then"}};
  for (const Past& p : pasts)
    past_rows.push_back({p.which.material, std::to_string(p.which.pattern), fmt::format("{}", p.fraction),
                         p.alarm_at ? fmt::format("{:.1f}", 1e6 * *p.alarm_at) : "-", std::to_string(p.steps), p.kind,
                         std::to_string(p.alarms), p.then});
  if (!pasts.empty()) fmt::print("runs past the edge\n{}\n", table_text(past_rows));
}

void print_json(const std::vector<Point>& points, const std::vector<Past>& pasts) {
  using Json = nlohmann::ordered_json;
  Json map = Json::array(), runs = Json::array();
  for (const Point& p : points)
    map.push_back({{"material", p.material},
                   {"varied", p.axis},
                   {"tier", tier_word(p.tier)},
                   {"penalty", p.penalty},
                   {"viscosity", p.viscosity},
                   {"smallest_height", p.smallest_height},
                   {"predicted", p.predicted},
                   {"observed", p.observed}});
  for (const Past& p : pasts)
    runs.push_back({{"material", p.which.material},
                    {"pattern", p.which.pattern},
                    {"dt_fraction", p.fraction},
                    {"alarm_at", p.alarm_at ? Json(*p.alarm_at) : Json(nullptr)},
                    {"steps", p.steps},
                    {"saw", p.kind},
                    {"alarms", p.alarms},
                    {"then", p.then}});
  fmt::print("{}\n", Json{{"schema", "fracfarm.study.fdem_stability/1"}, {"map", map}, {"past", runs}}.dump(2));
}

constexpr picture::Colour colours[]{{31, 107, 184}, {226, 116, 14}, {44, 145, 72}, {130, 84, 176}};

using Value = double (*)(const Point&);

double most(const std::vector<Point>& points, Value value) {
  return value(*std::max_element(points.begin(), points.end(), [&](const Point& a, const Point& b) { return value(a) < value(b); }));
}

// Edges over one of the three settings: predicted as a line by material, observed as crosses.
void draw_axis(picture::Canvas& canvas, const picture::Box& box, std::vector<Point> points, const std::vector<std::string>& materials,
               std::string_view axis, const picture::Axis& x_axis, Value x_of) {
  std::erase_if(points, [&](const Point& p) { return p.axis != axis || p.tier != FdemTier::fast; });
  const double dx = 0.012 * most(points, x_of), dy = 0.02 * most(points, [](const Point&p) { return p.predicted; });
  struct Line {
    std::vector<double> x, y;
  };
  std::vector<Line> predicted(materials.size());
  Line crosses;
  for (const Point& p : points) {
    Line& line = predicted[static_cast<std::size_t>(std::find(materials.begin(), materials.end(), p.material) - materials.begin())];
    line.x.push_back(x_of(p)), line.y.push_back(p.predicted);
    for (const double way : {1.0, -1.0})
      for (const double s : {-1.0, 1.0, 0.0})
        crosses.x.push_back(x_of(p) + s * dx), crosses.y.push_back(s == 0.0 ? NAN : p.observed + way * s * dy);
  }
  picture::Plot plot{"", x_axis, {"time step", "s"}, {}, {}};
  for (std::size_t m = 0; m < materials.size(); ++m) plot.curves.push_back({materials[m], colours[m % 4], predicted[m].x, predicted[m].y});
  plot.curves.push_back({"observed", picture::black, crosses.x, crosses.y});
  draw_plot(canvas, box, plot);
}

picture::Canvas draw_map(const std::vector<Point>& points, const std::vector<std::string>& materials) {
  picture::Canvas canvas(1680, 520);
  canvas.text(24, 30, "Edge of the time step of FDEM: predicted from the mesh (lines) and observed by bisection (crosses)", picture::black,
              picture::Align::left, picture::Font::bold);
  draw_axis(canvas, {0, 40, 560, 480}, points, materials, "penalty", {"penalty p h / C11", ""}, [](const Point& p) { return p.penalty; });
  draw_axis(canvas, {560, 40, 560, 480}, points, materials, "viscosity", {"viscosity, of 2 h sqrt(E rho)", ""},
            [](const Point& p) { return p.viscosity; });
  draw_axis(canvas, {1120, 40, 560, 480}, points, materials, "height", {"smallest height of the mesh", "m"},
            [](const Point& p) { return p.smallest_height; });
  return canvas;
}

}  // namespace

int fdem_stability(const FdemStabilityQuestion& question) {
  std::vector<Point> points = map_points(question.choice.materials);
  for_all(points.size(), question.choice.jobs, [&](std::size_t k) { find_edges(points[k]); });
  std::vector<std::pair<Case, double>> past_cases;
  for (const Case& one : cases_of(question.choice))
    for (const double fraction : question.past) past_cases.emplace_back(one, fraction);
  std::vector<Past> pasts(past_cases.size());
  for_all(pasts.size(), question.choice.jobs,
          [&](std::size_t k) { pasts[k] = run_past(past_cases[k].first, past_cases[k].second, question); });
  question.json ? print_json(points, pasts) : print_text(points, pasts);
  if (!question.picture.empty())
    if (auto kept = write_atomically(question.picture, picture::png_bytes(draw_map(points, question.choice.materials))); !kept) {
      fmt::print(stderr, "{}\n", kept.error().message);
      return exit_failed;
    }
  const bool all_met =
      std::all_of(points.begin(), points.end(), [](const Point& p) { return std::abs(p.observed / p.predicted - 1.0) <= 0.05; });
  return all_met ? exit_ok : exit_failed;
}

}  // namespace fracfarm::studies
