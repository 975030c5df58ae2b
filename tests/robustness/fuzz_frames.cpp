// libFuzzer target (option FRACFARM_FUZZ, clang): any bytes as a request and as a reply. What is accepted must encode to bytes that are
// accepted and encode to the same again.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "common/wire/codec.hpp"

namespace {

template <class Decode>
void stable(std::string_view bytes, Decode decode) {
  const auto first = decode(bytes);
  if (!first) return;
  const std::string again = fracfarm::wire::encode(*first);
  const auto second = decode(again);
  if (!second || fracfarm::wire::encode(*second) != again) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  stable(bytes, [](std::string_view it) { return fracfarm::wire::decode_request(it); });
  stable(bytes, [](std::string_view it) { return fracfarm::wire::decode_reply(it); });
  (void)fracfarm::wire::trace(bytes);
  return 0;
}
