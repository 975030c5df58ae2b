// What will happen when: simulated time, in one thread. Things due at the same instant happen in the order in which they were asked for.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <utility>

namespace fracfarm::simulation {

class Agenda {
 public:
  double now() const { return now_; }
  void after(double seconds, std::function<void()> what) { things_.emplace(std::pair{now_ + seconds, ++asked_}, std::move(what)); }
  // Goes to the next thing and does it; false where nothing is left.
  bool next() {
    if (things_.empty()) return false;
    auto thing = things_.extract(things_.begin());
    now_ = thing.key().first;
    thing.mapped()();
    return true;
  }

 private:
  double now_ = 0.0;  // s
  std::uint64_t asked_ = 0;
  std::map<std::pair<double, std::uint64_t>, std::function<void()>> things_;
};

}  // namespace fracfarm::simulation
