// What every verb does alike: declare and parse its options, print problems, choose between people and --json. CLI11 stands behind it: its
// headers take the compiler four seconds, so that options.cpp alone includes them.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "common/base/result.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace fracfarm::cli {

// An option of a Command. Each call adds a rule to it and gives it back.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}
  Option required();
  Option with_default_shown();  // by the help, as the value is when this is called
  Option in_range(int least, int most);
  Option in_range(double least, double most);
  Option positive();
  Option not_negative();
  // `fault` gives words where it refuses the text of a value, else nothing.
  Option checked(std::string (*fault)(const std::string& text));
  Option excludes(Option other);
  Option repeatable();  // one value each time it is given

 private:
  CLI::Option* option_;
};

// The command line of one verb. It writes into the values that its options were added with, which must outlive it.
class Command {
 public:
  Command(std::string description, std::string name);
  ~Command();
  // Names begin with dashes, "-o,--output"; without any it is a positional argument. For Value see options.cpp.
  template <class Value>
  Option add_option(const std::string& names, Value& value, const std::string& help);
  Option add_flag(const std::string& names, bool& value, const std::string& help);
  // On --help prints it and gives exit_ok, on a mistake prints it and gives exit_bad_input; nothing: go on.
  std::optional<int> parse(int argc, char** argv);

 private:
  std::unique_ptr<CLI::App> app_;
};

// Prints every problem to stderr (key, value, limit, suggestion), or as one JSON object to stdout; gives exit_bad_input.
int report_problems(const Problems& problems, std::string_view what, bool json);

// Prints one error to stderr or as JSON; gives exit_failed, or exit_bad_input for BAD_REQUEST.
int report_error(const Error& error, bool json);

}  // namespace fracfarm::cli
