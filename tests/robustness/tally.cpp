#include "tests/robustness/tally.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "common/base/terminal.hpp"
#include "common/base/text.hpp"

namespace fracfarm::robustness {
namespace {

// The evidence without its numbers: "not finite", "the energy ledger is open", ...
std::string kind_of(const std::string& evidence) { return evidence.substr(0, evidence.find_first_of(":;0123456789")); }

template <class Each>
void each_twist(const std::string& twists, Each each) {
  for (std::size_t from = 0; from <= twists.size();) {
    const std::size_t to = std::min(twists.find('+', from), twists.size());
    each(twists.substr(from, to - from));
    from = to + 1;
  }
}

}  // namespace

void Tally::add(const Outcome& outcome) {
  const std::size_t end = static_cast<std::size_t>(outcome.end);
  ++runs_;
  ++counts_[end];
  steps_ += outcome.steps;
  validated_ += outcome.validated;
  each_twist(outcome.twists, [&](const std::string& twist) { ++by_twist_[twist][end]; });
  if (outcome.end == End::numeric) ++numeric_[kind_of(outcome.why)];
  if (outcome.end == End::failed || outcome.end == End::censored) ++rules_[outcome.why];
  if (outcome.end == End::violation) violations_.push_back(outcome);
  if (outcome.seconds > slowest_.seconds) slowest_ = outcome;
  if (outcome.ledger_share > worst_ledger_.ledger_share) worst_ledger_ = outcome;
}

std::string Tally::counts_text() const {
  std::string text;
  for (std::size_t k = 0; k < counts_.size(); ++k) text += fmt::format("{}{} {}", k ? ", " : "", counts_[k], end_names[k]);
  return text;
}

std::string Tally::text(std::uint64_t seed) const {
  std::vector<std::vector<std::string>> rows{{"twist"}};
  for (const char* name : end_names) rows[0].push_back(name);
  for (const auto& [twist, counts] : by_twist_) {
    rows.push_back({twist});
    for (const std::uint64_t count : counts) rows.back().push_back(std::to_string(count));
  }
  std::string text = table_text(rows) + "\n";
  text += fmt::format("{} runs of seed {}: {}\n", runs_, seed, counts_text());
  for (const auto& [rule, count] : rules_) text += fmt::format("  ended by {}: {}\n", rule, count);
  for (const auto& [kind, count] : numeric_) text += fmt::format("  SOLVER_NUMERIC, {}: {}\n", kind, count);
  text += fmt::format("{} steps; {} records written, read back and validated\n", steps_, validated_);
  text += fmt::format("slowest: {} of run {} ({}, {})\n", duration_text(slowest_.seconds), slowest_.index, slowest_.twists, slowest_.why);
  text += fmt::format("worst ledger of an accepted run: {:.3f} % of run {} ({})\n", 100.0 * worst_ledger_.ledger_share, worst_ledger_.index,
                      worst_ledger_.twists);
  for (const Outcome& v : violations_)
    text += fmt::format("{} run {} ({}): {}\n  replay: fracfarm-hostile --seed {} --only {}\n", ink("VIOLATION", Ink::red, stdout), v.index,
                        v.twists, v.why, seed, v.index);
  return text;
}

nlohmann::ordered_json Tally::json(std::uint64_t seed) const {
  using Json = nlohmann::ordered_json;
  Json out{{"schema", "fracfarm.hostile/1"}, {"seed", seed}, {"runs", runs_}};
  for (std::size_t k = 0; k < counts_.size(); ++k) out["ends"][end_names[k]] = counts_[k];
  out["rules"] = rules_;
  out["numeric"] = numeric_;
  for (const auto& [twist, counts] : by_twist_)
    for (std::size_t k = 0; k < counts.size(); ++k) out["twists"][twist][end_names[k]] = counts[k];
  out["steps"] = steps_;
  out["records_validated"] = validated_;
  const auto row = [](const Outcome& o) {
    return Json{{"run", o.index}, {"twists", o.twists},   {"end", end_names[static_cast<int>(o.end)]},
                {"why", o.why},   {"seconds", o.seconds}, {"ledger_share", o.ledger_share}};
  };
  out["slowest"] = row(slowest_);
  out["worst_ledger"] = row(worst_ledger_);
  out["violations"] = Json::array();
  for (const Outcome& v : violations_) out["violations"].push_back(row(v));
  return out;
}

}  // namespace fracfarm::robustness
