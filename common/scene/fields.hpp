// Reading an object of an input file: one line a key, with its range. Every mistake is kept with its key path, so that all are reported at
// once; keys that nobody asked for are mistakes too, with the nearest known one as a suggestion.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.hpp"

namespace fracfarm {

// Mistakes as they are found, each once; keeps the first hundred and counts the rest.
class ProblemList {
 public:
  void add(std::string key, std::string value, std::string limit, std::string suggestion = {});
  void add(const Problems& others);
  bool empty() const { return problems_.empty(); }
  Problems take();

 private:
  Problems problems_;
  std::size_t dropped_ = 0;
};

// What a number may be. `above`: low itself is not allowed; `below`: nor is high.
struct Range {
  double low = 0.0;
  double high = 0.0;
  std::string_view unit;
  bool above = false;
  bool below = false;

  bool holds(double value) const { return (above ? value > low : value >= low) && (below ? value < high : value <= high); }
  std::string text() const;
};

// A named value of an enumeration, as files spell it.
template <class E>
struct Word {
  std::string_view name;
  E value;
};

std::string printed(const nlohmann::json& value);  // for a problem: compact, cut at 60 characters
std::string key_path(std::string_view parent, std::string_view key);
std::string key_path(std::string_view parent, std::size_t index);

// One value against its rule; a problem and nothing where it breaks it.
std::optional<double> read_number(const nlohmann::json& value, const std::string& path, const Range& range, ProblemList& problems);
std::optional<std::uint64_t> read_integer(const nlohmann::json& value, const std::string& path, std::uint64_t low, std::uint64_t high,
                                          ProblemList& problems);
// Exactly out.size() numbers; false where they are not.
bool read_numbers(const nlohmann::json& value, const std::string& path, const Range& range, std::span<double> out, ProblemList& problems);
// Index of the word in `here`; `later` are words that the format knows and this build does not have.
std::optional<std::size_t> read_word(const nlohmann::json& value, const std::string& path, std::span<const std::string_view> here,
                                     std::span<const std::string_view> later, ProblemList& problems);

// The keys of one object. Readers leave the target as it is where the key is absent or wrong.
class Fields {
 public:
  // A problem where value is no object; then every key is absent and none is missed.
  Fields(const nlohmann::json& value, std::string path, ProblemList& problems);

  bool has(std::string_view key) const;
  bool number(std::string_view key, const Range& range, double& target);  // true where it was given and right
  bool number(std::string_view key, const Range& range, std::optional<double>& target);
  bool integer(std::string_view key, std::uint64_t low, std::uint64_t high, std::uint64_t& target);
  template <class E, std::size_t N>
  bool word(std::string_view key, const std::array<Word<E>, N>& table, E& target, std::initializer_list<std::string_view> later = {}) {
    std::array<std::string_view, N> names;
    for (std::size_t i = 0; i < N; ++i) names[i] = table[i].name;
    const std::optional<std::size_t> index = word_index(key, names, {later.begin(), later.size()});
    if (index) target = table[*index].value;
    return index.has_value();
  }
  // A key that has one value in this build; others are refused by name.
  void only(std::string_view key, std::string_view value, std::initializer_list<std::string_view> later = {});
  const nlohmann::json* value(std::string_view key);  // null where absent; the caller reads it

  void require(std::initializer_list<std::string_view> keys);  // a problem for each absent one
  void allow(std::initializer_list<std::string_view> keys);    // known keys whose values are not read
  void done();                                                 // a problem for each unknown key

  std::string path(std::string_view key) const { return key_path(path_, key); }
  ProblemList& problems() { return problems_; }

 private:
  std::optional<std::size_t> word_index(std::string_view key, std::span<const std::string_view> here,
                                        std::span<const std::string_view> later);

  const nlohmann::json* object_;  // null where the value was no object
  std::string path_;
  ProblemList& problems_;
  std::vector<std::string_view> known_;
};

}  // namespace fracfarm
