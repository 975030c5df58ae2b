#include "worker/daemon.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/host.hpp"
#include "common/base/terminal.hpp"
#include "common/base/text.hpp"
#include "worker/judge.hpp"

namespace fracfarm::worker {
namespace {

namespace fs = std::filesystem;

int open_signals() {
  sigset_t set;
  ::sigemptyset(&set);
  for (const int number : {SIGTERM, SIGINT, SIGUSR1, SIGCHLD}) ::sigaddset(&set, number);
  ::sigprocmask(SIG_BLOCK, &set, nullptr);
  ::signal(SIGPIPE, SIG_IGN);
  return ::signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK);
}

// Records that an earlier run had not kept: their jobs are solved again, or went on elsewhere.
void clear_records(const fs::path& scratch) {
  std::error_code error;
  for (fs::directory_iterator entry(scratch, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename();
    std::error_code ignored;
    if (name.ends_with(".h5") || name.ends_with(".h5.part")) fs::remove(entry->path(), ignored);
  }
}

Result<void> make_folders(const std::vector<fs::path>& folders) {
  for (const fs::path& folder : folders) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) return fail(Fault::node_lost, fmt::format("cannot make {}: {}", folder.string(), error.message()));
  }
  return {};
}

std::string outcome_text(const Summary& summary) {
  const std::string time = summary.time_to_failure ? " at " + engineering(*summary.time_to_failure, "s") : "";
  return fmt::format("{}{} ({}) in {}", name_of(summary.verdict), time, summary.failure_rule, duration_text(summary.wall_s));
}

}  // namespace

int run_daemon(const DaemonOptions& given) {
  DaemonOptions options = given;
  const auto complain = [](const Error& error) {
    fmt::print(stderr, "{} {} ({})\n", ink("error:", Ink::red, stderr), error.message, fault_row(error.fault).name);
    return static_cast<int>(error.fault == Fault::bad_request ? exit_bad_input : exit_failed);
  };
  if (options.node.empty()) options.node = host_name();
  const auto identity = Identity::claim(options.farm, options.node, SystemClock().wall_s());
  if (!identity) return complain(identity.error());
  const auto own = wire::load_or_make_key(options.farm, identity->name());
  if (!own) return complain(own.error());
  if (options.scratch.empty()) options.scratch = options.farm / "scratch" / identity->name();
  if (auto made = make_folders({options.scratch, options.farm / "checkpoints", options.farm / "log"}); !made) return complain(made.error());
  Daemon daemon(options, *identity, *own);
  return daemon.run();
}

Daemon::Daemon(DaemonOptions options, const Identity& identity, wire::KeyPair own)
    : options_(std::move(options)),
      name_(identity.name()),
      instance_(identity.instance()),
      log_(options_.farm, name_, options_.quiet),
      signals_(open_signals()),
      link_(options_.farm, std::move(own), clock_) {
  for (int i = 0; i < options_.slots; ++i) places_.push_back({Slot(options_.slot, clock_), std::nullopt});
}

Daemon::~Daemon() {
  if (signals_ >= 0) ::close(signals_);
}

int Daemon::run() {
  clear_records(options_.scratch);
  std::string warning;
  Outbox outbox = Outbox::open(options_.scratch / "outbox", warning);
  if (!warning.empty()) log_.say(Say::Level::warning, warning);
  const auto build = solver_build();
  if (!build) {
    log_.say(Say::Level::error, build.error().message);
    return exit_failed;
  }
  session_.emplace(session_options(*build, outbox.completions()));
  keeper_ = std::make_unique<Keeper>(KeeperOptions{options_.farm, name_, judge_record}, std::move(outbox), clock_);
  log_.say(Say::Level::info, fmt::format("{} slots, solver build {}", options_.slots, *build));
  while (!status_) {
    feed(Tick{});
    if (status_) break;
    wait();
    hear_signals();
    for (const Event& event : link_.hear()) feed(event);
    hear_slots();
    hear_keeper();
  }
  log_.say(Say::Level::info, fmt::format("ends with status {}", static_cast<int>(*status_)));
  return *status_;
}

// The first slot's child says which build it is; it stays for the first job.
Result<std::string> Daemon::solver_build() {
  Slot& slot = places_.front().slot;
  slot.warm_up();
  for (;;) {
    for (const SlotEvent& event : slot.step()) {
      if (const auto* ready = std::get_if<SlotReady>(&event)) return ready->build_id;
      if (const auto* failed = std::get_if<SlotFailed>(&event)) return fail(failed->fault, failed->message);
    }
    wait();
  }
}

SessionOptions Daemon::session_options(const std::string& build_id, std::vector<wire::Completion> unacknowledged) {
  SessionOptions session;
  session.node = options_.node;
  session.instance = instance_;
  session.build_id = build_id;
  session.slots = options_.slots;
  session.memory_bytes = static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  session.once = options_.once;
  if (options_.remaining_s) session.end_at = clock_.monotonic_s() + *options_.remaining_s;
  session.unacknowledged = std::move(unacknowledged);
  return session;
}

