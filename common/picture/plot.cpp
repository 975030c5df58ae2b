#include "common/picture/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

namespace fracfarm::picture {
namespace {

struct Span {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void take(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  double largest() const { return std::max(std::abs(low), std::abs(high)); }
};

// Never empty, with a little air at the ends that curves reach.
Span settle(Span span, double air) {
  if (!(span.low <= span.high)) return {0.0, 1.0};
  if (span.low == span.high) return {span.low - 0.5 - std::abs(span.low), span.high + 0.5 + std::abs(span.high)};
  const double extra = air * (span.high - span.low);
  return {span.low < 0.0 ? span.low - extra : span.low, span.high + extra};
}

struct Frame {
  Box inner;
  Span x, y;
  double px(double value) const { return inner.x + (value - x.low) / (x.high - x.low) * inner.width; }
  double py(double value) const { return inner.y + inner.height - (value - y.low) / (y.high - y.low) * inner.height; }
};

std::string number(double value, double step) {
  const int digits = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 9);
  return fmt::format("{:.{}f}", std::abs(value) < 1e-6 * step ? 0.0 : value, digits);
}

std::string label(const Axis& axis, const Prefix& prefix) {
  return axis.unit.empty() ? axis.name : fmt::format("{} ({}{})", axis.name, prefix.sign, axis.unit);
}

void draw_axes(Canvas& canvas, const Frame& frame, const Plot& plot) {
  constexpr int x_parts = 7, y_parts = 5;
  const Prefix px = prefix_for(frame.x.largest()), py = prefix_for(frame.y.largest());
  const std::vector<double> across = ticks(frame.x.low / px.factor, frame.x.high / px.factor, x_parts);
  const std::vector<double> up = ticks(frame.y.low / py.factor, frame.y.high / py.factor, y_parts);
  const Box& in = frame.inner;
  int widest = 0;
  for (double value : up) {
    const int y = static_cast<int>(std::lround(frame.py(value * py.factor)));
    canvas.fill({in.x, y, in.width, 1}, pale);
    const std::string text = number(value, up.size() > 1 ? up[1] - up[0] : 1.0);
    widest = std::max(widest, text_width(text));
    canvas.text(in.x - 6, y + 4, text, grey, Align::right);
  }
  for (double value : across) {
    const int x = static_cast<int>(std::lround(frame.px(value * px.factor)));
    canvas.fill({x, in.y, 1, in.height}, pale);
    canvas.text(x, in.y + in.height + 16, number(value, across.size() > 1 ? across[1] - across[0] : 1.0), grey, Align::centre);
  }
  canvas.frame({in.x, in.y, in.width + 1, in.height + 1}, grey);
  canvas.text(in.x + in.width / 2, in.y + in.height + 34, label(plot.x, px), black, Align::centre);
  canvas.text_upwards(in.x - widest - 12, in.y + in.height / 2, label(plot.y, py));
}

void draw_curve(Canvas& canvas, const Frame& frame, const Curve& curve) {
  assert(curve.x.size() == curve.y.size());
  for (std::size_t i = 1; i < curve.x.size(); ++i)
    canvas.line(frame.px(curve.x[i - 1]), frame.py(curve.y[i - 1]), frame.px(curve.x[i]), frame.py(curve.y[i]), curve.colour, 1.6);
}

void draw_marks(Canvas& canvas, const Frame& frame, const Plot& plot) {
  const Box& in = frame.inner;
  const auto inside = [&](const Mark& mark) { return mark.x >= frame.x.low && mark.x <= frame.x.high; };
  const auto column = [&](const Mark& mark) { return static_cast<int>(std::lround(frame.px(mark.x))); };
  for (const Mark& mark : plot.marks)
    for (int y = in.y; inside(mark) && y < in.y + in.height; y += 6) canvas.fill({column(mark), y, 1, 3}, mark.colour);
  int base = in.y + 15;
  for (const Mark& mark : plot.marks) {
    if (!inside(mark)) continue;
    const int width = text_width(mark.name), right = column(mark) + 6,
              from = right + width > in.x + in.width ? column(mark) - 5 - width : right;
    canvas.fill({from - 2, base - 12, width + 4, 16}, white);  // readable where it crosses another mark
    canvas.text(from, base, mark.name, mark.colour);
    base += 16;
  }
}

// Above the frame, from the right end: it covers no curve.
void draw_legend(Canvas& canvas, const Frame& frame, const std::vector<Curve>& curves) {
  int x = frame.inner.x + frame.inner.width;
  for (auto curve = curves.rbegin(); curve != curves.rend(); ++curve) {
    x -= text_width(curve->name);
    canvas.text(x, frame.inner.y - 8, curve->name);
    x -= 24;
    canvas.fill({x, frame.inner.y - 14, 18, 3}, curve->colour);
    x -= 16;
  }
}

}  // namespace

std::vector<double> ticks(double low, double high, int count) {
  if (!(high > low) || count < 1) return {};
  const double rough = (high - low) / count, power = std::pow(10.0, std::floor(std::log10(rough)));
  const double step = power * (rough / power <= 1.5 ? 1.0 : rough / power <= 3.5 ? 2.0 : rough / power <= 7.5 ? 5.0 : 10.0);
  std::vector<double> values;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step && values.size() < 100; ++k) values.push_back(k * step);
  return values;
}

