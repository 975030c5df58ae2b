// The door to time: everything that decides by time is given a Clock, so that tests and simulation replace it.
#pragma once

#include <string>

namespace fracfarm {

class Clock {
 public:
  virtual ~Clock() = default;
  virtual double monotonic_s() = 0;  // never goes back; for deadlines
  virtual double wall_s() = 0;       // seconds since 1970 UTC; for people only
};

class SystemClock final : public Clock {
 public:
  double monotonic_s() override;
  double wall_s() override;
};

double thread_cpu_s();   // CPU seconds of the calling thread
double process_cpu_s();  // CPU seconds of this process

std::string utc_text(double wall_s);  // 2026-01-31T12:00:00Z

}  // namespace fracfarm
