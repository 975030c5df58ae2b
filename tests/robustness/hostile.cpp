// fracfarm-hostile: thousands of random and hostile scenes through the real parser, solver and record. Each must end as a scene may end;
// ends with status 1 where one does not, and leaves its scene in a file.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "common/base/clock.hpp"
#include "common/base/exit_code.hpp"
#include "common/base/terminal.hpp"
#include "common/base/text.hpp"
#include "tests/robustness/hostile_scene.hpp"
#include "tests/robustness/pool.hpp"
#include "tests/robustness/tally.hpp"

namespace fracfarm::robustness {
namespace {

struct Options {
  std::uint64_t runs = 10'000, seed = 1, first = 0;
  std::optional<std::uint64_t> only;
  Method method = Method::phase_field;
  int jobs = 1, validate_every = 10;
  double limit_s = 20.0;
  std::filesystem::path keep = "hostile-scenes";
  bool json = false;
};

Trial trial_of(const Options& options, std::uint64_t index, const std::filesystem::path& scratch) {
  return {options.seed,
          index,
          options.method,
          options.limit_s,
          options.validate_every > 0 && index % static_cast<std::uint64_t>(options.validate_every) == 0,
          scratch};
}

std::filesystem::path make_scratch() {
  std::string name = (std::filesystem::temp_directory_path() / "fracfarm-hostile-XXXXXX").string();
  if (!::mkdtemp(name.data())) throw std::runtime_error("no folder for records");
  return name;
}

void keep_scene(const Options& options, std::uint64_t index) {
  std::filesystem::create_directories(options.keep);
  std::ofstream(options.keep / fmt::format("seed-{}-run-{}.json", options.seed, index))
      << hostile_scene(options.seed, index, options.method).text;
}

class Progress {
 public:
  explicit Progress(std::uint64_t total) : total_(total) {}
  void show(const Tally& tally) {
    const double elapsed = clock_.monotonic_s() - start_s_;
    if (elapsed < 2.0) return;
    const double left = elapsed / static_cast<double>(tally.runs()) * static_cast<double>(total_ - tally.runs());
    line_.show(fmt::format("{} of {}: {}; {} left", tally.runs(), total_, tally.counts_text(), duration_text(left)));
  }

 private:
  std::uint64_t total_;
  SystemClock clock_;
  double start_s_ = clock_.monotonic_s();
  ProgressLine line_;
};

Tally run_all(const Options& options, const std::filesystem::path& scratch) {
  Tally tally;
  Progress progress(options.runs);
  const auto note = [&](const Outcome& outcome) {
    tally.add(outcome);
    if (outcome.end == End::violation) keep_scene(options, outcome.index);
    progress.show(tally);
  };
  run_pool(
      {options.first, options.runs, options.jobs, options.limit_s},
      [&](std::uint64_t index) { return to_line(outcome_of(trial_of(options, index, scratch))); },
      [&](const std::string& line) { note(from_line(line)); },
      [&](std::uint64_t index, const std::string& why) {
        note({.index = index, .twists = hostile_scene(options.seed, index, options.method).twists, .end = End::violation, .why = why});
      });
  return tally;
}

// In this process, so that a debugger sees it.
int replay(const Options& options, const std::filesystem::path& scratch) {
  Trial trial = trial_of(options, *options.only, scratch);
  trial.validate = options.validate_every > 0;
  const HostileScene scene = hostile_scene(trial.seed, trial.index, trial.method);
  fmt::print("{}\n", scene.text);
  const Outcome outcome = outcome_of(trial);
  fmt::print(stderr, "{} ({}): {}; {} steps, {}\n", end_names[static_cast<int>(outcome.end)], outcome.twists, outcome.why, outcome.steps,
             duration_text(outcome.seconds));
  return outcome.end == End::violation ? exit_failed : exit_ok;
}

int run(const Options& options) {
  const std::filesystem::path scratch = make_scratch();
  int status = exit_ok;
  if (options.only) {
    status = replay(options, scratch);
  } else {
    const Tally tally = run_all(options, scratch);
    fmt::print("{}\n", options.json ? tally.json(options.seed).dump(2, ' ', false, nlohmann::json::error_handler_t::replace)
                                    : tally.text(options.seed));
    status = tally.violations().empty() ? exit_ok : exit_failed;
  }
  std::error_code ignored;
  std::filesystem::remove_all(scratch, ignored);
  return status;
}

}  // namespace
}  // namespace fracfarm::robustness

int main(int argc, char** argv) {
  fracfarm::robustness::Options options;
  CLI::App app("Random and hostile scenes through parser, solver and record: each must end as a scene may end.", "fracfarm-hostile");
  app.add_option("--runs", options.runs, "How many scenes")->capture_default_str();
  app.add_option("--seed", options.seed, "Of the scenes")->capture_default_str();
  std::string method = "phase_field";
  app.add_option("--method", method, "Of the scenes")->check(CLI::IsMember({"phase_field", "fdem"}))->capture_default_str();
  app.add_option("--first", options.first, "Number of the first scene")->capture_default_str();
  app.add_option("--only", options.only, "Print this scene, run it in this process and say how it ended");
  app.add_option("--jobs", options.jobs, "Child processes at once")->check(CLI::Range(1, 1024))->capture_default_str();
  app.add_option("--limit", options.limit_s, "Seconds that one scene may take")->check(CLI::Range(1.0, 3600.0))->capture_default_str();
  app.add_option("--validate-every", options.validate_every, "Records of every so many scenes are written and validated; 0: none")
      ->check(CLI::Range(0, 1'000'000))
      ->capture_default_str();
  app.add_option("--keep", options.keep, "Folder for the scenes of violations")->capture_default_str();
  app.add_flag("--json", options.json, "Print one object");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? fracfarm::exit_ok : fracfarm::exit_bad_input;
  }
  options.method = method == "fdem" ? fracfarm::Method::fdem : fracfarm::Method::phase_field;
  return fracfarm::robustness::run(options);
}
