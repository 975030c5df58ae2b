// A farm in simulated time: the real reactor, real worker sessions and the real ledger, a coordinator as slow as a plan says, jobs that
// only take time, and allocations that end. Says where the slot time went. Nothing fails in it; what may go wrong is the business of
// tests/simulation.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/base/random.hpp"
#include "coordinator/reactor.hpp"
#include "tests/simulation/agenda.hpp"
#include "worker/session.hpp"

namespace fracfarm::benchmarks {

// Jobs of one material: log-normal.
struct RunTime {
  std::string material;
  double mean_s = 1.0;
  double spread = 0.0;  // of the logarithm
};

struct NodeKind {
  int slots = 25;
  std::uint64_t memory_bytes = std::uint64_t{1} << 36;
  double speed = 1.0;  // a job takes its time divided by this
};

struct FarmPlan {
  std::vector<RunTime> classes{{"pbx", 1.0, 0.0}};  // as many jobs of each
  std::vector<NodeKind> kinds{{}};                  // of workers, in turn
  int workers = 100;
  double wall_budget_s = 600.0;  // of a job
  double allocation_s = 0.0;     // of a worker: half of this to all of it, then another begins; 0: no end
  double warm_up_s = 20.0;       // simulated, before anything counts
  double counted_s = 300.0;
  // The machine: a coordinator that does 5,000 jobs a second asked for one by one.
  double latency_s = 0.002;  // of a message, one way
  double commit_s = 0.005;
  double message_s = 60e-6, job_s = 140e-6;
  double start_s = 0.002;  // of a job in a slot that was free
  double keep_s = 0.02;    // to judge a record and sync it, beside the slot
};

// Slot seconds within the counted time, of allocations until they are given back.
struct SlotTime {
  double working = 0.0;  // on tries that came to a result or still run
  double cut = 0.0;      // on tries that a limit ended: as if no checkpoint were kept
  double unfit = 0.0;    // idle because nothing that is left fits the time that is left
  double waiting = 0.0;  // idle for any other reason: before the first job and between jobs

  double all() const { return working + cut + unfit + waiting; }
};

class FarmInTime {
 public:
  explicit FarmInTime(FarmPlan plan);
  ~FarmInTime();

  void run(const std::function<void(double now_s, double end_s)>& told);  // now and then

  const SlotTime& slot_time() const { return spent_; }
  std::uint64_t done() const { return done_; }  // of the counted time, as the next two
  std::uint64_t cut() const { return cut_; }
  std::uint64_t allocations() const { return allocations_; }  // that ended
  double given_back_s() const { return given_back_s_; }       // slot seconds of allocations that ended early
  // Of the whole run, as the ledger has them.
  std::uint64_t planned_stops();
  std::uint64_t faults();  // others: retries that were burnt

 private:
  struct Worker;
  struct Message {
    int worker = 0;
    std::uint64_t life = 0;
    wire::RequestEnvelope envelope;
  };

  Instant instant() const { return {1000.0 + agenda_.now(), 1.7e9 + agenda_.now()}; }
  void begin(int number);
  void feed(int number, const worker::Event& event);
  void tick_later(int number);
  bool lives(int number, std::uint64_t life) const;
  void act(int number, const worker::Action& action);
  void post(int number, const wire::Request& request);
  void start(int number, const worker::StartJob& job);
  void solved(int number, std::uint64_t life, worker::JobId job, double takes_s);
  void stopped(int number, std::uint64_t life, worker::JobId job);
  void end(int number);
  void hear(const Message& asked, const wire::Reply& reply);
  void turn();
  void turn_soon(double after_s);
  void account(Worker& worker);
  double counted(double from_s) const;  // seconds from then to now that count
  double time_of(const wire::Assignment& job, const NodeKind& kind) const;

  FarmPlan plan_;
  simulation::Agenda agenda_;
  RandomStream random_;
  Ledger ledger_;
  Reactor reactor_;
  std::vector<std::unique_ptr<Worker>> workers_;
  std::deque<Message> inbox_;
  bool turning_ = false;
  std::uint64_t turns_asked_ = 0, lives_ = 0;
  SlotTime spent_;
  std::uint64_t done_ = 0, cut_ = 0, allocations_ = 0;
  double given_back_s_ = 0.0;
};

}  // namespace fracfarm::benchmarks
