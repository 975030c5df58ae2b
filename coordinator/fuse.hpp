// The fuse of a class of jobs: blows when too many of its latest attempts failed for reasons of the jobs themselves, so that a mistake in a
// campaign does not burn a night of a machine. A person looks, mends and resumes.
#pragma once

#include <bitset>
#include <cstddef>

namespace fracfarm {

inline constexpr std::size_t fuse_window = 1000;     // latest attempts of a class
inline constexpr std::size_t fuse_most_failed = 50;  // of them; one more and it blows (5 %)

class Fuse {
 public:
  // True where this attempt blows it; it then begins anew.
  bool blows(bool failed) {
    if (seen_ == fuse_window)
      failed_ -= window_[at_];
    else
      ++seen_;
    window_[at_] = failed;
    failed_ += failed;
    at_ = (at_ + 1) % fuse_window;
    if (failed_ <= fuse_most_failed) return false;
    last_seen_ = seen_;
    window_.reset();
    at_ = seen_ = failed_ = 0;
    return true;
  }
  std::size_t last_seen() const { return last_seen_; }  // attempts in the window when it blew

 private:
  std::bitset<fuse_window> window_;
  std::size_t at_ = 0, seen_ = 0, failed_ = 0, last_seen_ = 0;
};

}  // namespace fracfarm
