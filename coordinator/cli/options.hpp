// What every verb does alike: parse its options (CLI11), print problems, choose between people and --json.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>

#include "common/base/result.hpp"

namespace fracfarm::cli {

// Parses; on --help prints it and gives exit_ok, on a mistake prints it and gives exit_bad_input; nothing: go on.
std::optional<int> parse(CLI::App& app, int argc, char** argv);

// Prints every problem to stderr (key, value, limit, suggestion), or as one JSON object to stdout; gives exit_bad_input.
int report_problems(const Problems& problems, std::string_view what, bool json);

// Prints one error to stderr or as JSON; gives exit_failed, or exit_bad_input for BAD_REQUEST.
int report_error(const Error& error, bool json);

}  // namespace fracfarm::cli
