#include "tests/benchmarks/farm_in_time.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "common/base/hash.hpp"

namespace fracfarm::benchmarks {
namespace {

constexpr std::size_t most_messages = 256;  // of one transaction, as the serving loop has it
constexpr double longest_batch_s = 0.005;
constexpr double tick_s = 0.1;
constexpr double stop_s = 0.1;  // from TERM to the checkpoint
constexpr std::uint64_t seed = 1;
const std::string build = "simulated";

std::string campaign_of(const FarmPlan& plan) {
  nlohmann::json materials = nlohmann::json::array();
  for (const RunTime& it : plan.classes) materials.push_back(it.material);
  nlohmann::json jobs{{"method", "phase_field"}, {"loads", {"uniaxial"}}, {"patterns", {{"orthogonal", "1-1000000"}}}};
  jobs["materials"] = materials;
  nlohmann::json campaign{{"name", "simulated"}, {"seed", 7}, {"jobs", {jobs}}};
  campaign["budget"] = {{"wall_clock", fmt::format("{:.0f}s", plan.wall_budget_s)}, {"attempts", 3}};
  return campaign.dump();
}

}  // namespace

struct FarmInTime::Worker {
  NodeKind kind;
  std::uint64_t life = 0;
  std::unique_ptr<worker::Session> session;
  double end_s = -1.0;   // of its allocation
  double tick_s = -1.0;  // when it will be called without an event; < 0: not asked for
  std::uint64_t request = 0;
  int asked_for = 0;      // by the claim under way
  bool short_of = false;  // its last claim got less than it asked for, or it is ending
  double seen_s = 0.0;    // its slots are accounted for up to here
  int working = 0;        // slots
  std::map<worker::JobId, double> began;
  std::map<worker::JobId, wire::Assignment> jobs;
};

FarmInTime::FarmInTime(FarmPlan plan)
    : plan_(std::move(plan)), random_(seed, 1, 1), ledger_(Ledger::in_memory()), reactor_(ledger_, {build, 5.0, 30.0, 512}, instant()) {
  ledger_.begin();
  const wire::Ask submit{"submit", nlohmann::json{{"campaign", campaign_of(plan_)}}.dump()};
  const auto answer = std::get<wire::Answer>(reactor_.answer("client", {1, submit}, instant()));
  ledger_.commit();
  if (answer.exit_code != 0) throw std::runtime_error(answer.body);
  for (int number = 0; number < plan_.workers; ++number) {
    workers_.push_back(std::make_unique<Worker>());
    workers_.back()->kind = plan_.kinds[static_cast<std::size_t>(number) % plan_.kinds.size()];
    begin(number);
  }
  turn_soon(tick_s);
}

FarmInTime::~FarmInTime() = default;

void FarmInTime::run(const std::function<void(double, double)>& told) {
  const double end_s = plan_.warm_up_s + plan_.counted_s;
  for (std::uint64_t steps = 0; agenda_.now() < end_s && agenda_.next(); ++steps)
    if (steps % 100'000 == 0) told(std::min(agenda_.now(), end_s), end_s);
  for (const auto& worker : workers_) {
    account(*worker);
    for (const auto& [job, began_s] : worker->began) spent_.working += counted(began_s);
  }
}

std::uint64_t FarmInTime::planned_stops() { return fault_counts(ledger_.reading())["PLANNED_STOP"]; }

std::uint64_t FarmInTime::faults() {
  std::uint64_t n = 0;
  for (const auto& [fault, count] : fault_counts(ledger_.reading()))
    if (fault != "PLANNED_STOP") n += count;
  return n;
}

// --- slot time ---

double FarmInTime::counted(double from_s) const {
  const double end_s = plan_.warm_up_s + plan_.counted_s;
  return std::max(0.0, std::min(agenda_.now(), end_s) - std::max(from_s, plan_.warm_up_s));
}

// Idle slots since the last look; those that work are counted when their try ends.
void FarmInTime::account(Worker& worker) {
  const double idle = counted(worker.seen_s) * (worker.kind.slots - worker.working);
  (worker.short_of ? spent_.unfit : spent_.waiting) += idle;
  worker.seen_s = agenda_.now();
}

// The same job takes the same time, wherever and however often it is tried.
double FarmInTime::time_of(const wire::Assignment& job, const NodeKind& kind) const {
  const auto of = std::find_if(plan_.classes.begin(), plan_.classes.end(),
                               [&](const RunTime& it) { return job.scene.find('"' + it.material + '"') != std::string::npos; });
  if (of == plan_.classes.end()) throw std::runtime_error("a scene without one of the plan's materials");
  RandomStream random(seed, job.job, 2);
  const double normal = std::sqrt(-2.0 * std::log(1.0 - random.uniform())) * std::cos(2.0 * std::numbers::pi * random.uniform());
  return of->mean_s * std::exp(of->spread * normal - 0.5 * of->spread * of->spread) / kind.speed;
}

// --- workers ---

void FarmInTime::begin(int number) {
  Worker& worker = *workers_[static_cast<std::size_t>(number)];
  worker.life = ++lives_;
  worker::SessionOptions session;
  session.node = fmt::format("node-{}", number);
  session.instance = fmt::format("life-{:09}", worker.life);
  session.build_id = build;
  session.slots = worker.kind.slots;
  session.memory_bytes = worker.kind.memory_bytes;
  if (plan_.allocation_s > 0.0) session.end_at = worker.end_s = agenda_.now() + plan_.allocation_s * random_.uniform(0.5, 1.0);
  worker.session = std::make_unique<worker::Session>(session);
  worker.tick_s = -1.0;
  worker.short_of = false;
  worker.seen_s = agenda_.now();
  worker.began.clear();
  worker.jobs.clear();
  worker.working = 0;
  feed(number, worker::Tick{});
}

bool FarmInTime::lives(int number, std::uint64_t life) const { return workers_[static_cast<std::size_t>(number)]->life == life; }

void FarmInTime::feed(int number, const worker::Event& event) {
  Worker& worker = *workers_[static_cast<std::size_t>(number)];
  const std::uint64_t life = worker.life;
  for (const worker::Action& action : worker.session->step(event, agenda_.now())) {
    act(number, action);
    if (worker.life != life) return;  // it ended, and another began
  }
  tick_later(number);
}

void FarmInTime::tick_later(int number) {
  Worker& worker = *workers_[static_cast<std::size_t>(number)];
  const double next_s = worker.session->next_tick(agenda_.now());
  if (worker.tick_s >= 0.0 && worker.tick_s <= next_s) return;
  worker.tick_s = next_s;
  agenda_.after(next_s - agenda_.now(), [this, number, life = worker.life, next_s] {
    Worker& it = *workers_[static_cast<std::size_t>(number)];
    if (it.life != life || it.tick_s != next_s) return;
    it.tick_s = -1.0;
    feed(number, worker::Tick{});
  });
}

void FarmInTime::act(int number, const worker::Action& action) {
  Worker& worker = *workers_[static_cast<std::size_t>(number)];
  if (const auto* it = std::get_if<worker::Post>(&action)) post(number, it->request);
  if (const auto* it = std::get_if<worker::StartJob>(&action)) start(number, *it);
  if (const auto* it = std::get_if<worker::StopJob>(&action)) {
    account(worker);
    worker.short_of = true;
    agenda_.after(stop_s, [this, number, life = worker.life, job = it->job] { stopped(number, life, job); });
  }
  if (std::holds_alternative<worker::Finish>(action)) end(number);
}

void FarmInTime::post(int number, const wire::Request& request) {
  Worker& worker = *workers_[static_cast<std::size_t>(number)];
  if (const auto* next = std::get_if<wire::Next>(&request)) worker.asked_for = next->free_slots;
  agenda_.after(plan_.latency_s, [this, message = Message{number, worker.life, {++worker.request, request}}]() mutable {
    inbox_.push_back(std::move(message));
    if (!turning_) turn_soon(0.0);
  });
}

void FarmInTime::start(int number, const worker::StartJob& job) {
  Worker& worker = *workers_[static_cast<std::size_t>(number)];
  const double takes_s = time_of(job.assignment, worker.kind);
  worker.jobs[job.job] = job.assignment;
  agenda_.after(plan_.start_s, [this, number, life = worker.life, id = job.job, takes_s] {
    Worker& it = *workers_[static_cast<std::size_t>(number)];
    if (!lives(number, life) || !it.jobs.contains(id)) return;
    account(it);
    ++it.working;
    it.began[id] = agenda_.now();
    agenda_.after(takes_s, [this, number, life, id, takes_s] { solved(number, life, id, takes_s); });
  });
}

void FarmInTime::solved(int number, std::uint64_t life, worker::JobId job, double takes_s) {
  Worker& worker = *workers_[static_cast<std::size_t>(number)];
  if (!lives(number, life) || !worker.began.contains(job)) return;
  account(worker);
  --worker.working;
  spent_.working += counted(worker.began.at(job));
  worker.began.erase(job);
  if (agenda_.now() > plan_.warm_up_s) ++done_;
  const wire::Assignment it = worker.jobs.extract(job).mapped();
  wire::Completion kept{it.lease, it.key, Verdict::censored, std::nullopt, "horizon", 1e6, 10, takes_s, takes_s, "s.tar", 512, 300, {}};
  kept.sha256 = sha256_hex(it.key);
  agenda_.after(plan_.keep_s, [this, number, life, job, kept = std::move(kept)] {
    if (lives(number, life)) feed(number, worker::JobKept{job, kept});
  });
  feed(number, worker::JobSolved{job, takes_s});
}

void FarmInTime::stopped(int number, std::uint64_t life, worker::JobId job) {
  Worker& worker = *workers_[static_cast<std::size_t>(number)];
  if (!lives(number, life) || worker.jobs.erase(job) == 0) return;
  if (const auto began = worker.began.extract(job)) {
    account(worker);
    --worker.working;
    spent_.cut += counted(began.mapped());
    if (agenda_.now() > plan_.warm_up_s) ++cut_;
  }
  feed(number, worker::JobStopped{job});
}

// What is left of the allocation is somebody else's; the scheduler gives another at once.
void FarmInTime::end(int number) {
  Worker& worker = *workers_[static_cast<std::size_t>(number)];
  account(worker);
  if (agenda_.now() > plan_.warm_up_s) {
    ++allocations_;
    given_back_s_ += std::max(0.0, worker.end_s - agenda_.now()) * worker.kind.slots;
  }
  begin(number);
}

void FarmInTime::hear(const Message& asked, const wire::Reply& reply) {
  if (!lives(asked.worker, asked.life)) return;
  Worker& worker = *workers_[static_cast<std::size_t>(asked.worker)];
  if (const auto* jobs = std::get_if<wire::Jobs>(&reply); jobs && worker.asked_for > 0) {
    account(worker);
    worker.short_of = static_cast<int>(jobs->assignments.size()) < worker.asked_for;
  }
  feed(asked.worker, worker::ReplyCame{reply});
}

// --- the coordinator ---

void FarmInTime::turn_soon(double after_s) {
  agenda_.after(after_s, [this, asked = ++turns_asked_] {
    if (asked == turns_asked_) turn();
  });
}

// One transaction: what waits, the timers, commit, replies; then the next.
void FarmInTime::turn() {
  double takes_s = 0.0;
  std::vector<std::pair<Message, wire::Reply>> replies;
  ledger_.begin();
  while (!inbox_.empty() && replies.size() < most_messages && takes_s < longest_batch_s) {
    Message message = std::move(inbox_.front());
    inbox_.pop_front();
    wire::Reply reply = reactor_.answer(fmt::format("worker-{}", message.worker), message.envelope, instant());
    const auto* jobs = std::get_if<wire::Jobs>(&reply);
    takes_s += plan_.message_s + (jobs ? plan_.job_s * static_cast<double>(jobs->assignments.size()) : 0.0);
    replies.emplace_back(std::move(message), std::move(reply));
  }
  const bool more = reactor_.tick(instant());
  ledger_.commit();
  (void)reactor_.take_events();
  (void)reactor_.take_notices();
  turning_ = !replies.empty();
  if (!turning_) return turn_soon(more ? 0.0 : tick_s);
  agenda_.after(takes_s + plan_.commit_s, [this, replies = std::move(replies)]() mutable {
    for (auto& [asked, reply] : replies)
      agenda_.after(plan_.latency_s, [this, asked = std::move(asked), reply = std::move(reply)] { hear(asked, reply); });
    turning_ = false;
    turn_soon(inbox_.empty() ? tick_s : 0.0);
  });
}

}  // namespace fracfarm::benchmarks
