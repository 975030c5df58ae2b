#include "solver/program/duration.hpp"

#include <charconv>
#include <cmath>

namespace fracfarm {

std::optional<double> parse_duration(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
  if (error != std::errc{} || !std::isfinite(value) || value <= 0.0) return std::nullopt;
  if (unit.empty() || unit == "s") return value;
  if (unit == "m") return value * 60.0;
  if (unit == "h") return value * 3600.0;
  if (unit == "d") return value * 86400.0;
  return std::nullopt;
}

}  // namespace fracfarm
