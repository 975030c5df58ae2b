// Who is connected and how fast results come: the reactor's memory between messages. Nothing here is needed after a restart.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "common/wire/messages.hpp"

namespace fracfarm {

// Now, by both clocks: deadlines go by the monotonic one, people read the other.
struct Instant {
  double monotonic_s = 0.0;
  double wall_s = 0.0;
};

inline constexpr int most_fast_faults = 5;                            // in a row; then a worker gets nothing until it is started again
inline constexpr double fast_fault_s = 10.0;                          // a fault within this of its lease is a fast one
inline constexpr std::size_t kept_replies = 4;                        // for requests that come twice
inline constexpr std::uint64_t widest_step = std::uint64_t{1} << 32;  // between two requests of one life

// Whether there was work that takes longer than a worker has left: by the times that were learned, or by its budget, as none are known yet.
struct TooLong {
  bool known = false, unknown = false;
  void count(bool learned) { (learned ? known : unknown) = true; }
};

// One worker daemon, by the authenticated name of its key.
struct Session {
  std::int64_t worker = 0;  // row of the ledger
  std::string instance;
  std::string node;
  std::string build_id;
  int slots = 0;
  double remaining_s = -1.0;   // as it last said
  double seen_s = 0.0;         // monotonic
  int fast_faults = 0;         // in a row
  bool fault_counted = false;  // one of the message under way: what fails together has one cause, and counts once
  std::uint64_t memory_bytes = 0;
  bool draining = false;
  double idle_since_s = -1.0;  // asked and got nothing since then; < 0: it has work
  TooLong too_long = {};       // at its last claim
  std::uint64_t newest_request = 0;
  std::deque<std::pair<std::uint64_t, wire::Reply>> replies;

  std::uint64_t slot_memory() const { return memory_bytes / static_cast<std::uint64_t>(std::max(1, slots)); }
  bool stopped() const { return fast_faults >= most_fast_faults; }
  // A worker waits for one answer at a time and its request ids ascend, from a random start in each life: what does not come after the
  // newest, or is far from it, is a copy that was long under way. To answer it would give leases to nobody.
  bool late(std::uint64_t request_id) const { return request_id <= newest_request || request_id - newest_request > widest_step; }

  const wire::Reply* replied(std::uint64_t request_id) const {
    for (const auto& [id, reply] : replies)
      if (id == request_id) return &reply;
    return nullptr;
  }
  void remember(std::uint64_t request_id, const wire::Reply& reply) {
    newest_request = request_id;
    replies.emplace_back(request_id, reply);
    if (replies.size() > kept_replies) replies.pop_front();
  }
};

using Roster = std::map<std::string, Session>;

// Results a second over the last two minutes.
class RateMeter {
 public:
  explicit RateMeter(double now_s) : began_s_(now_s) {}
  void count(double now_s) {
    if (buckets_.empty() || now_s - buckets_.back().first >= 1.0) buckets_.emplace_back(now_s, 0);
    ++buckets_.back().second;
    forget(now_s);
  }
  double per_second(double now_s) {
    forget(now_s);
    std::uint64_t n = 0;
    for (const auto& bucket : buckets_) n += bucket.second;
    const double since = std::max(began_s_, now_s - window_s);
    return static_cast<double>(n) / std::max(1.0, now_s - since);
  }

 private:
  static constexpr double window_s = 120.0;
  void forget(double now_s) {
    while (!buckets_.empty() && now_s - buckets_.front().first > window_s) buckets_.pop_front();
  }
  double began_s_;
  std::deque<std::pair<double, std::uint64_t>> buckets_;
};

}  // namespace fracfarm
