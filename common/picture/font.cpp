#include "common/picture/font.hpp"

namespace fracfarm::picture {
namespace {

// One Unicode code from UTF-8, or '?' for what is none; `at` moves past it.
int next_code(std::string_view words, std::size_t& at) {
  const auto byte = [&](std::size_t i) { return i < words.size() ? static_cast<unsigned char>(words[i]) : 0u; };
  const unsigned first = byte(at++);
  const int extra = first < 0x80 ? 0 : first >= 0xC0 && first < 0xE0 ? 1 : first >= 0xE0 && first < 0xF0 ? 2 : -1;
  if (extra < 0) return '?';
  unsigned code = extra == 0 ? first : first & (extra == 1 ? 0x1Fu : 0x0Fu);
  for (int i = 0; i < extra; ++i) {
    if ((byte(at) & 0xC0) != 0x80) return '?';
    code = code << 6 | (byte(at++) & 0x3F);
  }
  return static_cast<int>(code);
}

const Glyph* find(const Face& letters, int code) {
  for (const Glyph& glyph : letters.glyphs)
    if (glyph.code == code) return &glyph;
  return code == '?' ? nullptr : find(letters, '?');
}

}  // namespace

std::vector<const Glyph*> glyphs_of(std::string_view words, Font font) {
  std::vector<const Glyph*> glyphs;
  for (std::size_t at = 0; at < words.size();)
    if (const Glyph* glyph = find(face(font), next_code(words, at))) glyphs.push_back(glyph);
  return glyphs;
}

int text_width(std::string_view words, Font font) {
  int width = 0;
  for (const Glyph* glyph : glyphs_of(words, font)) width += glyph->advance;
  return width;
}

}  // namespace fracfarm::picture
