// What happens in the world; what must hold is in invariants.cpp.
#include "tests/simulation/world.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/base/hash.hpp"
#include "coordinator/queries.hpp"

namespace fracfarm::simulation {
namespace {

constexpr double resend_s = 2.0;
constexpr double beat_s = 5.0;
const std::string build = "build-a";

std::string campaign_text(int patterns) {
  return fmt::format(
      R"({{"name": "simulated", "seed": 7, "jobs": [{{"method": "phase_field", "materials": ["pbx", "steel"], "loads": ["uniaxial"],
    "patterns": {{"orthogonal": "1-{}"}}}}], "budget": {{"wall_clock": "1h", "attempts": 3}}}})",
      patterns);
}

}  // namespace

World::World(std::uint64_t seed, Settings settings) : random_(seed, 1, 0), settings_(settings) {
  reactor_ = std::make_unique<Reactor>(ledger_, ReactorSettings{build, beat_s, 30.0, 5}, now_);
  for (int n = 0; n < settings_.workers; ++n) {
    Worker worker;
    worker.peer = fmt::format("worker-{}", n);
    worker.node = fmt::format("node-{}", n / 2);
    worker.instance = fmt::format("{}-0", worker.peer);
    if (n == 2) worker.remaining_s = 300.0;  // nothing fits it before there is history
    workers_.push_back(std::move(worker));
  }
  ledger_.begin();
  (void)reactor_->answer("client", {1, wire::Ask{"submit", nlohmann::json{{"campaign", campaign_text(settings_.patterns)}}.dump()}}, now_);
  ledger_.commit();
}

void World::trace(const std::string& text) { trace_ = xxh3_hex(trace_ + text); }

std::vector<std::string> World::run() {
  for (int n = 0; n < settings_.steps && broken_.empty(); ++n) {
    step();
    check();
  }
  if (broken_.empty()) calm_down();
  return broken_;
}

void World::step() {
  Worker& worker = workers_[static_cast<std::size_t>(pick(workers_.size()))];
  const double dice = random_.uniform();
  if (dice < 0.40)
    worker_acts(worker);
  else if (dice < 0.62)
    deliver_to_coordinator(chance(0.04) ? Crash::before_commit : chance(0.04) ? Crash::after_commit : Crash::none);
  else if (dice < 0.82)
    deliver_replies();
  else if (dice < 0.90)
    finish_one(worker);
  else if (dice < 0.96)
    pass(random_.uniform(0.1, 4.0));
  else if (dice < 0.975)
    kill_worker(worker);
  else if (dice < 0.985)
    pass(45.0);
  else if (dice < 0.99)
    restart_coordinator();
  else
    client_acts();
}

// --- workers ---

std::vector<wire::HeldLease> World::held_by(const Worker& worker) const {
  std::vector<wire::HeldLease> held;
  for (const Work& work : worker.running) held.push_back({work.assignment.lease, work.assignment.key, work.step});
  for (const wire::Completion& done : worker.outbox) held.push_back({done.lease, done.key, done.steps});
  return held;
}

wire::Request World::next_request(Worker& worker) {
  if (!worker.welcomed)
    return wire::Hello{worker.node, worker.instance, worker.slots, 1u << 30, build, worker.remaining_s, held_by(worker)};
  if (now_.monotonic_s - worker.beat_s > beat_s) {
    worker.beat_s = now_.monotonic_s;
    return wire::Beat{held_by(worker)};
  }
  const int free = std::max(0, worker.slots - static_cast<int>(worker.running.size()));
  return wire::Next{worker.outbox, worker.failed, worker.returned, free, worker.remaining_s};
}

void World::post(Worker& worker, wire::Request request) {
  worker.pending = wire::RequestEnvelope{++worker.last_request, std::move(request)};
  worker.sent_s = now_.monotonic_s;
  const int number = static_cast<int>(&worker - workers_.data());
  to_coordinator_.push_back({number, worker.pending, {}});
}

void World::worker_acts(Worker& worker) {
  for (Work& work : worker.running) ++work.step;
  if (!worker.pending) return post(worker, next_request(worker));
  if (now_.monotonic_s - worker.sent_s < resend_s) return;
  worker.sent_s = now_.monotonic_s;
  to_coordinator_.push_back({static_cast<int>(&worker - workers_.data()), worker.pending, {}});
}

