#include "common/picture/canvas.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "common/picture/font.hpp"

namespace fracfarm::picture {
namespace {

std::size_t pixel(int x, int y, int width) {
  return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
}

unsigned char mix(unsigned char below, unsigned char above, double share) {
  return static_cast<unsigned char>(std::lround(below + (above - below) * share));
}

double coverage(const Glyph& glyph, int column, int row) {
  const char digit = glyph.coverage[row * glyph.width + column];
  return (digit <= '9' ? digit - '0' : digit - 'a' + 10) / 15.0;
}

double distance_to(double px, double py, double x0, double y0, double x1, double y1) {
  const double dx = x1 - x0, dy = y1 - y0, length2 = dx * dx + dy * dy;
  const double along = length2 > 0.0 ? std::clamp(((px - x0) * dx + (py - y0) * dy) / length2, 0.0, 1.0) : 0.0;
  return std::hypot(px - x0 - along * dx, py - y0 - along * dy);
}

}  // namespace

Canvas::Canvas(int width, int height, Colour background) : width_(width), height_(height) {
  assert(width > 0 && height > 0);
  rgb_.resize(pixel(0, height, width));
  fill({0, 0, width, height}, background);
}

Colour Canvas::at(int x, int y) const {
  const unsigned char* p = &rgb_[pixel(x, y, width_)];
  return {p[0], p[1], p[2]};
}

void Canvas::blend(int x, int y, Colour colour, double share) {
  if (x < 0 || y < 0 || x >= width_ || y >= height_) return;
  unsigned char* p = &rgb_[pixel(x, y, width_)];
  p[0] = mix(p[0], colour.r, share), p[1] = mix(p[1], colour.g, share), p[2] = mix(p[2], colour.b, share);
}

void Canvas::fill(const Box& box, Colour colour) {
  for (int y = std::max(0, box.y); y < std::min(height_, box.y + box.height); ++y)
    for (int x = std::max(0, box.x); x < std::min(width_, box.x + box.width); ++x) {
      unsigned char* p = &rgb_[pixel(x, y, width_)];
      p[0] = colour.r, p[1] = colour.g, p[2] = colour.b;
    }
}

void Canvas::frame(const Box& box, Colour colour) {
  fill({box.x, box.y, box.width, 1}, colour);
  fill({box.x, box.y + box.height - 1, box.width, 1}, colour);
  fill({box.x, box.y, 1, box.height}, colour);
  fill({box.x + box.width - 1, box.y, 1, box.height}, colour);
}

void Canvas::line(double x0, double y0, double x1, double y1, Colour colour, double thickness) {
  if (!std::isfinite(x0 + y0 + x1 + y1)) return;
  const double reach = 0.5 * thickness + 0.5;
  const auto low = [&](double a, double b, int limit) {
    return static_cast<int>(std::clamp(std::floor(std::min(a, b) - reach), 0.0, double(limit)));
  };
  const auto high = [&](double a, double b, int limit) {
    return static_cast<int>(std::clamp(std::ceil(std::max(a, b) + reach), -1.0, limit - 1.0));
  };
  for (int y = low(y0, y1, height_); y <= high(y0, y1, height_); ++y)
    for (int x = low(x0, x1, width_); x <= high(x0, x1, width_); ++x) {
      const double share = reach - distance_to(x, y, x0, y0, x1, y1);
      if (share > 0.0) blend(x, y, colour, std::min(share, 1.0));
    }
}

void Canvas::place(const Canvas& other, int x, int y) {
  for (int row = 0; row < other.height_; ++row)
    for (int column = 0; column < other.width_; ++column) blend(x + column, y + row, other.at(column, row));
}

void Canvas::text(int x, int y, std::string_view words, Colour colour, Align align, Font font) {
  const int width = text_width(words, font);
  int pen = align == Align::left ? x : align == Align::right ? x - width : x - width / 2;
  for (const Glyph* glyph : glyphs_of(words, font)) {
    for (int row = 0; row < glyph->height; ++row)
      for (int column = 0; column < glyph->width; ++column)
        blend(pen + glyph->left + column, y - face(font).ascent + glyph->top + row, colour, coverage(*glyph, column, row));
    pen += glyph->advance;
  }
}

void Canvas::text_upwards(int x, int y, std::string_view words, Colour colour) {
  int pen = y + text_width(words) / 2;
  for (const Glyph* glyph : glyphs_of(words, Font::regular)) {
    for (int row = 0; row < glyph->height; ++row)
      for (int column = 0; column < glyph->width; ++column)
        blend(x - face(Font::regular).ascent + glyph->top + row, pen - glyph->left - column, colour, coverage(*glyph, column, row));
    pen -= glyph->advance;
  }
}

}  // namespace fracfarm::picture
