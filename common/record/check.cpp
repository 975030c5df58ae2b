#include "common/record/check.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/base/atomic_file.hpp"
#include "common/record/content.hpp"
#include "common/record/seal.hpp"

namespace fracfarm {
namespace {

Check count_check(std::string name, std::size_t count, std::string detail) {
  return {std::move(name), count == 0, static_cast<double>(count), 0.0, std::move(detail)};
}

std::string first_of(const std::vector<std::string>& sentences) {
  constexpr std::size_t shown = 5;
  std::string text;
  for (std::size_t i = 0; i < std::min(sentences.size(), shown); ++i) text += (i ? "; " : "") + sentences[i];
  if (sentences.size() > shown) text += fmt::format("; and {} more", sentences.size() - shown);
  return text;
}

}  // namespace

bool all_passed(const std::vector<Check>& checks) {
  return !checks.empty() && std::all_of(checks.begin(), checks.end(), [](const Check& check) { return check.passed; });
}

bool CheckedRecord::passed() const { return all_passed(checks); }

CheckedRecord check_record_bytes(const std::string& bytes, const Expectation& expectation) {
  CheckedRecord result;
  const std::string seal = broken_seal(bytes);
  result.checks.push_back(count_check("complete", !seal.empty(), seal.empty() ? "the seal fits" : seal));
  Reading reading;
  if (seal.empty())
    reading = read_leniently(bytes);
  else
    reading.violations.push_back("not looked at: HDF5 is not safe on damaged files");
  result.checks.push_back(count_check("grammar", reading.violations.size(),
                                      reading.violations.empty() ? "as the grammar states" : first_of(reading.violations)));
  if (reading.violations.empty()) {
    for (const ContentCheck& check : reading.checks)
      result.checks.push_back({std::string(check.name), check.passed, check.value, check.limit, std::string(check.meaning)});
    result.record = std::move(reading.record);
  }
  if (expectation.key) {
    const std::string found = result.record ? result.record->key : "unreadable";
    result.checks.push_back(
        count_check("expected_key", found != *expectation.key, fmt::format("key {}, expected {}", found, *expectation.key)));
  }
  return result;
}

std::vector<Check> check_record(const std::filesystem::path& path, const Expectation& expectation) {
  const Result<std::string> bytes = read_file(path, record_file_limit);
  if (!bytes) return {count_check("readable", 1, bytes.error().message)};
  return check_record_bytes(*bytes, expectation).checks;
}

}  // namespace fracfarm