// One job ends: mostly with a result, sometimes with a fault or by a planned stop. Job 1 diverges always: its fate is quarantine.
void World::finish_one(Worker& worker) {
  if (worker.running.empty()) return;
  const auto at = worker.running.begin() + pick(worker.running.size());
  const Work work = *at;
  worker.running.erase(at);
  const wire::Assignment& it = work.assignment;
  const double dice = calm_ ? 0.0 : random_.uniform();
  if (it.job == 1) return worker.failed.push_back({it.lease, it.key, Fault::solver_numeric, "not finite", "not finite"});
  if (dice < 0.80) {
    const std::string digest = sha256_hex(fmt::format("{} {} {}", it.key, worker.instance, now_.monotonic_s));
    produced_[it.key].insert(digest);
    return worker.outbox.push_back(
        {it.lease, it.key, Verdict::failed, 4.5e-5, "through_crack", 6.9e6, 180, 0.1, 0.2, "shard.tar", 512, 1000, digest});
  }
  if (dice < 0.86) return worker.returned.push_back(it.lease);
  const Fault fault = dice < 0.91 ? Fault::node_lost : dice < 0.96 ? Fault::solver_crash : Fault::output_bad;
  worker.failed.push_back({it.lease, it.key, fault, "simulated", chance(0.3) ? "same" : std::to_string(worker.last_request)});
}

// A new start: what ran is lost, what the outbox holds is not.
void World::kill_worker(Worker& worker) {
  worker.instance = fmt::format("{}-{}", worker.peer, ++worker.starts);
  worker.pending.reset();
  worker.last_request += 1000;
  worker.welcomed = worker.ended = false;
  worker.running.clear();
  worker.failed.clear();
  worker.returned.clear();
  trace("kill " + worker.instance);
}

void World::hear(Worker& worker, const wire::ReplyEnvelope& envelope) {
  if (!worker.pending || worker.pending->request_id != envelope.request_id) return;  // late, or of an earlier life
  const wire::Request asked = worker.pending->request;
  worker.pending.reset();
  if (std::holds_alternative<wire::Refusal>(envelope.reply)) worker.welcomed = false;
  if (const auto* welcome = std::get_if<wire::Welcome>(&envelope.reply)) {
    worker.welcomed = true;
    follow(worker, std::get<wire::Hello>(asked).held, welcome->rulings);
  }
  if (const auto* reply = std::get_if<wire::BeatReply>(&envelope.reply)) follow(worker, std::get<wire::Beat>(asked).held, reply->rulings);
  if (const auto* jobs = std::get_if<wire::Jobs>(&envelope.reply)) hear_jobs(worker, *jobs, std::get<wire::Next>(asked));
}

// Running work whose lease is no more is given up; a finished result never is.
void World::follow(Worker& worker, const std::vector<wire::HeldLease>& held, const std::vector<wire::Ruling>& rulings) {
  for (std::size_t at = 0; at < rulings.size() && at < held.size(); ++at)
    if (rulings[at] == wire::Ruling::abandon)
      std::erase_if(worker.running, [&](const Work& work) { return work.assignment.lease == held[at].lease; });
}

void World::hear_jobs(Worker& worker, const wire::Jobs& jobs, const wire::Next& asked) {
  for (std::size_t at = 0; at < asked.completed.size(); ++at) {
    const wire::Completion& told = asked.completed[at];
    if (jobs.receipts.at(at) == wire::Receipt::accepted) acknowledged_[told.key] = told.sha256;
    std::erase_if(worker.outbox, [&](const wire::Completion& it) { return it.sha256 == told.sha256; });
  }
  worker.failed.erase(worker.failed.begin(),
                      worker.failed.begin() + static_cast<std::ptrdiff_t>(std::min(asked.failed.size(), worker.failed.size())));
  worker.returned.erase(worker.returned.begin(),
                        worker.returned.begin() + static_cast<std::ptrdiff_t>(std::min(asked.returned.size(), worker.returned.size())));
  for (const wire::Assignment& it : jobs.assignments) worker.running.push_back({it, 0});
}

// --- network and coordinator ---

