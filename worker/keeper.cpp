#include "worker/keeper.hpp"

#include <fmt/format.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

#include "common/base/atomic_file.hpp"

namespace fracfarm::worker {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t max_record_bytes = 1ull << 30;

wire::Completion completion_of(const Finished& finished, const Placed& placed) {
  const Summary& s = finished.summary;
  return {finished.assignment.lease,
          finished.assignment.key,
          s.verdict,
          s.time_to_failure,
          s.failure_rule,
          s.peak_stress,
          s.steps,
          s.cpu_s,
          s.wall_s,
          placed.shard,
          placed.offset,
          placed.length,
          placed.sha256};
}

JobFailed failure_of(const Finished& finished, const Error& error) {
  const std::string rule = error.message.substr(0, error.message.find_first_of(":;"));  // the first broken rule: the same on another node
  return {finished.job, error.fault, error.message, rule};
}

// The last checkpoint of a run that its wall budget ended is worth keeping; any other has served.
void clean_up(const Finished& finished) {
  std::error_code ignored;
  fs::remove(finished.record, ignored);
  const bool unfinished = finished.summary.verdict == Verdict::censored && finished.summary.failure_rule == "wall_clock";
  if (!unfinished && !finished.checkpoint.empty()) fs::remove(finished.checkpoint, ignored);
}

}  // namespace

Keeper::Keeper(KeeperOptions options, Outbox outbox, Clock& clock)
    : options_(std::move(options)), outbox_(std::move(outbox)), clock_(clock), wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  thread_ = std::thread([this] { serve(); });
}

Keeper::~Keeper() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
  }
  more_.notify_one();
  thread_.join();
  (void)outbox_.close();
  if (wake_ >= 0) ::close(wake_);
}

void Keeper::give(Finished finished) {
  const std::lock_guard lock(mutex_);
  waiting_.emplace_back(std::move(finished));
  more_.notify_one();
}

void Keeper::acknowledge(std::vector<std::string> keys) {
  const std::lock_guard lock(mutex_);
  waiting_.emplace_back(std::move(keys));
  more_.notify_one();
}

std::vector<Keeper::Outcome> Keeper::take() {
  std::uint64_t count = 0;
  (void)!::read(wake_, &count, sizeof count);
  const std::lock_guard lock(mutex_);
  return std::exchange(told_, {});
}

void Keeper::tell(std::vector<Outcome> outcomes) {
  if (outcomes.empty()) return;
  const std::lock_guard lock(mutex_);
  std::move(outcomes.begin(), outcomes.end(), std::back_inserter(told_));
  const std::uint64_t one = 1;
  (void)!::write(wake_, &one, sizeof one);
}

void Keeper::serve() {
  for (;;) {
    std::vector<Work> batch;
    {
      std::unique_lock lock(mutex_);
      more_.wait(lock, [&] { return closing_ || !waiting_.empty(); });
      if (waiting_.empty()) return;
      const std::size_t taken = std::min(waiting_.size(), options_.batch);
      std::move(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(taken), std::back_inserter(batch));
      waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(taken));
    }
    work_on(std::move(batch));
  }
}

void Keeper::work_on(std::vector<Work> batch) {
  std::vector<Finished> appended;
  std::vector<Outcome> outcomes;
  for (Work& work : batch) {
    if (const auto* keys = std::get_if<std::vector<std::string>>(&work)) {
      outbox_.acknowledge(*keys);
      continue;
    }
    Finished& finished = std::get<Finished>(work);
    if (const auto done = judge_and_append(finished)) {
      appended.push_back(std::move(finished));
    } else {
      outcomes.emplace_back(failure_of(finished, done.error()));
      std::error_code ignored;
      fs::remove(finished.record, ignored);
    }
  }
  commit(appended, outcomes);
  tell(std::move(outcomes));
}

Result<void> Keeper::judge_and_append(const Finished& finished) {
  if (finished.summary.verdict == Verdict::rejected) return {};  // no record: its reason is the rule
  const auto bytes = read_file(finished.record, max_record_bytes);
  if (!bytes) return fail(Fault::output_bad, "readable: " + bytes.error().message);
  if (auto sound = options_.judge(*bytes, finished.assignment.key, finished.summary); !sound) return sound;
  return shard_of(finished.assignment).append(finished.assignment.key + ".h5", *bytes, finished.summary.record_sha256);
}

// Everything appended since the last time, all shards: sync and read back, then the outbox, then the news.
void Keeper::commit(std::vector<Finished>& appended, std::vector<Outcome>& outcomes) {
  std::map<ShardWriter*, std::vector<Result<Placed>>> placed;
  for (auto& [store, shard] : shards_) {
    placed[shard.get()] = shard->commit();
    std::reverse(placed[shard.get()].begin(), placed[shard.get()].end());  // taken from the back below, in order of appending
  }
  std::vector<wire::Completion> completions;
  std::vector<Finished> kept;
  for (Finished& finished : appended) {
    Result<Placed> place = Placed{};
    if (finished.summary.verdict != Verdict::rejected) {
      auto& of_shard = placed[&shard_of(finished.assignment)];
      place = std::move(of_shard.back());
      of_shard.pop_back();
    }
    if (!place) {
      outcomes.emplace_back(failure_of(finished, place.error()));
      continue;
    }
    completions.push_back(completion_of(finished, *place));
    kept.push_back(std::move(finished));
  }
  if (completions.empty()) return;
  const auto noted = outbox_.add(completions);
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (noted) clean_up(kept[i]);
    if (noted)
      outcomes.emplace_back(JobKept{kept[i].job, completions[i]});
    else
      outcomes.emplace_back(failure_of(kept[i], noted.error()));
  }
}

ShardWriter& Keeper::shard_of(const wire::Assignment& assignment) {
  const fs::path named = assignment.store.empty() ? "store" : assignment.store;
  const fs::path store = named.is_absolute() ? named : options_.farm / named;
  auto& shard = shards_[store];
  if (!shard) shard = std::make_unique<ShardWriter>(ShardOptions{.store = store, .worker = options_.worker}, clock_);
  return *shard;
}

}  // namespace fracfarm::worker
