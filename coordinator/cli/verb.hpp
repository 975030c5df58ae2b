// A verb of `fracfarm`: a row of the table in verbs.cpp. Help, dispatch and the contract tests walk that table.
#pragma once

#include <span>
#include <string_view>

namespace fracfarm::cli {

struct Verb {
  std::string_view name;
  std::string_view group;             // heading in the help: Run a campaign, Look, Mend, One simulation, Daemons
  std::string_view summary;           // one line
  int (*run)(int argc, char** argv);  // argv[0] is the verb; returns an ExitCode; null: the program fracfarm-NAME beside this one
};

std::span<const Verb> verbs();

}  // namespace fracfarm::cli
