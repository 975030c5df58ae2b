// A farm in one thread and one seed: the real reactor and the real ledger, with simulated workers, network, clock and crashes. The network
// loses, doubles and reorders; workers die and come back with what their outbox kept; the coordinator dies before or after a commit.
// The same seed gives the same trace.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/base/random.hpp"
#include "coordinator/reactor.hpp"

namespace fracfarm::simulation {

// Classic errors, put back in to show that the harness finds them.
enum class KnownBug { none, acknowledge_before_commit, epoch_not_raised, counter_drift, done_overwritten };

struct Settings {
  int patterns = 6;
  int workers = 3;
  int steps = 250;
  KnownBug bug = KnownBug::none;
};

class World {
 public:
  World(std::uint64_t seed, Settings settings);

  // Random events for `steps`, then none: whatever is not quarantined or cancelled must be DONE. Gives every broken invariant, in words.
  std::vector<std::string> run();
  std::string trace_hash() const { return trace_; }
  std::uint64_t done() const;
  std::uint64_t faults_seen() const;  // operational ones, to see that something happened at all

 private:
  struct Work {
    wire::Assignment assignment;
    long long step = 0;
  };
  struct Worker {
    std::string peer, node, instance;
    int slots = 2;
    double remaining_s = -1.0;
    int starts = 0;
    std::uint64_t last_request = 0;
    bool welcomed = false;
    bool ended = false;
    std::optional<wire::RequestEnvelope> pending;
    double sent_s = 0.0;
    double beat_s = 0.0;
    std::vector<Work> running;
    std::vector<wire::Completion> outbox;  // durable
    std::vector<wire::Failed> failed;
    std::vector<wire::LeaseId> returned;
  };
  struct Packet {
    int worker = 0;
    std::optional<wire::RequestEnvelope> request;
    std::optional<wire::ReplyEnvelope> reply;
  };
  enum class Crash { none, before_commit, after_commit };

  // events
  void step();
  void worker_acts(Worker& worker);
  void post(Worker& worker, wire::Request request);
  wire::Request next_request(Worker& worker);
  void finish_one(Worker& worker);
  void kill_worker(Worker& worker);
  void deliver_to_coordinator(Crash crash);
  void deliver_replies();
  void hear(Worker& worker, const wire::ReplyEnvelope& envelope);
  void hear_jobs(Worker& worker, const wire::Jobs& jobs, const wire::Next& asked);
  void follow(Worker& worker, const std::vector<wire::HeldLease>& held, const std::vector<wire::Ruling>& rulings);
  void restart_coordinator();
  void client_acts();
  void pass(double seconds);
  void calm_down();

  // invariants
  void check();
  void check_done(const Job& job);
  void check_assignment(const Worker& worker, const wire::Assignment& assignment);
  void broken(std::string what) { broken_.push_back(std::move(what)); }

  bool chance(double p) { return random_.uniform() < p; }
  int pick(std::size_t n) { return random_.integer(0, static_cast<int>(n) - 1); }
  std::vector<wire::HeldLease> held_by(const Worker& worker) const;
  void trace(const std::string& text);

  RandomStream random_;
  Settings settings_;
  bool calm_ = false;
  Instant now_{1000.0, 1.7e9};
  Ledger ledger_ = Ledger::in_memory();
  std::unique_ptr<Reactor> reactor_;
  std::vector<Worker> workers_;
  std::vector<Packet> to_coordinator_, to_workers_;
  std::string trace_;

  std::map<std::string, std::set<std::string>> produced_;                        // key -> digests that a worker wrote
  std::map<std::string, std::string> acknowledged_;                              // key -> digest that a worker was told is kept
  std::map<std::int64_t, std::string> done_digest_;                              // job -> digest since it was first seen DONE
  std::map<std::pair<std::uint64_t, std::uint64_t>, std::string> leases_given_;  // lease -> key
  std::vector<std::string> broken_;
};

}  // namespace fracfarm::simulation
