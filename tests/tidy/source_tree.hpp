// The project's own text files in memory, and what a rule says of them. Reads only; knows no rule.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tidy {

struct SourceFile {
  std::string path;  // from the top of the project, with /
  std::string text;

  bool ends_with(std::string_view tail) const { return path.ends_with(tail); }
  bool code() const { return ends_with(".cpp") || ends_with(".hpp"); }
  bool under(std::string_view folder) const { return path.starts_with(std::string(folder) + "/"); }
  std::string folder() const { return std::filesystem::path(path).parent_path().string(); }
};

using Tree = std::vector<SourceFile>;

struct Violation {
  std::string path;
  std::size_t line = 0;  // from 1; 0: the file as a whole
  std::string what;      // the rule, the value and the mend
};
using Violations = std::vector<Violation>;

std::string text_of(const Violations& violations);  // one a line, as path:line: what

// Folders with code, deploy, .ci and the files at the top; build folders are not the project's.
Tree read_tree(const std::filesystem::path& top);

std::vector<std::string_view> lines_of(std::string_view text);

// The same text, same length and lines, with comments, strings and character literals blanked out.
std::string only_code(std::string_view text);

// Rows of a ratchet file: words split at blanks, lines that begin with # left out.
std::vector<std::vector<std::string>> ratchet_rows(std::string_view text);

}  // namespace tidy
