#include "coordinator/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <set>

#include "common/base/hash.hpp"
#include "common/base/text.hpp"
#include "common/material/material.hpp"

namespace fracfarm {
namespace {

using Out = std::back_insert_iterator<std::string>;

constexpr std::string_view style = R"(
:root{color-scheme:light dark;--ink:#1a1a1a;--paper:#fcfcfa;--dim:#666;--line:#d8d8d2;--tile:#f1f1ec;--mark:#b3401f}
@media(prefers-color-scheme:dark){:root{--ink:#e8e6e1;--paper:#171716;--dim:#9a9890;--line:#3a3a36;--tile:#222220;--mark:#e8825d}}
body{font:15px/1.45 system-ui,sans-serif;color:var(--ink);background:var(--paper);max-width:75rem;margin:2rem auto;padding:0 1rem}
h1{font-size:1.6rem;margin:0}h2{font-size:1.15rem;margin:2.2rem 0 .6rem}p.dim,td.dim,figcaption{color:var(--dim)}
.tiles{display:flex;flex-wrap:wrap;gap:.6rem;margin:1rem 0}.tile{background:var(--tile);border-radius:.4rem;padding:.5rem .9rem}
.tile b{display:block;font-size:1.3rem;font-variant-numeric:tabular-nums}
.scroll{overflow-x:auto}
table{border-collapse:collapse;font-variant-numeric:tabular-nums}th,td{padding:.2rem .7rem .2rem 0;text-align:left;border-bottom:1px solid var(--line)}
td.n,th.n{text-align:right}
.grid{display:grid;gap:.5rem;align-items:start}.grid .name{font-weight:600;align-self:center}
figure{margin:0}figure img{width:100%;aspect-ratio:1;image-rendering:pixelated;border:1px solid var(--line);display:block}
figcaption{font-size:.78rem;line-height:1.25;margin-top:.15rem}
svg{display:block}svg text{font:11px system-ui,sans-serif;fill:var(--dim)}svg .curve{fill:none;stroke:var(--mark);stroke-width:1.3}
svg .axis{stroke:var(--line)}svg .uniaxial{fill:var(--mark)}svg .biaxial{fill:none;stroke:var(--mark);stroke-width:1.4}
)";

std::string escaped(std::string_view text) {
  std::string out;
  for (char c : text) {
    if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '&')
      out += "&amp;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

std::string time_text(const std::optional<double>& time) { return time ? fmt::format("{:.1f} µs", *time * 1e6) : "–"; }
std::string stress_text(double stress) { return fmt::format("{:.3g} MPa", stress * 1e-6); }

// Materials in the order of the material table, then others by name.
std::vector<std::string> materials_of(const ReportPage& page) {
  std::set<std::string> found;
  for (const ReportRun& run : page.runs) found.insert(run.material);
  std::vector<std::string> ordered;
  for (const Material& material : material_table())
    if (found.erase(material.name)) ordered.push_back(material.name);
  ordered.insert(ordered.end(), found.begin(), found.end());
  return ordered;
}

std::vector<std::string> loads_of(const ReportPage& page) {
  std::set<std::string> found;
  for (const ReportRun& run : page.runs) found.insert(run.load);
  return {found.rbegin(), found.rend()};  // uniaxial before biaxial
}

void tile(Out out, std::string_view value, std::string_view what) {
  fmt::format_to(out, "<div class=tile><b>{}</b>{}</div>", escaped(value), escaped(what));
}

void write_tiles(Out out, const ReportPage& page) {
  double cpu_s = 0.0;
  std::size_t failed = 0;
  for (const ReportRun& run : page.runs) {
    cpu_s += run.cpu_s;
    failed += run.verdict == Verdict::failed;
  }
  fmt::format_to(out, "<div class=tiles>");
  for (const auto& [state, count] : page.counts)
    if (count > 0) tile(out, fmt::format("{}", count), state);
  tile(out, fmt::format("{}", failed), "runs that failed");
  tile(out, fmt::format("{}", page.runs.size() - failed), "runs that held");
  tile(out, duration_text(cpu_s), "CPU time");
  if (!page.runs.empty()) tile(out, duration_text(cpu_s / static_cast<double>(page.runs.size())), "CPU time a run");
  fmt::format_to(out, "</div>\n");
}

// Mean stress against time as a small curve, from 0 to the run's end, 0 to its peak.
void write_curve(Out out, const std::vector<std::pair<double, double>>& stress) {
  if (stress.size() < 2) return;
  double peak = 0.0;
  for (const auto& [time, value] : stress) peak = std::max(peak, value);
  const double end = stress.back().first;
  if (!(peak > 0.0 && end > 0.0)) return;
  fmt::format_to(out, "<svg viewBox='0 0 100 30' width='100%' role=img aria-label='mean stress over time'><polyline class=curve points='");
  for (const auto& [time, value] : stress)
    fmt::format_to(out, "{:.1f},{:.1f} ", 100.0 * time / end, 29.0 - 28.0 * std::max(0.0, value) / peak);
  fmt::format_to(out, "'/></svg>");
}

void write_picture(Out out, const std::string& png, std::string_view alt) {
  fmt::format_to(out, "<img alt='{}' src='data:image/png;base64,{}'>", escaped(alt), base64(png));
}

void write_cell(Out out, const ReportPage& page, const ReportRun* run) {
  const auto picture = run ? page.pictures.find(run->job) : page.pictures.end();
  if (picture == page.pictures.end()) {
    fmt::format_to(out, "<figure><figcaption>not there yet</figcaption></figure>");
    return;
  }
  fmt::format_to(out, "<figure>");
  write_picture(out, picture->second.failure_png, fmt::format("crack pattern at the end of job {}", run->job));
  write_curve(out, picture->second.stress);
  fmt::format_to(out, "<figcaption>{} · {}<br>{}, job {}</figcaption></figure>\n", time_text(run->time_to_failure),
                 stress_text(run->peak_stress), escaped(run->rule), run->job);
}

// One load: a row for each of the first patterns, its initial cracks and then a column for each material.
void write_grid(Out out, const ReportPage& page, const std::string& load) {
  std::vector<std::string> patterns;
  std::map<std::pair<std::string, std::string>, const ReportRun*> cells;  // pattern, material
  for (const ReportRun& run : page.runs) {
    if (run.load != load || !page.pictures.contains(run.job)) continue;
    if (std::find(patterns.begin(), patterns.end(), run.pattern) == patterns.end()) patterns.push_back(run.pattern);
    cells[{run.pattern, run.material}] = &run;
  }
  if (patterns.empty()) return;
  patterns.resize(std::min(patterns.size(), report_max_patterns));
  const std::vector<std::string> materials = materials_of(page);
  fmt::format_to(out, "<h2>{} tension: initial cracks and the pattern at failure</h2><div class=scroll>", escaped(load));
  fmt::format_to(out, "<div class=grid style='grid-template-columns:repeat({},minmax(8rem,12rem))'>\n<div class=name>initial</div>",
                 materials.size() + 1);
  for (const std::string& material : materials) fmt::format_to(out, "<div class=name>{}</div>", escaped(material));
  for (const std::string& pattern : patterns) {
    const ReportRun* first = cells.lower_bound({pattern, ""})->second;
    fmt::format_to(out, "\n<figure>");
    write_picture(out, page.pictures.at(first->job).initial_png, "initial cracks");
    fmt::format_to(out, "<figcaption>{}</figcaption></figure>\n", escaped(pattern));
    for (const std::string& material : materials) {
      const auto cell = cells.find({pattern, material});
      write_cell(out, page, cell == cells.end() ? nullptr : cell->second);
    }
  }
  fmt::format_to(out, "</div></div>\n");
}

// A dot for each failed run on a logarithmic time axis, a line for each material; filled: uniaxial, open: biaxial.
void write_strip(Out out, const ReportPage& page) {
  double low = 1e300, high = 0.0;
  for (const ReportRun& run : page.runs)
    if (run.time_to_failure && *run.time_to_failure > 0.0) {
      low = std::min(low, *run.time_to_failure);
      high = std::max(high, *run.time_to_failure);
    }
  if (!(high > 0.0)) return;
  const double from = std::floor(std::log10(low) * 4.0) / 4.0, to = std::max(from + 0.25, std::ceil(std::log10(high) * 4.0) / 4.0);
  const auto x_of = [&](double time) { return 90.0 + 640.0 * (std::log10(time) - from) / (to - from); };
  const std::vector<std::string> materials = materials_of(page);
  const double height = 26.0 * static_cast<double>(materials.size()) + 30.0;
  fmt::format_to(out,
                 "<h2>Time to failure</h2><p class=dim>Logarithmic; filled dots uniaxial, open dots biaxial.</p><div class=scroll><svg "
                 "viewBox='0 0 760 {0}' width='760' height='{0}'>",
                 height);
  for (double mark : {1e-5, 2e-5, 5e-5, 1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3}) {
    if (std::log10(mark) < from - 1e-9 || std::log10(mark) > to + 1e-9) continue;
    fmt::format_to(
        out, "<line class=axis x1='{0:.1f}' x2='{0:.1f}' y1='0' y2='{1}'/><text x='{0:.1f}' y='{2}' text-anchor='middle'>{3:.0f} µs</text>",
        x_of(mark), height - 24.0, height - 8.0, mark * 1e6);
  }
  for (std::size_t row = 0; row < materials.size(); ++row) {
    const double y = 16.0 + 26.0 * static_cast<double>(row);
    fmt::format_to(out, "<text x='0' y='{}'>{}</text>", y + 4.0, escaped(materials[row]));
    for (const ReportRun& run : page.runs)
      if (run.material == materials[row] && run.time_to_failure && *run.time_to_failure > 0.0)
        fmt::format_to(out, "<circle class='{}' cx='{:.1f}' cy='{}' r='4'><title>job {}: {}</title></circle>",
                       run.load == "biaxial" ? "biaxial" : "uniaxial", x_of(*run.time_to_failure), y + (run.load == "biaxial" ? 5.0 : -3.0),
                       run.job, time_text(run.time_to_failure));
  }
  fmt::format_to(out, "</svg></div>\n");
}

struct Statistic {
  std::size_t runs = 0, failed = 0;
  double time = 0.0, peak = 0.0, cpu_s = 0.0;
};

void write_classes(Out out, const ReportPage& page) {
  fmt::format_to(out,
                 "<h2>By material and load</h2><div class=scroll><table><tr><th>material<th>load<th class=n>runs<th class=n>failed<th "
                 "class=n>mean time to failure<th class=n>mean peak stress<th class=n>CPU a run</tr>\n");
  for (const std::string& material : materials_of(page))
    for (const std::string& load : loads_of(page)) {
      Statistic sum;
      for (const ReportRun& run : page.runs) {
        if (run.material != material || run.load != load) continue;
        ++sum.runs;
        sum.peak += run.peak_stress;
        sum.cpu_s += run.cpu_s;
        if (!run.time_to_failure) continue;
        ++sum.failed;
        sum.time += *run.time_to_failure;
      }
      if (sum.runs == 0) continue;
      const double runs = static_cast<double>(sum.runs);
      const std::optional<double> mean = sum.failed ? std::optional(sum.time / static_cast<double>(sum.failed)) : std::nullopt;
      fmt::format_to(out, "<tr><td>{}<td>{}<td class=n>{}<td class=n>{}<td class=n>{}<td class=n>{}<td class=n>{}</tr>\n",
                     escaped(material), escaped(load), sum.runs, sum.failed, time_text(mean), stress_text(sum.peak / runs),
                     duration_text(sum.cpu_s / runs));
    }
  fmt::format_to(out, "</table></div>\n");
}

void write_runs(Out out, const ReportPage& page) {
  fmt::format_to(out,
                 "<h2>Every run</h2><div class=scroll><table><tr><th class=n>job<th>material<th>load<th>pattern<th>verdict<th class=n>time "
                 "to failure<th>by<th class=n>peak stress<th class=n>steps<th class=n>CPU</tr>\n");
  for (const ReportRun& run : page.runs)
    fmt::format_to(
        out, "<tr><td class=n>{}<td>{}<td>{}<td>{}<td>{}<td class=n>{}<td class=dim>{}<td class=n>{}<td class=n>{}<td class=n>{}</tr>\n",
        run.job, escaped(run.material), escaped(run.load), escaped(run.pattern), name_of(run.verdict), time_text(run.time_to_failure),
        escaped(run.rule), stress_text(run.peak_stress), run.steps, duration_text(run.cpu_s));
  fmt::format_to(out, "</table></div>\n");
  if (page.runs_left_out)
    fmt::format_to(out, "<p class=dim>{} more runs are in the ledger; fracfarm jobs lists them.</p>\n", page.runs_left_out);
}

void write_faults(Out out, const ReportPage& page) {
  if (page.faults.empty()) return;
  fmt::format_to(out, "<h2>Faults</h2><table><tr><th>class<th class=n>attempts</tr>\n");
  for (const auto& [fault, count] : page.faults) fmt::format_to(out, "<tr><td>{}<td class=n>{}</tr>\n", escaped(fault), count);
  fmt::format_to(out, "</table>\n");
}

}  // namespace

std::string report_html(const ReportPage& page) {
  std::string html;
  const Out out(html);
  fmt::format_to(out,
                 "<!doctype html><html lang=en><meta charset=utf-8><meta name=viewport "
                 "content='width=device-width'><title>{}</title><style>{}</style>\n",
                 escaped(page.title), style);
  fmt::format_to(out, "<h1>{}</h1><p class=dim>{} · solver build {}</p>\n", escaped(page.title), escaped(page.generated),
                 escaped(page.build_id));
  write_tiles(out, page);
  for (const std::string& load : loads_of(page)) write_grid(out, page, load);
  write_strip(out, page);
  write_classes(out, page);
  write_faults(out, page);
  write_runs(out, page);
  fmt::format_to(out, "</html>\n");
  return html;
}

}  // namespace fracfarm
