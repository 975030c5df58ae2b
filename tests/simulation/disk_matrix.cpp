#include "tests/simulation/disk_matrix.hpp"

#include <fmt/format.h>

#include "tests/simulation/world.hpp"

namespace fracfarm::simulation {
namespace {

constexpr std::uint64_t seed = 1;
constexpr Trouble troubles[]{Trouble::no_space,  Trouble::io_error,    Trouble::short_write,
                             Trouble::torn_page, Trouble::lost_writes, Trouble::killed};

Settings undisturbed() {
  Settings settings;
  settings.patterns = matrix_jobs / 2;  // of two acts each
  settings.rough = false;
  return settings;
}

// What is done must be all but job 1, which always diverges.
std::string run_with(Trouble trouble, std::uint64_t call) {
  World world(seed, undisturbed());
  world.disk.plan(call, trouble);
  std::string broken = world.run();
  if (broken.empty() && world.disk.planned()) broken = "the trouble never came";
  if (broken.empty() && world.watched().done() != matrix_jobs - 1) broken = fmt::format("{} jobs are done", world.watched().done());
  return broken;
}

}  // namespace

std::vector<MatrixRow> disk_matrix(std::uint64_t every, const std::function<void(const MatrixRow&)>& told) {
  World world(seed, undisturbed());
  (void)world.run();
  const std::vector<FaultDisk::Call> calls = world.disk.calls();
  std::vector<MatrixRow> rows;
  for (const Trouble trouble : troubles) {
    MatrixRow row{trouble, 0, 0, 0, {}};
    for (std::size_t at = 0; at < calls.size(); ++at) {
      if (!FaultDisk::may_have(calls[at], trouble) || row.calls++ % every != 0) continue;
      ++row.runs;
      const std::string broken = run_with(trouble, at);
      if (broken.empty()) continue;
      if (row.violations++ == 0) row.first = fmt::format("call {}: {}", at, broken);
    }
    told(row);
    rows.push_back(row);
  }
  return rows;
}

std::string text_of(const MatrixRow& row) {
  return fmt::format("{:22} {:6} calls, {:6} campaigns of {} jobs, {} violations{}", name_of(row.trouble), row.calls, row.runs, matrix_jobs,
                     row.violations, row.first.empty() ? "" : ", the first at " + row.first);
}

}  // namespace fracfarm::simulation
