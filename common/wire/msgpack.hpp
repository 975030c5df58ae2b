// MessagePack, as much of it as messages need, without a tree: a writer that appends to bytes and a reader that walks along them. Binary
// and extension types are no part of it, and neither are keys of a map that are no text.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace fracfarm::wire::msgpack {

void put_nil(std::string& bytes);
void put_map(std::string& bytes, std::size_t pairs);
void put_list(std::string& bytes, std::size_t elements);
void put_text(std::string& bytes, std::string_view text);
void put_unsigned(std::string& bytes, std::uint64_t value);
void put_signed(std::string& bytes, std::int64_t value);
void put_real(std::string& bytes, double value);  // in 4 bytes where that is exact

enum class Kind { broken, nil, boolean, natural, negative, real, text, list, map };

// One value; of a list or a map only its head: what it holds is what the reader takes next.
struct Value {
  Kind kind = Kind::broken;
  std::uint64_t natural = 0;
  std::int64_t negative = 0;  // below 0
  double real = 0.0;
  std::string_view text;  // lies in the bytes read
  std::size_t size = 0;   // elements of a list, pairs of a map
};

class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}
  Value take();  // broken: no value begins here, or it is cut off
  void skip();   // a whole value with all that it holds; only over bytes that are well formed
  bool at_nil() const { return at_ < bytes_.size() && static_cast<unsigned char>(bytes_[at_]) == 0xC0; }
  bool ended() const { return at_ == bytes_.size(); }

 private:
  std::uint64_t number(std::size_t width);  // big-endian; broken_ where it is cut off
  Value text(std::size_t length);
  Value wide(unsigned char first);

  std::string_view bytes_;
  std::size_t at_ = 0;
  bool broken_ = false;
};

// One value and nothing behind it, at most `depth` lists and maps in one another, at most `values` values and keys. No memory is needed
// for the answer, whatever the bytes.
bool well_formed(std::string_view bytes, std::size_t depth, std::size_t values);

}  // namespace fracfarm::wire::msgpack
