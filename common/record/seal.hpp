// The last line of a record file: its length and XXH3-128, after the end of the HDF5 data, where stock readers do not look.
// A record without a fitting seal was not finished, or was changed after it was written.
#pragma once

#include <string>
#include <string_view>

namespace fracfarm {

inline constexpr std::size_t seal_size = 82;

std::string seal_of(std::string_view body);  // seal_size bytes of text, the last a newline

// Empty where the last seal_size bytes of the file are the seal of all bytes before, else what is wrong in words.
std::string broken_seal(std::string_view file);

}  // namespace fracfarm
