#include "common/record/chunk_codec.hpp"

#include <isa-l/igzip_lib.h>
#include <libdeflate.h>
#ifdef __x86_64__
#include <immintrin.h>
#endif

#include <algorithm>
#include <cassert>
#include <cstring>
#include <memory>
#include <vector>

#include "common/record/vector_paths.hpp"

namespace fracfarm {
namespace {

using Decompressor = std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)>;

constexpr std::size_t checksum_size = 4;
constexpr std::size_t block = 1024;  // elements that are shuffled while they lie in the nearest cache

// Byte k of every element, then byte k + 1: H5Zshuffle. Word is the element.
template <class Word>
[[gnu::always_inline]] inline void shuffle_words(const char* raw, std::size_t count, char* out) {
  Word words[block];
  for (std::size_t first = 0; first < count; first += block) {
    const std::size_t many = std::min(block, count - first);
    std::memcpy(words, raw + first * sizeof(Word), many * sizeof(Word));
    for (std::size_t k = 0; k < sizeof(Word); ++k)
      for (std::size_t i = 0; i < many; ++i) out[k * count + first + i] = static_cast<char>(words[i] >> (8 * k) & 0xff);
  }
}

template <class Word>
[[gnu::always_inline]] inline void unshuffle_words(const char* shuffled, std::size_t count, char* raw) {
  Word words[block];
  for (std::size_t first = 0; first < count; first += block) {
    const std::size_t many = std::min(block, count - first);
    const char* from = shuffled + first;
    for (std::size_t i = 0; i < many; ++i) {
      Word word = 0;
      for (std::size_t k = 0; k < sizeof(Word); ++k) word |= static_cast<Word>(static_cast<unsigned char>(from[k * count + i])) << (8 * k);
      words[i] = word;
    }
    std::memcpy(raw + first * sizeof(Word), words, many * sizeof(Word));
  }
}

FRACFARM_VECTOR_PATHS void shuffle(const char* raw, std::size_t bytes, std::size_t element_size, char* out) {
  if (element_size == 4) shuffle_words<std::uint32_t>(raw, bytes / 4, out);
  if (element_size == 8) shuffle_words<std::uint64_t>(raw, bytes / 8, out);
}

FRACFARM_VECTOR_PATHS void unshuffle(const char* shuffled, std::size_t bytes, std::size_t element_size, char* raw) {
  if (element_size == 4) unshuffle_words<std::uint32_t>(shuffled, bytes / 4, raw);
  if (element_size == 8) unshuffle_words<std::uint64_t>(shuffled, bytes / 8, raw);
}

// Memory of this thread that is kept from chunk to chunk: a chunk has a quarter of a megabyte.
class Kept {
 public:
  char* at_least(std::size_t size) {
    if (bytes_.size() < size) bytes_.resize(size);
    return bytes_.data();
  }

 private:
  std::vector<char> bytes_;
};
thread_local Kept kept_shuffled, kept_stored, kept_level;

// A zlib stream of at most 2 bytes a byte: no Huffman code of deflate is longer than 15 bits, and few blocks have a header.
std::size_t zlib_bound(std::size_t size) { return 2 * size + 4096; }

// ISA-L 2.30 returns with the upper halves of the vector registers in use, which makes every later SSE instruction of the thread wait: the
// rest of a record then takes three times as long.
#ifdef __x86_64__
[[gnu::target("avx")]] void clear_upper_halves() { _mm256_zeroupper(); }
bool has_upper_halves() { return __builtin_cpu_supports("avx"); }
#else
void clear_upper_halves() {}
bool has_upper_halves() { return false; }
#endif

std::size_t deflate_to(std::string_view input, char* output, std::size_t room) {
  isal_zstream stream;
  isal_deflate_stateless_init(&stream);
  stream.level = deflate_level;
  stream.level_buf = reinterpret_cast<std::uint8_t*>(kept_level.at_least(ISAL_DEF_LVL2_DEFAULT));
  stream.level_buf_size = ISAL_DEF_LVL2_DEFAULT;
  stream.gzip_flag = IGZIP_ZLIB;
  stream.end_of_stream = 1;
  stream.next_in = reinterpret_cast<std::uint8_t*>(const_cast<char*>(input.data()));
  stream.avail_in = static_cast<std::uint32_t>(input.size());
  stream.next_out = reinterpret_cast<std::uint8_t*>(output);
  stream.avail_out = static_cast<std::uint32_t>(room);
  [[maybe_unused]] const int status = isal_deflate_stateless(&stream);
  if (has_upper_halves()) clear_upper_halves();
  assert(status == COMP_OK);
  return stream.total_out;
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
    std::size_t many = std::min<std::size_t>(words, 360);  // as many as cannot overflow
    words -= many;
    for (; many; --many, data += 2) sum2 += sum1 += static_cast<std::uint32_t>(data[0] << 8 | data[1]);
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

std::string_view encode_chunk(std::string_view raw, std::size_t element_size) {
  assert(element_size == 1 || element_size == 4 || element_size == 8);
  std::string_view input = raw;
  if (element_size > 1) {
    char* shuffled = kept_shuffled.at_least(raw.size());
    shuffle(raw.data(), raw.size(), element_size, shuffled);
    input = {shuffled, raw.size()};
  }
  char* stored = kept_stored.at_least(zlib_bound(input.size()) + checksum_size);
  const std::size_t packed = deflate_to(input, stored, zlib_bound(input.size()));
  put_little_endian(fletcher32({stored, packed}), stored + packed);
  return {stored, packed + checksum_size};
}

std::string_view decode_chunk(std::string_view stored, std::size_t element_size, std::span<char> raw) {
  if (stored.size() < checksum_size) return "too short for a checksum";
  const std::string_view packed = stored.substr(0, stored.size() - checksum_size);
  char checksum[checksum_size];
  put_little_endian(fletcher32(packed), checksum);
  if (stored.substr(packed.size()) != std::string_view(checksum, checksum_size)) return "the fletcher32 checksum differs";
  char* output = element_size > 1 ? kept_shuffled.at_least(raw.size()) : raw.data();
  // With no place for the actual size, libdeflate demands exactly the size that is expected.
  if (libdeflate_zlib_decompress(decompressor(), packed.data(), packed.size(), output, raw.size(), nullptr) != LIBDEFLATE_SUCCESS)
    return "does not inflate to the size of a chunk";
  if (element_size > 1) unshuffle(output, raw.size(), element_size, raw.data());
  return {};
}

}  // namespace fracfarm
