#include "solver/program/drill.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <limits>
#include <memory>
#include <vector>

#include "common/base/atomic_file.hpp"
#include "common/base/clock.hpp"
#include "common/base/hash.hpp"
#include "common/scene/parse.hpp"
#include "solver/program/provenance.hpp"
#include "solver/program/signals.hpp"

namespace fracfarm {
namespace {

constexpr double turn_s = 0.05;
constexpr std::size_t bite = std::size_t{16} << 20;  // bytes that a leak takes at once
const std::string drill_rule = "drill";              // the reason of a record without a simulation

// Waits for a turn, or less where a stop is asked for.
void rest(double seconds) {
  struct pollfd stop {
    stop_descriptor(), POLLIN, 0
  };
  ::poll(&stop, 1, static_cast<int>(std::clamp(seconds, 0.0, turn_s) * 1e3));
}

// Work that takes its time; false where it was stopped.
bool work(double seconds, const Progress& progress) {
  SystemClock clock;
  const double began_s = clock.monotonic_s();
  for (long long turn = 1;; ++turn) {
    if (stop_requested()) return false;
    const double left_s = seconds - (clock.monotonic_s() - began_s);
    if (left_s <= 0.0) return true;
    rest(left_s);
    progress(turn, 0.0, seconds);
  }
}

[[noreturn]] void crash() {
  ::signal(SIGABRT, SIG_DFL);
  std::abort();
}

[[noreturn]] void hang() {
  for (;;) ::sleep(3600);
}

[[noreturn]] void work_on_whatever_is_said(const Progress& progress) {
  ::signal(SIGTERM, SIG_IGN);
  for (long long turn = 1;; ++turn) {
    ::usleep(static_cast<useconds_t>(turn_s * 1e6));
    progress(turn, 0.0, 0.0);
  }
}

bool memory_is_limited() {
  struct rlimit limit {};
  return ::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
}

// Throws std::bad_alloc at the limit, and is no hang on a slow machine before it.
[[noreturn]] void leak(const Progress& progress) {
  std::vector<std::unique_ptr<char[]>> kept;
  for (long long turn = 1;; ++turn) {
    progress(turn, 0.0, 0.0);
    kept.push_back(std::make_unique<char[]>(bite));
    std::memset(kept.back().get(), 1, bite);
  }
}

std::vector<FailureTime> no_times() {
  std::vector<FailureTime> times;
  for (const char* rule : {"through_crack", "stress_drop", "five_step"}) times.push_back({rule, std::nullopt});
  return times;
}

// The smallest record there is: four nodes at time 0.
Record nothing_happened(const Task& task, const Scene& scene, const Judgement& judgement) {
  Record record;
  record.key = task.key;
  record.canonical_scene = canonical_text(scene);
  record.method = name_of(scene.method);
  record.material = material_name(scene);
  record.boundary_condition = scene.sample ? scene.sample->load : "scene";
  if (scene.sample) record.sample_id = scene.sample->id, record.pattern_seed = scene.sample->seed;
  record.judgement = judgement;
  record.failure_times = no_times();
  const std::vector<float> intact(4, 0.0f);
  record.phase_field = {{0.0, 1.0}, {0.0, 1.0}, {0.0}, {intact}, intact, intact, std::vector<unsigned char>(4, 0)};
  for (const ColumnRow& row : series_table)
    if (row.required) record.series.columns.push_back({std::string(row.name), std::string(row.unit), {0.0}});
  record.provenance = provenance_of(scene, {}, {task.attempt, task.step_scale});
  return record;
}

// The record's bytes with one thing wrong, under the digest of the wrong bytes: only the validator can find it.
Result<std::string> spoil(const std::filesystem::path& path, DrillAct act) {
  Result<std::string> bytes = read_file(path, std::uint64_t{1} << 30);
  if (!bytes) return bytes;
  if (act == DrillAct::truncated) bytes->resize(bytes->size() / 2);
  if (act == DrillAct::bit_flipped) (*bytes)[bytes->size() / 2] = static_cast<char>((*bytes)[bytes->size() / 2] ^ 0x10);
  if (const Result<void> written = write_unsynced(path, *bytes); !written) return tl::unexpected(written.error());
  return sha256_hex(*bytes);
}

Result<TaskEnd> write_nothing(const Task& task, const Scene& scene, Keeping keeping, DrillAct act, double wall_s) {
  TaskEnd end;
  end.summary.failure_rule = drill_rule;
  end.summary.wall_s = wall_s;
  end.summary.kernel = "none";
  Record record = nothing_happened(task, scene, judge(name_of(Method::drill), no_times(), drill_rule));
  if (act == DrillAct::wrong_job) record.key = sha256_hex(task.key);
  if (act == DrillAct::nan) record.phase_field.psi[0][0] = std::numeric_limits<float>::quiet_NaN();
  Result<std::string> digest = write_record(std::move(record), task.output, keeping);
  if (digest && (act == DrillAct::truncated || act == DrillAct::bit_flipped)) digest = spoil(task.output, act);
  if (!digest) return tl::unexpected(digest.error());
  end.summary.record_sha256 = *digest;
  return end;
}

}  // namespace

Result<TaskEnd> run_drill(const Task& task, const Scene& scene, Keeping keeping, const Progress& progress) {
  const DrillSettings& drill = scene.drill;
  SystemClock clock;
  const double began_s = clock.monotonic_s();
  if (!work(std::min(drill.seconds, task.wall_budget_s), progress)) return TaskEnd{true, {}};
  const bool acts = drill.attempts == 0 || task.attempt <= drill.attempts;
  const DrillAct act = acts ? drill.act : DrillAct::sleep;
  switch (act) {
    case DrillAct::crash:
      crash();
    case DrillAct::hang:
      hang();
    case DrillAct::ignore_term:
      work_on_whatever_is_said(progress);
    case DrillAct::leak:
      if (!memory_is_limited())
        return fail(Fault::bad_request, "a drill leaks only under a memory limit: start the worker with --memory-limit");
      leak(progress);
    case DrillAct::sleep:
    case DrillAct::truncated:
    case DrillAct::bit_flipped:
    case DrillAct::wrong_job:
    case DrillAct::nan:
      break;
  }
  return write_nothing(task, scene, keeping, act, clock.monotonic_s() - began_s);
}

}  // namespace fracfarm
