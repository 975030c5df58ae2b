// What happens in the world; the processes are in coordinator_process.cpp and worker_process.cpp, what must hold in watch.cpp.
#include "tests/simulation/world.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "common/wire/codec.hpp"
#include "tests/simulation/coordinator_process.hpp"
#include "tests/simulation/worker_process.hpp"

namespace fracfarm::simulation {
namespace {

constexpr std::size_t most_overheard = 40;

}  // namespace

std::string name_of_worker(int number) { return fmt::format("worker-{}", number); }
std::string node_of_worker(int number) { return fmt::format("node-{}", number / 2); }

std::string campaign_text(int patterns) {
  return fmt::format(
      R"({{"name": "simulated", "seed": 7, "jobs": [{{"method": "drill", "patterns": {{"orthogonal": "1-{}"}},
    "set": {{"drill.act": ["sleep", "crash"]}}}}], "budget": {{"wall_clock": {}, "attempts": 3}}}})",
      patterns, wall_budget_s);
}

World::World(std::uint64_t seed, Settings given)
    : random(seed, 1, 0), settings(given), disk(seed), watch(lease_timeout_s, wall_budget_s), rough_(given.rough) {
  if (settings.bug == KnownBug::retry_after_failed_sync) disk.believe_failed_syncs();
  coordinator_ = std::make_unique<CoordinatorProcess>(*this);
  for (int n = 0; n < settings.workers; ++n) workers_.push_back(std::make_unique<WorkerProcess>(*this, n));
  parted_.assign(static_cast<std::size_t>(settings.workers), false);
  if (rough_) workers_.back()->have_end(true);
}

// The ledger is closed on this world's disk, whichever world ran last.
World::~World() { FaultDisk::use(disk); }

std::uint64_t World::epoch() const { return coordinator_->epoch(); }

// FNV-1a, 64 bits.
void World::trace(std::string_view text) {
  for (const char c : text) trace_ = (trace_ ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  trace_ ^= static_cast<std::uint64_t>(agenda.now() * 1e6);
  tell([&] { return std::string(text); });
}

void World::tell(const std::function<std::string()>& line) const {
  if (settings.tell) fmt::print("{:10.4f} {}\n", agenda.now(), line());
}

std::string World::trace_hash() const { return fmt::format("{:016x}", trace_); }

std::string World::run() {
  coordinator_->start();
  for (auto& worker : workers_) agenda.after(random.uniform(0.0, 3.0), [&worker] { worker->start(); });
  if (rough_) {
    agenda.after(random.uniform(0.0, 5.0), [this] { rough_patch(); });
    run_until(settings.rough_s, false);
    calm_down();
  }
  run_until(agenda.now() + settings.calm_s, true);
  if (watch.first_broken().empty() && !coordinator_->settled()) watch.broken("I8: jobs are left though nothing goes wrong any more");
  return watch.first_broken();
}

void World::run_until(double time_s, bool till_settled) {
  while (watch.first_broken().empty() && agenda.now() < time_s && !(till_settled && coordinator_->settled())) {
    agenda.next();
    ++steps_;
  }
}

// --- network ---

double World::travel_s() {
  if (fault(0.06)) return random.uniform(1.0, 40.0);  // overtaken by later ones
  return random.uniform(0.0002, 0.02);
}

void World::send_to_coordinator(int worker, const std::string& bytes) {
  if (rough_ && overheard_.size() < most_overheard) overheard_.emplace_back(worker, bytes);
  for (int copies = fault(0.08) ? 2 : 1; copies > 0; --copies) {
    if (parted_[static_cast<std::size_t>(worker)] || fault(0.06)) continue;
    agenda.after(travel_s(), [this, worker, bytes] { coordinator_->hear({worker, name_of_worker(worker), bytes}); });
  }
}

void World::send_to_worker(int worker, const std::string& bytes) {
  for (int copies = fault(0.08) ? 2 : 1; copies > 0; --copies) {
    if (parted_[static_cast<std::size_t>(worker)] || fault(0.06)) continue;
    agenda.after(travel_s(), [this, worker, bytes] { workers_[static_cast<std::size_t>(worker)]->hear(bytes); });
  }
}

// --- what goes wrong ---

void World::rough_patch() {
  if (!rough_) return;
  agenda.after(random.uniform(0.5, 12.0), [this] { rough_patch(); });
  const auto somebody = [this]() -> WorkerProcess& { return *workers_[static_cast<std::size_t>(pick(workers_.size()))]; };
  const double dice = random.uniform();
  if (dice < 0.12) return coordinator_->alive() ? coordinator_->die(chance(0.5)) : void();
  if (dice < 0.18) return coordinator_->stand_still(random.uniform(1.0, 90.0));
  if (dice < 0.34) return somebody().die(chance(0.4));
  if (dice < 0.42) return somebody().feed(worker::TerminateAsked{});
  if (dice < 0.46) return somebody().feed(worker::DrainAsked{});
  if (dice < 0.58) return part_somebody();
  if (dice < 0.66) {
    wall_jump_s_ += random.uniform(-7200.0, 7200.0);
    return trace("clock jumps");
  }
  if (dice < 0.88) return stranger_acts();
  person_acts();
}

void World::part_somebody() {
  const auto who = static_cast<std::size_t>(pick(parted_.size()));
  parted_[who] = true;
  agenda.after(random.uniform(1.0, 70.0), [this, who] { parted_[who] = false; });
  trace("parted");
}

// A peer with a key of its own, a worker's routing id, and what it overheard that worker say: beats, results, faults, returns, byes.
void World::stranger_acts() {
  if (overheard_.empty()) return;
  const auto at = static_cast<std::size_t>(pick(overheard_.size()));
  const auto [victim, bytes] = overheard_[at];
  overheard_.erase(overheard_.begin() + static_cast<std::ptrdiff_t>(at));
  const auto request = wire::decode_request(bytes);
  if (!request || std::holds_alternative<wire::Hello>(request->request)) return;  // with its own key it may be a worker of its own
  coordinator_->hear({stranger, name_of_worker(victim), bytes});
}

void World::person_acts() {
  const std::int64_t job = random.integer(1, 2 * settings.patterns);
  static constexpr const char* verbs[]{"cancel", "retry", "retry", "hold", "release", "release"};
  const std::string verb = verbs[pick(std::size(verbs))];
  coordinator_->hear({person, "", wire::encode(wire::RequestEnvelope{0, wire::Ask{verb, nlohmann::json{{"jobs", {job}}}.dump()}})});
  trace(verb);
}

// Faults stop; workers are started again, as a person would: those that had too many fast faults, and those whose allocation is too short.
void World::calm_down() {
  rough_ = false;
  disk.forget_plan();
  parted_.assign(parted_.size(), false);
  for (auto& worker : workers_) {
    worker->have_end(false);
    worker->die(false);
  }
  trace("calm");
}

}  // namespace fracfarm::simulation
