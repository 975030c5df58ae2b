#include "worker/slot.hpp"

#include <fmt/format.h>
#include <signal.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace fracfarm::worker {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

}  // namespace

Slot::Slot(SlotOptions options, Clock& clock) : options_(std::move(options)), clock_(clock) {}

bool Slot::ensure_child() {
  if (child_) return true;
  auto child = Child::spawn({options_.solver, options_.arguments, options_.memory_limit});
  if (!child) {
    task_.reset();
    give(SlotFailed{child.error().fault, child.error().message, "cannot run"});
    return false;
  }
  child_.emplace(std::move(*child));
  ready_ = stopping_ = stop_reported_ = false;
  killed_ = stop_reason_ = Killed::no;
  heard_at_ = clock_.monotonic_s();
  memory_kills_before_ = memory_kills();
  return true;
}

void Slot::warm_up() { ensure_child(); }

void Slot::start(Task task) {
  task_ = std::move(task);
  if (!ensure_child()) return;
  started_at_ = heard_at_ = clock_.monotonic_s();
  child_->forget_last_words();
  child_->limit_cpu(task_->wall_budget_s + options_.budget_grace_s + options_.stop_grace_s);
  child_->write(to_line(*task_));  // where it reads no more, its end is seen by step()
}

void Slot::stop() {
  if (!child_ || stopping_) return;
  stopping_ = true;
  stop_reason_ = Killed::grace;
  kill_at_ = clock_.monotonic_s() + options_.stop_grace_s;
  child_->signal(SIGTERM);
}

void Slot::abandon() {
  if (child_) kill(Killed::abandoned);
}

void Slot::kill(Killed why) {
  if (killed_ == Killed::no) killed_ = why;
  child_->kill_group();
}

std::vector<SlotEvent> Slot::step() {
  std::vector<SlotEvent> events = std::exchange(early_, {});
  if (!child_) return events;
  child_->flush();
  child_->read_errors();
  read_reports(events);
  if (killed_ == Killed::no) keep_deadlines();
  see_end(events);
  return events;
}

void Slot::read_reports(std::vector<SlotEvent>& events) {
  bool overlong = false;
  for (const std::string& line : child_->read_lines(overlong)) {
    auto report = report_from_line(line);
    if (killed_ != Killed::no) return;
    if (!report) return kill(Killed::unreadable);
    heard_at_ = clock_.monotonic_s();
    hear(std::move(*report), events);
  }
  if (overlong) kill(Killed::unreadable);
}

void Slot::hear(Report&& report, std::vector<SlotEvent>& events) {
  if (report.kind == Report::Kind::ready) {
    ready_ = true;
    events.push_back(SlotReady{report.build_id});
    return;
  }
  if (!task_ || (report.key != task_->key && report.kind != Report::Kind::stopped)) return kill(Killed::unreadable);
  switch (report.kind) {
    case Report::Kind::ready:
      break;
    case Report::Kind::progress:
      events.push_back(SlotProgress{report.step});
      break;
    case Report::Kind::done:
      task_.reset();
      events.push_back(SlotSolved{std::move(report.summary)});
      break;
    case Report::Kind::stopped:
      stop_reported_ = true;
      break;  // its end follows
    case Report::Kind::fault: {
      const Error error = report.error.value_or(Error{Fault::solver_crash, "a fault without a reason"});
      task_.reset();
      if (error.fault == Fault::planned_stop)
        events.push_back(SlotStopped{});
      else
        events.push_back(SlotFailed{error.fault, error.message, fmt::format("reported {}", fault_row(error.fault).name)});
      break;
    }
  }
}

void Slot::keep_deadlines() {
  const double now = clock_.monotonic_s();
  if (!ready_ && now - heard_at_ > options_.start_s) return kill(Killed::hang);
  if (stopping_) {
    if (now > kill_at_) kill(stop_reason_);
    return;
  }
  if (!task_) return;
  if (now - heard_at_ > options_.hang_s) return kill(Killed::hang);
  if (now - started_at_ > task_->wall_budget_s + options_.budget_grace_s) {
    stop();
    stop_reason_ = Killed::wall_budget;
  }
}

void Slot::see_end(std::vector<SlotEvent>& events) {
  const auto end = child_->ended();
  if (!end) return;
  child_->read_errors();
  bool overlong = false;
  for (const std::string& line : child_->read_lines(overlong))  // said just before the end
    if (auto report = report_from_line(line); report && killed_ == Killed::no) hear(std::move(*report), events);
  const bool over_budget = stop_reason_ == Killed::wall_budget;
  if (task_ && stop_reported_ && !over_budget) {
    events.push_back(SlotStopped{});
  } else if (task_ || !ready_) {
    const bool counted = memory_kills() > memory_kills_before_;
    const Killed why = over_budget ? Killed::wall_budget : stopping_ && killed_ == Killed::no ? Killed::grace : killed_;
    const Classified cause = classify({end->status, why, end->peak_rss, options_.memory_limit, counted, child_->last_words()});
    if (cause.fault == Fault::planned_stop)
      events.push_back(SlotStopped{});
    else
      events.push_back(SlotFailed{cause.fault, cause.message, cause.signature});
  }
  task_.reset();
  child_.reset();
}

std::vector<int> Slot::descriptors() const {
  std::vector<int> all;
  if (child_ && child_->output() >= 0) all.push_back(child_->output());
  if (child_ && child_->errors() >= 0) all.push_back(child_->errors());
  return all;
}

std::optional<int> Slot::write_descriptor() const {
  return child_ && child_->writing() && child_->input() >= 0 ? std::optional(child_->input()) : std::nullopt;
}

double Slot::next_deadline() const {
  if (!early_.empty()) return 0.0;
  if (!child_) return never;
  if (stopping_) return kill_at_;
  if (!ready_) return heard_at_ + options_.start_s;
  if (!task_) return never;
  return std::min(heard_at_ + options_.hang_s, started_at_ + task_->wall_budget_s + options_.budget_grace_s);
}

}  // namespace fracfarm::worker
