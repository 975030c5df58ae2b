// That the hostile scenes could find something: each rule of acceptance refuses a result that breaks it, and no child can take the command
// with it.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <cstdlib>
#include <limits>
#include <map>
#include <set>

#include "tests/robustness/accepted.hpp"
#include "tests/robustness/hostile_scene.hpp"
#include "tests/robustness/outcome.hpp"
#include "tests/robustness/pool.hpp"
#include "tests/solver/scenes.hpp"

using namespace fracfarm;
using namespace fracfarm::robustness;

namespace {

const Scene& scene() {
  static const Scene cracked = test::cracked("pbx", 24);
  return cracked;
}

const RunResult& sound() {
  static const RunResult result = solve(scene(), {}).value();
  return result;
}

std::string first_word(const std::string& text) { return text.substr(0, text.find(':')); }

// The rule that a changed result breaks.
template <class Change>
std::string broken_by(Change change) {
  RunResult result = sound();
  change(result);
  return first_word(broken_rule(scene(), result));
}

double& at(RunResult& r, std::string_view name, std::size_t row) {
  for (Column& column : r.series.columns)
    if (column.name == name) return column.values.at(row);
  throw std::runtime_error("no such column");
}

}  // namespace

TEST_CASE("a sound run is accepted, and its ledger is closed without being empty") {
  REQUIRE(sound().judgement.rule == "through_crack");
  CHECK(broken_rule(scene(), sound()).empty());
  CHECK(ledger_share(sound()) > 0.0);
}

TEST_CASE("each rule of acceptance refuses what breaks it") {
  CHECK(broken_by([](RunResult& r) { r.frames.back().damage.pop_back(); }) == "sizes");
  CHECK(broken_by([](RunResult& r) { at(r, "stress_xx", 3) = std::numeric_limits<double>::quiet_NaN(); }) == "finite");
  CHECK(broken_by([](RunResult& r) { r.damage_failure[7] = 1.001f; }) == "damage_in_range");
  CHECK(broken_by([](RunResult& r) {
          for (std::size_t n = 0; n < std::get<GridLayout>(r.layout).mask.size(); ++n)
            if (std::get<GridLayout>(r.layout).mask[n]) r.damage_failure[n] = 0.99f;
        }) == "cracks_held");
  CHECK(broken_by([](RunResult& r) {
          r.frames.back().damage = std::vector<float>(r.frames.back().damage.size(), 1.0f), r.frames.front().damage = r.frames.back().damage,
          r.frames.back().damage[0] = 0.5f;
        }) == "never_heals");
  CHECK(broken_by([](RunResult& r) { r.frames.back().time = 1.0; }) == "times");
  CHECK(broken_by([](RunResult& r) { r.judgement.time_to_failure.reset(); }) == "time_to_failure");
  CHECK(broken_by([](RunResult& r) { r.judgement.time_to_failure = 1.0; }) == "time_to_failure");
  CHECK(broken_by([](RunResult& r) { r.damage_failure = r.damage_initial; }) == "through_crack");
  CHECK(broken_by([](RunResult& r) {
          r.judgement = {Verdict::failed, r.series["step_time"][5], "stress_drop", 1.0}, r.damage_failure = r.damage_initial;
        }) == "stress_drop");
  CHECK(broken_by([](RunResult& r) { r.peak_stress *= 0.9; }) == "peak");
  CHECK(broken_by([](RunResult& r) { at(r, "kinetic_energy", 20) *= 1.5; }) == "ledger_closed");
  CHECK(broken_by([](RunResult& r) {
          for (Column& column : r.series.columns)
            if (column.name != "step_time" && column.name != "dt" && column.name != "stress_zz")
              column.values.assign(column.values.size(), 0.0);
        }) == "something_happens");
}

TEST_CASE("a child that dies, hangs or leaves is counted, and the others' answers come in") {
  std::map<std::uint64_t, std::string> lost;
  std::set<std::string> answers;
  const auto work = [](std::uint64_t number) -> std::string {
    if (number == 3) std::raise(SIGKILL);
    if (number == 5) ::pause();
    if (number == 7) ::_exit(9);
    return std::to_string(number) + "\n";
  };
  run_pool(
      {0, 12, 2, 0.5}, work, [&](const std::string& line) { answers.insert(line); },
      [&](std::uint64_t number, const std::string& why) { lost[number] = why; });
  CHECK(answers.size() == 9);
  REQUIRE(lost.size() == 3);
  CHECK(lost[3].find("signal 9") != std::string::npos);
  CHECK(lost[5].find("hung") == 0);
  CHECK(lost[7] == "died with status 9");
}

TEST_CASE("a hostile scene is the same whenever it is asked for, and its outcome survives the line that carries it") {
  CHECK(hostile_scene(5, 17).text == hostile_scene(5, 17).text);
  CHECK(hostile_scene(5, 17).text != hostile_scene(5, 18).text);
  Outcome outcome = outcome_of_text("{\"method\": NaN}", {});
  CHECK(outcome.end == End::rejected);
  outcome.twists = "a+b", outcome.index = 77;
  const Outcome back = from_line(to_line(outcome));
  CHECK(back.index == 77);
  CHECK(back.end == outcome.end);
  CHECK(back.why == outcome.why);
  CHECK(back.twists == "a+b");
}
