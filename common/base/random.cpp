#include "common/base/random.hpp"

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wconversion"
#endif
#include <Random123/philox.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

#include <cassert>

namespace fracfarm {

// The 64-bit seed is Philox's key; id and role fill the counter's upper words, the block number its lowest.
RandomStream::RandomStream(std::uint64_t seed, std::uint64_t id, std::uint32_t role)
    : key_{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)},
      counter_{0, role, static_cast<std::uint32_t>(id), static_cast<std::uint32_t>(id >> 32)} {}

void RandomStream::refill() {
  const r123::Philox4x32::ctr_type counter{{counter_[0], counter_[1], counter_[2], counter_[3]}};
  const r123::Philox4x32::key_type key{{key_[0], key_[1]}};
  const auto block = r123::Philox4x32{}(counter, key);
  for (unsigned word = 0; word < 4; ++word) block_[word] = block[word];
  ++counter_[0];
  assert(counter_[0] != 0 && "stream exhausted");
  used_ = 0;
}

std::uint64_t RandomStream::bits() {
  if (used_ >= 4) refill();
  const std::uint64_t low = block_[used_];
  const std::uint64_t high = block_[used_ + 1];
  used_ += 2;
  return high << 32 | low;
}

double RandomStream::uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }

double RandomStream::uniform(double low, double high) { return low + (high - low) * uniform(); }

int RandomStream::integer(int low, int high) {
  assert(low <= high);
  const std::uint64_t span = static_cast<std::uint64_t>(high - low) + 1;
  const std::uint64_t limit = UINT64_MAX - UINT64_MAX % span;
  std::uint64_t draw = bits();
  while (draw >= limit) draw = bits();
  return low + static_cast<int>(draw % span);
}

}  // namespace fracfarm
