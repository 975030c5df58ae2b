#include "coordinator/cli/options.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "common/base/exit_code.hpp"
#include "common/base/terminal.hpp"

namespace fracfarm::cli {

std::optional<int> parse(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::ParseError& mistake) {
    return app.exit(mistake) == 0 ? exit_ok : exit_bad_input;
  }
}

int report_problems(const Problems& problems, std::string_view what, bool json) {
  if (json) {
    nlohmann::json list = nlohmann::json::array();
    for (const Problem& p : problems)
      list.push_back({{"key", p.key}, {"value", p.value}, {"limit", p.limit}, {"suggestion", p.suggestion}});
    const nlohmann::json body{{"schema", "fracfarm.problems/1"}, {"what", what}, {"problems", list}};
    fmt::print("{}\n", body.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    return exit_bad_input;
  }
  fmt::print(stderr, "{} {}: {} problem{}\n", ink("error:", Ink::red, stderr), what, problems.size(), problems.size() == 1 ? "" : "s");
  for (const Problem& p : problems) {
    fmt::print(stderr, "  {} = {}; allowed: {}", ink(p.key, Ink::bold, stderr), p.value, p.limit);
    if (!p.suggestion.empty()) fmt::print(stderr, "; {}", p.suggestion);
    fmt::print(stderr, "\n");
  }
  return exit_bad_input;
}

int report_error(const Error& error, bool json) {
  const FaultRow& row = fault_row(error.fault);
  if (json) {
    const nlohmann::json body{{"schema", "fracfarm.error/1"}, {"fault", row.name}, {"message", error.message}};
    fmt::print("{}\n", body.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
  } else {
    fmt::print(stderr, "{} {} ({})\n", ink("error:", Ink::red, stderr), error.message, row.name);
  }
  return error.fault == Fault::bad_request ? exit_bad_input : exit_failed;
}

}  // namespace fracfarm::cli
