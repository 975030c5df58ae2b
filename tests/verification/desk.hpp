// What a case has besides its result: a progress line, and a folder's worth of pictures.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/base/clock.hpp"
#include "common/base/terminal.hpp"
#include "common/picture/canvas.hpp"

namespace fracfarm::verification {

struct Picture {
  std::string name;     // of the file, without folder and ending
  std::string caption;  // one sentence
  picture::Canvas canvas;
};

class Desk {
 public:
  explicit Desk(std::string_view id) : id_(id) {}

  // What is being done and how much of the case is done, 0 ... 1. Cheap enough to be called every few steps.
  void progress(std::string_view what, double share);
  // From now on, shares are of this part of the case, which begins at `begin`.
  void part(double begin, double length) { begin_ = begin, length_ = length; }
  void add(Picture picture) { pictures_.push_back(std::move(picture)); }
  const std::vector<Picture>& pictures() const { return pictures_; }

 private:
  std::string id_;
  std::vector<Picture> pictures_;
  SystemClock clock_;
  double start_s_ = clock_.monotonic_s(), last_s_ = start_s_;
  double begin_ = 0.0, length_ = 1.0;
  ProgressLine line_;
};

}  // namespace fracfarm::verification
