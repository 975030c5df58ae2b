// Words and numbers of a text with blanks between them, and the line that is being read.
#pragma once

#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string_view>

namespace fracfarm::fdem {

class MshWords {
 public:
  explicit MshWords(std::string_view bytes) : bytes_(bytes) {}

  std::size_t line() const { return line_; }
  std::size_t left() const { return bytes_.size() - at_; }  // bytes

  // The next word, empty at the end.
  std::string_view word() {
    while (at_ < bytes_.size() && blank(bytes_[at_])) line_ += bytes_[at_++] == '\n';
    const std::size_t from = at_;
    while (at_ < bytes_.size() && !blank(bytes_[at_])) ++at_;
    return bytes_.substr(from, at_ - from);
  }

  // The rest of the line, without the blanks around it.
  std::string_view rest_of_line() {
    const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
    std::string_view rest = bytes_.substr(at_, end - at_);
    at_ = end;
    while (!rest.empty() && blank(rest.front())) rest.remove_prefix(1);
    while (!rest.empty() && blank(rest.back())) rest.remove_suffix(1);
    return rest;
  }

  // Goes on after the next word that is `end`; false where there is none.
  bool skip_past(std::string_view end) {
    for (std::string_view next = word(); !next.empty(); next = word())
      if (next == end) return true;
    return false;
  }

  template <class Number>
  std::optional<Number> number() {
    std::string_view text = word();
    if (text.starts_with('+')) text.remove_prefix(1);
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
  }

  // A count of things that take two bytes each at least: one that the rest of the file cannot hold is none.
  std::optional<std::size_t> count() {
    const auto value = number<long long>();
    if (!value || *value < 0 || static_cast<unsigned long long>(*value) > left() / 2 + 1) return std::nullopt;
    return static_cast<std::size_t>(*value);
  }

 private:
  static bool blank(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }

  std::string_view bytes_;
  std::size_t at_ = 0, line_ = 1;
};

}  // namespace fracfarm::fdem
