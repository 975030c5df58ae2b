// The coordinator as a server: sockets, timers and group commit around the reactor. Everything that waits, up to 256 messages or 20 ms, is
// answered in one transaction; it is committed, and only then are the replies sent.
#pragma once

#include <atomic>
#include <filesystem>
#include <string>

#include "common/base/exit_code.hpp"
#include "coordinator/log.hpp"

namespace fracfarm {

struct ServeOptions {
  std::filesystem::path farm;
  std::string bind = "tcp://127.0.0.1:*";
  bool until_done = false;  // end when nothing is left and every worker has said BYE
  double lease_timeout_s = 30.0;
  double lock_patience_s = 5.0;    // a verb may hold the ledger for a moment
  double audit_fraction = 0.001;   // of results, computed again on another node and compared
  double backup_every_s = 3600.0;  // 0: never
  std::string notify = {};         // a command that is run for what somebody should know of
  std::string advertise = {};      // host that others reach it by where it listens on every interface; empty: this host's name
};

// Serves until `stop`, or until nothing is left where it was asked to. Every failure of the ledger ends it: a lost fsync is never tried
// again.
ExitCode serve(const ServeOptions& options, const std::atomic<bool>& stop, CoordinatorLog& log);

}  // namespace fracfarm
