// FD-14: the dataset's loading (plates, ramp) in the reference tier closes its energies, and the five-step pick is exact on signals whose
// answer is written down.
#include <fmt/format.h>

#include <cmath>

#include "common/failure/failure.hpp"
#include "tests/studies/fdem_study.hpp"
#include "tests/verification/desk.hpp"
#include "tests/verification/fdem/sample_cases.hpp"

namespace fracfarm::verification {
namespace {

constexpr int signal_rows = 4000;
constexpr double step = 0.5e-6;  // s

// Straight lines between corners (row, value).
std::vector<double> signal(const std::vector<std::pair<int, double>>& corners) {
  std::vector<double> values;
  for (std::size_t k = 0; k + 1 < corners.size(); ++k) {
    const auto [from, low] = corners[k];
    const auto [to, high] = corners[k + 1];
    for (int row = from; row < to; ++row) values.push_back(low + (high - low) * (row - from) / (to - from));
  }
  values.push_back(corners.back().second);
  return values;
}

constexpr int after_key = 420;  // rows from the key peak to the answer

struct Written {
  std::vector<double> stress, energy;
};

// Energy: a small peak, then the key peak with the steepest fall behind it. Stress: a small peak, the strength, and behind the key peak of
// the energy one more peak at +300, the end of whose fall is the answer. `bump`: of a peak at +100 that is too weak to count.
Written written(int key, double bump) {
  return {signal({{0, 0.0},
                  {400, 3.0},
                  {450, 2.0},
                  {1000, 10.0},
                  {key, -2.0},
                  {key + 100, -0.5 + bump},
                  {key + 110, -0.5},
                  {key + 300, 1.5},
                  {key + after_key, 0.2},
                  {key + 600, 1.0},
                  {signal_rows - 1, 0.0}}),
          signal({{0, 0.0}, {600, 2.0}, {700, 1.0}, {key, 20.0}, {key + 200, 8.0}, {key + 500, 9.0}, {signal_rows - 1, 4.0}})};
}

// The largest |error| in rows over many places of the key peak.
double worst_pick(double bump) {
  std::vector<double> time;
  for (int row = 0; row < signal_rows; ++row) time.push_back(step * row);
  double worst = 0.0;
  for (int key = 1200; key < 2600; key += 7) {
    const Written w = written(key, bump);
    const auto pick = five_step(time, w.stress, w.energy);
    worst = std::max(worst, pick ? std::abs(*pick / step - (key + after_key)) : INFINITY);
  }
  return worst;
}

}  // namespace

std::vector<Row> paper_loading(Desk& desk) {
  std::vector<Row> rows;
  int done = 0;
  const studies::Case longest{"pbx", "uniaxial", 7};  // of twelve patterns the one whose ledger closes worst
  for (const studies::Case& which :
       {studies::Case{"shale", "uniaxial", 1}, studies::Case{"tungsten", "uniaxial", 1}, studies::Case{"pbx5", "uniaxial", 1}, longest}) {
    desk.progress(which.material, 0.25 * done++);
    const studies::FdemRun run = studies::run_fdem(studies::fdem_scene(which, 2026, FdemTier::reference));
    if (!run.trouble.empty()) return {compare(run.trouble, "", 1.0, 0.0, 0.0)};
    rows.push_back(between(fmt::format("{}: energy residual over external work", which.material), "", {0.0, 1e-3}, run.residual, 0.0));
    rows.push_back(compare(fmt::format("{}: alarms", which.material), "", 0.0, static_cast<double>(run.notes.size()), 0.0));
  }
  rows.push_back(compare("five-step pick on written signals: largest error", "rows", 0.0, worst_pick(0.0), 1e-9));
  rows.push_back(compare("the same with a peak of 1 % of the range before it", "rows", 0.0, worst_pick(0.12), 1e-9));
  return rows;
}

}  // namespace fracfarm::verification
