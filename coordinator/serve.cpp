#include "coordinator/serve.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <deque>

#include "common/base/build_info.hpp"
#include "common/base/clock.hpp"
#include "common/base/host.hpp"
#include "common/wire/codec.hpp"
#include "common/wire/endpoint.hpp"
#include "common/wire/socket.hpp"
#include "coordinator/backup_timer.hpp"
#include "coordinator/enrolment.hpp"
#include "coordinator/notifier.hpp"
#include "coordinator/reactor.hpp"

namespace fracfarm {
namespace {

using Level = CoordinatorLog::Level;
constexpr std::size_t most_messages = 256;  // of one transaction
constexpr double longest_batch_s = 0.02;    // of work before its sync: a sync costs milliseconds, however much it is for
constexpr double tick_s = 0.1;
constexpr double farewell_s = 10.0;  // for workers to say BYE where nothing is left

struct Outgoing {
  std::string route;
  wire::ReplyEnvelope reply;
};

class Switchboard {
 public:
  Switchboard(wire::Server server, Ledger& ledger, Reactor& reactor, Clock& clock)
      : server_(std::move(server)), ledger_(ledger), reactor_(reactor), clock_(clock) {}

  // One transaction: what waits, the timers, commit, replies.
  void turn() {
    const double patience_s = more_ || !waiting_.empty() ? 0.0 : tick_s;
    for (wire::Incoming& message : server_.receive(most_messages - waiting_.size(), patience_s)) waiting_.push_back(std::move(message));
    const double began_s = clock_.monotonic_s();
    std::vector<Outgoing> replies;
    ledger_.begin();
    while (!waiting_.empty() && (replies.empty() || clock_.monotonic_s() - began_s < longest_batch_s)) {
      replies.push_back(answer(waiting_.front()));
      waiting_.pop_front();
    }
    more_ = reactor_.tick(now());
    ledger_.commit();
    for (const Outgoing& it : replies) (void)server_.send(it.route, wire::encode(it.reply));  // not sent: the peer asks again
  }
  bool healthy() const { return server_.healthy(); }
  bool idle() const { return waiting_.empty() && !more_; }
  std::string endpoint() const { return server_.endpoint(); }
  Instant now() { return {clock_.monotonic_s(), clock_.wall_s()}; }

 private:
  Outgoing answer(const wire::Incoming& message) {
    const Result<wire::RequestEnvelope> request = wire::decode_request(message.bytes);
    if (!request) return {message.route, {0, wire::Refusal{request.error().message}}};
    return {message.route, {request->request_id, reactor_.answer(message.peer, *request, now())}};
  }

  wire::Server server_;
  Ledger& ledger_;
  Reactor& reactor_;
  Clock& clock_;
  std::deque<wire::Incoming> waiting_;
  bool more_ = false;
};

// What goes on beside the serving.
struct Aside {
  Notifier notifier;
  BackupTimer backup;

  void tell(Reactor& reactor, CoordinatorLog& log, double wall_s) {
    for (const std::string& event : reactor.take_events()) log.say(Level::info, event);
    notifier.tell(reactor.take_notices(), wall_s);
    for (const std::string& complaint : notifier.take_complaints()) log.say(Level::warning, complaint);
    for (const std::string& words : backup.take_words()) log.say(Level::info, words);
  }
};

// Scenes are made by this program: it must be of the build that the unfinished jobs are for.
Result<void> demand_build(Ledger& ledger) {
  const std::string jobs_build = meta_value(ledger.reading(), "build_id"), own = build_info().build_id;
  if (jobs_build.empty() || jobs_build == own || is_settled(ledger.reading())) return {};
  return fail(Fault::bad_request, fmt::format("this farm's unfinished jobs are for build {}, this coordinator is build {}: use that build, "
                                              "or cancel them, or begin another farm (--farm)",
                                              jobs_build, own));
}

ExitCode complain(CoordinatorLog& log, const Error& error, ExitCode otherwise) {
  log.say(Level::error, error.message);
  return error.fault == Fault::bad_request ? exit_bad_input : otherwise;
}

ExitCode loop(Switchboard& desk, Reactor& reactor, const ServeOptions& options, const std::atomic<bool>& stop, CoordinatorLog& log) {
  Aside aside{Notifier(options.notify), BackupTimer({options.farm}, options.backup_every_s)};
  double settled_at_s = -1.0;
  while (!stop) {
    desk.turn();
    aside.tell(reactor, log, desk.now().wall_s);
    if (!desk.healthy()) {
      log.say(Level::error, "the thread that checks keys has ended: nobody could connect any more");
      return exit_failed;
    }
    if (!options.until_done) continue;
    const double now_s = desk.now().monotonic_s;
    if (!desk.idle() || !reactor.settled())
      settled_at_s = -1.0;
    else if (settled_at_s < 0.0)
      settled_at_s = now_s;
    else if (now_s - settled_at_s > (reactor.anybody_here() ? farewell_s : 1.0))
      break;
  }
  log.say(Level::info, stop ? "stopped" : "nothing is left to do");
  return exit_ok;
}

}  // namespace

ExitCode serve(const ServeOptions& options, const std::atomic<bool>& stop, CoordinatorLog& log) {
  const FarmPaths paths{options.farm};
  SystemClock clock;
  Result<Ledger> ledger = Ledger::open(paths, true, options.lock_patience_s, holder_coordinator);
  if (!ledger) return complain(log, ledger.error(), exit_unreachable);
  if (const Result<void> made = enrol_the_rest(*ledger); !made) return complain(log, made.error(), exit_failed);
  if (const Result<void> fits = demand_build(*ledger); !fits) return complain(log, fits.error(), exit_failed);
  Result<wire::Server> server = wire::Server::bind(options.bind, options.farm);
  if (!server) return complain(log, server.error(), exit_failed);
  Reactor reactor(*ledger, {build_info().build_id, options.lease_timeout_s / 6.0, options.lease_timeout_s, 512, options.audit_fraction},
                  {clock.monotonic_s(), clock.wall_s()});
  Switchboard desk(std::move(*server), *ledger, reactor, clock);
  const std::string endpoint = wire::reachable(desk.endpoint(), options.advertise.empty() ? host_name() : options.advertise);
  if (const Result<void> told = wire::write_endpoint(options.farm, {endpoint, reactor.epoch(), ::getpid()}); !told)
    return complain(log, told.error(), exit_failed);
  log.say(Level::info, fmt::format("serves {} at {}, epoch {}", options.farm.string(), endpoint, reactor.epoch()));
  return loop(desk, reactor, options, stop, log);
}

}  // namespace fracfarm
