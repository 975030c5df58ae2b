// libFuzzer target (option FRACFARM_FUZZ, clang): any bytes as a request and as a reply. What is accepted must encode to bytes that are
// accepted and encode to the same again, and what our reader of MessagePack passes another one reads.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "common/wire/codec.hpp"
#include "common/wire/fields.hpp"
#include "common/wire/msgpack.hpp"

namespace {

template <class Decode>
void stable(std::string_view bytes, Decode decode) {
  const auto first = decode(bytes);
  if (!first) return;
  const std::string again = fracfarm::wire::encode(*first);
  const auto second = decode(again);
  if (!second || fracfarm::wire::encode(*second) != again) std::abort();
}

// What our reader finds well formed, another hand's reader reads.
void same_shape(std::string_view bytes) {
  const bool ours = fracfarm::wire::msgpack::well_formed(bytes, fracfarm::wire::max_depth, fracfarm::wire::max_values);
  if (ours != (fracfarm::wire::trace(bytes) != "not MessagePack")) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  stable(bytes, [](std::string_view it) { return fracfarm::wire::decode_request(it); });
  stable(bytes, [](std::string_view it) { return fracfarm::wire::decode_reply(it); });
  same_shape(bytes);
  return 0;
}
