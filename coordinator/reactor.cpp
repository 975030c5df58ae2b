// The worker's four messages and the timers; what becomes of results and faults is in reactor_results.cpp.
#include "coordinator/reactor.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace fracfarm {
namespace {

constexpr std::size_t longest_name = 128;
constexpr int most_rechecks = 1000000;  // under way at once: there is no limit

bool writes(const std::string& verb) {
  const auto rows = requests();
  return std::any_of(rows.begin(), rows.end(), [&](const RequestRow& row) { return row.verb == verb && row.writes; });
}

wire::Reply refuse(std::string reason) { return wire::Refusal{std::move(reason)}; }

bool is_name(const std::string& text) { return !text.empty() && text.size() <= longest_name; }

}  // namespace

Reactor::Reactor(Ledger& ledger, ReactorSettings settings, Instant now)
    : ledger_(ledger),
      settings_(std::move(settings)),
      epoch_(ledger.raise_epoch()),
      rate_(now.monotonic_s),
      began_s_(now.monotonic_s),
      ticked_s_(now.monotonic_s) {
  const double deadline_s = now.monotonic_s + settings_.lease_timeout_s;
  for (const Job& job : leased_jobs(ledger_.reading()))
    held_[{job.lease.epoch, job.lease.counter}] = {job.id, deadline_s, now.monotonic_s, 0, 0, job.worker};
  for (const RecheckRow& it : open_rechecks(ledger_.reading(), "LEASED", most_rechecks))
    held_[{it.lease.epoch, it.lease.counter}] = {it.job, deadline_s, now.monotonic_s, 0, it.id, it.worker};
  for (const Job& job : waiting_jobs(ledger_.reading())) due_.emplace(now.monotonic_s + job.wait_s, job.id);
  learn_anew();
}

void Reactor::learn_anew() {
  jobs_build_ = meta_value(ledger_.reading(), "build_id");
  paused_ = paused_classes(ledger_.reading());
  rechecks_waiting_ = true;
  nodes_.clear();
  for (NodeRow& row : node_rows(ledger_.reading())) nodes_[row.node] = std::move(row);
  std::set<std::int64_t> draining;
  for (const WorkerRow& row : open_workers(ledger_.reading()))
    if (row.draining) draining.insert(row.id);
  for (auto& [peer, session] : roster_) session.draining = draining.contains(session.worker);
}

wire::Reply Reactor::answer(const std::string& peer, const wire::RequestEnvelope& envelope, Instant now) {
  if (const auto* ask = std::get_if<wire::Ask>(&envelope.request)) {
    ledger_.settle();
    wire::Answer answer = answer_ask(Desk{ledger_, book_, settings_.build_id, now, [this, now] { return live(now); }}, *ask);
    if (writes(ask->verb)) learn_anew();
    return answer;
  }
  if (const auto* bye = std::get_if<wire::Bye>(&envelope.request)) return on_bye(peer, *bye, now);
  const auto* hello = std::get_if<wire::Hello>(&envelope.request);
  const auto known = roster_.find(peer);
  const bool same = known != roster_.end() && (!hello || hello->instance == known->second.instance);
  if (!same && !hello)
    return refuse(fmt::format("say HELLO first: {} is not known to this start of the coordinator (epoch {})", peer, epoch_));
  if (same) {
    const wire::Reply* earlier = known->second.replied(envelope.request_id);
    if (!earlier && known->second.late(envelope.request_id))
      return refuse("a later request of this worker was answered before this one came");
    known->second.seen_s = now.monotonic_s;
    if (earlier) return *earlier;
  }
  const auto reply = [&]() -> wire::Reply {
    if (hello) return on_hello(peer, *hello, now);
    if (const auto* next = std::get_if<wire::Next>(&envelope.request)) return on_next(peer, known->second, *next, now);
    return on_beat(peer, known->second, std::get<wire::Beat>(envelope.request), now);
  }();
  const auto session = roster_.find(peer);
  if (session != roster_.end() && !std::holds_alternative<wire::Refusal>(reply)) session->second.remember(envelope.request_id, reply);
  return reply;
}

