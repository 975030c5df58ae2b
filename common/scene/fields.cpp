#include "common/scene/fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/base/text.hpp"
#include "common/scene/json_text.hpp"

namespace fracfarm {
namespace {

using nlohmann::json;

constexpr std::size_t max_problems = 100;

std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates) {
  const std::string_view near = nearest(word, candidates);
  return near.empty() ? std::string() : fmt::format("did you mean '{}'?", near);
}

}  // namespace

void ProblemList::add(std::string key, std::string value, std::string limit, std::string suggestion) {
  const auto same = [&](const Problem& p) { return p.key == key && p.value == value && p.limit == limit; };
  if (problems_.size() < max_problems && std::none_of(problems_.begin(), problems_.end(), same))
    problems_.push_back({std::move(key), std::move(value), std::move(limit), std::move(suggestion)});
  else if (problems_.size() >= max_problems)
    ++dropped_;
}

void ProblemList::add(const Problems& others) {
  for (const Problem& p : others) add(p.key, p.value, p.limit, p.suggestion);
}

Problems ProblemList::take() {
  if (dropped_ > 0) problems_.push_back({"...", fmt::format("{} more problems", dropped_), "none", "mend these first"});
  dropped_ = 0;
  return std::move(problems_);
}

std::string Range::text() const {
  const std::string tail = unit.empty() ? std::string() : fmt::format(" {}", unit);
  return fmt::format("{} {}{} {}{}", above ? "above" : "from", shortest(low), below ? " to below" : " to", shortest(high), tail);
}

std::string printed(const json& value) {
  if (value.is_object() && value.size() > 8) return fmt::format("an object of {} keys", value.size());
  if (value.is_array() && value.size() > 16) return fmt::format("a list of {} values", value.size());
  if (value.is_number_float()) return shortest(value.get<double>());
  std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
  if (text.size() > 60) text = text.substr(0, 57) + "...";
  return text;
}

std::string key_path(std::string_view parent, std::string_view key) {
  return parent.empty() ? std::string(key) : fmt::format("{}.{}", parent, key);
}

std::string key_path(std::string_view parent, std::size_t index) { return fmt::format("{}[{}]", parent, index); }

std::optional<double> read_number(const json& value, const std::string& path, const Range& range, ProblemList& problems) {
  if (value.is_number()) {
    const double number = value.get<double>() + 0.0;  // -0 becomes 0
    if (std::isfinite(number) && range.holds(number)) return number;
  }
  problems.add(path, printed(value), "a number " + range.text());
  return std::nullopt;
}

std::optional<std::uint64_t> read_integer(const json& value, const std::string& path, std::uint64_t low, std::uint64_t high,
                                          ProblemList& problems) {
  std::optional<std::uint64_t> number;
  if (value.is_number_unsigned() || (value.is_number_integer() && value.get<std::int64_t>() >= 0)) number = value.get<std::uint64_t>();
  if (value.is_number_float()) {
    const double given = value.get<double>();  // 127.0 is an integer; above 2^53 a double does not say which
    if (given >= 0 && given <= 0x1p53 && given == std::floor(given)) number = static_cast<std::uint64_t>(given);
  }
  if (number && *number >= low && *number <= high) return number;
  problems.add(path, printed(value), fmt::format("an integer from {} to {}", low, high));
  return std::nullopt;
}

bool read_numbers(const json& value, const std::string& path, const Range& range, std::span<double> out, ProblemList& problems) {
  if (!value.is_array() || value.size() != out.size()) {
    problems.add(path, printed(value), fmt::format("a list of {} numbers", out.size()));
    return false;
  }
  bool good = true;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const std::optional<double> number = read_number(value[i], key_path(path, i), range, problems);
    if (number) out[i] = *number;
    good = good && number.has_value();
  }
  return good;
}

std::optional<std::size_t> read_word(const json& value, const std::string& path, std::span<const std::string_view> here,
                                     std::span<const std::string_view> later, ProblemList& problems) {
  const std::string_view given = value.is_string() ? std::string_view(value.get_ref<const std::string&>()) : std::string_view();
  if (value.is_string())
    for (std::size_t i = 0; i < here.size(); ++i)
      if (here[i] == given) return i;
  const bool known_later = std::find(later.begin(), later.end(), given) != later.end();
  problems.add(path, printed(value), join(here, " | "),
               known_later ? fmt::format("this build has no '{}'", given) : did_you_mean(given, here));
  return std::nullopt;
}

Fields::Fields(const json& value, std::string path, ProblemList& problems)
    : object_(value.is_object() ? &value : nullptr), path_(std::move(path)), problems_(problems) {
  if (!object_) problems_.add(path_.empty() ? "(whole file)" : path_, printed(value), "an object of keys");
}

bool Fields::has(std::string_view key) const { return object_ && object_->contains(key); }

const json* Fields::value(std::string_view key) {
  known_.push_back(key);
  if (!object_) return nullptr;
  const auto found = object_->find(key);
  return found == object_->end() ? nullptr : &*found;
}

bool Fields::number(std::string_view key, const Range& range, double& target) {
  const json* given = value(key);
  const std::optional<double> number = given ? read_number(*given, path(key), range, problems_) : std::nullopt;
  if (number) target = *number;
  return number.has_value();
}

bool Fields::number(std::string_view key, const Range& range, std::optional<double>& target) {
  double number = 0.0;
  if (!this->number(key, range, number)) return false;
  target = number;
  return true;
}

bool Fields::integer(std::string_view key, std::uint64_t low, std::uint64_t high, std::uint64_t& target) {
  const json* given = value(key);
  const std::optional<std::uint64_t> number = given ? read_integer(*given, path(key), low, high, problems_) : std::nullopt;
  if (number) target = *number;
  return number.has_value();
}

std::optional<std::size_t> Fields::word_index(std::string_view key, std::span<const std::string_view> here,
                                              std::span<const std::string_view> later) {
  const json* given = value(key);
  return given ? read_word(*given, path(key), here, later, problems_) : std::nullopt;
}

void Fields::only(std::string_view key, std::string_view value, std::initializer_list<std::string_view> later) {
  word_index(key, {&value, 1}, {later.begin(), later.size()});
}

void Fields::require(std::initializer_list<std::string_view> keys) {
  for (const std::string_view key : keys)
    if (object_ && !has(key)) problems_.add(path(key), "(missing)", "required key");
}

void Fields::allow(std::initializer_list<std::string_view> keys) { known_.insert(known_.end(), keys); }

void Fields::done() {
  if (!object_) return;
  for (auto item = object_->begin(); item != object_->end(); ++item)
    if (std::find(known_.begin(), known_.end(), item.key()) == known_.end())
      problems_.add(path(item.key().substr(0, 80)), printed(*item), "keys " + join(known_, " "), did_you_mean(item.key(), known_));
}

}  // namespace fracfarm
