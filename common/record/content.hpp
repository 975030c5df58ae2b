// What a record must satisfy beyond its grammar: one table of rules, each a number that may be at most its limit. The writer stores the
// outcome in /checks; the validator works it out again from the closed file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/record/record.hpp"

namespace fracfarm {

struct ContentCheck {
  std::string_view name;
  std::string_view meaning;
  double value = 0.0;  // infinity where the rule cannot be worked out
  double limit = 0.0;
  bool passed = false;  // value <= limit
};

// Empty where sizes fit together, else what does not, in words. The rules below need it to be empty.
std::string broken_shape(const Record& record);

std::vector<ContentCheck> check_content(const Record& record);

}  // namespace fracfarm
