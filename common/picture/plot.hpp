// Line plots with axes, ticks in engineering units, legend and marks; and fields as images. Plain numbers in, pixels out.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "common/picture/canvas.hpp"

namespace fracfarm::picture {

struct Curve {
  std::string name;  // in the legend
  Colour colour;
  std::span<const double> x, y;  // of equal length; gaps where not finite
};

struct Mark {
  std::string name;  // written along a vertical line
  double x = 0.0;
  Colour colour;
};

struct Axis {
  std::string name;
  std::string unit;  // SI; the plot picks the power of 1000
};

struct Plot {
  std::string title;
  Axis x, y;
  std::vector<Curve> curves;
  std::vector<Mark> marks;
};

void draw_plot(Canvas& canvas, const Box& box, const Plot& plot);

// Round numbers (1, 2 or 5 times a power of ten) that divide low ... high into about `count` parts.
std::vector<double> ticks(double low, double high, int count);

// A power of 1000 and its prefix, so that `largest` becomes 1 ... 1000 of them.
struct Prefix {
  double factor = 1.0;
  std::string sign;
};
Prefix prefix_for(double largest);

// Values low ... high as viridis, nodes as they are (no smoothing), row 0 at the bottom; stretched to width x height pixels.
struct Field {
  std::span<const float> values;
  int columns = 0, rows = 0;
};
Canvas draw_field(const Field& field, int width, int height, double low = 0.0, double high = 1.0);

// A vertical scale of viridis with the numbers low and high beside it.
void draw_colour_scale(Canvas& canvas, const Box& box, std::string_view name, double low = 0.0, double high = 1.0);

}  // namespace fracfarm::picture