// Sleeps until something can be read or the next deadline of anybody.
void Daemon::wait() {
  std::vector<pollfd> all{{signals_, POLLIN, 0}};
  if (keeper_) all.push_back({keeper_->descriptor(), POLLIN, 0});
  if (link_.descriptor() >= 0) all.push_back({link_.descriptor(), POLLIN, 0});
  const double now = clock_.monotonic_s();
  double until = std::min(now + 0.25, link_.next_try());  // the link looks for a moved coordinator that often
  if (session_) until = std::min(until, session_->next_tick(now));
  for (const Place& place : places_) {
    for (const int fd : place.slot.descriptors()) all.push_back({fd, POLLIN, 0});
    if (const auto fd = place.slot.write_descriptor()) all.push_back({*fd, POLLOUT, 0});
    until = std::min(until, place.slot.next_deadline());
  }
  const int milliseconds = static_cast<int>(std::clamp(std::ceil((until - now) * 1e3), 0.0, 1000.0));
  ::poll(all.data(), all.size(), milliseconds);
}

void Daemon::hear_signals() {
  signalfd_siginfo info{};
  while (::read(signals_, &info, sizeof info) == sizeof info) {
    const int number = static_cast<int>(info.ssi_signo);
    if (number == SIGUSR1) {
      log_.say(Say::Level::info, "draining: finishing what runs, taking no more");
      feed(DrainAsked{});
    } else if (number == SIGTERM || number == SIGINT) {
      log_.say(Say::Level::info, "stopping: checkpointing what runs");
      feed(TerminateAsked{});
    }
  }
}

void Daemon::hear_slots() {
  for (Place& place : places_)
    for (const SlotEvent& event : place.slot.step()) hear_slot(place, event);
  if (link_.trouble() != told_trouble_ && !(told_trouble_ = link_.trouble()).empty()) log_.say(Say::Level::warning, told_trouble_);
}

void Daemon::hear_slot(Place& place, const SlotEvent& event) {
  if (!place.run) return;
  if (const auto* progress = std::get_if<SlotProgress>(&event)) return hear_progress(*place.run, progress->step);
  if (std::holds_alternative<SlotReady>(event)) return;
  const Run run = *std::exchange(place.run, std::nullopt);
  if (const auto* solved = std::get_if<SlotSolved>(&event)) return finished(run, solved->summary);
  if (const auto* failed = std::get_if<SlotFailed>(&event)) {
    log_.job(run.assignment.job, "fault", fmt::format("{}: {}", fault_row(failed->fault).name, failed->message));
    return feed(JobFailed{run.job, failed->fault, failed->message, failed->signature});
  }
  log_.job(run.assignment.job, "stopped", fmt::format("at step {}", run.step));
  feed(JobStopped{run.job});
}

void Daemon::hear_progress(Run& run, long long step) {
  if (run.step < 0) log_.job(run.assignment.job, "progress", fmt::format("at step {}", step));
  run.step = step;
  feed(JobProgress{run.job, step});
}

void Daemon::finished(Run run, const Summary& summary) {
  log_.job(run.assignment.job, "solved", outcome_text(summary));
  const JobId job = run.job;
  const std::string key = run.assignment.key;
  keeper_->give({job, std::move(run.assignment), summary, record_path(key), checkpoint_path(key)});
  feed(JobSolved{job, summary.wall_s});
}

void Daemon::hear_keeper() {
  for (const auto& outcome : keeper_->take()) {
    if (const auto* failed = std::get_if<JobFailed>(&outcome)) {
      log_.say(Say::Level::warning, fmt::format("a record was not kept: {}", failed->message));
      feed(*failed);
    } else {
      feed(std::get<JobKept>(outcome));
    }
  }
}

void Daemon::feed(const Event& event) {
  if (status_) return;
  for (const Action& action : session_->step(event, clock_.monotonic_s())) act(action);
}

void Daemon::act(const Action& action) {
  if (const auto* post = std::get_if<Post>(&action)) link_.post(post->request);
  if (const auto* job = std::get_if<StartJob>(&action)) start(*job);
  if (const auto* stop = std::get_if<StopJob>(&action))
    if (Place* place = place_of(stop->job)) place->slot.stop();
  if (const auto* abandon = std::get_if<AbandonJob>(&action))
    if (Place* place = place_of(abandon->job)) place->slot.abandon();
  if (const auto* acknowledged = std::get_if<Acknowledged>(&action)) keeper_->acknowledge(acknowledged->keys);
  if (const auto* finish = std::get_if<Finish>(&action)) status_ = finish->status;
  if (const auto* words = std::get_if<Say>(&action)) log_.say(words->level, words->text);
}

// The session starts no more jobs than there are slots.
void Daemon::start(const StartJob& job) {
  const auto place = std::find_if(places_.begin(), places_.end(), [](const Place& p) { return !p.run && !p.slot.busy(); });
  if (place == places_.end()) return feed(JobFailed{job.job, Fault::node_lost, "no slot is free", "no slot"});
  const wire::Assignment& a = job.assignment;
  log_.job(a.job, "started", fmt::format("attempt {} lease {}.{}", a.attempt, a.lease.epoch, a.lease.counter));
  std::error_code ignored;
  fs::remove(record_path(a.key), ignored);
  place->run = Run{job.job, a, -1};
  place->slot.start({a.key, a.scene, record_path(a.key), checkpoint_path(a.key), a.wall_budget_s, a.attempt, a.step_scale});
}

Daemon::Place* Daemon::place_of(JobId job) {
  const auto place = std::find_if(places_.begin(), places_.end(), [&](const Place& p) { return p.run && p.run->job == job; });
  return place == places_.end() ? nullptr : &*place;
}

}  // namespace fracfarm::worker
