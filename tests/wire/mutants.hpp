// Bytes that no peer of ours would send: noise, and real messages with damage.
#pragma once

#include <string>
#include <vector>

#include "common/base/random.hpp"

namespace fracfarm::wire::test {

inline std::string noise(RandomStream& random) {
  std::string bytes(static_cast<std::size_t>(random.integer(0, 300)), '\0');
  for (char& c : bytes) c = static_cast<char>(random.integer(0, 255));
  return bytes;
}

inline std::string mutated(std::string bytes, RandomStream& random) {
  for (int edits = random.integer(1, 4); edits > 0 && !bytes.empty(); --edits) {
    const auto at = static_cast<std::size_t>(random.integer(0, static_cast<int>(bytes.size()) - 1));
    switch (random.integer(0, 4)) {
      case 0:
        bytes[at] = static_cast<char>(random.integer(0, 255));
        break;
      case 1:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.integer(0, 7)));
        break;
      case 2:
        bytes.resize(at);
        break;
      case 3:
        bytes.insert(at, bytes.substr(at / 2, 16));
        break;
      default:
        bytes.erase(at, 8);
        break;
    }
  }
  return bytes;
}

// One of ten is noise.
inline std::string any_bytes(const std::vector<std::string>& seeds, RandomStream& random) {
  const auto seed = static_cast<std::size_t>(random.integer(0, static_cast<int>(seeds.size()) - 1));
  return random.integer(0, 9) == 0 ? noise(random) : mutated(seeds[seed], random);
}

}  // namespace fracfarm::wire::test
