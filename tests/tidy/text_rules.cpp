#include <algorithm>
#include <regex>

#include "tests/tidy/rules.hpp"

namespace tidy {
namespace {

constexpr std::size_t most_columns = 160;

// Words that must not stand in files whose path begins so. The patterns are written in two pieces where they would find themselves.
struct Ban {
  std::string pattern;
  std::string where;  // beginning of the path; empty: everywhere
  std::string why;
};

const std::vector<Ban>& bans() {
  static const std::string random = "\\bstd::(mt19937|minstd_rand|default_random_engine|[a-z_]+_distribution)";
  static const std::vector<Ban> table{
      {"\\b(FIX"
       "ME|TO"
       "DO|XX"
       "X)\\b",
       "", "finish it, or write down what is left where people plan"},
      {"(^|[^A-Za-z0-9_.\\-/])/(wo"
       "rk|ro"
       "ot|ho"
       "me)(/|\\b)",
       "", "a path of one machine"},
      {"-ff"
       "ast-math|-Of"
       "ast|-ffp-contract=f"
       "ast",
       "", "the same bits always: no option that reorders arithmetic"},
      {"\\b(s?rand|drand48)\\s*\\(", "", "randomness only from RandomStream"},
      {random, "common/", "randomness only from RandomStream: std distributions differ between libraries"},
      {random, "solver/", "randomness only from RandomStream: std distributions differ between libraries"},
      {random, "worker/", "randomness only from RandomStream: std distributions differ between libraries"},
      {random, "coordinator/", "randomness only from RandomStream: std distributions differ between libraries"},
      {"\\bstd::(cout|cerr)\\b", "common/", "libraries print nothing: they give values and results"},
      {"\\bstd::(cout|cerr)\\b", "solver/", "libraries print nothing: they give values and results"},
      {"\\bomp atomic\\b|std::atomic<(double|float)>", "solver/", "sums in a fixed order, no floating-point atomics"},
  };
  return table;
}

bool limited_columns(const SourceFile& file) { return !file.ends_with(".md") && !file.ends_with("packages.txt"); }

// UTF-8 continuation bytes take no column.
std::size_t columns(std::string_view line) {
  return static_cast<std::size_t>(
      std::count_if(line.begin(), line.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0u) != 0x80u; }));
}

void check_lines(const SourceFile& file, Violations& out) {
  std::size_t number = 0;
  for (const std::string_view line : lines_of(file.text)) {
    ++number;
    if (limited_columns(file) && columns(line) > most_columns)
      out.push_back({file.path, number, std::to_string(columns(line)) + " columns, at most " + std::to_string(most_columns)});
    if (line.find('\t') != std::string_view::npos) out.push_back({file.path, number, "a tab: use blanks"});
    if (line.ends_with('\r')) out.push_back({file.path, number, "a carriage return at the end of the line"});
  }
}

void check_bans(const SourceFile& file, Violations& out) {
  for (const Ban& ban : bans()) {
    if (!file.path.starts_with(ban.where)) continue;
    const std::regex pattern(ban.pattern);
    std::size_t number = 0;
    for (const std::string_view line : lines_of(file.text)) {
      ++number;
      std::match_results<std::string_view::const_iterator> found;
      if (std::regex_search(line.begin(), line.end(), found, pattern))
        out.push_back({file.path, number, "'" + found.str() + "': " + ban.why});
    }
  }
}

void check_opening(const SourceFile& file, Violations& out) {
  if (!file.ends_with(".hpp")) return;
  const std::vector<std::string_view> lines = lines_of(file.text);
  std::size_t comment = 0;
  while (comment < lines.size() && lines[comment].starts_with("//")) ++comment;
  if (comment == 0) out.push_back({file.path, 1, "opens without a comment that says what the file is for"});
  if (comment == lines.size() || lines[comment] != "#pragma once")
    out.push_back({file.path, comment + 1, "#pragma once must follow the opening comment"});
}

}  // namespace

Violations check_text(const Tree& tree) {
  Violations out;
  for (const SourceFile& file : tree) {
    check_lines(file, out);
    check_bans(file, out);
    check_opening(file, out);
    if (!file.text.empty() && !file.text.ends_with('\n')) out.push_back({file.path, 0, "does not end with a line break"});
  }
  return out;
}

}  // namespace tidy
