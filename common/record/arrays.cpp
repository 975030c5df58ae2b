// Arrays of the grammar: between typed values and the bytes of a dataset.
#include <algorithm>
#include <bit>
#include <cstring>

#include "common/record/grammar.hpp"

namespace fracfarm::grammar {

static_assert(std::endian::native == std::endian::little, "records are little-endian and copied as they are");

std::size_t width_of(Type type) {
  switch (type) {
    case Type::f4:
      return 4;
    case Type::f8:
      return 8;
    case Type::i1:
    case Type::text:
      return 1;
  }
  return 0;
}

std::size_t Array::count() const {
  std::size_t product = 1;
  for (std::size_t extent : dims) product *= extent;
  return product;
}

std::vector<std::string> texts_of(const Array& array) {
  const std::size_t width = array.dims.back();
  std::vector<std::string> texts;
  for (std::size_t at = 0; width && at < array.bytes.size(); at += width) {
    std::string text = array.bytes.substr(at, width);
    text.erase(std::find(text.begin(), text.end(), '\0'), text.end());
    texts.push_back(std::move(text));
  }
  return texts;
}

std::vector<double> doubles_of(const Array& array) {
  std::vector<double> values(array.count());
  if (!values.empty()) std::memcpy(values.data(), array.bytes.data(), array.bytes.size());
  return values;
}

Array array_of(std::span<const double> values, std::vector<std::size_t> dims) {
  return {Type::f8, std::move(dims), std::string(reinterpret_cast<const char*>(values.data()), values.size_bytes())};
}

Array array_of(std::span<const std::string> texts) {
  std::size_t width = 1;
  for (const std::string& text : texts) width = std::max(width, text.size());
  Array array{Type::text, {texts.size(), width}, {}};
  for (const std::string& text : texts) array.bytes += text + std::string(width - text.size(), '\0');
  return array;
}

std::vector<std::size_t> chunk_dims(std::span<const std::size_t> dims) {
  constexpr std::size_t budget = 65536;
  std::vector<std::size_t> chunk(dims.size());
  std::size_t product = 1;
  for (std::size_t d = dims.size(); d-- > 0;) {
    chunk[d] = std::min(dims[d], std::max<std::size_t>(1, budget / product));
    product *= chunk[d];
  }
  return chunk;
}

bool same(const Value& a, const Value& b) {
  const double* x = std::get_if<double>(&a);
  const double* y = std::get_if<double>(&b);
  return x && y ? std::bit_cast<std::uint64_t>(*x) == std::bit_cast<std::uint64_t>(*y) : a == b;
}

}  // namespace fracfarm::grammar
