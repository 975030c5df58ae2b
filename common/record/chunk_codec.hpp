// One chunk of a dataset as HDF5's own filters shuffle, deflate and fletcher32 would store it, in that order. Byte-exact in both
// directions: stock readers open what is encoded here. Decoding is given the size to expect and never writes more, so that a bomb stays
// small.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace fracfarm {

// raw: whole chunk, elements of 1 (no shuffle), 4 or 8 bytes. Level: libdeflate's, 1 ... 12.
std::string encode_chunk(std::string_view raw, std::size_t element_size, int level);

// Empty on success, else what is wrong in words. `raw` is sized by the caller and filled.
std::string_view decode_chunk(std::string_view stored, std::size_t element_size, std::string& raw);

// As HDF5 computes it: 16-bit big-endian words, an odd last byte counts as a high byte.
std::uint32_t fletcher32(std::string_view bytes);

}  // namespace fracfarm
