// Hostile frames: mutated real messages and pure noise. Nothing may throw or crash, and whatever is accepted must be stable.
#include <catch2/catch.hpp>

#include "common/base/random.hpp"
#include "common/wire/codec.hpp"
#include "tests/wire/samples.hpp"

using namespace fracfarm;
using namespace fracfarm::wire;

namespace {

std::string noise(RandomStream& random) {
  std::string bytes(static_cast<std::size_t>(random.integer(0, 300)), '\0');
  for (char& c : bytes) c = static_cast<char>(random.integer(0, 255));
  return bytes;
}

std::string mutated(std::string bytes, RandomStream& random) {
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

}  // namespace

TEST_CASE("20,000 hostile frames neither throw nor crash, and what is accepted reads back the same") {
  RandomStream random(2026, 7, 1);
  std::vector<std::string> seeds;
  for (const Request& request : sample_requests()) seeds.push_back(encode(RequestEnvelope{9, request}));
  for (const Reply& reply : sample_replies()) seeds.push_back(encode(ReplyEnvelope{9, reply}));
  int accepted = 0;
  int unstable = 0;
  for (int i = 0; i < 20'000; ++i) {
    const auto seed = static_cast<std::size_t>(random.integer(0, static_cast<int>(seeds.size()) - 1));
    const std::string bytes = random.integer(0, 9) == 0 ? noise(random) : mutated(seeds[seed], random);
    if (const auto request = decode_request(bytes)) {
      ++accepted;
      const auto again = decode_request(encode(*request));
      if (!again || encode(*again) != encode(*request)) ++unstable;
    }
    if (const auto reply = decode_reply(bytes)) {
      ++accepted;
      const auto again = decode_reply(encode(*reply));
      if (!again || encode(*again) != encode(*reply)) ++unstable;
    }
    (void)trace(bytes);
  }
  CHECK(unstable == 0);
  CHECK(accepted > 100);  // flips inside texts and numbers leave a sound message: the fuzz reaches the inner readers
  CHECK(accepted < 19'000);
}
