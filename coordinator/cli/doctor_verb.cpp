// fracfarm doctor: is this machine fit to serve or to work?
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "common/base/exit_code.hpp"
#include "common/base/terminal.hpp"
#include "coordinator/cli/checkup.hpp"
#include "coordinator/cli/farm_verbs.hpp"
#include "coordinator/cli/options.hpp"

namespace fracfarm::cli {
namespace {

using nlohmann::json;
using Verdict = CheckupLine::Verdict;

// Does somebody answer? A farm that is not there yet is nothing bad.
CheckupLine reachable(const FarmOptions& options) {
  std::error_code none;
  if (!std::filesystem::exists(options.farm, none)) return {Verdict::good, "farm", "not there yet: fracfarm submit or run makes it", ""};
  Result<FarmLink> link = FarmLink::open(options.farm);
  if (!link) return {Verdict::bad, "farm", link.error().message, "fracfarm coordinator serves it"};
  const Result<wire::Answer> answer = link->ask("status", json::object());
  if (!answer) return {Verdict::bad, "farm", answer.error().message, "look at FARM/log/coordinator.jsonl"};
  return {Verdict::good, "farm", link->served() ? "its coordinator answers" : "no coordinator runs; its ledger can be read", ""};
}

int doctor(const FarmOptions& options) {
  std::vector<CheckupLine> lines = check_up(options.farm);
  lines.push_back(reachable(options));
  const bool bad = std::any_of(lines.begin(), lines.end(), [](const CheckupLine& line) { return line.verdict == Verdict::bad; });
  if (options.json) {
    json list = json::array();
    for (const CheckupLine& it : lines)
      list.push_back({{"name", it.name}, {"verdict", word_of(it.verdict)}, {"found", it.found}, {"advice", it.advice}});
    fmt::print("{}\n", json{{"schema", "fracfarm.doctor/1"}, {"fit", !bad}, {"checks", list}}.dump(2));
    return bad ? exit_failed : exit_ok;
  }
  constexpr Ink inks[] = {Ink::green, Ink::yellow, Ink::red};
  for (const CheckupLine& it : lines) {
    const std::string mark = fmt::format("{:<8}", word_of(it.verdict));
    fmt::print("{} {:<22} {}{}\n", ink(mark, inks[static_cast<int>(it.verdict)], stdout), it.name, it.found,
               it.advice.empty() ? "" : "; " + it.advice);
  }
  return bad ? exit_failed : exit_ok;
}

}  // namespace

int run_doctor(int argc, char** argv) {
  FarmOptions options;
  Command app{
      "Looks at this machine: file systems, free space and inodes, clock, keys, limits, the farm. Exit status 1 where something is bad.",
      "fracfarm doctor"};
  add_farm_options(app, options);
  if (const auto status = app.parse(argc, argv)) return *status;
  return guarded(options, [&] { return doctor(options); });
}

}  // namespace fracfarm::cli
