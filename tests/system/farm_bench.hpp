// A farm of real processes in a temporary folder: programs started and killed as a person or a power cut would, and the questions that
// every test asks at its end. Everything started here is killed by the kernel when the test program ends.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tests/wire/temp_farm.hpp"

namespace fracfarm::bench {

// One program in a process group of its own; killed with its group when this goes.
class Process {
 public:
  Process(const std::vector<std::string>& command, const std::filesystem::path& log,
          const std::map<std::string, std::string>& environment = {});
  ~Process();
  Process(Process&& other) noexcept;
  Process& operator=(Process&& other) noexcept;

  pid_t pid() const { return pid_; }
  void signal(int number) const;
  void signal_group(int number) const;
  bool running();
  // Exit status, or 128 + signal; fails the test where it does not end in time.
  int wait(double timeout_s = 200.0);

 private:
  pid_t pid_ = -1;
  std::optional<int> status_;
};

bool wait_until(const std::function<bool()>& holds, double timeout_s = 200.0);
void sleep_s(double seconds);

struct Campaign {
  std::string materials = R"(["pbx"])";
  std::string loads = R"(["uniaxial"])";
  int patterns = 8;
  std::string set = R"("phase_field.cells" = [63, 63])";  // inline table of scene keys
  std::string wall_clock = "10min";
  int attempts = 3;
};

class FarmBench {
 public:
  FarmBench();
  ~FarmBench();  // on a failed test, prints what the programs said

  std::filesystem::path folder() const { return temp_.path; }
  std::filesystem::path farm() const { return temp_.path / "farm"; }
  std::filesystem::path campaign(const Campaign& campaign);

  // `fracfarm VERB ... --farm FARM`, to its end.
  struct Outcome {
    int status = 0;
    std::string output;
  };
  Outcome verb(std::vector<std::string> words);
  nlohmann::json json(std::vector<std::string> words);  // with --json; fails the test where it is no JSON

  void submit(const Campaign& campaign);
  Process coordinator(std::vector<std::string> more = {});
  Process worker(std::vector<std::string> more = {}, const std::map<std::string, std::string>& environment = {});
  Process start(std::vector<std::string> words, const std::map<std::string, std::string>& environment = {});

  int done();                          // jobs DONE; -1 where nobody answers just now
  std::vector<nlohmann::json> jobs();  // rows
  nlohmann::json explain(int job);
  // From the workers' logs: how often each job was started.
  std::map<int, int> starts() const;
  std::vector<long long> steps_logged(const std::string& event) const;  // "at step N" of progress or stopped, in order, of one worker's log
  bool logged(const std::string& text) const;                           // by any worker
  void power_cut() const;                                               // SIGKILL to every process of this farm at once
  int processes_alive() const;                                          // of this farm, daemons and solvers
  int solvers_alive() const;                                            // solver children of this farm's workers

  // The end of every test: all jobs are DONE exactly once, the counters equal a recount, the ledger agrees with the shards, no solver is
  // left.
  void check_all_done(int expected);

 private:
  std::filesystem::path next_log(const std::string& name);
  TempFarm temp_;
  int logs_ = 0;
};

}  // namespace fracfarm::bench
