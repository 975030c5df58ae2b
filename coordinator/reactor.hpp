// The coordinator's mind: (peer, request, now, ledger) -> reply. No sockets, no clocks, no threads, no files but the ledger. The caller
// opens a transaction, gives any number of messages and a tick, commits, and only then sends the replies.
#pragma once

#include <deque>
#include <map>
#include <string>
#include <vector>

#include "common/wire/messages.hpp"
#include "coordinator/blame.hpp"
#include "coordinator/campaign_book.hpp"
#include "coordinator/claim.hpp"
#include "coordinator/fuse.hpp"
#include "coordinator/ledger.hpp"
#include "coordinator/requests.hpp"
#include "coordinator/roster.hpp"

namespace fracfarm {

struct ReactorSettings {
  std::string build_id;  // of this program: its scenes are those of solvers of the same build
  double beat_interval_s = 5.0;
  double lease_timeout_s = 30.0;  // without a beat; also the grace after a start
  std::uint64_t wake_most = 512;  // jobs that waited, made ready in one tick
  double audit_fraction = 0.0;    // of results, computed again on another node and compared
  double idle_return_s = 60.0;    // a worker whose time is limited ends after so long without work
};

// What somebody may want to be told of at once.
struct Notice {
  std::string kind;  // quarantined, paused, alarm, suspect, trusted, stopped, settled
  std::string text;
  std::int64_t job = 0;  // 0: none
  std::string node = {};
};

class Reactor {
 public:
  // Raises the epoch, on the disk, before it can answer anybody; every lease of the ledger gets the full grace.
  Reactor(Ledger& ledger, ReactorSettings settings, Instant now);

  // `peer` is the authenticated name, never a routing id. Within the caller's transaction.
  wire::Reply answer(const std::string& peer, const wire::RequestEnvelope& envelope, Instant now);

  // Ends leases whose time is over, wakes jobs that waited. True: more are to be woken, come back at once.
  bool tick(Instant now);

  bool settled();                                         // nothing is left to do in the ledger
  bool anybody_here() const { return !roster_.empty(); }  // workers that have said HELLO and not BYE
  std::uint64_t epoch() const { return epoch_; }
  std::vector<std::string> take_events();  // one line each, for the log
  std::vector<Notice> take_notices();      // for the notify hook

 private:
  struct Held {
    std::int64_t job = 0;
    double deadline_s = 0.0;
    double began_s = 0.0;
    long long step = 0;
    std::int64_t recheck = 0;  // of a DONE job, for which this is; 0: the job itself
    std::int64_t worker = 0;
  };
  struct Outrun {
    std::int64_t job = 0;
    wire::LeaseId lease;
    std::int64_t worker = 0;
  };
  using LeaseKey = std::pair<std::uint64_t, std::uint64_t>;

  bool was_outrun(const std::string& peer, const Job& job, const wire::LeaseId& lease) const;
  wire::Reply on_hello(const std::string& peer, const wire::Hello& hello, Instant now);
  wire::Reply on_next(const std::string& peer, Session& session, const wire::Next& next, Instant now);
  wire::Reply on_beat(const std::string& peer, Session& session, const wire::Beat& beat, Instant now);
  wire::Reply on_bye(const std::string& peer, const wire::Bye& bye, Instant now);

  bool holds(const std::string& peer, const wire::LeaseId& lease, const Job& job);
  wire::Ruling rule_on(const std::string& peer, const wire::HeldLease& held, std::int64_t worker, Instant now);
  void take_back_unlisted(const std::string& peer, const wire::Hello& hello, std::int64_t worker, Instant now);
  wire::Receipt on_completion(const std::string& peer, Session& session, const wire::Completion& completion, Instant now);
  wire::Receipt on_duplicate(const Job& job, const wire::Completion& completion, Instant now);
  wire::Receipt on_failed(const std::string& peer, Session& session, const wire::Failed& failed, Instant now);
  void on_returned(const std::string& peer, const wire::LeaseId& lease, Instant now);
  void end_try(const Job& job, const Attempt& attempt, Instant now);
  void count_fast(Session& session, const wire::LeaseId& lease, Fault fault, Instant now);
  void count_attempt(const JobClass& job_class, bool job_reason, Instant now);  // for the class's fuse
  void settle_blame(const Job& job, const std::string& node);
  void suspect(const std::string& node, const std::string& why);