Prefix prefix_for(double largest) {
  static constexpr std::array<const char*, 9> signs{"n", "µ", "m", "", "k", "M", "G", "T", "P"};
  if (!(largest > 0.0) || !std::isfinite(largest)) return {};
  const int power = std::clamp(static_cast<int>(std::floor(std::log10(largest) / 3.0 + 1e-12)), -3, 5);
  return {std::pow(1000.0, power), signs[static_cast<std::size_t>(power + 3)]};
}

void draw_plot(Canvas& canvas, const Box& box, const Plot& plot) {
  constexpr int left = 66, right = 14, above = 32, below = 44;
  Frame frame{{box.x + left, box.y + above, box.width - left - right, box.height - above - below}, {}, {}};
  for (const Curve& curve : plot.curves) {
    for (double value : curve.x) frame.x.take(value);
    for (double value : curve.y) frame.y.take(value);
  }
  frame.y.take(0.0);
  frame.x = settle(frame.x, 0.0);
  frame.y = settle(frame.y, 0.06);
  draw_axes(canvas, frame, plot);
  draw_marks(canvas, frame, plot);
  for (const Curve& curve : plot.curves) draw_curve(canvas, frame, curve);
  draw_legend(canvas, frame, plot.curves);
  canvas.text(box.x, box.y + 18, plot.title, black, Align::left, Font::bold);
}

Canvas draw_field(const Field& field, int width, int height, double low, double high) {
  assert(field.values.size() == static_cast<std::size_t>(field.columns) * static_cast<std::size_t>(field.rows));
  Canvas canvas(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const int column = x * field.columns / width, row = (height - 1 - y) * field.rows / height;
      const double value =
          field.values[static_cast<std::size_t>(row) * static_cast<std::size_t>(field.columns) + static_cast<std::size_t>(column)];
      canvas.blend(x, y, viridis((value - low) / (high - low)));
    }
  return canvas;
}

void draw_colour_scale(Canvas& canvas, const Box& box, std::string_view name, double low, double high) {
  for (int y = 0; y < box.height; ++y) canvas.fill({box.x, box.y + y, box.width, 1}, viridis(1.0 - y / (box.height - 1.0)));
  canvas.frame(box, grey);
  canvas.text(box.x + box.width + 5, box.y + 10, fmt::format("{:g}", high), grey);
  canvas.text(box.x + box.width + 5, box.y + box.height, fmt::format("{:g}", low), grey);
  canvas.text(box.x + box.width + 5, box.y + box.height / 2 + 4, name);
}

}  // namespace fracfarm::picture
