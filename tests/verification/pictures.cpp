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

picture::Canvas damage_page(const std::string& title, const std::vector<Damage>& fields, int longest, int per_row) {
  const Damage& first = fields.front();
  const double side = std::max(first.width, first.height);
  const int across = pixels(first.width, side, longest), up = pixels(first.height, side, longest), count = static_cast<int>(fields.size());
  const int columns = std::min(count, per_row), rows = (count + per_row - 1) / per_row, pitch = caption_room + up + margin;
  const int width = margin + columns * (across + margin) + scale_room + margin;
  picture::Canvas page(std::max(width, picture::text_width(title, picture::Font::bold) + 2 * margin), head + rows * pitch);
  page.text(margin, 26, title, picture::black, picture::Align::left, picture::Font::bold);
  for (int k = 0; k < count; ++k) {
    const Damage& field = fields[static_cast<std::size_t>(k)];
    const int x = margin + k % per_row * (across + margin), y = head + k / per_row * pitch;
    page.text(x, y + 14, field.caption);
    page.place(picture::draw_field({field.psi, field.columns, field.rows}, across, up), x, y + caption_room);
    page.frame({x - 1, y + caption_room - 1, across + 2, up + 2}, picture::grey);
  }
  picture::draw_colour_scale(page, {margin + columns * (across + margin), head + caption_room, 14, up}, "ψ");
  return page;
}

}  // namespace fracfarm::verification