  void hand_out(Session& session, int free_slots, wire::Jobs& reply, Instant now);
  void give_jobs(Session& session, int most, wire::Jobs& reply, Instant now);
  bool give_up_allocation(const std::string& peer, Session& session, Instant now);
  Claimant claimant_of(const Session& session, int most) const;
  struct Pick;
  std::vector<Pick> pick(const Claimant& claimant, const std::vector<Job>& jobs, std::vector<Lane>& lanes);
  std::vector<Job> fitting_jobs(const Claimant& claimant, TooLong& too_long, Instant now);
  std::vector<Lane> fitting_lanes(const Claimant& claimant, TooLong& too_long);
  std::optional<Candidate> candidate_of(const Job& job);
  double wall_budget_s(std::int64_t campaign);
  std::optional<wire::Assignment> assign_untouched(const Lane& lane, std::int64_t id, const Session& session, Instant now);
  wire::Assignment assign(const Job& job, const Session& session, Instant now);
  static wire::Assignment assignment_of(const std::string& key, std::int64_t id, const Campaign& campaign, wire::LeaseId lease,
                                        std::string scene, int attempt, double step_scale);
  std::set<std::string> live_nodes(Instant now) const;
  std::optional<wire::Reply> wrong_build(const std::string& build_id);

  // DONE jobs that are computed again (reactor_rechecks.cpp).
  std::optional<RecheckRow> recheck_of(const wire::LeaseId& lease);
  bool must_prove_itself(const Session& session) const;
  void give_canary(Session& session, wire::Jobs& reply, Instant now);
  void give_rechecks(Session& session, int most, wire::Jobs& reply, Instant now);
  std::optional<wire::Assignment> assign_recheck(const RecheckRow& recheck, const Job& job, const Session& session, Instant now);
  void sample_for_audit(const Job& job, const std::string& node, Instant now);
  wire::Receipt end_recheck(const RecheckRow& recheck, const Job& job, const wire::Completion& completion, Session& session, Instant now);
  void fail_recheck(const RecheckRow& recheck, const Attempt& attempt, Instant now);
  void canary_failed(const std::string& node, const std::string& why, Instant now);

  void learn_anew();  // what the ledger says of builds, draining workers, pauses and nodes, after a verb may have changed it
  void expire_leases(Instant now);
  void wake_waiting(Instant now);
  void forget_silent(Instant now);
  Live live(Instant now);
  void note(std::string event) { events_.push_back(std::move(event)); }
  void notice(Notice notice);

  Ledger& ledger_;
  ReactorSettings settings_;
  CampaignBook book_;
  std::uint64_t epoch_ = 0;
  std::uint64_t counter_ = 0;
  Roster roster_;
  std::map<std::string, std::string> gone_;  // peer -> its start that said BYE last: a copy of its HELLO is no worker
  RateMeter rate_;
  std::deque<Outrun> outrun_;               // leases whose jobs others finished first: their results are still duplicates, not lies
  std::map<LeaseKey, Held> held_;            // deadlines of LEASED jobs; the ledger says whose they are
  std::multimap<double, std::int64_t> due_;  // RETRY_WAIT jobs by when they wake
  LearnedTimes learned_;
  double learned_at_s_ = -1e300;
  std::string jobs_build_;                  // the farm's, as the ledger has it
  std::map<JobClass, std::string> paused_;  // classes, and why
  std::map<JobClass, Fuse> fuses_;
  std::map<std::string, NodeRow> nodes_;  // those that something is held against
  struct Canary {
    int failed = 0;
    double next_s = 0.0;
    bool under_way = false;
  };
  std::map<std::string, Canary> canaries_;  // by node
  bool rechecks_waiting_ = true;            // there may be some that are READY
  bool was_settled_ = true;
  double began_s_ = 0.0;
  double ticked_s_ = 0.0;
  std::vector<std::string> events_;
  std::vector<Notice> notices_;
};

}  // namespace fracfarm
