// The worker daemon: carries events from signals, the link, the slots and the keeper to the session, and does what it says. Decides
// nothing.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/clock.hpp"
#include "worker/identity.hpp"
#include "worker/keeper.hpp"
#include "worker/link.hpp"
#include "worker/log.hpp"
#include "worker/session.hpp"
#include "worker/slot.hpp"

namespace fracfarm::worker {

struct DaemonOptions {
  std::filesystem::path farm;
  std::filesystem::path scratch;  // empty: FARM/scratch/<name>
  std::string node;               // empty: the host's name
  int slots = 1;
  SlotOptions slot;
  std::optional<double> remaining_s;  // of the allocation
  bool once = false;
  bool quiet = false;
};

// Runs until it is told to end; gives an ExitCode.
int run_daemon(const DaemonOptions& options);

class Daemon {
 public:
  // The caller keeps `identity`, whose key is `own`. Blocks SIGTERM, SIGINT, SIGUSR1 and SIGCHLD in this thread and those it starts.
  Daemon(DaemonOptions options, const Identity& identity, wire::KeyPair own);
  ~Daemon();
  int run();

 private:
  struct Run {  // what a slot is at
    JobId job = 0;
    wire::Assignment assignment;
    long long step = -1;  // as it last reported
  };
  struct Place {
    Slot slot;
    std::optional<Run> run;
  };

  Result<std::string> solver_build();
  SessionOptions session_options(const std::string& build_id, std::vector<wire::Completion> unacknowledged);
  void wait();
  void hear_signals();
  void hear_slots();
  void hear_slot(Place& place, const SlotEvent& event);
  void hear_progress(Run& run, long long step);
  void hear_keeper();
  void feed(const Event& event);
  void act(const Action& action);
  void start(const StartJob& start);
  void finished(Run run, const Summary& summary);
  Place* place_of(JobId job);
  std::filesystem::path record_path(const std::string& key) const { return options_.scratch / (key + ".h5"); }
  std::filesystem::path checkpoint_path(const std::string& key) const { return options_.farm / "checkpoints" / (key + ".ckpt"); }

  DaemonOptions options_;
  std::string name_, instance_;
  SystemClock clock_;
  Log log_;
  int signals_ = -1;
  Link link_;
  std::vector<Place> places_;
  std::unique_ptr<Keeper> keeper_;
  std::optional<Session> session_;
  std::optional<ExitCode> status_;
  std::string told_trouble_;  // the last reason for no connection that was logged
};

}  // namespace fracfarm::worker
