// Counter-based random numbers: Philox4x32-10 (Salmon et al., 2011). A stream is a key and a role; draws never depend on other streams.
#pragma once

#include <array>
#include <cstdint>

namespace fracfarm {

class RandomStream {
 public:
  // key: (seed, id); role: which quantity is drawn, so that adding a draw to one role moves no other.
  RandomStream(std::uint64_t seed, std::uint64_t id, std::uint32_t role);

  std::uint64_t bits();                     // 64 uniform bits
  double uniform();                         // [0, 1): the top 53 bits times 2^-53
  double uniform(double low, double high);  // [low, high)
  int integer(int low, int high);           // low...high inclusive, unbiased (rejection)

 private:
  void refill();

  std::array<std::uint32_t, 2> key_;
  std::array<std::uint32_t, 4> counter_;
  std::array<std::uint32_t, 4> block_{};
  unsigned used_ = 4;  // 32-bit words of block_ already given out
};

}  // namespace fracfarm
