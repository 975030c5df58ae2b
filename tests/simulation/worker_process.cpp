#include "tests/simulation/worker_process.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/base/hash.hpp"
#include "common/wire/codec.hpp"

namespace fracfarm::simulation {
namespace {

constexpr double first_silence_s = 2.0, longest_silence_s = 15.0;

// The same key gives the same physics, whoever solves it.
wire::Completion physics_of(const wire::Assignment& it) {
  wire::Completion out;
  const double share = static_cast<double>(std::stoul(it.key.substr(0, 6), nullptr, 16)) / 16777216.0;
  out.lease = it.lease;
  out.key = it.key;
  out.verdict = Verdict::failed;
  out.time_to_failure = (4.0 + share) * 1e-5;
  out.failure_rule = "through_crack";
  out.peak_stress = 6.9e6 * (1.0 + share);
  out.steps = 180 + static_cast<long long>(100.0 * share);
  return out;
}

}  // namespace

WorkerProcess::WorkerProcess(World& world, int number)
    : world_(world), number_(number), clock_offset_s_(world.random.uniform(-200.0, 200.0)) {}

void WorkerProcess::later(double after_s, std::function<void()> what) {
  world_.agenda.after(after_s, [this, life = life_, what = std::move(what)] {
    if (life == life_) what();
  });
}

void WorkerProcess::start() {
  if (alive()) return;
  ++life_;
  worker::SessionOptions options;
  options.node = node_of_worker(number_);
  options.instance = fmt::format("{}-{:08}", name_of_worker(number_), life_);
  options.build_id = build;
  options.slots = 2;
  options.memory_bytes = 1u << 30;
  if (has_end_) options.end_at = own_clock_s() + world_.random.uniform(60.0, 5000.0);
  options.unacknowledged = outbox_;
  session_.emplace(options);
  request_id_ = life_ * requests_of_a_life;
  epoch_seen_ = world_.epoch();
  pending_.clear();
  world_.watch.began(name_of_worker(number_), life_);
  world_.trace(options.instance);
  tick();
}

void WorkerProcess::die(bool with_its_node) {
  if (!alive()) return;
  session_.reset();
  running_.clear();
  ++life_;
  const std::string shard = "shard-" + name_of_worker(number_);
  for (std::size_t at = 0; with_its_node && at < shard_.size(); ++at) {
    if (shard_[at].synced) continue;
    if (world_.chance(0.7)) shard_[at].bytes.resize(shard_[at].bytes.size() / 2);
    if (sha256_hex(shard_[at].bytes) != shard_[at].completion.sha256) world_.watch.lost(shard, at + 1);
    shard_[at].synced = true;  // whatever it is now, it stays
  }
  world_.trace(fmt::format("{} dies", name_of_worker(number_)));
  world_.agenda.after(world_.random.uniform(0.5, 40.0), [this] { start(); });
}

// --- the session and what it says ---

void WorkerProcess::tick() {
  if (world_.epoch() != epoch_seen_ && world_.chance(0.7)) {
    epoch_seen_ = world_.epoch();
    feed(worker::CoordinatorChanged{});
  }
  if (!alive()) return;
  for (const auto& [job, assignment] : running_)
    if (world_.chance(0.2)) return feed(worker::JobProgress{job, static_cast<long long>(world_.agenda.now())}), tick();
  feed(worker::Tick{});
  if (!alive()) return;
  const double own = own_clock_s();
  later(session_->next_tick(own) - own, [this] { tick(); });
}

void WorkerProcess::feed(const worker::Event& event) {
  if (!alive()) return;
  for (const worker::Action& action : session_->step(event, own_clock_s()))
    if (alive()) act(action);
}

void WorkerProcess::act(const worker::Action& action) {
  if (const auto* it = std::get_if<worker::Post>(&action)) post(it->request);
  if (const auto* it = std::get_if<worker::StartJob>(&action)) {
    running_[it->job] = it->assignment;
    later(world_.random.uniform(1.0, 45.0), [this, job = it->job, assignment = it->assignment] { end_job(job, assignment); });
  }
  const auto stop = [&](worker::JobId job) {
    later(world_.random.uniform(0.01, 3.0), [this, job] {
      if (running_.erase(job) > 0) feed(worker::JobStopped{job});
    });
  };
  if (const auto* it = std::get_if<worker::StopJob>(&action)) stop(it->job);
  if (const auto* it = std::get_if<worker::AbandonJob>(&action)) stop(it->job);
  if (const auto* it = std::get_if<worker::Acknowledged>(&action))
    std::erase_if(outbox_, [&](const wire::Completion& c) { return std::find(it->keys.begin(), it->keys.end(), c.key) != it->keys.end(); });
  if (std::holds_alternative<worker::Finish>(action)) die(false);
}

// --- the link: one request at a time, again after silence ---

void WorkerProcess::post(const wire::Request& request) {
  pending_ = wire::encode(wire::RequestEnvelope{++request_id_, request});
  silence_s_ = first_silence_s;
  world_.send_to_coordinator(number_, pending_);
  resend_later();
}

void WorkerProcess::resend_later() {
  later(silence_s_, [this, id = request_id_] {
    if (pending_.empty() || id != request_id_) return;
    silence_s_ = std::min(1.5 * silence_s_, longest_silence_s);
    world_.send_to_coordinator(number_, pending_);
    resend_later();
  });
}

void WorkerProcess::hear(const std::string& bytes) {
  const auto reply = wire::decode_reply(bytes);
  if (!alive() || !reply || pending_.empty() || reply->request_id != request_id_) return;
  pending_.clear();
  if (std::holds_alternative<wire::ByeReply>(reply->reply)) world_.watch.left(name_of_worker(number_), life_);
  if (const auto* refusal = std::get_if<wire::Refusal>(&reply->reply)) return feed(worker::RequestRefused{refusal->reason});
  feed(worker::ReplyCame{reply->reply});
}

// --- slots and keeper ---

// Job 1 diverges always: its fate is quarantine.
void WorkerProcess::end_job(worker::JobId job, const wire::Assignment& assignment) {
  if (running_.erase(job) == 0) return;
  if (assignment.job == 1) return fail(job, Fault::solver_numeric, "not finite");
  if (world_.fault(0.05)) return fail(job, Fault::solver_crash, world_.chance(0.3) ? "SIGSEGV" : fmt::format("exit {}", life_));
  if (world_.fault(0.04)) return fail(job, Fault::node_lost, "SIGBUS");
  if (world_.fault(0.04)) return fail(job, Fault::output_bad, fmt::format("digest {}", world_.agenda.now()));
  const double wall_s = world_.random.uniform(1.0, 45.0);
  feed(worker::JobSolved{job, wall_s});
  later(world_.random.uniform(0.001, 0.5), [this, job, assignment, wall_s] { append(job, assignment, wall_s); });
}

void WorkerProcess::fail(worker::JobId job, Fault fault, const std::string& signature) {
  feed(worker::JobFailed{job, fault, "simulated", signature});
}

void WorkerProcess::append(worker::JobId job, const wire::Assignment& assignment, double wall_s) {
  if (world_.fault(0.02)) return fail(job, Fault::node_lost, "cannot append");
  const std::size_t at = shard_.size();
  Stored& it = shard_.emplace_back();
  it.bytes = fmt::format("{} by {} in life {} at {}: a record long enough to be torn", assignment.key, number_, life_, world_.agenda.now());
  it.completion = physics_of(assignment);
  it.completion.wall_s = wall_s;
  it.completion.cpu_s = wall_s;
  it.completion.shard = "shard-" + name_of_worker(number_);
  it.completion.offset = at + 1;
  it.completion.length = it.bytes.size();
  it.completion.sha256 = sha256_hex(it.bytes);
  world_.watch.stored(it.completion.shard, at + 1, it.completion.sha256);
  const bool hasty = world_.settings.bug == KnownBug::report_before_sync;
  later(world_.random.uniform(0.001, 0.3), [this, job, at, hasty] { hasty ? note(job, at) : sync(job, at); });
}

void WorkerProcess::sync(worker::JobId job, std::size_t at) {
  if (world_.fault(0.02)) return fail(job, Fault::node_lost, "cannot sync");
  shard_[at].synced = true;
  later(world_.random.uniform(0.001, 0.3), [this, job, at] { note(job, at); });
}

void WorkerProcess::note(worker::JobId job, std::size_t at) {
  if (world_.fault(0.02)) return fail(job, Fault::node_lost, "cannot write the outbox");
  outbox_.push_back(shard_[at].completion);
  later(world_.random.uniform(0.0, 0.1), [this, job, at] { feed(worker::JobKept{job, shard_[at].completion}); });
}

}  // namespace fracfarm::simulation
