// The letters that pictures are labelled with.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "common/picture/canvas.hpp"

namespace fracfarm::picture {

struct Glyph {
  int code;     // Unicode
  int advance;  // pixels to the next letter
  int left;     // of the bitmap from the pen
  int top;      // of the bitmap below the ascent line
  int width, height;
  const char* coverage;  // hexadecimal digits, 0 ... f
};

struct Face {
  int ascent, descent;  // pixels above and below the base line
  std::span<const Glyph> glyphs;
};

const Face& face(Font font);

std::vector<const Glyph*> glyphs_of(std::string_view words, Font font);

}  // namespace fracfarm::picture
