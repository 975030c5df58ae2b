#include "coordinator/cli/options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "common/base/exit_code.hpp"
#include "common/base/terminal.hpp"

namespace fracfarm::cli {

Option Option::required() { return Option(option_->required()); }
Option Option::with_default_shown() { return Option(option_->capture_default_str()); }
Option Option::in_range(int least, int most) { return Option(option_->check(CLI::Range(least, most))); }
Option Option::in_range(double least, double most) { return Option(option_->check(CLI::Range(least, most))); }
Option Option::positive() { return Option(option_->check(CLI::PositiveNumber)); }
Option Option::not_negative() { return Option(option_->check(CLI::NonNegativeNumber)); }
Option Option::checked(std::string (*fault)(const std::string&)) { return Option(option_->check(fault)); }
Option Option::excludes(Option other) { return Option(option_->excludes(other.option_)); }
Option Option::repeatable() { return Option(option_->take_all()->allow_extra_args(false)); }

Command::Command(std::string description, std::string name) : app_(std::make_unique<CLI::App>(std::move(description), std::move(name))) {}
Command::~Command() = default;

template <class Value>
Option Command::add_option(const std::string& names, Value& value, const std::string& help) {
  return Option(app_->add_option(names, value, help));
}
template Option Command::add_option(const std::string&, std::string&, const std::string&);
template Option Command::add_option(const std::string&, std::optional<std::string>&, const std::string&);
template Option Command::add_option(const std::string&, std::vector<std::string>&, const std::string&);
template Option Command::add_option(const std::string&, std::filesystem::path&, const std::string&);
template Option Command::add_option(const std::string&, std::vector<std::filesystem::path>&, const std::string&);
template Option Command::add_option(const std::string&, int&, const std::string&);
template Option Command::add_option(const std::string&, std::int64_t&, const std::string&);
template Option Command::add_option(const std::string&, std::uint64_t&, const std::string&);
template Option Command::add_option(const std::string&, double&, const std::string&);

Option Command::add_flag(const std::string& names, bool& value, const std::string& help) {
  return Option(app_->add_flag(names, value, help));
}

std::optional<int> Command::parse(int argc, char** argv) {
  try {
    app_->parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::ParseError& mistake) {
    return app_->exit(mistake) == 0 ? exit_ok : exit_bad_input;
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
