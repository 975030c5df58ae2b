// A farm in one thread and one seed: the real reactor, real worker sessions and real SQLite, on simulated disks, network, clocks and
// processes. The network loses, doubles, delays and parts; disks fail, clocks jump, processes stop and die at any call; then all faults
// end, and whatever is not quarantined must come to its end. The same seed gives the same trace.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/base/random.hpp"
#include "coordinator/roster.hpp"
#include "tests/simulation/agenda.hpp"
#include "tests/simulation/fault_disk.hpp"
#include "tests/simulation/known_bugs.hpp"
#include "tests/simulation/watch.hpp"

namespace fracfarm::simulation {

class CoordinatorProcess;
class WorkerProcess;

inline constexpr double lease_timeout_s = 30.0;
inline constexpr double wall_budget_s = 3600.0;
inline const std::string build = "build-a";

struct Settings {
  int patterns = 6;      // of two materials each
  int workers = 3;       // two on a node
  double rough_s = 150;  // simulated seconds with faults
  double calm_s = 4000;  // at most, after them
  bool rough = true;     // false: nothing goes wrong but what a test plans
  bool tell = false;     // prints what happens
  KnownBug bug = KnownBug::none;
};

class World {
 public:
  World(std::uint64_t seed, Settings settings);
  ~World();

  // The first broken invariant in words, or empty.
  std::string run();
  std::string trace_hash() const;
  double simulated_s() const { return agenda.now(); }
  std::uint64_t steps() const { return steps_; }
  const Watch& watched() const { return watch; }

  // --- for the processes of this world ---
  bool chance(double p) { return random.uniform() < p; }
  bool fault(double p) { return rough_ && chance(p); }  // only while things go wrong
  int pick(std::size_t n) { return random.integer(0, static_cast<int>(n) - 1); }
  Instant instant() const { return {1000.0 + agenda.now(), 1.7e9 + agenda.now() + wall_jump_s_}; }
  void trace(std::string_view text);
  void tell(const std::function<std::string()>& line) const;  // where it is asked for
  void send_to_coordinator(int worker, const std::string& bytes);
  void send_to_worker(int worker, const std::string& bytes);
  WorkerProcess& worker(int number) { return *workers_[static_cast<std::size_t>(number)]; }
  std::uint64_t epoch() const;  // as the farm folder says

  Agenda agenda;
  RandomStream random;
  Settings settings;
  FaultDisk disk;
  Watch watch;

 private:
  double travel_s();
  void rough_patch();
  void part_somebody();
  void stranger_acts();
  void person_acts();
  void calm_down();
  void run_until(double time_s, bool till_settled);

  bool rough_ = false;
  double wall_jump_s_ = 0.0;
  std::uint64_t steps_ = 0;
  std::uint64_t trace_ = 0xcbf29ce484222325u;
  std::vector<bool> parted_;
  std::vector<std::pair<int, std::string>> overheard_;  // requests of workers: what a stranger may say again
  std::unique_ptr<CoordinatorProcess> coordinator_;
  std::vector<std::unique_ptr<WorkerProcess>> workers_;
};

std::string name_of_worker(int number);
std::string node_of_worker(int number);
std::string campaign_text(int patterns);

}  // namespace fracfarm::simulation
