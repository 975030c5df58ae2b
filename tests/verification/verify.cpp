// fracfarm-verify: runs the benchmark rows and prints the table as text, Markdown or JSON. Ends with status 1 where a row misses.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "common/base/exit_code.hpp"
#include "common/base/terminal.hpp"
#include "tests/verification/cases.hpp"

namespace fracfarm::verification {
namespace {

struct Done {
  const Case* which;
  std::vector<Row> rows;
  double seconds;
};

std::vector<Done> run(std::span<const std::string_view> wanted) {
  std::vector<Done> done;
  for (const Case& one : cases()) {
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), one.id) == wanted.end()) continue;
    const auto begin = std::chrono::steady_clock::now();
    std::vector<Row> rows = one.run();
    done.push_back({&one, std::move(rows), std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count()});
  }
  return done;
}

std::string number(double value) { return fmt::format("{:.6g}", value); }

std::vector<std::vector<std::string>> cells(const std::vector<Done>& done) {
  std::vector<std::vector<std::string>> table{{"id", "what", "target", "ours", "unit", "error", "allowed", "verdict", "note"}};
  for (const Done& one : done)
    for (const Row& row : one.rows)
      table.push_back({std::string(one.which->id), row.what, number(row.target), number(row.ours), row.unit,
                       fmt::format("{:.1e}", row.error), fmt::format("{:.1e}", row.tolerance), row.passed ? "pass" : "MISS", row.note});
  return table;
}

void print_markdown(const std::vector<Done>& done) {
  bool heading = true;
  for (const auto& row : cells(done)) {
    for (const std::string& cell : row) fmt::print("| {} ", cell);
    fmt::print("|\n");
    if (heading) fmt::print("|---|---|---:|---:|---|---:|---:|---|---|\n");
    heading = false;
  }
}

void print_json(const std::vector<Done>& done) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Done& one : done)
    for (const Row& row : one.rows)
      list.push_back({{"id", one.which->id},
                      {"title", one.which->title},
                      {"source", one.which->source},
                      {"what", row.what},
                      {"unit", row.unit},
                      {"target", row.target},
                      {"ours", row.ours},
                      {"error", row.error},
                      {"tolerance", row.tolerance},
                      {"passed", row.passed},
                      {"note", row.note},
                      {"case_seconds", one.seconds}});
  fmt::print("{}\n", nlohmann::ordered_json{{"schema", "fracfarm.verification/1"}, {"rows", list}}.dump(2));
}

void print_text(const std::vector<Done>& done) {
  fmt::print("{}\n", table_text(cells(done)));
  for (const Done& one : done) fmt::print("{:<6} {:<30} {:6.2f} s   {}\n", one.which->id, one.which->title, one.seconds, one.which->source);
}

}  // namespace
}  // namespace fracfarm::verification

int main(int argc, char** argv) {
  using namespace fracfarm::verification;
  std::string_view format = "text";
  std::vector<std::string_view> wanted;
  for (int k = 1; k < argc; ++k) {
    const std::string_view word = argv[k];
    if (word == "--json" || word == "--markdown") {
      format = word.substr(2);
    } else if (std::any_of(cases().begin(), cases().end(), [&](const Case& one) { return one.id == word; })) {
      wanted.push_back(word);
    } else {
      fmt::print(stderr, "usage: fracfarm-verify [--json | --markdown] [ID ...]\nids:");
      for (const Case& one : cases()) fmt::print(stderr, " {}", one.id);
      fmt::print(stderr, "\n");
      return word == "--help" ? fracfarm::exit_ok : fracfarm::exit_bad_input;
    }
  }
  const auto done = run(wanted);
  format == "json" ? print_json(done) : format == "markdown" ? print_markdown(done) : print_text(done);
  for (const auto& one : done)
    for (const Row& row : one.rows)
      if (!row.passed) return fracfarm::exit_failed;
  return fracfarm::exit_ok;
}
