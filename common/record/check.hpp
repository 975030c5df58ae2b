// The validator: is this file a record that may be trusted, and the one that was asked for? Every rule by name, each with its value and
// limit.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/record/reader.hpp"

namespace fracfarm {

struct Check {
  std::string name;
  bool passed = false;
  double value = 0.0;
  double limit = 0.0;
  std::string detail;  // what the value is, or the first things that are wrong
};

struct Expectation {
  std::optional<std::string> key;  // the right file for the right job
};

struct CheckedRecord {
  std::vector<Check> checks;
  std::optional<Record> record;  // where it could be read whole
  bool passed() const;
};

// Rules of the file (complete, grammar), of the content (content.hpp) and of the expectation, in this order. HDF5 sees only a file whose
// seal fits, and the content is looked at only where the grammar holds. A file that cannot be read at all is one failed check named
// "readable".
std::vector<Check> check_record(const std::filesystem::path& path, const Expectation& expectation = {});
CheckedRecord check_record_bytes(const std::string& bytes, const Expectation& expectation = {});

bool all_passed(const std::vector<Check>& checks);

}  // namespace fracfarm