void World::deliver_to_coordinator(Crash crash) {
  std::vector<Packet> replies;
  ledger_.begin();
  for (int n = pick(4); n >= 0 && !to_coordinator_.empty(); --n) {
    const auto at = to_coordinator_.begin() + pick(to_coordinator_.size());
    const Packet packet = *at;
    if (calm_ || !chance(0.15)) to_coordinator_.erase(at);  // else it comes again
    if (!calm_ && chance(0.10)) continue;                   // lost
    const Worker& worker = workers_[static_cast<std::size_t>(packet.worker)];
    const wire::Reply reply = reactor_->answer(worker.peer, *packet.request, now_);
    if (const auto* jobs = std::get_if<wire::Jobs>(&reply); jobs && crash != Crash::before_commit)
      for (const wire::Assignment& it : jobs->assignments) check_assignment(worker, it);
    replies.push_back({packet.worker, {}, wire::ReplyEnvelope{packet.request->request_id, reply}});
  }
  (void)reactor_->tick(now_);
  const bool lost = crash == Crash::before_commit;
  if (lost)
    ledger_.rollback();
  else
    ledger_.commit();
  const bool replied = crash == Crash::none || (lost && settings_.bug == KnownBug::acknowledge_before_commit);
  if (replied)
    for (Packet& packet : replies) to_workers_.push_back(std::move(packet));
  if (crash != Crash::none) restart_coordinator();
}

void World::deliver_replies() {
  for (int n = pick(4); n >= 0 && !to_workers_.empty(); --n) {
    const auto at = to_workers_.begin() + pick(to_workers_.size());
    const Packet packet = *at;
    if (calm_ || !chance(0.15)) to_workers_.erase(at);
    if (!calm_ && chance(0.10)) continue;
    hear(workers_[static_cast<std::size_t>(packet.worker)], *packet.reply);
  }
}

void World::restart_coordinator() {
  reactor_.reset();
  Database& database = ledger_.reading();
  if (settings_.bug == KnownBug::epoch_not_raised)
    database.run("UPDATE meta SET value = CAST(CAST(value AS INTEGER) - 1 AS TEXT) WHERE name = 'epoch'");
  if (settings_.bug == KnownBug::counter_drift) database.run("UPDATE counts SET n = n + 1 WHERE state = 'LEASED' AND n > 0");
  if (settings_.bug == KnownBug::done_overwritten)
    database.run("UPDATE jobs SET sha256 = randomblob(32) WHERE state = 'DONE' AND id = (SELECT max(id) FROM jobs WHERE state = 'DONE')");
  reactor_ = std::make_unique<Reactor>(ledger_, ReactorSettings{build, beat_s, 30.0, 5}, now_);
  for (Worker& worker : workers_)
    if (chance(0.7)) worker.welcomed = false;  // noticed the new epoch; the others are told to say hello
  trace("restart");
}

void World::client_acts() {
  const std::int64_t job = random_.integer(1, 2 * settings_.patterns);
  const std::string verb = chance(0.5) ? "cancel" : "retry";
  ledger_.begin();
  (void)reactor_->answer("client", {0, wire::Ask{verb, nlohmann::json{{"jobs", {job}}}.dump()}}, now_);
  ledger_.commit();
  trace(verb);
}

void World::pass(double seconds) {
  for (double left = seconds; left > 0.0; left -= 2.0) {
    now_.monotonic_s += std::min(left, 2.0);
    now_.wall_s += std::min(left, 2.0);
    ledger_.begin();
    (void)reactor_->tick(now_);
    ledger_.commit();
  }
}

// Faults stop; workers that had too many fast faults are started again, as a person would.
void World::calm_down() {
  calm_ = true;
  for (Worker& worker : workers_) {
    worker.remaining_s = -1.0;
    kill_worker(worker);
  }
  for (int n = 0; n < 4000 && !reactor_->settled() && broken_.empty(); ++n) {
    for (Worker& worker : workers_) {
      worker_acts(worker);
      finish_one(worker);
    }
    deliver_to_coordinator(Crash::none);
    deliver_replies();
    pass(1.0);
    if (n % 50 == 0) check();
  }
  check();
  if (!reactor_->settled()) broken("I8: jobs are left though nothing went wrong any more");
}

}  // namespace fracfarm::simulation
