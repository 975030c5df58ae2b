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
std::string text_of(const JobClass& job_class);  // "phase_field pbx uniaxial"

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
  std::uint64_t memory_floor = 0;  // bytes that a slot must have more than; 0: any
  double wait_s = 0.0;             // RETRY_WAIT
  wire::LeaseId lease;             // the current one where LEASED, else the last
  std::int64_t worker = 0;         // who holds it, or who did it last; 0: nobody yet
  double leased_at = 0.0;          // wall clock
  std::optional<Outcome> outcome;
};

// A job as the ledger first hears of it.
struct NewJob {
  std::string key;
  std::int64_t campaign = 0;
  std::uint64_t position = 0;
  JobClass job_class;
  std::string crack_set;
  std::uint64_t sample_id = 0;
  std::int64_t id = 0;  // 0: the next free one
  State state = State::ready;
  int priority = 0;
};

// Which jobs a series is: those of one combination of material, load and settings of a campaign's block.
struct SeriesPlace {
  std::int64_t campaign = 0;
  std::size_t block = 0;
  std::uint64_t variant = 0;
};

// Jobs of one class of a campaign that nobody has touched: ids next, next + stride, ..., last. They have no row of their own.
struct Lane {
  std::int64_t id = 0;
  std::int64_t campaign = 0;
  std::int64_t first_id = 0;  // of the campaign: position = job id - first_id
  JobClass job_class;
  State state = State::ready;  // READY, HELD or CANCELLED
  int priority = 0;
  std::int64_t next = 0;
  std::int64_t last = 0;
  std::int64_t stride = 1;

  bool has(std::int64_t job) const { return job >= next && job <= last && (job - next) % stride == 0; }
  std::uint64_t size() const { return static_cast<std::uint64_t>((last - next) / stride + 1); }
};

}  // namespace fracfarm
