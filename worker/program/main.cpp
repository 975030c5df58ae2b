// fracfarm-worker: the daemon of one node. Options to DaemonOptions, nothing else.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include "common/base/build_info.hpp"
#include "common/base/clock.hpp"
#include "common/base/exit_code.hpp"
#include "common/base/kept_memory.hpp"
#include "worker/daemon.hpp"

namespace {

using namespace fracfarm;
using worker::DaemonOptions;

// Seconds left of a Slurm allocation, where this runs in one.
std::optional<double> slurm_remaining_s() {
  const char* end = std::getenv("SLURM_JOB_END_TIME");
  if (!end) return std::nullopt;
  char* rest = nullptr;
  const double at = std::strtod(end, &rest);
  if (rest == end || *rest != '\0') return std::nullopt;
  return std::max(0.0, at - SystemClock().wall_s());
}

std::filesystem::path solver_beside_this() {
  std::error_code error;
  return std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / "fracfarm-solve";
}

}  // namespace

int main(int argc, char** argv) {
  DaemonOptions options;
  options.farm = "farm";
  options.slots = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  options.slot.solver = solver_beside_this();
  std::optional<double> remaining_s = slurm_remaining_s();
  bool version = false;

  CLI::App app{
      "Takes jobs from the coordinator of a farm and solves them.\n"
      "SIGUSR1 drains (finish, take no more, exit 0); SIGTERM and SIGINT checkpoint, give jobs back, exit 3.",
      "fracfarm worker"};
  app.add_option("--farm", options.farm, "folder of the farm")->capture_default_str();
  app.add_option("--slots", options.slots, "jobs at once; default: cores")->check(CLI::Range(1, 4096));
  app.add_option("--scratch", options.scratch, "folder of this worker for records under way; default FARM/scratch/NAME");
  app.add_option("--solver", options.slot.solver, "solver program; default: fracfarm-solve beside this one");
  app.add_option("--memory-limit", options.slot.memory_limit, "address space of one solver, as in 2G; default: none")
      ->transform(CLI::AsSizeValue(false));
  app.add_option("--remaining", remaining_s, "seconds left of the allocation; default: from SLURM_JOB_END_TIME")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--node", options.node, "name of this node; default: the host's");
  app.add_option("--hang-after", options.slot.hang_s, "kill a solver that says nothing for so many seconds")
      ->check(CLI::Range(1.0, 86400.0))
      ->capture_default_str();
  app.add_option("--grace", options.slot.stop_grace_s, "seconds from SIGTERM to SIGKILL of a solver")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
  app.add_option("--budget-grace", options.slot.budget_grace_s, "seconds beyond its wall budget before a solver is stopped from outside")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
  app.add_flag("--once", options.once, "end when the coordinator says that nothing is left");
  app.add_flag("--quiet", options.quiet, "only warnings and errors on stderr");
  app.add_flag("--version", version, "print the version and end");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& mistake) {
    return app.exit(mistake) == 0 ? exit_ok : exit_bad_input;
  }
  if (version) return fmt::print("fracfarm-worker {}\n", build_info().build_id), exit_ok;
  if (std::error_code error; !std::filesystem::is_directory(options.farm, error)) {
    fmt::print(stderr, "error: no farm at {}; name its folder with --farm, or start a coordinator there first\n", options.farm.string());
    return exit_bad_input;
  }
  keep_freed_memory();
  options.farm = std::filesystem::absolute(options.farm).lexically_normal();
  options.remaining_s = remaining_s;
  return worker::run_daemon(options);
}
