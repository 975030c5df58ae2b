// Arrays of the grammar: between typed values and the bytes of a dataset.
#include <algorithm>
#include <bit>
#include <cstring>

#include "common/record/layouts.hpp"

namespace fracfarm::grammar {

static_assert(std::endian::native == std::endian::little, "records are little-endian and copied as they are");

std::size_t width_of(Type type) {
  switch (type) {
    case Type::f4:
    case Type::i4:
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

Array array_of_frames(const std::vector<std::vector<float>>& frames, std::vector<std::size_t> field) {
  Array array{Type::f4, std::move(field), {}};
  array.dims.insert(array.dims.begin(), frames.size());
  array.bytes.reserve(array.count() * sizeof(float));
  for (const std::vector<float>& frame : frames) array.bytes.append(reinterpret_cast<const char*>(frame.data()), frame.size() * 4);
  return array;
}

std::vector<std::vector<float>> frames_of(const Array& array) {
  std::vector<std::vector<float>> frames;
  if (array.count() == 0) return frames;  // any number of frames of nothing would fit a small file
  const std::size_t values = array.count() / array.dims[0];
  frames.reserve(array.dims[0]);
  for (std::size_t t = 0; t < array.dims[0]; ++t)
    std::memcpy(frames.emplace_back(values).data(), array.bytes.data() + t * values * 4, values * 4);
  return frames;
}

std::vector<std::size_t> chunk_dims(std::span<const std::size_t> dims, Chunking chunking) {
  constexpr std::size_t budget = 65536, frames_together = 64;
  if (chunking == Chunking::columns) return {std::min(dims[0], budget), 1};
  if (chunking == Chunking::blocks && dims[0] > 0) {
    const std::size_t parts = (dims[0] - 1) / frames_together + 1, frames = (dims[0] - 1) / parts + 1;
    return {frames, std::min(dims[1], budget / frames)};
  }
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
