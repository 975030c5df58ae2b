#include "common/picture/record_picture.hpp"

#include <catch2/catch.hpp>

#include "tests/record/sample_record.hpp"

using namespace fracfarm;
using picture::Canvas, picture::draw_record;

namespace {

int count(const Canvas& canvas, picture::Colour colour) {
  int found = 0;
  for (int y = 0; y < canvas.height(); ++y)
    for (int x = 0; x < canvas.width(); ++x) found += canvas.at(x, y) == colour;
  return found;
}

}  // namespace

TEST_CASE("the sheet of a record shows its fields and curves") {
  const Canvas sheet = draw_record(sample::record());
  CHECK(sheet.width() > 1000);
  CHECK(count(sheet, picture::viridis(1.0)) > 5000);  // cracks
  CHECK(count(sheet, {31, 107, 184}) > 300);          // vertical stress and elastic energy
}

TEST_CASE("the same record gives the same picture, another another") {
  Record other = sample::record();
  other.phase_field.psi_failure.assign(other.phase_field.psi_failure.size(), 0.0f);
  CHECK(draw_record(sample::record()).rgb() == draw_record(sample::record()).rgb());
  CHECK(draw_record(sample::record()).rgb() != draw_record(other).rgb());
}

TEST_CASE("records of one frame, without failure, of two nodes or of a thin strip are drawn") {
  Record censored = sample::record();
  for (FailureTime& time : censored.failure_times) time.time.reset();
  censored.judgement = judge(censored.method, censored.failure_times, "horizon");
  censored.phase_field.psi.resize(1), censored.phase_field.time.resize(1);
  CHECK(draw_record(censored).height() > 400);
  CHECK(draw_record(sample::record({1, 1, 2, 3})).height() > 400);
  Record strip = sample::record();
  for (double& z : strip.phase_field.z) z *= 1e-4;
  CHECK(draw_record(strip).height() > 400);
  for (double& z : strip.phase_field.z) z *= 1e8;
  CHECK(draw_record(strip).height() < 1200);
}
