// What must hold after every step (the farm's invariants I1 to I10): sees every request and reply at the coordinator, every record at the
// workers and every state of the ledger. The first thing that does not hold is kept, in words.
#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/wire/messages.hpp"
#include "coordinator/ledger.hpp"
#include "coordinator/queries.hpp"

namespace fracfarm::simulation {

// Request ids of a worker's life begin here.
inline constexpr std::uint64_t requests_of_a_life = 1u << 20;

class Watch {
 public:
  Watch(double lease_timeout_s, double wall_budget_s) : lease_timeout_s_(lease_timeout_s), wall_budget_s_(wall_budget_s) {}

  // --- what happened ---
  void stored(const std::string& shard, std::uint64_t offset, const std::string& digest) { stored_[{shard, offset}] = digest; }
  void lost(const std::string& shard, std::uint64_t offset) { stored_.erase({shard, offset}); }  // with a node's power
  void began(const std::string& peer, std::uint64_t life) { lives_[peer] = life; }               // a worker process
  void left(const std::string& peer, std::uint64_t life) { left_.insert({peer, life}); }         // it said BYE and was heard
  void asked(const std::string& peer, const wire::Request& request);
  // Before the transaction of the reply is committed; `epoch` of the coordinator that gives it.
  void answered(const std::string& peer, const wire::RequestEnvelope& asked, const wire::Reply& reply, std::uint64_t epoch, double now,
                Database& ledger);
  void sent(const std::string& peer, const wire::RequestEnvelope& asked,
            const wire::Reply& reply);  // on its way: from here on it is a promise
  void stranger_answered(const wire::Reply& reply);

  // --- what holds ---
  void look(Database& ledger, double now);  // at the committed ledger, where it has changed
  void broken(std::string what) {
    if (broken_.empty()) broken_ = std::move(what);
  }
  const std::string& first_broken() const { return broken_; }
  std::uint64_t done() const { return done_.size(); }
  std::uint64_t faults() const { return faults_; }
  std::uint64_t looks() const { return looks_; }
  const std::string& state() const { return state_; }  // of the ledger when it was last looked at

 private:
  using LeaseKey = std::pair<std::uint64_t, std::uint64_t>;
  struct Given {
    std::string key, peer;
    std::uint64_t life = 0;  // of its holder
    int attempt = 0;
    double heard_at = 0.0;  // when its holder last named it
    bool returned = false;  // its holder gave it back
    bool again = false;     // of a job that is done: to compare
  };
  void look_at_assignments(const std::string& peer, const wire::RequestEnvelope& asked, const wire::Jobs& jobs, std::uint64_t epoch,
                           double now, Database& ledger);
  void look_at_rulings(const std::string& peer, const std::vector<wire::HeldLease>& held, const std::vector<wire::Ruling>& rulings,
                       Database& ledger);
  void look_at_receipts(const wire::Next& next, const wire::Jobs& jobs, Database& ledger);
  void look_at_counts(Database& ledger);
  void look_at_jobs(Database& ledger);
  void look_at_done(const Job& job);
  void look_at_history(const Job& job, std::vector<AttemptRow> history);
  void look_at_attempt(const Job& job, const AttemptRow& row, double now);
  Given* given(const wire::LeaseId& lease);

  double lease_timeout_s_, wall_budget_s_;
  std::map<std::pair<std::string, std::uint64_t>, std::string> stored_;  // (shard, offset) -> digest of what lies there, synced
  std::map<std::string, std::uint64_t> lives_;                           // by peer
  std::set<std::pair<std::string, std::uint64_t>> left_;                 // lives of peers
  std::map<LeaseKey, Given> given_;
  std::map<std::pair<std::string, int>, LeaseKey> tries_;  // (key, attempt) -> lease
  std::map<std::string, std::vector<LeaseKey>> served_;    // one claim -> the leases it got
  std::set<std::string> heard_;                            // beats and hellos
  std::map<std::string, std::string> promised_;            // key -> digest that was acknowledged, empty where another's was
  std::map<std::int64_t, std::string> done_;               // job -> digest
  std::int64_t last_attempt_ = 0;
  std::uint64_t faults_ = 0, looks_ = 0;
  std::string state_, broken_;
};

}  // namespace fracfarm::simulation
