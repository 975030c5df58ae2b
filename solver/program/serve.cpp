#include "solver/program/serve.hpp"

#include <poll.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <optional>
#include <string>

#include "common/base/build_info.hpp"
#include "common/base/clock.hpp"
#include "common/base/exit_code.hpp"
#include "common/base/kept_memory.hpp"
#include "common/scene/parse.hpp"
#include "solver/program/run_task.hpp"
#include "solver/program/signals.hpp"

namespace fracfarm {
namespace {

constexpr std::size_t line_limit = std::size_t{64} << 20;
constexpr double report_interval_s = 1.0;

// Lines of standard input; waiting ends with the stop signal too.
class TaskLines {
 public:
  // Nothing at the end of input, at a stop, and where a line never ends.
  std::optional<std::string> next() {
    for (;;) {
      if (stop_requested()) return std::nullopt;
      if (const std::size_t end = buffer_.find('\n'); end != std::string::npos) {
        std::string line = buffer_.substr(0, end);
        buffer_.erase(0, end + 1);
        return line;
      }
      if (buffer_.size() > line_limit || !fill()) return std::nullopt;
    }
  }

 private:
  bool fill() {
    struct pollfd waits[] = {{STDIN_FILENO, POLLIN, 0}, {stop_descriptor(), POLLIN, 0}};
    if (::poll(waits, 2, -1) < 0) return errno == EINTR;
    if (waits[1].revents != 0) return false;
    char bytes[1 << 16];
    const ssize_t got = ::read(STDIN_FILENO, bytes, sizeof bytes);
    if (got < 0) return errno == EINTR || errno == EAGAIN;
    buffer_.append(bytes, static_cast<std::size_t>(got));
    return got > 0;
  }

  std::string buffer_;
};

bool say(const Report& report) {
  std::string_view line;
  const std::string text = to_line(report);
  for (line = text; !line.empty();) {
    const ssize_t wrote = ::write(STDOUT_FILENO, line.data(), line.size());
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote < 0) return false;
    line.remove_prefix(static_cast<std::size_t>(wrote));
  }
  return true;
}

Report fault_report(const std::string& key, Error error) {
  Report report;
  report.kind = Report::Kind::fault;
  report.key = key;
  report.error = std::move(error);
  return report;
}

Report answer(const Task& task) {
  const Parsed<Scene> scene = parse_scene(task.scene);
  if (!scene) return fault_report(task.key, {Fault::bad_request, problems_text(scene.error())});
  SystemClock clock;
  double last_s = clock.monotonic_s();
  const auto progress = [&](long long step, double time, double horizon) {
    if (clock.monotonic_s() - last_s < report_interval_s) return;
    last_s = clock.monotonic_s();
    Report report;
    report.kind = Report::Kind::progress;
    report.key = task.key;
    report.step = step, report.time = time, report.horizon = horizon;
    say(report);
  };
  Result<TaskEnd> end = run_task(task, *scene, Keeping::scratch, progress);
  if (!end) return fault_report(task.key, end.error());
  Report report;
  report.kind = end->stopped ? Report::Kind::stopped : Report::Kind::done;
  report.key = task.key;
  report.summary = std::move(end->summary);
  return report;
}

}  // namespace

int serve() {
  keep_freed_memory();
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  Report ready;
  ready.build_id = build_info().build_id;
  if (!say(ready)) return exit_failed;
  TaskLines lines;
  while (const std::optional<std::string> line = lines.next()) {
    const Result<Task> task = task_from_line(*line);
    const Report report = task ? answer(*task) : fault_report({}, task.error());
    if (!say(report)) return exit_failed;
    if (report.kind == Report::Kind::stopped) break;
  }
  return exit_ok;
}

}  // namespace fracfarm
