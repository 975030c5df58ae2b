// Every message between workers, clients and the coordinator (FARM.md): plain structs. codec.hpp turns them into MessagePack and back.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "common/base/fault.hpp"
#include "common/failure/failure.hpp"

namespace fracfarm::wire {

inline constexpr int protocol_version = 1;
inline constexpr std::size_t max_message_bytes = 8u << 20;

// Never reissued: epoch is raised at every coordinator start, counter within it.
struct LeaseId {
  std::uint64_t epoch = 0;
  std::uint64_t counter = 0;
  bool operator==(const LeaseId&) const = default;
};

struct HeldLease {
  LeaseId lease;
  std::string key;  // of the job
  long long step = 0;
};

struct Hello {
  std::string node;      // host name
  std::string instance;  // one id for each start of the daemon; that of a later start sorts after it
  int slots = 1;
  std::uint64_t memory_bytes = 0;
  std::string build_id;       // of the solver
  double remaining_s = -1.0;  // in which jobs may run, until they are stopped for the end of the allocation; < 0: unlimited
  std::vector<HeldLease> held;
};

enum class Ruling { adopt, abandon };
struct Welcome {
  std::uint64_t epoch = 0;
  double beat_interval_s = 5.0;
  double lease_timeout_s = 30.0;
  std::vector<Ruling> rulings;  // for Hello::held, in order
};

// Where a record lies and what it said.
struct Completion {
  LeaseId lease;
  std::string key;
  Verdict verdict = Verdict::censored;
  std::optional<double> time_to_failure;
  std::string failure_rule;
  double peak_stress = 0.0;
  long long steps = 0;
  double cpu_s = 0.0;
  double wall_s = 0.0;
  std::string shard;         // file name in the store
  std::uint64_t offset = 0;  // of the record's bytes in the shard
  std::uint64_t length = 0;
  std::string sha256;
};

struct Failed {
  LeaseId lease;
  std::string key;
  Fault fault = Fault::solver_crash;
  std::string message;
  std::string signature;  // the same on two nodes: the job is to blame (signal number, exit status, first broken rule)
};

struct Next {
  std::vector<Completion> completed;
  std::vector<Failed> failed;
  std::vector<LeaseId> returned;  // planned stops: READY at once
  int free_slots = 0;
  double remaining_s = -1.0;
};

// wait: nothing now, ask again after wait_s. drain: finish what you hold, take no more, BYE, end.
// stop: nothing is left in the ledger; a worker started with --once ends, a daemon asks again after wait_s.
enum class Order { none, wait, drain, stop };
// What became of a result. All four mean that the worker may forget it; refused is logged by both sides.
enum class Receipt { accepted, duplicate, stale, refused };

struct Assignment {
  LeaseId lease;
  std::string key;
  std::uint64_t job = 0;
  int attempt = 1;
  std::string scene;  // canonical text
  double wall_budget_s = 8.0 * 3600.0;
  double step_scale = 1.0;
  std::string store;  // folder of the shards; relative: below the farm folder; empty: "store"
};

struct Jobs {
  std::vector<Receipt> receipts;  // for Next::completed, then Next::failed, in order
  std::vector<Assignment> assignments;
  Order order = Order::none;
  double wait_s = 0.0;  // ask again after this where nothing was assigned
};

struct Beat {
  std::vector<HeldLease> held;
};

struct BeatReply {
  std::vector<Ruling> rulings;  // abandon: cancelled or no longer the current lease; kill it
  Order order = Order::none;
};

struct Bye {
  std::vector<LeaseId> returned;
};
struct ByeReply {};

// A client verb: the coordinator answers as JSON, `exit_code` as the verb should end.
struct Ask {
  std::string verb;       // of the table of requests
  std::string arguments;  // JSON text
};
struct Answer {
  int exit_code = 0;
  std::string body;  // JSON text
};

struct Refusal {
  std::string reason;  // version, size, key or grammar, in words
};

using Request = std::variant<Hello, Next, Beat, Bye, Ask>;
using Reply = std::variant<Welcome, Jobs, BeatReply, ByeReply, Answer, Refusal>;

// request_id: the same id twice from one peer gives the same reply.
struct RequestEnvelope {
  std::uint64_t request_id = 0;
  Request request;
};
struct ReplyEnvelope {
  std::uint64_t request_id = 0;
  Reply reply;
};

}  // namespace fracfarm::wire