std::optional<wire::Reply> Reactor::wrong_build(const std::string& build_id) {
  if (jobs_build_.empty() || jobs_build_ == build_id) return std::nullopt;
  return refuse(
      fmt::format("this farm's jobs are for solver build {}; this worker's solver is build {}: install the same build on every node",
                  jobs_build_, build_id));
}

// LEASED under this very lease, by this peer. An earlier epoch's lease is as good as any: a restart takes nothing away.
bool Reactor::holds(const std::string& peer, const wire::LeaseId& lease, const Job& job) {
  if (job.state != State::leased || !(job.lease == lease)) return false;
  if (const auto session = roster_.find(peer); session != roster_.end() && session->second.worker == job.worker) return true;
  const std::optional<WorkerRow> holder = worker_row(ledger_.reading(), job.worker);
  return holder && holder->peer == peer;
}

wire::Ruling Reactor::rule_on(const std::string& peer, const wire::HeldLease& held, std::int64_t worker, Instant now) {
  const std::optional<Job> job = job_by_lease(ledger_.reading(), held.lease);
  const std::optional<RecheckRow> recheck = job ? std::nullopt : recheck_of(held.lease);
  if (recheck) {
    const std::optional<Job> done = job_by_id(ledger_.reading(), recheck->job);
    const std::optional<WorkerRow> holder = worker_row(ledger_.reading(), recheck->worker);
    if (!done || done->key != held.key || !holder || holder->peer != peer) return wire::Ruling::abandon;
  } else {
    if (!job || job->key != held.key || !holds(peer, held.lease, *job)) return wire::Ruling::abandon;
    if (job->worker != worker) ledger_.adopt(job->id, worker);
  }
  Held& kept = held_[{held.lease.epoch, held.lease.counter}];
  if (kept.job == 0) kept = {job ? job->id : recheck->job, 0.0, now.monotonic_s, 0, recheck ? recheck->id : 0, worker};
  kept.worker = worker;
  kept.deadline_s = now.monotonic_s + settings_.lease_timeout_s;
  kept.step = held.step;
  return wire::Ruling::adopt;
}

// Jobs that the ledger thinks this peer has and that it does not list. An earlier start of the daemon lost them with its life; the same
// start never got them, because the reply with them was lost: nothing is counted for that.
void Reactor::take_back_unlisted(const std::string& peer, const wire::Hello& hello, std::int64_t worker, Instant now) {
  const auto listed = [&](const Job& job) {
    return std::any_of(hello.held.begin(), hello.held.end(),
                       [&](const wire::HeldLease& held) { return held.lease == job.lease && held.key == job.key; });
  };
  for (const Job& job : leased_by_peer(ledger_.reading(), peer)) {
    if (listed(job)) continue;
    if (job.worker != worker) {
      end_try(job, {Fault::node_lost, "worker_restarted", fmt::format("{} started again without this job", peer)}, now);
    } else {
      ledger_.make_ready(job.id);
      held_.erase({job.lease.epoch, job.lease.counter});
    }
  }
  for (const RecheckRow& it : open_rechecks(ledger_.reading(), "LEASED", most_rechecks)) {
    const std::optional<WorkerRow> holder = worker_row(ledger_.reading(), it.worker);
    const bool has_it =
        std::any_of(hello.held.begin(), hello.held.end(), [&](const wire::HeldLease& held) { return held.lease == it.lease; });
    if (!holder || holder->peer != peer || has_it) continue;
    fail_recheck(it, {Fault::planned_stop, "", "its worker came without it"}, now);
  }
}

