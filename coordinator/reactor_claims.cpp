// Claims: which work a worker gets for its free slots, and what to do where there is none.
#include <fmt/format.h>

#include <algorithm>
#include <climits>
#include <tuple>
#include <utility>

#include "coordinator/reactor.hpp"

namespace fracfarm {
namespace {

constexpr int claim_page = 64;   // READY jobs or lanes looked at at once
constexpr int claim_pages = 16;  // and how often, where they do not fit the claimant
constexpr int most_rounds = 16;  // of filling a claim, where jobs turn out to be there already
constexpr double relearn_s = 5.0;

}  // namespace

// Work for free slots; where there is none, what to do instead.
void Reactor::hand_out(Session& session, int free_slots, wire::Jobs& reply, Instant now) {
  if (session.draining) {
    reply.order = wire::Order::drain;
    return;
  }
  const int most = std::min(free_slots, most_jobs_a_slot * std::min(session.slots, most_jobs_a_claim));
  const bool may_work = most > 0 && !wrong_build(session.build_id) && !wrong_build(settings_.build_id);
  if (may_work && must_prove_itself(session)) {
    give_canary(session, reply, now);
  } else if (may_work) {
    give_rechecks(session, most, reply, now);
    give_jobs(session, most - static_cast<int>(reply.assignments.size()), reply, now);
  }
  if (!reply.assignments.empty()) session.idle_since_s = -1.0;
  if (!reply.assignments.empty() || free_slots <= 0) return;
  if (session.idle_since_s < 0.0) session.idle_since_s = now.monotonic_s;
  reply.order = settled() ? wire::Order::stop : wire::Order::wait;
  reply.wait_s = std::clamp(static_cast<double>(roster_.size()) / 200.0, 0.5, 10.0);
}

// An allocation costs whether it works or not: one that holds nothing is given back early, at once where all work that there is is known to
// take longer than is left, after a while where there is none or its time is not known yet.
bool Reactor::give_up_allocation(const std::string& peer, Session& session, Instant now) {
  if (session.remaining_s < 0.0 || session.idle_since_s < 0.0) return false;
  const bool at_once = session.too_long.known && !session.too_long.unknown;
  if (!at_once && now.monotonic_s - session.idle_since_s < settings_.idle_return_s) return false;
  const bool holds_something = std::any_of(held_.begin(), held_.end(), [&](const auto& it) { return it.second.worker == session.worker; });
  if (holds_something) return false;
  note(fmt::format("{} on {} ends early: nothing has fitted the {:.0f} s that its allocation has left", peer, session.node,
                   session.remaining_s));
  return true;
}

Claimant Reactor::claimant_of(const Session& session, int most) const {
  Claimant it{session.node,          most, session.remaining_s, node_type_of(session.slots, session.memory_bytes), session.slots,
              session.slot_memory(), 0};
  for (const auto& [peer, other] : roster_)
    if (!other.stopped()) it.most_memory = std::max(it.most_memory, other.slot_memory());
  return it;
}

// A job that has a row, or the next of a lane.
struct Reactor::Pick {
  bool touched = false;
  std::size_t at = 0;  // of the jobs or lanes
  std::int64_t id = 0;
};

// The first in order of both lists, as many as fit behind one another. `lanes` move on past what is picked from them.
std::vector<Reactor::Pick> Reactor::pick(const Claimant& claimant, const std::vector<Job>& jobs, std::vector<Lane>& lanes) {
  Claim taking(claimant, learned_);
  std::vector<Pick> picks;
  std::size_t job = 0;
  std::vector<bool> closed(lanes.size());  // ended, or its class no longer fits
  while (taking.left() > 0) {
    std::size_t lane = lanes.size();
    for (std::size_t at = 0; at < lanes.size(); ++at)
      if (!closed[at] &&
          (lane == lanes.size() || std::tuple(-lanes[at].priority, lanes[at].next) < std::tuple(-lanes[lane].priority, lanes[lane].next)))
        lane = at;
    if (job == jobs.size() && lane == lanes.size()) break;
    const bool touched = lane == lanes.size() || (job < jobs.size() && std::tuple(-jobs[job].priority, jobs[job].id) <
                                                                           std::tuple(-lanes[lane].priority, lanes[lane].next));
    const JobClass& job_class = touched ? jobs[job].job_class : lanes[lane].job_class;
    const double budget_s = wall_budget_s(touched ? jobs[job].campaign : lanes[lane].campaign);
    const bool fits = taking.fits(job_class, budget_s);
    if (fits) taking.take(job_class, budget_s);
    if (touched) {
      if (fits) picks.push_back({true, job, jobs[job].id});
      ++job;
    } else {
      if (fits) picks.push_back({false, lane, lanes[lane].next});
      if (fits) lanes[lane].next += lanes[lane].stride;
      closed[lane] = !fits || lanes[lane].next > lanes[lane].last;
    }
  }
  return picks;
}

// A lane's job becomes a row as it is leased. Where the ledger has its key already there is one job less, and the claim is filled again.
void Reactor::give_jobs(Session& session, int most, wire::Jobs& reply, Instant now) {
  if (now.monotonic_s - learned_at_s_ > relearn_s) {
    learned_ = {learned_times(ledger_.reading()), learned_times_by_node(ledger_.reading())};
    learned_at_s_ = now.monotonic_s;
  }
  const std::size_t want = reply.assignments.size() + static_cast<std::size_t>(std::max(0, most));
  session.too_long = {};
  bool again = true;
  for (int round = 0; again && round < most_rounds && reply.assignments.size() < want; ++round) {
    const Claimant claimant = claimant_of(session, static_cast<int>(want - reply.assignments.size()));
    const std::vector<Job> jobs = fitting_jobs(claimant, session.too_long, now);
    const std::vector<Lane> before = fitting_lanes(claimant, session.too_long);
    std::vector<Lane> lanes = before;
    again = false;
    for (const Pick& it : pick(claimant, jobs, lanes)) {
      if (it.touched) {
        reply.assignments.push_back(assign(jobs[it.at], session, now));
        continue;
      }
      auto assignment = assign_untouched(before[it.at], it.id, session, now);
      again = again || !assignment;
      if (assignment) reply.assignments.push_back(std::move(*assignment));
    }
    for (std::size_t at = 0; at < lanes.size(); ++at)
      if (lanes[at].next != before[at].next) ledger_.advance_lane(before[at], lanes[at].next);
  }
}

// Nothing where this program cannot read the job's campaign.
std::optional<Candidate> Reactor::candidate_of(const Job& job) {
  const auto campaign = book_.open(ledger_.reading(), job.campaign);
  if (!campaign || paused_.contains(job.job_class)) return std::nullopt;
  Candidate candidate{job.id, job.job_class, (*campaign)->wall_budget_s, {}, job.memory_floor};
  if (job.attempts == 0) return candidate;
  for (const AttemptRow& row : attempts_of(ledger_.reading(), job.id))
    if (row.id > job.forgiven && row.fault != fault_row(Fault::planned_stop).name) candidate.failed_on.insert(row.node);
  return candidate;
}

double Reactor::wall_budget_s(std::int64_t campaign) {
  const auto known = book_.open(ledger_.reading(), campaign);
  return known ? (*known)->wall_budget_s : 0.0;
}

// Looks at READY jobs a page at a time, so that jobs which do not fit this claimant hide none that do; the number of pages is bounded.
std::vector<Job> Reactor::fitting_jobs(const Claimant& claimant, TooLong& too_long, Instant now) {
  std::vector<Job> fitting;
  std::set<std::string> nodes;
  ClaimCursor cursor;
  const Claim nobody_before(claimant, learned_);
  for (int page = 0; page < claim_pages && static_cast<int>(fitting.size()) < claimant.free_slots; ++page) {
    std::vector<Job> jobs = ready_jobs(ledger_.reading(), cursor, page == 0 ? std::min(claimant.free_slots, claim_page) : claim_page);
    if (jobs.empty()) break;
    if (page == 0) nodes = live_nodes(now);
    cursor = {jobs.back().priority, jobs.back().id};
    for (Job& job : jobs) {
      const std::optional<Candidate> it = candidate_of(job);
      if (!it || better_elsewhere(*it, claimant, nodes) || larger_elsewhere(it->memory_floor, claimant)) continue;
      if (nobody_before.fits(it->job_class, it->wall_budget_s))
        fitting.push_back(std::move(job));
      else
        too_long.count(longest_try(it->job_class, it->wall_budget_s, learned_, claimant.node_type).learned);
    }
  }
  return fitting;
}

// The first of the lanes that this claimant may have something of: no claim reaches into more lanes than it has jobs.
std::vector<Lane> Reactor::fitting_lanes(const Claimant& claimant, TooLong& too_long) {
  std::vector<Lane> fitting;
  int priority = INT_MAX;
  std::int64_t after = 0;
  const Claim nobody_before(claimant, learned_);
  for (int page = 0; page < claim_pages && static_cast<int>(fitting.size()) < claimant.free_slots; ++page) {
    const std::vector<Lane> lanes = ready_lanes(ledger_.reading(), priority, after, std::max(claimant.free_slots, claim_page));
    if (lanes.empty()) break;
    priority = lanes.back().priority;
    after = lanes.back().next;
    for (const Lane& lane : lanes) {
      if (paused_.contains(lane.job_class) || !book_.open(ledger_.reading(), lane.campaign)) continue;
      const double budget_s = wall_budget_s(lane.campaign);
      if (nobody_before.fits(lane.job_class, budget_s))
        fitting.push_back(lane);
      else
        too_long.count(longest_try(lane.job_class, budget_s, learned_, claimant.node_type).learned);
    }
  }
  return fitting;
}

wire::Assignment Reactor::assign(const Job& job, const Session& session, Instant now) {
  const wire::LeaseId lease{epoch_, ++counter_};
  ledger_.lease(job.id, lease, session.worker, now.wall_s);
  held_[{lease.epoch, lease.counter}] = {job.id, now.monotonic_s + settings_.lease_timeout_s, now.monotonic_s, 0, 0, session.worker};
  const std::shared_ptr<const Campaign> campaign = book_.open(ledger_.reading(), job.campaign).value();  // candidate_of opened it
  return assignment_of(job.key, job.id, *campaign, lease, book_.scene_text(job.campaign, job.position), job.attempts + 1, job.step_scale);
}

std::optional<wire::Assignment> Reactor::assign_untouched(const Lane& lane, std::int64_t id, const Session& session, Instant now) {
  Result<Untouched> made = untouched_job(ledger_.reading(), book_, lane, id);
  if (!made) return std::nullopt;
  const wire::LeaseId lease{epoch_, counter_ + 1};
  if (!ledger_.add_leased(made->job, lease, session.worker, now.wall_s)) return ledger_.count_shared(lane.campaign), std::nullopt;
  ++counter_;
  held_[{lease.epoch, lease.counter}] = {id, now.monotonic_s + settings_.lease_timeout_s, now.monotonic_s, 0, 0, session.worker};
  const std::shared_ptr<const Campaign> campaign = book_.open(ledger_.reading(), lane.campaign).value();
  return assignment_of(made->job.key, id, *campaign, lease, std::move(made->scene), 1, 1.0);
}

wire::Assignment Reactor::assignment_of(const std::string& key, std::int64_t id, const Campaign& campaign, wire::LeaseId lease,
                                        std::string scene, int attempt, double step_scale) {
  return {lease, key, static_cast<std::uint64_t>(id), attempt, std::move(scene), campaign.wall_budget_s, step_scale, campaign.store};
}

}  // namespace fracfarm
