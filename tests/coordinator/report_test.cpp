#include "coordinator/report.hpp"

#include <catch2/catch.hpp>

using namespace fracfarm;

namespace {

ReportPage page_of_two() {
  ReportPage page;
  page.title = "demo <1 & 2>";
  page.counts = {{"done", 2}, {"ready", 0}};
  page.runs = {{1, "pbx", "uniaxial", "orthogonal 1", Verdict::failed, 443e-6, "through_crack", 6.9e6, 800, 0.1},
               {2, "granite", "biaxial", "orthogonal 1", Verdict::censored, std::nullopt, "horizon", 7.7e6, 900, 0.3}};
  page.pictures[1] = {"initial bytes", "failure bytes", {{0.0, 0.0}, {1e-4, 6.9e6}, {2e-4, 0.0}}};
  return page;
}

std::size_t count(const std::string& text, std::string_view word) {
  std::size_t found = 0;
  for (std::size_t at = text.find(word); at != text.npos; at = text.find(word, at + 1)) ++found;
  return found;
}

}  // namespace

TEST_CASE("the report shows every run once in its table, with its numbers in people's units") {
  const std::string html = report_html(page_of_two());
  CHECK(count(html, "443.0 µs") == 4);  // grid, dot, class mean, table
  CHECK(count(html, "7.7 MPa") == 2);   // class mean, table
  CHECK(html.find("<td class=n>2<td>granite<td>biaxial<td>orthogonal 1<td>censored<td class=n>–") != html.npos);
}

TEST_CASE("the report is self-contained and escapes what it did not write") {
  const std::string html = report_html(page_of_two());
  CHECK(html.find("demo &lt;1 &amp; 2&gt;") != html.npos);
  CHECK(count(html, "src='data:image/png;base64,") == 2);
  CHECK(html.find("http") == html.npos);
  CHECK(html.find("<script") == html.npos);
}

TEST_CASE("a campaign with nothing done still makes a page") {
  ReportPage page;
  page.title = "empty";
  CHECK(report_html(page).find("</html>") != std::string::npos);
}
