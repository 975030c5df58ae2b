// What the ledger knows of one job: its states, its row, its outcome.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "common/failure/failure.hpp"
#include "common/wire/messages.hpp"

namespace fracfarm {

enum class State { held, ready, leased, done, retry_wait, quarantined, cancelled };

struct StateRow {
  State state;
  std::string_view name;  // as it is stored
  std::string_view word;  // as JSON and people have it
  bool settled;           // nothing more happens of its own accord
};
inline constexpr std::array<StateRow, 7> state_table{{
    {State::held, "HELD", "held", true},
    {State::ready, "READY", "ready", false},
    {State::leased, "LEASED", "leased", false},
    {State::done, "DONE", "done", true},
    {State::retry_wait, "RETRY_WAIT", "retry_wait", false},
    {State::quarantined, "QUARANTINED", "quarantined", true},
    {State::cancelled, "CANCELLED", "cancelled", true},
}};
constexpr const StateRow& state_row(State state) { return state_table[static_cast<std::size_t>(state)]; }
constexpr std::optional<State> state_by_name(std::string_view name) {  // either spelling
  for (const StateRow& row : state_table)
    if (row.name == name || row.word == name) return row.state;
  return std::nullopt;
}

// Methods, materials and loads make the classes that times are learned by and counts are kept for.
struct JobClass {
  std::string method;
  std::string material;
  std::string load;
  auto operator<=>(const JobClass&) const = default;
};

// What a DONE job came to. A rejected one has no record: its reason is the rule.
struct Outcome {
  Verdict verdict = Verdict::censored;
  std::optional<double> time_to_failure;  // s
  std::string failure_rule;
  double peak_stress = 0.0;  // Pa
  long long steps = 0;
  double cpu_s = 0.0;
  double wall_s = 0.0;
  double done_at = 0.0;  // wall clock, s since 1970
  std::string shard;
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  std::string sha256;
};

struct Job {
  std::int64_t id = 0;
  std::string key;  // hex
  std::int64_t campaign = 0;
  std::uint64_t position = 0;  // in the campaign
  JobClass job_class;
  std::string crack_set;
  std::uint64_t sample_id = 0;
  State state = State::ready;
  int priority = 0;
  int attempts = 0;           // leases given
  std::int64_t forgiven = 0;  // faults of the history up to here no longer count: a person said retry
  double step_scale = 1.0;
  double wait_s = 0.0;      // RETRY_WAIT
  wire::LeaseId lease;      // the current one where LEASED, else the last
  std::int64_t worker = 0;  // who holds it, or who did it last; 0: nobody yet
  double leased_at = 0.0;   // wall clock
  std::optional<Outcome> outcome;
};

// A job as it is submitted.
struct NewJob {
  std::string key;
  std::int64_t campaign = 0;
  std::uint64_t position = 0;
  JobClass job_class;
  std::string crack_set;
  std::uint64_t sample_id = 0;
};

}  // namespace fracfarm
