// Words and numbers for people: nearest name, durations, shortest round-trip numbers.
#pragma once

#include <cstdint>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fracfarm {

// The candidate nearest to `word` by Damerau-Levenshtein distance, or empty where none is near enough to suggest.
std::string_view nearest(std::string_view word, std::span<const std::string_view> candidates);

std::string shortest(double value);                            // shortest decimal that reads back the same bits; nan, inf, -inf in words
std::string duration_text(double seconds);                     // 850 ms, 12.3 s, 4 min 05 s, 3 h 12 min, 2 d 04 h
std::string engineering(double value, std::string_view unit);  // 6.91 MPa, 443 us, 12.5 MiB never: powers of 1000 only
std::string bytes_text(std::uint64_t bytes);                   // 512 B, 3.4 kB, 1.2 GB (powers of 1000)
std::string join(std::span<const std::string_view> words, std::string_view separator);

}  // namespace fracfarm
