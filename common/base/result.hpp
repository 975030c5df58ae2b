// Results of things that may fail: a value, or an Error that carries a row of the fault table and one sentence.
// Input mistakes are Problems: all of them are collected and reported at once. Programmer's errors are asserts, not results.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "common/base/fault.hpp"

namespace fracfarm {

struct Error {
  Fault fault = Fault::solver_crash;
  std::string message;  // one sentence with the offending value and limit
};

template <class T>
using Result = tl::expected<T, Error>;

inline tl::unexpected<Error> fail(Fault fault, std::string message) { return tl::unexpected<Error>(Error{fault, std::move(message)}); }

// One mistake in an input: where, what was given, what is allowed, what to do.
struct Problem {
  std::string key;         // path of the key, as in phase_field.cfl or cracks[3][0]
  std::string value;       // what was given, printed
  std::string limit;       // what is allowed
  std::string suggestion;  // the mend, or empty
};

using Problems = std::vector<Problem>;

// A value, or every mistake that kept it from being made.
template <class T>
using Parsed = tl::expected<T, Problems>;

}  // namespace fracfarm
