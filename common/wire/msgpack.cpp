#include "common/wire/msgpack.hpp"

#include <bit>
#include <cmath>
#include <limits>
#include <vector>

namespace fracfarm::wire::msgpack {
namespace {

void put_byte(std::string& bytes, unsigned value) { bytes += static_cast<char>(value); }

void put_number(std::string& bytes, std::uint64_t value, std::size_t width) {
  for (std::size_t shift = 8 * width; shift > 0; shift -= 8) put_byte(bytes, (value >> (shift - 8)) & 0xFF);
}

// The head of a text, list or map in the narrowest form that holds `size`.
struct Heads {
  unsigned fix, fix_limit, by_8, by_16, by_32;  // by_8 0: there is none
};
constexpr Heads text_heads{0xA0, 32, 0xD9, 0xDA, 0xDB}, list_heads{0x90, 16, 0, 0xDC, 0xDD}, map_heads{0x80, 16, 0, 0xDE, 0xDF};

void put_head(std::string& bytes, std::size_t size, const Heads& heads) {
  if (size < heads.fix_limit) return put_byte(bytes, heads.fix | static_cast<unsigned>(size));
  const std::size_t width = heads.by_8 && size < 0x100 ? 1 : size < 0x10000 ? 2 : 4;
  put_byte(bytes, width == 1 ? heads.by_8 : width == 2 ? heads.by_16 : heads.by_32);
  put_number(bytes, size, width);
}

std::size_t narrowest(std::uint64_t value) { return value < 0x100 ? 1 : value < 0x10000 ? 2 : value < 0x100000000 ? 4 : 8; }

}  // namespace

void put_nil(std::string& bytes) { put_byte(bytes, 0xC0); }
void put_map(std::string& bytes, std::size_t pairs) { put_head(bytes, pairs, map_heads); }
void put_list(std::string& bytes, std::size_t elements) { put_head(bytes, elements, list_heads); }

void put_text(std::string& bytes, std::string_view text) {
  put_head(bytes, text.size(), text_heads);
  bytes += text;
}

void put_unsigned(std::string& bytes, std::uint64_t value) {
  if (value < 0x80) return put_byte(bytes, static_cast<unsigned>(value));
  const std::size_t width = narrowest(value);
  put_byte(bytes, 0xCC + static_cast<unsigned>(std::countr_zero(width)));
  put_number(bytes, value, width);
}

void put_signed(std::string& bytes, std::int64_t value) {
  if (value >= 0) return put_unsigned(bytes, static_cast<std::uint64_t>(value));
  if (value >= -32) return put_byte(bytes, static_cast<unsigned>(value & 0xFF));
  const std::size_t width = value >= INT8_MIN ? 1 : value >= INT16_MIN ? 2 : value >= INT32_MIN ? 4 : 8;
  put_byte(bytes, 0xD0 + static_cast<unsigned>(std::countr_zero(width)));
  put_number(bytes, static_cast<std::uint64_t>(value), width);
}

void put_real(std::string& bytes, double value) {
  const bool small = std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max());
  if (small && static_cast<double>(static_cast<float>(value)) == value) {
    put_byte(bytes, 0xCA);
    put_number(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(value)), 4);
  } else {
    put_byte(bytes, 0xCB);
    put_number(bytes, std::bit_cast<std::uint64_t>(value), 8);
  }
}

std::uint64_t Reader::number(std::size_t width) {
  if (bytes_.size() - at_ < width) return broken_ = true, 0;
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < width; ++i) value = value << 8 | static_cast<unsigned char>(bytes_[at_++]);
  return value;
}

Value Reader::text(std::size_t length) {
  if (broken_ || bytes_.size() - at_ < length) return broken_ = true, Value{};
  Value value{.kind = Kind::text, .text = bytes_.substr(at_, length)};
  at_ += length;
  return value;
}

Value Reader::take() {
  const auto first = static_cast<unsigned char>(number(1));
  if (broken_) return {};
  if (first < 0x80) return {.kind = Kind::natural, .natural = first, .text = {}};
  if (first < 0x90) return {.kind = Kind::map, .text = {}, .size = first & 0x0Fu};
  if (first < 0xA0) return {.kind = Kind::list, .text = {}, .size = first & 0x0Fu};
  if (first < 0xC0) return text(first & 0x1Fu);
  if (first >= 0xE0) return {.kind = Kind::negative, .negative = static_cast<std::int8_t>(first), .text = {}};
  const Value value = wide(first);
  return broken_ ? Value{} : value;
}

// What says its width in its first byte.
Value Reader::wide(unsigned char first) {
  const std::size_t width = std::size_t{1} << (first & 3);
  switch (first) {
    case 0xC0:
      return {.kind = Kind::nil, .text = {}};
    case 0xC2:
    case 0xC3:
      return {.kind = Kind::boolean, .natural = first & 1u, .text = {}};
    case 0xCA:
      return {.kind = Kind::real, .real = std::bit_cast<float>(static_cast<std::uint32_t>(number(4))), .text = {}};
    case 0xCB:
      return {.kind = Kind::real, .real = std::bit_cast<double>(number(8)), .text = {}};
    case 0xCC:
    case 0xCD:
    case 0xCE:
    case 0xCF:
      return {.kind = Kind::natural, .natural = number(width), .text = {}};
    case 0xD0:
    case 0xD1:
    case 0xD2:
    case 0xD3: {
      const std::size_t unused = 64 - 8 * width;
      const auto value = static_cast<std::int64_t>(number(width) << unused) >> unused;  // the sign, drawn out
      if (value < 0) return {.kind = Kind::negative, .negative = value, .text = {}};
      return {.kind = Kind::natural, .natural = static_cast<std::uint64_t>(value), .text = {}};
    }
    case 0xD9:
      return text(number(1));
    case 0xDA:
      return text(number(2));
    case 0xDB:
      return text(number(4));
    case 0xDC:
    case 0xDD:
      return {.kind = Kind::list, .text = {}, .size = number(first == 0xDC ? 2 : 4)};
    case 0xDE:
    case 0xDF:
      return {.kind = Kind::map, .text = {}, .size = number(first == 0xDE ? 2 : 4)};
    default:
      broken_ = true;
      return {};
  }
}

void Reader::skip() {
  for (std::size_t left = 1; left > 0; --left) {
    const Value value = take();
    if (value.kind == Kind::broken) return;
    if (value.kind == Kind::list) left += value.size;
    if (value.kind == Kind::map) left += 2 * value.size;
  }
}

bool well_formed(std::string_view bytes, std::size_t depth, std::size_t values) {
  struct Open {
    std::size_t left;  // values and keys that are still to come
    bool map;
  };
  std::vector<Open> open;
  open.reserve(depth);
  Reader reader(bytes);
  for (std::size_t seen = 1; seen <= values; ++seen) {
    const Value value = reader.take();
    const bool is_key = !open.empty() && open.back().map && open.back().left % 2 == 0;
    if (value.kind == Kind::broken || (is_key && value.kind != Kind::text)) return false;
    if (!open.empty()) --open.back().left;
    if (value.kind == Kind::list || value.kind == Kind::map) {
      const bool map = value.kind == Kind::map;
      if (open.size() == depth || value.size > values) return false;
      open.push_back({map ? 2 * value.size : value.size, map});
    }
    while (!open.empty() && open.back().left == 0) open.pop_back();
    if (open.empty()) return reader.ended();
  }
  return false;
}

}  // namespace fracfarm::wire::msgpack
