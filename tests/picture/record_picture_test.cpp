#include "common/picture/record_picture.hpp"

#include <catch2/catch.hpp>

#include "common/picture/mesh_picture.hpp"
#include "tests/record/sample_fdem.hpp"
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

TEST_CASE("the sheet of an FDEM record shows cracks, broken and softening edges, and both failure times") {
  const Record record = sample::fdem_record();
  const Canvas sheet = draw_record(record);
  CHECK(count(sheet, picture::initial_crack_colour) > 500);
  CHECK(count(sheet, picture::broken_colour) > 500);
  Record whole = record;
  for (std::vector<float>& frame : whole.fdem.damage) frame = record.fdem.damage_initial;
  whole.fdem.damage_failure = record.fdem.damage_initial;
  CHECK(count(draw_record(whole), picture::broken_colour) < 100);  // the key's
  Record unpicked = record;
  unpicked.failure_times[1].time.reset();
  CHECK(draw_record(unpicked).rgb() != sheet.rgb());
}

TEST_CASE("one field of a record is drawn as its method draws it") {
  const Record record = sample::fdem_record(), grid = sample::record();
  const Canvas first = picture::draw_damage(record, record.fdem.damage_initial, 300),
               last = picture::draw_damage(record, record.fdem.damage_failure, 300);
  CHECK(first.height() == 240);
  CHECK(count(first, picture::broken_colour) == 0);
  CHECK(count(last, picture::broken_colour) > 100);
  CHECK(count(picture::draw_damage(grid, grid.phase_field.psi_failure, 300), picture::viridis(1.0)) > 1000);
}

TEST_CASE("a record of a method without frames is its curves") {
  Record record = sample::record();
  record.method = "drill";
  record.phase_field = {};
  CHECK(draw_record(record).height() < draw_record(sample::record()).height());
}