wire::Reply Reactor::on_hello(const std::string& peer, const wire::Hello& hello, Instant now) {
  if (!is_name(hello.node) || !is_name(hello.instance) || hello.slots < 1)
    return refuse(fmt::format("HELLO needs a node and an instance of 1 to {} bytes, and at least one slot", longest_name));
  if (std::optional<wire::Reply> refusal = wrong_build(hello.build_id)) return *refusal;
  if (had_later_life(ledger_.reading(), peer, hello.instance))
    return refuse(fmt::format("{} has started again since: this HELLO is of an earlier life", peer));
  if (const auto gone = gone_.find(peer); gone != gone_.end() && gone->second == hello.instance)
    return refuse(fmt::format("{} has said BYE since: this HELLO was long under way", peer));
  const std::int64_t worker = ledger_.register_worker(peer, hello, now.wall_s);
  wire::Welcome welcome{epoch_, settings_.beat_interval_s, settings_.lease_timeout_s, {}};
  for (const wire::HeldLease& held : hello.held) welcome.rulings.push_back(rule_on(peer, held, worker, now));
  take_back_unlisted(peer, hello, worker, now);
  Session session{.worker = worker,
                  .instance = hello.instance,
                  .node = hello.node,
                  .build_id = hello.build_id,
                  .slots = hello.slots,
                  .remaining_s = hello.remaining_s,
                  .seen_s = now.monotonic_s,
                  .memory_bytes = hello.memory_bytes,
                  .replies = {}};
  const std::optional<WorkerRow> row = worker_row(ledger_.reading(), worker);
  session.draining = row && row->draining;
  const auto known = roster_.find(peer);
  if (known != roster_.end() && known->second.instance == hello.instance) session.fast_faults = known->second.fast_faults;
  roster_[peer] = std::move(session);
  const auto adopted = std::count(welcome.rulings.begin(), welcome.rulings.end(), wire::Ruling::adopt);
  note(fmt::format("{} on {} says hello: {} slots, {} of {} leases adopted", peer, hello.node, hello.slots, adopted, hello.held.size()));
  return welcome;
}

wire::Reply Reactor::on_next(const std::string& peer, Session& session, const wire::Next& next, Instant now) {
  session.remaining_s = next.remaining_s;
  const bool brings_nothing = next.completed.empty() && next.failed.empty() && next.returned.empty();
  if (std::optional<wire::Reply> refusal = wrong_build(session.build_id); refusal && brings_nothing) return *refusal;
  wire::Jobs reply;
  for (const wire::Completion& completion : next.completed) reply.receipts.push_back(on_completion(peer, session, completion, now));
  session.fault_counted = false;
  for (const wire::Failed& failed : next.failed) reply.receipts.push_back(on_failed(peer, session, failed, now));
  for (const wire::LeaseId& lease : next.returned) on_returned(peer, lease, now);
  hand_out(session, next.free_slots, reply, now);
  if (reply.assignments.empty() && reply.order != wire::Order::drain && give_up_allocation(peer, session, now))
    reply.order = wire::Order::drain;
  return reply;
}

wire::Reply Reactor::on_beat(const std::string& peer, Session& session, const wire::Beat& beat, Instant now) {
  wire::BeatReply reply;
  for (const wire::HeldLease& held : beat.held) reply.rulings.push_back(rule_on(peer, held, session.worker, now));
  if (session.draining) reply.order = wire::Order::drain;
  return reply;
}

// Also from a peer that this start does not know: what it gives back is as good.
wire::Reply Reactor::on_bye(const std::string& peer, const wire::Bye& bye, Instant now) {
  for (const wire::LeaseId& lease : bye.returned) on_returned(peer, lease, now);
  if (const auto session = roster_.find(peer); session != roster_.end()) {
    ledger_.end_worker(session->second.worker, now.wall_s);
    note(fmt::format("{} says bye, {} leases returned", peer, bye.returned.size()));
    gone_[peer] = session->second.instance;
    roster_.erase(session);
  }
  return wire::ByeReply{};
}

bool Reactor::tick(Instant now) {
  // Not having run for a while is this program's own doing (stopped, starved, suspended): nobody's lease ends for it, and nobody was
  // silent.
  const double away_s = now.monotonic_s - ticked_s_;
  ticked_s_ = now.monotonic_s;
  if (away_s > settings_.lease_timeout_s / 3.0) {
    for (auto& [lease, held] : held_) held.deadline_s = std::max(held.deadline_s, now.monotonic_s + settings_.lease_timeout_s);
    for (auto& [peer, session] : roster_) session.seen_s = now.monotonic_s;
  }
  expire_leases(now);
  wake_waiting(now);
  forget_silent(now);
  if (const bool is = settled(); is != was_settled_) {
    was_settled_ = is;
    if (is) notice({"settled", "nothing is left to do"});
  }
  return !due_.empty() && due_.begin()->first <= now.monotonic_s;
}

