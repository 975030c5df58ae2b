// Pages for the verification pictures: plots side by side, and damage fields with captions.
#pragma once

#include <string>
#include <vector>

#include "common/picture/plot.hpp"

namespace fracfarm::verification {

inline constexpr picture::Colour blue{31, 107, 184}, orange{226, 116, 14}, green{44, 145, 72}, purple{130, 84, 176}, red{201, 42, 42};
inline constexpr picture::Colour palette[]{blue, orange, green, purple, red, picture::black};

// Curves with their numbers, which a picture::Curve only looks at.
struct Line {
  std::string name;
  picture::Colour colour;
  std::vector<double> x, y;
};

struct Chart {
  std::string title;
  picture::Axis x, y;
  std::vector<Line> lines;
  std::vector<picture::Mark> marks = {};
};

// Side by side, each 560 pixels wide.
picture::Canvas chart_page(const std::vector<Chart>& charts);

// Damage at one instant: nodes in rows from the bottom, over a sample of the given size (m).
struct Damage {
  std::string caption;
  std::vector<float> psi;
  int columns = 0, rows = 0;
  double width = 0.0, height = 0.0;
};

// `per_row` side by side with one scale, the longer side of each `longest` pixels. The fields are of one shape.
picture::Canvas damage_page(const std::string& title, const std::vector<Damage>& fields, int longest, int per_row = 4);

}  // namespace fracfarm::verification
