// One chunk of a dataset as HDF5's own filters shuffle, deflate and fletcher32 would store it, in that order: stock readers open what is
// encoded here, and what they wrote is decoded here. Decoding is given the size to expect and never writes more, so that a bomb stays
// small.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace fracfarm {

// Of ISA-L, 0 ... 3. Level 2 takes a quarter of the time of libdeflate's level 1 on fields of damage, for 8 % more bytes.
inline constexpr int deflate_level = 2;

// raw: whole chunk, elements of 1 (no shuffle), 4 or 8 bytes. What is returned lies in memory of this thread until its next chunk. The
// bytes may differ between generations of processors, what they inflate to does not.
std::string_view encode_chunk(std::string_view raw, std::size_t element_size);

// Empty on success, else what is wrong in words. `raw` is sized by the caller and filled.
std::string_view decode_chunk(std::string_view stored, std::size_t element_size, std::span<char> raw);

// As HDF5 computes it: 16-bit big-endian words, an odd last byte counts as a high byte.
std::uint32_t fletcher32(std::string_view bytes);

}  // namespace fracfarm
