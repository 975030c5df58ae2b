#include "common/record/seal.hpp"

#include <fmt/format.h>

#include "common/base/hash.hpp"

namespace fracfarm {

std::string seal_of(std::string_view body) {
  return fmt::format("\nfracfarm.seal/1 bytes={:<20} xxh3={:<32}\n", body.size(), xxh3_hex(body));
}

std::string broken_seal(std::string_view file) {
  if (file.size() < seal_size) return fmt::format("{} bytes is too short for a record", file.size());
  const std::string_view body = file.substr(0, file.size() - seal_size), seal = file.substr(body.size());
  if (!seal.starts_with("\nfracfarm.seal/1 ")) return "there is no seal at the end: the file is cut off or was never finished";
  if (seal != seal_of(body)) return "the seal does not fit the bytes before it: the file was changed after it was written";
  return {};
}

}  // namespace fracfarm
