// The coordinator's mind: (peer, request, now, ledger) -> reply. No sockets, no clocks, no threads, no files but the ledger. The caller
// opens a transaction, gives any number of messages and a tick, commits, and only then sends the replies.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/wire/messages.hpp"
#include "coordinator/campaign_book.hpp"
#include "coordinator/claim.hpp"
#include "coordinator/ledger.hpp"
#include "coordinator/requests.hpp"
#include "coordinator/roster.hpp"

namespace fracfarm {

struct ReactorSettings {
  std::string build_id;  // of this program: its scenes are those of solvers of the same build
  double beat_interval_s = 5.0;
  double lease_timeout_s = 30.0;    // without a beat; also the grace after a start
  std::uint64_t expand_most = 512;  // jobs of a campaign made a tick
};

class Reactor {
 public:
  // Raises the epoch, on the disk, before it can answer anybody; every lease of the ledger gets the full grace.
  Reactor(Ledger& ledger, ReactorSettings settings, Instant now);

  // `peer` is the authenticated name, never a routing id. Within the caller's transaction.
  wire::Reply answer(const std::string& peer, const wire::RequestEnvelope& envelope, Instant now);

  // Ends leases whose time is over, wakes jobs that waited, makes jobs of campaigns. True: more is to be made, come back at once.
  bool tick(Instant now);

  bool settled();                                         // nothing is left to do in the ledger
  bool anybody_here() const { return !roster_.empty(); }  // workers that have said HELLO and not BYE
  std::uint64_t epoch() const { return epoch_; }
  std::vector<std::string> take_events();  // one line each, for the log

 private:
  struct Held {
    std::int64_t job = 0;
    double deadline_s = 0.0;
    double began_s = 0.0;
    long long step = 0;
  };
  using LeaseKey = std::pair<std::uint64_t, std::uint64_t>;

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

  void hand_out(Session& session, int free_slots, wire::Jobs& reply, Instant now);
  std::vector<Job> choose(const Session& session, int most, Instant now);
  std::optional<Candidate> candidate_of(const Job& job);
  wire::Assignment assign(const Job& job, const Session& session, Instant now);
  std::set<std::string> live_nodes(Instant now) const;
  std::optional<wire::Reply> wrong_build(const std::string& build_id);

  void expire_leases(Instant now);
  void forget_silent(Instant now);
  Live live(Instant now);
  void note(std::string event) { events_.push_back(std::move(event)); }

  Ledger& ledger_;
  ReactorSettings settings_;
  CampaignBook book_;
  std::uint64_t epoch_ = 0;
  std::uint64_t counter_ = 0;
  Roster roster_;
  RateMeter rate_;
  std::map<LeaseKey, Held> held_;            // deadlines of LEASED jobs; the ledger says whose they are
  std::multimap<double, std::int64_t> due_;  // RETRY_WAIT jobs by when they wake
  std::map<JobClass, Learned> learned_;
  double learned_at_s_ = -1e300;
  double began_s_ = 0.0;
  double ticked_s_ = 0.0;
  std::vector<std::string> events_;
};

}  // namespace fracfarm
