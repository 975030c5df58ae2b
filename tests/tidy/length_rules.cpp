#include <algorithm>
#include <map>
#include <regex>

#include "tests/tidy/rules.hpp"

namespace tidy {
namespace {

constexpr std::size_t most_file_lines = 400;
constexpr std::size_t most_function_lines = 60;

// Holds lengths against the limit and the listed exceptions; a listed length that is no longer needed must come off the list.
class Ratchet {
 public:
  Ratchet(std::string_view exceptions, std::string list, std::size_t most, std::string noun)
      : list_(std::move(list)), most_(most), noun_(std::move(noun)) {
    for (const auto& row : ratchet_rows(exceptions))
      if (row.size() >= 2) allowed_[row[0]] = std::stoul(row[1]);
  }

  // what: path, or path:function.
  void hold(const std::string& what, const std::string& path, std::size_t line, std::size_t length, Violations& out) {
    const auto row = allowed_.find(what);
    const std::size_t allowed = row == allowed_.end() ? most_ : row->second;
    if (row != allowed_.end()) seen_.push_back(what);
    const std::string size = noun_ + " of " + std::to_string(length) + " lines";
    if (length > allowed)
      out.push_back({path, line, what + ": " + size + ", at most " + std::to_string(allowed) + ": split it"});
    else if (row != allowed_.end() && length < allowed)
      out.push_back({path, line, what + ": " + size + " has shrunk from " + std::to_string(allowed) + ": say so in " + list_});
  }

  void finish(Violations& out) const {
    for (const auto& [what, lines] : allowed_)
      if (std::find(seen_.begin(), seen_.end(), what) == seen_.end())
        out.push_back({list_, 0, what + " is not there (any more): remove its row"});
  }

 private:
  std::map<std::string, std::size_t> allowed_;
  std::vector<std::string> seen_;
  std::string list_;
  std::size_t most_;
  std::string noun_;
};

struct Function {
  std::string name;
  std::size_t line, length;
};

// What stands before an opening brace, back to the last statement or brace.
std::string_view head_before(std::string_view code, std::size_t brace) {
  const std::size_t cut = code.find_last_of(";{}", brace == 0 ? 0 : brace - 1);
  const std::size_t start = brace == 0 || cut == std::string_view::npos ? 0 : cut + 1;
  return code.substr(start, brace - start);
}

// A scope whose inside may hold functions again: a namespace, a type, extern "C".
bool holds_functions(std::string_view head) {
  static const std::regex scope(R"re(\b(namespace|struct|class|union|extern)\b)re");
  return std::regex_search(head.begin(), head.end(), scope) && head.find('(') == std::string_view::npos;
}

// Where the parameters begin: the first parenthesis that is in no template argument.
std::size_t parameters(std::string_view head) {
  int depth = 0;
  for (std::size_t i = 0; i < head.size(); ++i) {
    depth += head[i] == '<' ? 1 : head[i] == '>' ? -1 : 0;
    if (head[i] == '(' && depth <= 0) return i;
  }
  return head.find('(');
}

// The word before the parameters, with its qualifier; empty where the head is no function's.
std::string function_name(std::string_view head) {
  const std::size_t end = parameters(head);
  if (end == std::string_view::npos) return {};
  if (head.find('=') < end && head.find("operator") == std::string_view::npos) return {};  // the value of a variable
  static const std::regex word(R"re(([A-Za-z_~][A-Za-z0-9_:~]*|operator[^(]*)\s*$)re");
  const std::string before(head.substr(0, end));
  std::smatch found;
  return std::regex_search(before, found, word) ? found[1].str() : "";
}

std::size_t closing(std::string_view code, std::size_t brace) {
  int depth = 0;
  for (std::size_t i = brace; i < code.size(); ++i) {
    depth += code[i] == '{' ? 1 : code[i] == '}' ? -1 : 0;
    if (depth == 0) return i;
  }
  return code.size();
}

// Braces before a constructor's body, as in S::S(int a) : a_{a} {: what follows them tells.
bool is_initialiser(std::string_view code, std::size_t end) {
  const std::size_t next = end + 1 < code.size() ? code.find_first_not_of(" \n", end + 1) : std::string_view::npos;
  return next != std::string_view::npos && (code[next] == ',' || code[next] == '{');
}

// Outermost functions by braces alone: good enough for formatted code, and a lambda counts with the function around it.
std::vector<Function> functions_of(const std::string& text) {
  std::string code = only_code(text);
  std::vector<Function> out;
  for (std::size_t i = 0; i < code.size(); ++i) {
    if (code[i] != '{') continue;
    const std::string_view head = head_before(code, i);
    if (holds_functions(head)) continue;
    const std::size_t end = closing(code, i);
    if (is_initialiser(code, end)) {
      std::replace_if(
          code.begin() + static_cast<std::ptrdiff_t>(i), code.begin() + static_cast<std::ptrdiff_t>(end) + 1,
          [](char c) { return c != '\n'; }, ' ');
      continue;
    }
    if (const std::string name = function_name(head); !name.empty()) {
      const std::size_t start = i - head.size() + head.find_first_not_of(" \n");
      out.push_back({name, static_cast<std::size_t>(1 + std::count(code.begin(), code.begin() + static_cast<std::ptrdiff_t>(start), '\n')),
                     static_cast<std::size_t>(1 + std::count(code.begin() + static_cast<std::ptrdiff_t>(start),
                                                             code.begin() + static_cast<std::ptrdiff_t>(end), '\n'))});
    }
    i = end;
  }
  return out;
}

}  // namespace

Violations check_file_lengths(const Tree& tree, std::string_view exceptions) {
  Violations out;
  Ratchet ratchet(exceptions, "tests/tidy/long_files.txt", most_file_lines, "file");
  for (const SourceFile& file : tree)
    if (file.code()) ratchet.hold(file.path, file.path, 0, lines_of(file.text).size(), out);
  ratchet.finish(out);
  return out;
}

Violations check_function_lengths(const Tree& tree, std::string_view exceptions) {
  Violations out;
  Ratchet ratchet(exceptions, "tests/tidy/long_functions.txt", most_function_lines, "function");
  for (const SourceFile& file : tree) {
    if (!file.code()) continue;
    std::map<std::string, Function> longest;  // overloads, and tests, share a name
    for (const Function& function : functions_of(file.text))
      if (const auto [at, first] = longest.try_emplace(function.name, function); !first && at->second.length < function.length)
        at->second = function;
    for (const auto& [name, function] : longest) ratchet.hold(file.path + ":" + name, file.path, function.line, function.length, out);
  }
  ratchet.finish(out);
  return out;
}

}  // namespace tidy
