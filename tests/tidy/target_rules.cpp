#include <algorithm>
#include <regex>
#include <set>

#include "tests/tidy/rules.hpp"

namespace tidy {
namespace {

const SourceFile* find(const Tree& tree, const std::string& path) {
  const auto found = std::find_if(tree.begin(), tree.end(), [&](const SourceFile& file) { return file.path == path; });
  return found == tree.end() ? nullptr : &*found;
}

std::string without_comments(const std::string& cmake) { return std::regex_replace(cmake, std::regex("#[^\n]*"), ""); }

// Words of a command list, as in fracfarm_room(NAME SOURCES a.cpp ...); every command's where `commands` is empty.
std::set<std::string> words_of(const SourceFile& cmake, const std::string& commands) {
  static const std::regex word("[^\\s()\"]+");
  const std::string text = without_comments(cmake.text);
  const std::regex call("(" + commands + ")\\s*\\(([^)]*)\\)");
  std::set<std::string> out;
  for (std::sregex_iterator at(text.begin(), text.end(), call), end; at != end; ++at) {
    const std::string list = (*at)[2];
    for (std::sregex_iterator one(list.begin(), list.end(), word); one != std::sregex_iterator(); ++one) out.insert(one->str());
  }
  return out;
}

// The CMakeLists.txt of a folder or of the nearest one above it, and the path from there.
std::pair<const SourceFile*, std::string> owner_of(const Tree& tree, const SourceFile& file) {
  for (std::filesystem::path folder = file.folder(); !folder.empty(); folder = folder.parent_path())
    if (const SourceFile* cmake = find(tree, (folder / "CMakeLists.txt").generic_string()))
      return {cmake, std::filesystem::path(file.path).lexically_relative(folder).generic_string()};
  return {nullptr, {}};
}

bool builds(const SourceFile& cmake, const std::string& name, bool test) {
  if (words_of(cmake, "fracfarm_room|fracfarm_kernels|add_library|add_executable|target_sources").contains(name)) return true;
  return test && words_of(cmake, "fracfarm_tests").contains(name);
}

void check_sources(const Tree& tree, Violations& out) {
  for (const SourceFile& file : tree) {
    if (!file.ends_with(".cpp")) continue;
    const auto [cmake, name] = owner_of(tree, file);
    if (!cmake)
      out.push_back({file.path, 0, "no CMakeLists.txt builds it"});
    else if (!builds(*cmake, name, file.under("tests")))
      out.push_back(
          {file.path, 0, "is in no target of " + cmake->path + (file.under("tests") ? ": a test that never runs" : ": an orphan")});
    else if (file.ends_with("_test.cpp") && !words_of(*cmake, "fracfarm_tests").contains(name))
      out.push_back({file.path, 0, "is built but in no fracfarm_tests row of " + cmake->path + ": a test that never runs"});
  }
}

void check_folders(const Tree& tree, Violations& out) {
  for (const SourceFile& file : tree) {
    if (!file.ends_with("/CMakeLists.txt")) continue;
    const std::filesystem::path folder = file.folder();
    const SourceFile* above = find(tree, (folder.parent_path() / "CMakeLists.txt").generic_string());
    if (!above || !words_of(*above, "add_subdirectory").contains(folder.filename().string()))
      out.push_back({file.path, 0, "is not reached by add_subdirectory(" + folder.filename().string() + ") of the folder above"});
  }
}

void check_headers(const Tree& tree, Violations& out) {
  for (const SourceFile& header : tree) {
    if (!header.ends_with(".hpp")) continue;
    const std::string include = "#include \"" + header.path + "\"";
    if (std::none_of(tree.begin(), tree.end(),
                     [&](const SourceFile& file) { return file.code() && file.text.find(include) != std::string::npos; }))
      out.push_back({header.path, 0, "is included by nobody: an orphan"});
  }
}

}  // namespace

Violations check_targets(const Tree& tree) {
  Violations out;
  check_sources(tree, out);
  check_folders(tree, out);
  check_headers(tree, out);
  return out;
}

}  // namespace tidy
