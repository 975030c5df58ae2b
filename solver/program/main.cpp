// fracfarm-solve: one scene by hand, or the kept-alive child of a worker. Knows no network and no ledger.
#include <fmt/format.h>

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdlib>

#include "common/base/build_info.hpp"
#include "common/base/exit_code.hpp"
#include "common/base/kept_memory.hpp"
#include "solver/program/duration.hpp"
#include "solver/program/one_shot.hpp"
#include "solver/program/serve.hpp"
#include "solver/program/signals.hpp"

namespace {

// OpenMP's threads spin while they wait for each other, which makes a run up to ten times slower where other work wants the cores. Its
// library reads its settings as the program is loaded, so the program is loaded again.
void let_threads_sleep(char** argv) {
  if (std::getenv("OMP_WAIT_POLICY") || std::getenv("GOMP_SPINCOUNT")) return;
  setenv("OMP_WAIT_POLICY", "passive", 1);
  execv("/proc/self/exe", argv);  // comes back where it cannot: they spin
}

}  // namespace

int main(int argc, char** argv) {
  using namespace fracfarm;
  OneShot options;
  std::string budget = "8h";
  bool serving = false;
  CLI::App app{"Solves one scene and writes its record.", "fracfarm solve"};
  app.add_option("SCENE", options.scene, "scene file, - for standard input");
  app.add_option("-o,--output", options.output, "record to write (HDF5)");
  app.add_option("--checkpoint", options.checkpoint,
                 "kept on SIGTERM, SIGINT, at the wall budget and every 5 minutes; resumed from where it fits");
  app.add_option("--wall-budget", budget, "wall-clock limit: seconds, or 30s, 10m, 8h, 2d")->capture_default_str();
  app.add_option("--threads", options.threads, "of one FDEM run; the result is the same to the last bit")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  app.add_flag("--json", options.json, "print the summary as one JSON object");
  app.add_flag("--quiet", options.quiet, "no progress and no warnings");
  app.add_flag("--serve", serving, "read tasks on standard input and report on standard output, for a worker");
  app.set_version_flag("--version", build_info().build_id);
  app.footer("exit status: 0 solved, 1 failed (diverged, no disk), 2 bad input or a scene that is rejected, 3 stopped by a signal");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& mistake) {
    return app.exit(mistake) == 0 ? exit_ok : exit_bad_input;
  }
  if (options.threads > 1) let_threads_sleep(argv);
  use_large_pages();
  catch_stop_signals();
  if (serving) return serve();
  const std::optional<double> seconds = parse_duration(budget);
  if (options.scene.empty() || options.output.empty() || !seconds) {
    if (options.scene.empty()) fmt::print(stderr, "error: SCENE is missing: a scene file, or - for standard input\n");
    if (options.output.empty()) fmt::print(stderr, "error: --output is missing: the record to write\n");
    if (!seconds) fmt::print(stderr, "error: --wall-budget = {}; allowed: a positive number of seconds, or with s, m, h or d\n", budget);
    return exit_bad_input;
  }
  options.wall_budget_s = *seconds;
  return solve_one(options);
}
