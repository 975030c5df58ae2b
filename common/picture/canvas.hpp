// A raster of RGB pixels, x to the right, y down, origin at the upper left: what pictures are drawn on. Knows shapes and letters, no data.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fracfarm::picture {

struct Colour {
  unsigned char r = 0, g = 0, b = 0;
  friend bool operator==(const Colour&, const Colour&) = default;
};

inline constexpr Colour white{255, 255, 255}, black{20, 20, 24}, grey{120, 122, 128}, pale{226, 228, 232};

Colour viridis(double share);  // 0 ... 1; magenta for what is not a number

enum class Font { regular, bold };
enum class Align { left, centre, right };

struct Box {
  int x = 0, y = 0, width = 0, height = 0;
};

class Canvas {
 public:
  Canvas(int width, int height, Colour background = white);

  int width() const { return width_; }
  int height() const { return height_; }
  Colour at(int x, int y) const;
  const std::vector<unsigned char>& rgb() const { return rgb_; }  // rows from the top

  // Everything below is cut at the edges.
  void blend(int x, int y, Colour colour, double share = 1.0);
  void fill(const Box& box, Colour colour);
  void frame(const Box& box, Colour colour);                                                     // one pixel wide, inside the box
  void line(double x0, double y0, double x1, double y1, Colour colour, double thickness = 1.5);  // smooth edges
  void place(const Canvas& other, int x, int y);

  // (x, y) is the left end, middle or right end of the base line. UTF-8; letters that the font lacks become '?'.
  void text(int x, int y, std::string_view words, Colour colour = black, Align align = Align::left, Font font = Font::regular);
  void text_upwards(int x, int y, std::string_view words,
                    Colour colour = black);  // turned to read from below, centred at y; x is the base line

 private:
  int width_, height_;
  std::vector<unsigned char> rgb_;
};

int text_width(std::string_view words, Font font = Font::regular);

std::string png_bytes(const Canvas& canvas);

}  // namespace fracfarm::picture
