#include "common/record/chunk_codec.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <cassert>
#include <cstring>
#include <memory>

namespace fracfarm {
namespace {

using Compressor = std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)>;
using Decompressor = std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)>;

constexpr std::size_t checksum_size = 4;

// Byte k of every element, then byte k+1: H5Zshuffle. Word is the element; one pass over whole words is thrice as fast as one over each
// byte.
template <class Word>
void shuffle(std::string_view raw, char* out) {
  const std::size_t count = raw.size() / sizeof(Word);
  for (std::size_t i = 0; i < count; ++i) {
    Word word;
    std::memcpy(&word, raw.data() + i * sizeof word, sizeof word);
    for (std::size_t k = 0; k < sizeof word; ++k) out[k * count + i] = static_cast<char>(word >> (8 * k) & 0xff);
  }
}

template <class Word>
void unshuffle(std::string_view shuffled, char* out) {
  const std::size_t count = shuffled.size() / sizeof(Word);
  for (std::size_t i = 0; i < count; ++i) {
    Word word = 0;
    for (std::size_t k = 0; k < sizeof word; ++k) word |= static_cast<Word>(static_cast<unsigned char>(shuffled[k * count + i])) << (8 * k);
    std::memcpy(out + i * sizeof word, &word, sizeof word);
  }
}

libdeflate_compressor* compressor(int level) {
  thread_local Compressor kept{nullptr, &libdeflate_free_compressor};
  thread_local int kept_level = 0;
  if (!kept || kept_level != level) kept.reset(libdeflate_alloc_compressor(kept_level = level));
  return kept.get();
}

libdeflate_decompressor* decompressor() {
  thread_local Decompressor kept{libdeflate_alloc_decompressor(), &libdeflate_free_decompressor};
  return kept.get();
}

void put_little_endian(std::uint32_t value, char* out) {
  for (std::size_t k = 0; k < checksum_size; ++k) out[k] = static_cast<char>(value >> (8 * k) & 0xff);
}

}  // namespace

std::uint32_t fletcher32(std::string_view bytes) {
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  std::uint32_t sum1 = 0, sum2 = 0;
  const auto fold = [](std::uint32_t sum) { return (sum & 0xffffu) + (sum >> 16); };
  for (std::size_t words = bytes.size() / 2; words;) {
    std::size_t block = std::min<std::size_t>(words, 360);  // as many as cannot overflow
    words -= block;
    for (; block; --block, data += 2) sum2 += sum1 += static_cast<std::uint32_t>(data[0] << 8 | data[1]);
    sum1 = fold(sum1);
    sum2 = fold(sum2);
  }
  if (bytes.size() % 2) {
    sum2 += sum1 += static_cast<std::uint32_t>(*data << 8);
    sum1 = fold(sum1);
    sum2 = fold(sum2);
  }
  return fold(sum2) << 16 | fold(sum1);
}

std::string encode_chunk(std::string_view raw, std::size_t element_size, int level) {
  assert(element_size == 1 || element_size == 4 || element_size == 8);
  std::string shuffled(element_size > 1 ? raw.size() : 0, '\0');
  if (element_size == 4) shuffle<std::uint32_t>(raw, shuffled.data());
  if (element_size == 8) shuffle<std::uint64_t>(raw, shuffled.data());
  const std::string_view input = element_size > 1 ? std::string_view(shuffled) : raw;
  std::string stored(libdeflate_zlib_compress_bound(compressor(level), input.size()) + checksum_size, '\0');
  const std::size_t packed =
      libdeflate_zlib_compress(compressor(level), input.data(), input.size(), stored.data(), stored.size() - checksum_size);
  put_little_endian(fletcher32({stored.data(), packed}), stored.data() + packed);
  stored.resize(packed + checksum_size);
  return stored;
}

std::string_view decode_chunk(std::string_view stored, std::size_t element_size, std::string& raw) {
  if (stored.size() < checksum_size) return "too short for a checksum";
  const std::string_view packed = stored.substr(0, stored.size() - checksum_size);
  char checksum[checksum_size];
  put_little_endian(fletcher32(packed), checksum);
  if (stored.substr(packed.size()) != std::string_view(checksum, checksum_size)) return "the fletcher32 checksum differs";
  std::string shuffled(element_size > 1 ? raw.size() : 0, '\0');
  std::string& output = element_size > 1 ? shuffled : raw;
  // With no place for the actual size, libdeflate demands exactly the size that is expected.
  if (libdeflate_zlib_decompress(decompressor(), packed.data(), packed.size(), output.data(), output.size(), nullptr) != LIBDEFLATE_SUCCESS)
    return "does not inflate to the size of a chunk";
  if (element_size == 4) unshuffle<std::uint32_t>(shuffled, raw.data());
  if (element_size == 8) unshuffle<std::uint64_t>(shuffled, raw.data());
  return {};
}

}  // namespace fracfarm