void Reactor::wake_waiting(Instant now) {
  for (std::uint64_t n = 0; n < settings_.wake_most && !due_.empty() && due_.begin()->first <= now.monotonic_s; ++n) {
    const std::int64_t id = due_.begin()->second;
    due_.erase(due_.begin());
    const std::optional<Job> job = job_by_id(ledger_.reading(), id);
    if (job && job->state == State::retry_wait) ledger_.make_ready(id);
  }
}

void Reactor::notice(Notice notice) {
  note(notice.text);
  notices_.push_back(std::move(notice));
}

void Reactor::expire_leases(Instant now) {
  for (auto at = held_.begin(); at != held_.end();) {
    if (at->second.deadline_s > now.monotonic_s) {
      ++at;
      continue;
    }
    const wire::LeaseId lease{at->first.first, at->first.second};
    const Attempt lost{Fault::node_lost, "lease_timeout", fmt::format("no beat for {:.0f} s", settings_.lease_timeout_s)};
    const std::optional<RecheckRow> recheck = at->second.recheck ? recheck_of(lease) : std::nullopt;
    at = held_.erase(at);
    if (recheck)
      fail_recheck(*recheck, lost, now);
    else if (const std::optional<Job> job = job_by_lease(ledger_.reading(), lease))
      end_try(*job, lost, now);
  }
}

// Workers that are gone for good leave the list; those of earlier starts get the grace to come back.
void Reactor::forget_silent(Instant now) {
  const double patience_s = 2.0 * settings_.lease_timeout_s;
  for (auto at = roster_.begin(); at != roster_.end();) {
    const bool gone = now.monotonic_s - at->second.seen_s > patience_s;
    if (gone) {
      ledger_.end_worker(at->second.worker, now.wall_s);
      note(fmt::format("{} on {} has been silent for {:.0f} s", at->first, at->second.node, now.monotonic_s - at->second.seen_s));
    }
    at = gone ? roster_.erase(at) : std::next(at);
  }
  if (began_s_ >= 0.0 && now.monotonic_s - began_s_ > patience_s) {
    began_s_ = -1.0;  // once
    for (const WorkerRow& row : open_workers(ledger_.reading()))
      if (!roster_.contains(row.peer)) ledger_.end_worker(row.id, now.wall_s);
  }
}

std::set<std::string> Reactor::live_nodes(Instant now) const {
  std::set<std::string> nodes;
  for (const auto& [peer, session] : roster_)
    if (!session.stopped() && now.monotonic_s - session.seen_s < settings_.lease_timeout_s) nodes.insert(session.node);
  return nodes;
}

bool Reactor::settled() { return is_settled(ledger_.reading()); }

std::vector<std::string> Reactor::take_events() { return std::exchange(events_, {}); }
std::vector<Notice> Reactor::take_notices() { return std::exchange(notices_, {}); }

Live Reactor::live(Instant now) {
  Live view;
  view.epoch = epoch_;
  view.rate_per_s = rate_.per_second(now.monotonic_s);
  std::map<std::int64_t, int> running;
  for (const auto& [lease, held] : held_) {
    ++running[held.worker];
    view.steps[held.job] = held.step;
  }
  for (const auto& [peer, session] : roster_) {
    const std::optional<WorkerRow> row = worker_row(ledger_.reading(), session.worker);
    if (!row) continue;
    const double silent_s = now.monotonic_s - session.seen_s;
    const std::string_view state = silent_s > settings_.lease_timeout_s ? "silent"
                                   : session.stopped()                  ? "stopped"
                                   : must_prove_itself(session)         ? "suspect"
                                   : session.draining                   ? "draining"
                                                                        : "working";
    view.workers.push_back({peer, session.node, std::string(state), session.slots, running[session.worker], session.remaining_s, silent_s,
                            row->done, row->faults, row->node_type});
  }
  return view;
}

}  // namespace fracfarm
