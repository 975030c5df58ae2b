// Keeps finished records: judge, append to a shard, sync, read back, note in the outbox, and only then say so. A thread of its own, so that
// a slow disk holds up no solver; whatever has gathered meanwhile is committed together.
#pragma once

#include <condition_variable>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "common/base/clock.hpp"
#include "common/task/task.hpp"
#include "common/wire/messages.hpp"
#include "worker/outbox.hpp"
#include "worker/session.hpp"
#include "worker/shard.hpp"

namespace fracfarm::worker {

struct Finished {
  JobId job = 0;
  wire::Assignment assignment;
  Summary summary;
  std::filesystem::path record;
  std::filesystem::path checkpoint;
};

// Says whether the bytes of a closed record are what the summary says of it, OUTPUT_BAD with every broken rule where not.
using Judge = std::function<Result<void>(const std::string& bytes, const std::string& key, const Summary& summary)>;

struct KeeperOptions {
  std::filesystem::path farm;
  std::string worker;
  Judge judge;
  std::size_t batch = 32;
};

class Keeper {
 public:
  Keeper(KeeperOptions options, Outbox outbox, Clock& clock);
  ~Keeper();  // what was given is kept first
  Keeper(const Keeper&) = delete;
  Keeper& operator=(const Keeper&) = delete;

  void give(Finished finished);
  void acknowledge(std::vector<std::string> keys);
  std::vector<std::variant<JobKept, JobFailed>> take();  // what became of what was given
  int descriptor() const { return wake_; }               // readable where take() has something

 private:
  using Work = std::variant<Finished, std::vector<std::string>>;
  using Outcome = std::variant<JobKept, JobFailed>;
  void serve();
  void work_on(std::vector<Work> batch);
  void commit(std::vector<Finished>& appended, std::vector<Outcome>& outcomes);
  Result<void> judge_and_append(const Finished& finished);
  ShardWriter& shard_of(const wire::Assignment& assignment);
  void tell(std::vector<Outcome> outcomes);

  KeeperOptions options_;
  Outbox outbox_;
  Clock& clock_;
  std::map<std::filesystem::path, std::unique_ptr<ShardWriter>> shards_;  // by store
  int wake_ = -1;
  std::mutex mutex_;
  std::condition_variable more_;
  std::vector<Work> waiting_;
  std::vector<Outcome> told_;
  bool closing_ = false;
  std::thread thread_;
};

}  // namespace fracfarm::worker
