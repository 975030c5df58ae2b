// The finished rows as text for a terminal, as JSON, and as the page VERIFICATION.md.
#pragma once

#include <string>
#include <vector>

#include "tests/verification/cases.hpp"
#include "tests/verification/desk.hpp"

namespace fracfarm::verification {

struct Done {
  const Case* which;
  std::vector<Row> rows;
  std::vector<Picture> pictures;
  double seconds;
  bool passed() const;
};

std::string text_report(const std::vector<Done>& done);
std::string json_report(const std::vector<Done>& done);
// A summary with one row a case, then each case with its set-up, rows and pictures; `pictures` is the folder that the page links to, empty
// for none.
std::string page_report(const std::vector<Done>& done, const std::string& pictures);

}  // namespace fracfarm::verification
