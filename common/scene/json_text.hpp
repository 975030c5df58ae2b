// JSON as text, both ways: reading within stated bounds (nothing that a file holds can crash or exhaust the program) and the one compact
// form whose bytes never differ (sorted keys, shortest round-trip numbers).
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "common/base/result.hpp"

namespace fracfarm {

struct JsonBounds {
  std::size_t max_bytes = std::size_t{8} << 20;
  std::size_t max_depth = 16;
  std::size_t max_values = 500'000;  // numbers, words, lists and objects together
};

// Refuses, with line and column: what is not JSON, numbers too large for a double, a key twice in one object, and what exceeds the bounds.
// `name` stands for the file in the problems.
Parsed<nlohmann::json> read_json(std::string_view text, std::string_view name, const JsonBounds& bounds = {});

// No blanks, keys in byte order, numbers as shortest(); not-finite numbers are a programmer's error.
std::string compact_text(const nlohmann::json& value);

// The same values for people: containers that fit a line of 120 columns stand on one, the others break at their items. Ends with a newline.
std::string pretty_text(const nlohmann::json& value);

}  // namespace fracfarm
