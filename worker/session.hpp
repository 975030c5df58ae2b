// What a worker decides: a pure state machine. Events and the time go in, actions come out; it has no socket, no process, no clock and no
// disk. One request is under way at a time. Whatever is lost on the way is asked again; what was finished is never given up.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "common/base/exit_code.hpp"
#include "common/wire/messages.hpp"

namespace fracfarm::worker {

using JobId = std::uint64_t;  // of this run of the worker; a lease may change under it when a coordinator restarts

// --- events ---
struct Tick {};
struct ReplyCame {
  wire::Reply reply;
};
struct RequestRefused {
  std::string reason;
};
struct CoordinatorChanged {};  // its epoch is another one: say HELLO
struct JobProgress {
  JobId job = 0;
  long long step = 0;
};
struct JobSolved {  // the slot is free; the record is being judged and kept
  JobId job = 0;
  double wall_s = 0.0;
};
struct JobKept {  // durable in a shard and in the outbox
  JobId job = 0;
  wire::Completion completion;
};
struct JobFailed {
  JobId job = 0;
  Fault fault = Fault::solver_crash;
  std::string message;
  std::string signature;
};
struct JobStopped {  // by StopJob or by a signal: its checkpoint is kept
  JobId job = 0;
};
struct DrainAsked {};      // USR1: finish what runs, take no more
struct TerminateAsked {};  // TERM, INT, or the allocation ends: checkpoint, return, leave
using Event = std::variant<Tick, ReplyCame, RequestRefused, CoordinatorChanged, JobProgress, JobSolved, JobKept, JobFailed, JobStopped,
                           DrainAsked, TerminateAsked>;

// --- actions ---
struct Post {
  wire::Request request;
};
struct StartJob {
  JobId job = 0;
  wire::Assignment assignment;
};
struct StopJob {  // checkpoint and end; answered by JobStopped, JobSolved or JobFailed
  JobId job = 0;
};
struct AbandonJob {  // kill at once; answered by JobStopped
  JobId job = 0;
};
struct Acknowledged {  // the outbox may forget these
  std::vector<std::string> keys;
};
struct Finish {
  ExitCode status = exit_ok;
};
struct Say {  // for the log
  enum class Level { info, warning, error } level = Level::info;
  std::string text;
};
using Action = std::variant<Post, StartJob, StopJob, AbandonJob, Acknowledged, Finish, Say>;
using Actions = std::vector<Action>;

struct SessionOptions {
  std::string node = {};
  std::string instance = {};
  std::string build_id = {};  // of the solver
  int slots = 1;
  std::uint64_t memory_bytes = 0;
  bool once = false;                                  // end where the coordinator says that nothing is left
  double short_job_s = 5.0;                           // jobs below it are asked for ahead, so that no slot waits for the network
  double report_delay_s = 0.5;                        // gather completions so long where no slot waits
  double farewell_s = 3.0;                            // for the last words after TERM where nobody answers
  double end_margin_s = 30.0;                         // before the end of the allocation
  std::optional<double> end_at = {};                  // of the allocation, on the clock of `now`
  std::vector<wire::Completion> unacknowledged = {};  // what an earlier run of this worker left in its outbox
};

class Session {
 public:
  explicit Session(SessionOptions options);
  Actions step(const Event& event, double now);
  // When step(Tick) should be called again at the latest.
  double next_tick(double now) const;

 private:
  enum class Phase { working, draining, terminating, leaving, ended };
  enum class State { queued, running, keeping, abandoned };
  struct Job {
    JobId id;
    wire::Assignment assignment;
    State state = State::queued;
    long long step = 0;
    double started_at = 0.0;
  };

  // events
  void on(const Tick&) {}
  void on(const ReplyCame& event);
  void on(const RequestRefused& event);
  void on(const CoordinatorChanged&);
  void on(const JobProgress& event);
  void on(const JobSolved& event);
  void on(const JobKept& event);
  void on(const JobFailed& event);
  void on(const JobStopped& event);
  void on(const DrainAsked&);
  void on(const TerminateAsked&);

  // replies
  void hear(const wire::Welcome& welcome);
  void hear(const wire::Jobs& jobs);
  void hear(const wire::BeatReply& reply);
  void hear(const wire::ByeReply&);
  void hear(const wire::Answer&);
  void hear(const wire::Refusal& refusal);
  void hear_order(wire::Order order, double wait_s);
  void follow(const std::vector<wire::Ruling>& rulings);
  void settle(const std::vector<wire::Receipt>& receipts);
  void take(const wire::Assignment& assignment);

  // what to do now
  void start_queued();
  void return_queued();
  void say_something();
  std::optional<wire::Request> next_request();
  wire::Request make_hello();
  wire::Request make_next(int wanted);
  wire::Request make_beat();
  double remaining_s() const;
  int wanted() const;
  bool should_report(int wanted) const;
  bool anything_to_report() const { return !completed_.empty() || !failed_.empty() || !returned_.empty(); }
  std::vector<wire::HeldLease> held() const;
  int count(State state) const;
  Job* find(JobId id);
  void drop(JobId id);
  void begin_leaving(Phase phase, ExitCode status);
  void finish();
  void greet_again(double after_s);
  void say(Say::Level level, std::string text);

  SessionOptions options_;
  Phase phase_ = Phase::working;
  ExitCode status_ = exit_ok;
  double now_ = 0.0;
  Actions actions_;

  bool welcomed_ = false;
  bool asking_ = false;  // a request is under way
  double greet_at_ = 0.0;
  double greet_delay_s_ = 1.0;
  int refusals_ = 0;  // of HELLO, in a row
  double beat_interval_s_ = 5.0;
  double beat_at_ = 0.0;
  bool beat_last_ = false;  // the last request but HELLO was one
  double ask_at_ = 0.0;  // not before: the coordinator said WAIT
  double give_up_at_ = 1e300;

  std::deque<Job> jobs_;
  JobId last_id_ = 0;
  double mean_job_s_ = 0.0;    // of solved jobs, moving; 0: unknown
  double round_trip_s_ = 0.0;  // of requests, moving
  double posted_at_ = 0.0;
  int node_faults_ = 0;       // NODE_LOST in a row
  double claims_from_ = 0.0;  // no claims before, after too many of them

  std::vector<wire::Completion> completed_;  // to report
  std::vector<wire::Failed> failed_;
  std::vector<wire::LeaseId> returned_;
  double report_since_ = 0.0;  // when the oldest of them came
  struct UnderWay {            // what the request under way holds of the lists above, from their fronts
    std::size_t completed = 0, failed = 0, returned = 0, wanted = 0;
    std::vector<wire::HeldLease> held;
    bool hello = false, next = false, bye = false;
  } under_way_;
};

}  // namespace fracfarm::worker
