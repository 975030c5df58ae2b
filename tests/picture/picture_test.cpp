#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <set>

#include "common/picture/canvas.hpp"
#include "common/picture/plot.hpp"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

using namespace fracfarm::picture;

namespace {

int count(const Canvas& canvas, const Box& box, Colour colour) {
  int found = 0;
  for (int y = box.y; y < box.y + box.height; ++y)
    for (int x = box.x; x < box.x + box.width; ++x) found += canvas.at(x, y) == colour;
  return found;
}

constexpr Colour red{255, 0, 0};

}  // namespace

TEST_CASE("viridis runs from dark violet to yellow and shows what is not a number") {
  CHECK(viridis(0.0) == Colour{68, 1, 84});
  CHECK(viridis(1.0) == Colour{253, 231, 37});
  CHECK(viridis(0.5) == Colour{33, 145, 140});
  CHECK(viridis(-3.0) == viridis(0.0));
  CHECK(viridis(7.0) == viridis(1.0));
  CHECK(viridis(std::nan("")) == Colour{255, 0, 255});
}

TEST_CASE("a PNG decodes to the pixels of the canvas") {
  Canvas canvas(7, 5);
  canvas.fill({2, 1, 3, 2}, red);
  const std::string png = png_bytes(canvas);
  int width = 0, height = 0, channels = 0;
  unsigned char* pixels = stbi_load_from_memory(reinterpret_cast<const unsigned char*>(png.data()), static_cast<int>(png.size()), &width,
                                                &height, &channels, 3);
  REQUIRE(pixels);
  CHECK(width == 7);
  CHECK(height == 5);
  CHECK(std::vector<unsigned char>(pixels, pixels + 105) == canvas.rgb());
  stbi_image_free(pixels);
}

TEST_CASE("row 0 of a field is at the bottom, column 0 at the left") {
  const std::vector<float> values{1, 0, 0, 0, 0, 0};  // 3 columns, 2 rows: the lower left node
  const Canvas canvas = draw_field({values, 3, 2}, 30, 20);
  CHECK(count(canvas, {0, 10, 10, 10}, viridis(1.0)) == 100);
  CHECK(count(canvas, {0, 0, 30, 20}, viridis(1.0)) == 100);
}

TEST_CASE("a field is stretched without losing a node") {
  const std::vector<float> values{0.0f, 0.25f, 0.5f, 0.75f, 1.0f};
  const Canvas canvas = draw_field({values, 5, 1}, 13, 4);
  for (float value : values) CHECK(count(canvas, {0, 0, 13, 4}, viridis(value)) >= 8);
}

TEST_CASE("a line covers its ends and nothing far away") {
  Canvas canvas(40, 40);
  canvas.line(5, 5, 30, 20, red, 2.0);
  CHECK(canvas.at(5, 5) == red);
  CHECK(canvas.at(30, 20) == red);
  CHECK(canvas.at(30, 5) == white);
  CHECK(canvas.at(17, 12).g < 100);  // near the middle
}

TEST_CASE("whatever lies outside the canvas, or is not a number, is cut") {
  Canvas canvas(10, 10);
  canvas.line(-1e6, -1e6, 1e6, 1e6, red);
  canvas.line(std::nan(""), 0, 5, 5, red);
  canvas.line(0, 0, std::numeric_limits<double>::infinity(), 5, red);
  canvas.fill({-5, -5, 100, 100}, white);
  canvas.text(-50, 200, "outside", red);
  canvas.text_upwards(400, -3, "outside", red);
  CHECK(count(canvas, {0, 0, 10, 10}, white) == 100);
}

TEST_CASE("letters take the room that their width says, and unknown ones become question marks") {
  CHECK(text_width("") == 0);
  CHECK(text_width("ab") == text_width("a") + text_width("b"));
  CHECK(text_width("µ") > 0);
  CHECK(text_width("ψ", Font::bold) > 0);
  CHECK(text_width("漢") == text_width("?"));
  CHECK(text_width("\xff\xfe") == text_width("??"));
  Canvas canvas(200, 30);
  canvas.text(100, 20, "right", black, Align::right);
  CHECK(count(canvas, {101, 0, 99, 30}, white) == 99 * 30);
  CHECK(count(canvas, {100 - text_width("right") - 1, 0, text_width("right"), 30}, white) < text_width("right") * 30);
}

TEST_CASE("every letter of printable ASCII has its own shape") {
  std::set<std::vector<unsigned char>> shapes;
  for (char c = '!'; c <= '~'; ++c) {
    Canvas canvas(30, 30);
    canvas.text(5, 20, std::string(1, c));
    shapes.insert(canvas.rgb());
  }
  CHECK(shapes.size() == 94);
}

TEST_CASE("ticks are round numbers inside the range") {
  CHECK(ticks(0.0, 10.0, 5) == std::vector<double>{0, 2, 4, 6, 8, 10});
  CHECK(ticks(0.0, 1000.0, 4).size() == 6);
  CHECK(ticks(-0.3, 0.3, 3) == std::vector<double>{-0.2, 0.0, 0.2});
  CHECK(ticks(1.0, 1.0, 5).empty());
  CHECK(ticks(0.0, std::numeric_limits<double>::infinity(), 5).empty());
}

TEST_CASE("prefixes bring a value into 1 ... 1000") {
  CHECK(prefix_for(6.9e6).sign == "M");
  CHECK(prefix_for(443e-6).sign == "µ");
  CHECK(prefix_for(1000.0).sign == "k");
  CHECK(prefix_for(999.0).sign.empty());
  CHECK(prefix_for(0.0).factor == 1.0);
}

TEST_CASE("a plot draws its curves inside its frame and nothing outside its box") {
  const std::vector<double> x{0, 1, 2, 3}, y{0, 5, std::nan(""), 2};
  Canvas canvas(500, 300, Colour{1, 2, 3});
  canvas.fill({50, 20, 400, 260}, white);
  draw_plot(canvas, {50, 20, 400, 260},
            {"title", {"time", "s"}, {"stress", "Pa"}, {{"curve", red, x, y}}, {{"mark", 1.5, Colour{0, 0, 255}}, {"far", 99.0, black}}});
  CHECK(count(canvas, {50, 20, 400, 260}, red) > 100);
  CHECK(count(canvas, {50, 20, 400, 260}, Colour{0, 0, 255}) > 50);
  CHECK(count(canvas, {0, 0, 500, 20}, Colour{1, 2, 3}) == 500 * 20);
  CHECK(count(canvas, {0, 0, 50, 300}, Colour{1, 2, 3}) == 50 * 300);
  CHECK(count(canvas, {450, 0, 50, 300}, Colour{1, 2, 3}) == 50 * 300);
}

TEST_CASE("plots of nothing, of one point and of a constant do not divide by zero") {
  Canvas canvas(300, 200);
  const std::vector<double> none, one{1.0}, constant{2.0, 2.0}, x{0.0, 1.0};
  draw_plot(canvas, {0, 0, 300, 200}, {"", {"t", "s"}, {"y", ""}, {{"none", red, none, none}}, {}});
  draw_plot(canvas, {0, 0, 300, 200}, {"", {"t", "s"}, {"y", ""}, {{"one", red, one, one}}, {}});
  draw_plot(canvas, {0, 0, 300, 200}, {"", {"t", "s"}, {"y", ""}, {{"constant", red, x, constant}}, {}});
  CHECK(count(canvas, {0, 0, 300, 200}, red) > 50);
}
