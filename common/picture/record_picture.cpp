#include "common/picture/record_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "common/picture/plot.hpp"

namespace fracfarm::picture {
namespace {

constexpr int margin = 28, gap = 14, panels = 6, panel_width = 186, scale_room = 62;
constexpr int page_width = 2 * margin + panels * panel_width + (panels - 1) * gap + scale_room;
constexpr int head_height = 92, caption_height = 24, plot_height = 330;

constexpr Colour blue{31, 107, 184}, orange{226, 116, 14}, green{44, 145, 72}, purple{130, 84, 176}, red{201, 42, 42};

struct EnergyCurve {
  std::string_view column, name;
  Colour colour;
};
constexpr std::array<EnergyCurve, 5> energies{{
    {"external_work", "external work", black},
    {"elastic_energy", "elastic", blue},
    {"kinetic_energy", "kinetic", orange},
    {"released_energy", "released", green},
    {"energy_residual", "residual", red},
}};

std::string in_units(double value, std::string_view unit) {
  const Prefix prefix = prefix_for(std::abs(value));
  const double scaled = value / prefix.factor;
  return fmt::format("{:.{}f} {}{}", scaled,
                     std::abs(scaled) < 9.995   ? 2
                     : std::abs(scaled) < 99.95 ? 1
                                                : 0,
                     prefix.sign, unit);  // 3 digits
}

std::string words(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

double width_of(const Record& r) { return r.phase_field.x.back() - r.phase_field.x.front(); }
double height_of(const Record& r) { return r.phase_field.z.back() - r.phase_field.z.front(); }

// A strip thinner than a line of text or taller than the page helps nobody.
int proportionate(const Record& r, int width) {
  return static_cast<int>(std::clamp(std::lround(width * height_of(r) / width_of(r)), 24L, 3L * width));
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

std::string facts_of(const Record& r) {
  return fmt::format("peak stress {} · {:.3g} m × {:.3g} m, {} × {} nodes · {} cracks · energy closed to {:.2g} % · key {:.12}",
                     in_units(r.peak_stress, "Pa"), width_of(r), height_of(r), r.phase_field.x.size(), r.phase_field.z.size(),
                     r.cracks.size(), 100.0 * r.energy_residual, r.key);
}

void draw_panel(Canvas& page, const Record& r, const std::vector<float>& psi, int number, const std::string& caption) {
  const int height = proportionate(r, panel_width), x = margin + number * (panel_width + gap);
  const Field field{psi, static_cast<int>(r.phase_field.x.size()), static_cast<int>(r.phase_field.z.size())};
  page.text(x, head_height + 16, caption);
  page.place(draw_field(field, panel_width, height), x, head_height + caption_height);
  page.frame({x - 1, head_height + caption_height - 1, panel_width + 2, height + 2}, grey);
}

// Frames that divide the time from the start to the failure (or to the last frame) evenly.
std::vector<std::size_t> chosen_frames(const Record& r) {
  const std::vector<double>& time = r.phase_field.time;
  const double end = std::min(time.back(), r.judgement.time_to_failure.value_or(time.back()));
  std::vector<std::size_t> chosen;
  for (int k = 1; k <= panels - 2; ++k) {
    const double wanted = end * k / (panels - 1);
    const auto nearest =
        std::min_element(time.begin(), time.end(), [&](double a, double b) { return std::abs(a - wanted) < std::abs(b - wanted); });
    const std::size_t frame = static_cast<std::size_t>(nearest - time.begin());
    if (chosen.empty() || chosen.back() != frame) chosen.push_back(frame);
  }
  return chosen;
}

void draw_fields(Canvas& page, const Record& r) {
  int number = 0;
  draw_panel(page, r, r.phase_field.psi_initial, number++, "initial");
  for (std::size_t frame : chosen_frames(r))
    draw_panel(page, r, r.phase_field.psi[frame], number++, in_units(r.phase_field.time[frame], "s"));
  const std::string last = r.judgement.time_to_failure ? "failure, " + in_units(*r.judgement.time_to_failure, "s") : "last state";
  draw_panel(page, r, r.phase_field.psi_failure, panels - 1, last);
  draw_colour_scale(page, {page_width - margin - scale_room + 18, head_height + caption_height, 14, proportionate(r, panel_width)}, "ψ");
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

Plot energy_plot(const Record& r) {
  Plot plot{"Energy", {"time", "s"}, {"energy", "J/m"}, {}, {}};
  for (const EnergyCurve& curve : energies)
    if (const Column* column = r.series.find(curve.column))
      plot.curves.push_back({std::string(curve.name), curve.colour, r.series["step_time"], column->values});
  return plot;
}

}  // namespace

Canvas draw_record(const Record& record) {
  const int plots_top = head_height + caption_height + proportionate(record, panel_width) + 30;
  const int half = (page_width - 2 * margin - 2 * gap) / 2;
  Canvas page(page_width, plots_top + plot_height + margin);
  page.text(margin, 40, title_of(record), black, Align::left, Font::bold);
  page.text(page_width - margin, 40, verdict_of(record), record.judgement.time_to_failure ? red : black, Align::right, Font::bold);
  page.text(margin, 66, facts_of(record), grey);
  draw_fields(page, record);
  draw_plot(page, {margin, plots_top, half, plot_height}, stress_plot(record));
  draw_plot(page, {margin + half + 2 * gap, plots_top, half, plot_height}, energy_plot(record));
  return page;
}

}  // namespace fracfarm::picture
