#include "common/picture/record_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "common/picture/panels.hpp"
#include "common/picture/plot.hpp"

namespace fracfarm::picture {
namespace {

constexpr int head_height = 92, plot_height = 330;
constexpr double visible_share = 0.05;  // of the largest energy

const MethodPage* page_of(std::string_view method) {
  static const std::array<MethodPage, 2> pages{phase_field_page(), fdem_page()};
  const auto found = std::find_if(pages.begin(), pages.end(), [&](const MethodPage& page) { return page.method == method; });
  return found == pages.end() ? nullptr : &*found;
}

std::string words(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

std::string title_of(const Record& r) {
  const std::string sample = r.sample_id ? fmt::format(" · sample {}", r.sample_id) : "";
  return fmt::format("{} · {}{}", r.material, r.boundary_condition, sample);
}

std::string verdict_of(const Record& r) {
  const Judgement& j = r.judgement;
  if (!j.time_to_failure) return fmt::format("{}: no failure by {}", name_of(j.verdict), words(j.rule));
  return fmt::format("{} at {} by {}, confidence {:.2f}", name_of(j.verdict), in_units(*j.time_to_failure, "s"), words(j.rule),
                     j.confidence);
}

std::string facts_of(const Record& r, const std::string& body) {
  return fmt::format("peak stress {} · {}{}{} cracks · energy closed to {:.2g} % · key {:.12}", in_units(r.peak_stress, "Pa"), body,
                     body.empty() ? "" : " · ", r.cracks.size(), 100.0 * r.energy_residual, r.key);
}

std::vector<Mark> marks_of(const Record& r) {
  std::vector<Mark> marks;
  for (const FailureTime& candidate : r.failure_times)
    if (candidate.time) marks.push_back({words(candidate.rule), *candidate.time, candidate.rule == r.judgement.rule ? red : purple});
  return marks;
}

Plot stress_plot(const Record& r) {
  Plot plot{"Mean stress", {"time", "s"}, {"stress", "Pa"}, {}, marks_of(r)};
  const auto time = r.series["step_time"];
  plot.curves.push_back({"vertical", blue, time, r.series["stress_zz"]});
  if (const Column* horizontal = r.series.find("stress_xx")) plot.curves.push_back({"horizontal", orange, time, horizontal->values});
  return plot;
}

double largest(const Column& column) {
  double most = 0.0;
  for (double value : column.values) most = std::max(most, std::abs(value));
  return most;
}

Plot energy_plot(const Record& r, const std::vector<EnergyCurve>& energies) {
  Plot plot{"Energy", {"time", "s"}, {"energy", "J/m"}, {}, {}};
  const auto column_of = [&](const EnergyCurve& curve) { return r.series.find(curve.column); };
  double most = 0.0;
  for (const EnergyCurve& curve : energies)
    if (const Column* column = column_of(curve)) most = std::max(most, largest(*column));
  for (const EnergyCurve& curve : energies)
    if (const Column* column = column_of(curve); column && (curve.even_if_small || largest(*column) >= visible_share * most))
      plot.curves.push_back({std::string(curve.name), curve.colour, r.series["step_time"], column->values});
  return plot;
}

}  // namespace

std::string in_units(double value, std::string_view unit) {
  const Prefix prefix = prefix_for(std::abs(value));
  const double scaled = value / prefix.factor;
  return fmt::format("{:.{}f} {}{}", scaled,
                     std::abs(scaled) < 9.995   ? 2
                     : std::abs(scaled) < 99.95 ? 1
                                                : 0,
                     prefix.sign, unit);  // 3 digits
}

std::string failure_caption(const Record& r) {
  return r.judgement.time_to_failure ? "failure, " + in_units(*r.judgement.time_to_failure, "s") : "last state";
}

std::vector<std::size_t> chosen_frames(const Record& r, int count) {
  const std::vector<double>& time = frame_times(r);
  const double end = std::min(time.back(), r.judgement.time_to_failure.value_or(time.back()));
  std::vector<std::size_t> chosen;
  for (int k = 1; k <= count; ++k) {
    const double wanted = end * k / (count + 1);
    const auto nearest =
        std::min_element(time.begin(), time.end(), [&](double a, double b) { return std::abs(a - wanted) < std::abs(b - wanted); });
    const std::size_t frame = static_cast<std::size_t>(nearest - time.begin());
    if (chosen.empty() || chosen.back() != frame) chosen.push_back(frame);
  }
  return chosen;
}

Canvas draw_damage(const Record& record, const std::vector<float>& damage, int width) {
  const MethodPage* method = page_of(record.method);
  return method ? method->field(record, damage, width) : Canvas(width, width);
}

Canvas draw_record(const Record& record) {
  const MethodPage* method = page_of(record.method);
  const int plots_top = head_height + (method ? method->height(record) : 0) + 30;
  const int half = (page_width - 2 * page_margin - 2 * panel_gap) / 2;
  Canvas page(page_width, plots_top + plot_height + page_margin);
  page.text(page_margin, 40, title_of(record), black, Align::left, Font::bold);
  page.text(page_width - page_margin, 40, verdict_of(record), record.judgement.time_to_failure ? red : black, Align::right, Font::bold);
  page.text(page_margin, 66, facts_of(record, method ? method->body(record) : ""), grey);
  if (method) method->draw(page, record, head_height);
  draw_plot(page, {page_margin, plots_top, half, plot_height}, stress_plot(record));
  draw_plot(page, {page_margin + half + 2 * panel_gap, plots_top, half, plot_height},
            energy_plot(record, method ? method->energies : std::vector<EnergyCurve>{}));
  return page;
}

}  // namespace fracfarm::picture
