#include "common/base/clock.hpp"

#include <ctime>

namespace fracfarm {
namespace {

double read(clockid_t id) {
  timespec now{};
  clock_gettime(id, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

double SystemClock::monotonic_s() { return read(CLOCK_MONOTONIC); }
double SystemClock::wall_s() { return read(CLOCK_REALTIME); }
double thread_cpu_s() { return read(CLOCK_THREAD_CPUTIME_ID); }
double process_cpu_s() { return read(CLOCK_PROCESS_CPUTIME_ID); }

std::string utc_text(double wall_s) {
  const std::time_t seconds = static_cast<std::time_t>(wall_s);
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

}  // namespace fracfarm
