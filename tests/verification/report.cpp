#include "tests/verification/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace fracfarm::verification {
namespace {

std::string number(double value) { return fmt::format("{:.6g}", value); }
std::string wanted(const Row& row) { return !row.judged ? "–" : row.wanted.empty() ? number(row.target) : row.wanted; }
std::string error(const Row& row) { return row.judged ? fmt::format("{:.1e}", row.error) : "–"; }
std::string allowed(const Row& row) { return row.judged ? fmt::format("{:.1e}", row.tolerance) : "–"; }

std::string verdict(const Row& row) { return !row.judged ? "report" : row.passed ? "pass" : "MISS"; }

// How near a row comes to its limit; a miss is nearer than any pass.
double strain(const Row& row) {
  if (!row.judged) return -1.0;
  const double share = row.tolerance > 0.0 ? row.error / row.tolerance : row.error > 0.0 ? 2.0 : 0.0;
  return row.passed ? std::min(share, 1.0) : 1.0 + (std::isfinite(share) ? share : 1e300);
}

const Row* hardest(const Done& one) {
  const auto worst = std::max_element(one.rows.begin(), one.rows.end(), [](const Row& a, const Row& b) { return strain(a) < strain(b); });
  return worst == one.rows.end() ? nullptr : &*worst;
}

std::string line(std::initializer_list<std::string> cells) {
  std::string out = "|";
  for (std::string cell : cells) {
    for (std::size_t at = 0; (at = cell.find('|', at)) != std::string::npos; at += 2) cell.insert(at, "\\");
    out += fmt::format(" {} |", cell);
  }
  return out + "\n";
}

std::string tally(const Done& one) {
  const auto judged = std::count_if(one.rows.begin(), one.rows.end(), [](const Row& row) { return row.judged; });
  const auto passed = std::count_if(one.rows.begin(), one.rows.end(), [](const Row& row) { return row.judged && row.passed; });
  return judged == 0        ? "report"
         : passed == judged ? fmt::format("pass {}/{}", passed, judged)
                            : fmt::format("**MISS** {}/{}", passed, judged);
}

std::string summary(const std::vector<Done>& done) {
  std::string out = line({"id", "case", "row nearest to its limit", "target", "ours", "unit", "error", "allowed", "seconds", "rows met"});
  out += "|---|---|---|---:|---:|---|---:|---:|---:|---|\n";
  for (const Done& one : done)
    if (const Row* row = hardest(one))
      out += line({std::string(one.which->id), std::string(one.which->title), row->what, wanted(*row), number(row->ours), row->unit,
                   error(*row), allowed(*row), fmt::format("{:.1f}", one.seconds), tally(one)});
  return out;
}

std::string section(const Done& one, const std::string& pictures) {
  std::string out = fmt::format("\n## {} {}\n\nTarget: {}. {:.1f} s.\n", one.which->id, one.which->title, one.which->source, one.seconds);
  if (!one.which->set_up.empty()) out += fmt::format("\n{}\n", one.which->set_up);
  out += "\n" + line({"what", "target", "ours", "unit", "error", "allowed", "verdict", "note"}) + "|---|---:|---:|---|---:|---:|---|---|\n";
  for (const Row& row : one.rows)
    out += line(
        {row.what, wanted(row), number(row.ours), row.unit, error(row), allowed(row), row.passed ? verdict(row) : "**MISS**", row.note});
  if (!pictures.empty())
    for (const Picture& picture : one.pictures)
      out += fmt::format("\n{}\n\n![{}]({}/{}.png)\n", picture.caption, picture.name, pictures, picture.name);
  return out;
}

}  // namespace

bool Done::passed() const {
  return std::all_of(rows.begin(), rows.end(), [](const Row& row) { return row.passed; });
}

std::string text_report(const std::vector<Done>& done) {
  std::vector<std::vector<std::string>> table{{"id", "what", "target", "ours", "unit", "error", "allowed", "verdict", "note"}};
  for (const Done& one : done)
    for (const Row& row : one.rows)
      table.push_back({std::string(one.which->id), row.what, wanted(row), number(row.ours), row.unit, error(row), allowed(row),
                       verdict(row), row.note});
  std::string out = table_text(table) + "\n";
  for (const Done& one : done)
    out += fmt::format("{:<6} {:<42} {:7.2f} s   {}\n", one.which->id, one.which->title, one.seconds, one.which->source);
  return out;
}

std::string json_report(const std::vector<Done>& done) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Done& one : done)
    for (const Row& row : one.rows)
      list.push_back({{"id", one.which->id},
                      {"title", one.which->title},
                      {"source", one.which->source},
                      {"what", row.what},
                      {"unit", row.unit},
                      {"target", row.target},
                      {"wanted", wanted(row)},
                      {"ours", row.ours},
                      {"error", row.error},
                      {"tolerance", row.tolerance},
                      {"judged", row.judged},
                      {"passed", row.passed},
                      {"note", row.note},
                      {"case_seconds", one.seconds}});
  return nlohmann::ordered_json{{"schema", "fracfarm.verification/1"}, {"rows", list}}.dump(2) + "\n";
}

std::string page_report(const std::vector<Done>& done, const std::string& pictures) {
  std::string out =
      "# Verification\n\nWritten by `sh deploy/verify.sh`; `fracfarm-verify ID` runs one case, `fracfarm-verify` alone the fast ones, "
      "which every build runs as "
      "a test. Each case below says where its target comes from, how it is set up, and every row with its error; a row that misses stays, "
      "with its reason. A "
      "*report* is a figure that has no target.\n\n<!-- summary -->\n\n" +
      summary(done) + "\n<!-- end of summary -->\n";
  for (const Done& one : done) out += section(one, pictures);
  return out;
}

}  // namespace fracfarm::verification
