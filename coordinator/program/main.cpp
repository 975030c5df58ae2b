// fracfarm-coordinator: options, signals, and the one place where a failing ledger ends the program.
#include <fmt/format.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <filesystem>

#include "common/base/build_info.hpp"
#include "coordinator/ledger_sqlite.hpp"
#include "coordinator/serve.hpp"

namespace {

std::atomic<bool> stop_asked{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void on_signal(int) { stop_asked = true; }

void catch_signals() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  ::sigaction(SIGTERM, &action, nullptr);
  ::sigaction(SIGINT, &action, nullptr);
  ::signal(SIGPIPE, SIG_IGN);
}

// As many as this machine allows: every worker has a connection, and so has whoever knocks at the door.
void raise_file_limit() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  (void)::setrlimit(RLIMIT_NOFILE, &limit);
}

}  // namespace

int main(int argc, char** argv) {
  using namespace fracfarm;
  ServeOptions options{"farm"};
  bool quiet = false, version = false;
  CLI::App app{
      "Keeps the ledger of a farm: hands jobs to workers, takes their results, answers questions.\n"
      "SIGTERM and SIGINT finish what is under way and end; killed at any moment it loses nothing: start it again.",
      "fracfarm coordinator"};
  app.add_option("--farm", options.farm, "folder of the farm; its folder 'ledger' must be on a local disk, or a link to one")
      ->capture_default_str();
  app.add_option("--bind", options.bind, "where to listen; port * is any; tcp://0.0.0.0:* lets other nodes in")->capture_default_str();
  app.add_option("--advertise", options.advertise,
                 "host name that other nodes reach it by, with --bind tcp://0.0.0.0:*; default: this host's");
  app.add_option("--lease-timeout", options.lease_timeout_s, "seconds without a beat after which a job goes to another worker")
      ->check(CLI::Range(0.5, 86400.0))
      ->capture_default_str();
  app.add_option("--audit", options.audit_fraction, "share of the results that another node computes again, to compare")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  double backup_minutes = options.backup_every_s / 60.0;
  app.add_option("--backup-every", backup_minutes, "minutes between copies of the ledger in FARM/backups; 0: none")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
  app.add_option(
      "--notify", options.notify,
      "command that is run, with JSON on its standard input, when a job is quarantined, a class is paused, an alarm is raised, a node "
      "is suspect, or nothing is left");
  app.add_flag("--until-done", options.until_done, "end when nothing is left to do");
  app.add_flag("--quiet", quiet, "only warnings and errors on stderr");
  app.add_flag("--version", version, "print the version and end");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& mistake) {
    return app.exit(mistake) == 0 ? exit_ok : exit_bad_input;
  }
  if (version) return fmt::print("fracfarm-coordinator {}\n", build_info().build_id), exit_ok;
  catch_signals();
  raise_file_limit();
  options.backup_every_s = 60.0 * backup_minutes;
  options.farm = std::filesystem::absolute(options.farm).lexically_normal();
  std::error_code error;
  std::filesystem::create_directories(options.farm / "log", error);
  CoordinatorLog log(options.farm / "log", quiet);
  try {
    return serve(options, stop_asked, log);
  } catch (const LedgerError& failure) {
    log.say(CoordinatorLog::Level::error,
            fmt::format("{}; nothing more is handed out; mend the cause (disk full, broken disk) and start again", failure.what()));
    return exit_failed;
  }
}
