// fracfarm: the one command a person types. A verb of the table runs here; `fracfarm X` otherwise becomes the program fracfarm-X beside it.
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "common/base/build_info.hpp"
#include "common/base/exit_code.hpp"
#include "common/base/terminal.hpp"
#include "common/base/text.hpp"
#include "coordinator/cli/verb.hpp"

namespace fracfarm::cli {
namespace {

void print_help(std::FILE* to) {
  fmt::print(to, "usage: fracfarm VERB [options]      (fracfarm VERB --help tells more)\n");
  std::string_view group;
  for (const Verb& verb : verbs()) {
    if (verb.group != group) fmt::print(to, "\n{}\n", ink(group = verb.group, Ink::bold, to));
    fmt::print(to, "  {:<12} {}\n", verb.name, verb.summary);
  }
  fmt::print(to, "\nexit status: 0 done, 1 failed, 2 bad input, 3 stopped, 4 no farm to reach, 5 jobs quarantined\n");
}

int unknown_verb(std::string_view word) {
  std::vector<std::string_view> names;
  for (const Verb& verb : verbs()) names.push_back(verb.name);
  const std::string_view near = nearest(word, names);
  fmt::print(stderr, "{} unknown verb '{}'{}; fracfarm --help lists them\n", ink("error:", Ink::red, stderr), word,
             near.empty() ? std::string() : fmt::format("; did you mean '{}'?", near));
  return exit_bad_input;
}

// Replaces this process by fracfarm-NAME from the same folder.
int become_program(std::string_view name, char** argv) {
  const std::filesystem::path here = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  const std::string program = here / fmt::format("fracfarm-{}", name);
  ::execv(program.c_str(), argv);
  fmt::print(stderr, "{} cannot run {}: {}\n", ink("error:", Ink::red, stderr), program, std::strerror(errno));
  return exit_failed;
}

int run(int argc, char** argv) {
  if (argc < 2) return print_help(stderr), exit_bad_input;
  const std::string_view word = argv[1];
  if (word == "--help" || word == "-h" || word == "help") return print_help(stdout), exit_ok;
  if (word == "--version") return fmt::print("fracfarm {}\n", build_info().build_id), exit_ok;
  for (const Verb& verb : verbs())
    if (verb.name == word) return verb.run ? verb.run(argc - 1, argv + 1) : become_program(word, argv + 1);
  return unknown_verb(word);
}

}  // namespace
}  // namespace fracfarm::cli

int main(int argc, char** argv) { return fracfarm::cli::run(argc, argv); }
