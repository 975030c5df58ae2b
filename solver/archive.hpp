// Bytes of a checkpoint's payload: fixed-size values and arrays of them, in the order they were put. Reading past the end or an array of
// another length marks the reader as failed and gives zeros; it never throws and never reads outside.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

namespace fracfarm {

class ArchiveWriter {
 public:
  template <class T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  template <class Array>
  void put_array(const Array& values) {
    static_assert(std::is_trivially_copyable_v<typename Array::value_type>);
    put(static_cast<std::uint64_t>(values.size()));
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof values[0]);
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

class ArchiveReader {
 public:
  explicit ArchiveReader(std::string_view bytes) : rest_(bytes) {}

  template <class T>
  T get() {
    T value{};
    if (const char* from = take(sizeof value)) std::memcpy(&value, from, sizeof value);
    return value;
  }
  // Any length: grows the array.
  template <class Array>
  void get_array(Array& values) {
    const std::uint64_t size = get<std::uint64_t>();
    if (size > rest_.size() / sizeof values[0]) failed_ = true;
    if (failed_) return;
    values.resize(size);
    fill(values);
  }
  // Exactly as long as the array is.
  template <class Array>
  void get_array_like(Array& values) {
    if (get<std::uint64_t>() != values.size()) failed_ = true;
    fill(values);
  }
  void reject() { failed_ = true; }
  bool failed() const { return failed_; }
  bool finished() const { return !failed_ && rest_.empty(); }

 private:
  template <class Array>
  void fill(Array& values) {
    const std::size_t size = values.size() * sizeof values[0];
    if (const char* from = take(size); from && size > 0) std::memcpy(values.data(), from, size);
  }

  const char* take(std::size_t size) {
    if (failed_ || size > rest_.size()) {
      failed_ = true;
      return nullptr;
    }
    const char* from = rest_.data();
    rest_.remove_prefix(size);
    return from;
  }

  std::string_view rest_;
  bool failed_ = false;
};

}  // namespace fracfarm
