// One hostile scene through the parser, the solver's door and, for a share, the record's writer and validator; how it ended and whether
// that is an end that a scene may have.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "common/scene/scene.hpp"

namespace fracfarm::robustness {

enum class End { rejected, failed, censored, numeric, violation };
inline constexpr const char* end_names[]{"REJECTED", "FAILED", "CENSORED", "SOLVER_NUMERIC", "VIOLATION"};

struct Outcome {
  std::uint64_t index = 0;
  std::string twists;
  End end = End::violation;
  std::string why;            // first problem, failure rule, evidence, or what was violated
  double seconds = 0.0;       // wall clock
  long long steps = 0;        // made
  double ledger_share = 0.0;  // of accepted runs: largest residual over the largest work or energy
  bool validated = false;     // the record was written and validated, too
};

struct Trial {
  std::uint64_t seed = 1;
  std::uint64_t index = 0;
  Method method = Method::phase_field;
  double limit_s = 20.0;          // wall clock; a run ends itself at half of it
  bool validate = false;          // write the record and validate it
  std::filesystem::path scratch;  // folder for that record
};

// Never throws.
Outcome outcome_of(const Trial& trial);
// The same of a given text.
Outcome outcome_of_text(const std::string& text, const Trial& trial);

std::string to_line(const Outcome& outcome);  // one line of JSON
Outcome from_line(const std::string& line);

}  // namespace fracfarm::robustness
