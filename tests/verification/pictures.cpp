#include "tests/verification/pictures.hpp"

#include <algorithm>
#include <cmath>

namespace fracfarm::verification {
namespace {

constexpr int chart_width = 560, chart_height = 340, title_room = 26, margin = 20, head = 40, caption_room = 24, scale_room = 56;

int pixels(double part, double whole, int longest) { return std::max(24, static_cast<int>(std::lround(longest * part / whole))); }

}  // namespace

picture::Canvas chart_page(const std::vector<Chart>& charts) {
  const int count = static_cast<int>(charts.size());
  picture::Canvas page(count * chart_width + (count + 1) * margin, title_room + chart_height + 2 * margin);
  int x = margin;
  for (const Chart& chart : charts) {
    picture::Plot plot{"", chart.x, chart.y, {}, chart.marks};
    for (const Line& line : chart.lines) plot.curves.push_back({line.name, line.colour, line.x, line.y});
    page.text(x, margin + 14, chart.title, picture::black, picture::Align::left, picture::Font::bold);
    picture::draw_plot(page, {x, margin + title_room, chart_width, chart_height}, plot);
    x += chart_width + margin;
  }
  return page;
}

picture::Canvas damage_page(const std::string& title, const std::vector<Damage>& fields, int longest) {
  int width = 2 * margin + scale_room, height = 0;
  for (const Damage& field : fields) {
    const double side = std::max(field.width, field.height);
    width += pixels(field.width, side, longest) + margin;
    height = std::max(height, pixels(field.height, side, longest));
  }
  width = std::max(width, picture::text_width(title, picture::Font::bold) + 2 * margin);
  picture::Canvas page(width, head + caption_room + height + margin);
  page.text(margin, 26, title, picture::black, picture::Align::left, picture::Font::bold);
  int x = margin;
  for (const Damage& field : fields) {
    const double side = std::max(field.width, field.height);
    const int across = pixels(field.width, side, longest), up = pixels(field.height, side, longest);
    page.text(x, head + 14, field.caption);
    page.place(picture::draw_field({field.psi, field.columns, field.rows}, across, up), x, head + caption_room);
    page.frame({x - 1, head + caption_room - 1, across + 2, up + 2}, picture::grey);
    x += across + margin;
  }
  picture::draw_colour_scale(page, {x, head + caption_room, 14, height}, "ψ");
  return page;
}

}  // namespace fracfarm::verification
