#include "common/record/writer.hpp"

#include <stdlib.h>

#include <catch2/catch.hpp>
#include <filesystem>

#include "common/base/atomic_file.hpp"
#include "common/base/hash.hpp"
#include "common/record/reader.hpp"
#include "common/record/seal.hpp"
#include "tests/record/sample_fdem.hpp"
#include "tests/record/sample_record.hpp"
#include "tests/record/temporary_folder.hpp"

using namespace fracfarm;

namespace {

std::string why_not(const Record& record) {
  const auto bytes = record_bytes(record);
  return bytes ? "" : bytes.error().message;
}

}  // namespace

TEST_CASE("the same record gives the same bytes") {
  const std::string first = record_bytes(sample::record()).value();
  { const std::vector<std::string> litter(100, std::string(5000, 'x')); }  // other memory under the second one
  CHECK(record_bytes(sample::record()).value() == first);
}

TEST_CASE("what is read back is what is written, and writing it again gives the same bytes") {
  const Record record = sample::record();
  const std::string bytes = record_bytes(record).value();
  const Record back = read_record_bytes(bytes).value();
  CHECK(record_bytes(back).value() == bytes);
  CHECK(back.key == record.key);
  CHECK(back.canonical_scene == record.canonical_scene);
  CHECK(back.provenance == record.provenance);
  CHECK(back.cracks == record.cracks);
  CHECK(back.judgement.time_to_failure == record.judgement.time_to_failure);
  CHECK(back.judgement.rule == "through_crack");
  CHECK(back.phase_field.time == record.phase_field.time);
  CHECK(back.phase_field.psi == as_stored(record).phase_field.psi);
  CHECK(back.phase_field.mask_initial == record.phase_field.mask_initial);
  REQUIRE(back.series.columns.size() == record.series.columns.size());
  for (std::size_t i = 0; i < back.series.columns.size(); ++i) {
    CHECK(back.series.columns[i].name == record.series.columns[i].name);
    CHECK(back.series.columns[i].values == record.series.columns[i].values);
  }
}

TEST_CASE("records of any grid come back whole, chunk edges included") {
  for (const sample::Size size : {sample::Size{1, 1, 2, 10}, {300, 260, 3, 20}, {15, 11, 4, 20}, {15, 11, 33, 20}}) {
    const Record record = sample::record(size);
    const Record back = read_record_bytes(record_bytes(record).value()).value();
    CHECK(back.phase_field.psi == as_stored(record).phase_field.psi);
    CHECK(back.phase_field.psi_failure == as_stored(record).phase_field.psi_failure);
  }
}

TEST_CASE("FDEM records of any mesh come back whole, chunk edges included") {
  for (const sample::FdemSize size : {sample::FdemSize{10, 8, 2, 40}, {20, 16, 33, 60}, {220, 176, 2, 40}}) {
    const Record record = as_stored(sample::fdem_record(size));
    const Record back = read_record_bytes(record_bytes(record).value()).value();
    CHECK(back.fdem.mesh == record.fdem.mesh);
    CHECK(back.fdem.time == record.fdem.time);
    CHECK(back.fdem.damage == record.fdem.damage);
    CHECK(back.fdem.damage_initial == record.fdem.damage_initial);
    CHECK(back.fdem.damage_failure == record.fdem.damage_failure);
    CHECK(back.fdem.break_mode == record.fdem.break_mode);
    const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
    CHECK(std::equal(back.fdem.break_time.begin(), back.fdem.break_time.end(), record.fdem.break_time.begin(), same));
    CHECK(back.phase_field.psi.empty());
  }
}

TEST_CASE("a scene without cracks and criteria without times are stored as such") {
  Record record = sample::record();
  record.cracks.clear();
  record.failure_times[2].time.reset();
  const Record back = read_record_bytes(record_bytes(record).value()).value();
  CHECK(back.cracks.empty());
  CHECK_FALSE(back.failure_times[2].time);
}

TEST_CASE("the file is complete at its path, its digest is returned and nothing is left beside it") {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "record.h5";
  const Keeping keeping = GENERATE(Keeping::durable, Keeping::scratch);
  const std::string digest = write_record(sample::record(), path, keeping).value();
  CHECK(digest == sha256_file(path).value());
  CHECK(broken_seal(read_file(path, 1 << 30).value()).empty());
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 1);
  CHECK(read_record(path).value().key == sample::record().key);
}

TEST_CASE("a folder that is not there is an error, not a crash") {
  CHECK(write_record(sample::record(), "/nonexistent/folder/record.h5", Keeping::scratch).error().fault == Fault::node_lost);
}

TEST_CASE("sizes that do not fit together are refused in words") {
  Record record = sample::record();
  record.phase_field.psi.pop_back();
  CHECK(why_not(record).find("8 frames of psi and 9 times") != std::string::npos);
  record = sample::record();
  record.phase_field.psi_failure.pop_back();
  CHECK(why_not(record).find("psi_failure") != std::string::npos);
  record = sample::record();
  record.series.columns[3].values.pop_back();
  CHECK(why_not(record).find("has 59 rows, not 60") != std::string::npos);
  record = sample::record();
  record.series.columns.erase(record.series.columns.begin() + 2);
  CHECK(why_not(record).find("no column") != std::string::npos);
  record = sample::record();
  record.failure_times.clear();
  CHECK(why_not(record).find("candidate") != std::string::npos);
}

TEST_CASE("texts and names that fixed-length ASCII cannot hold are refused in words") {
  Record record = sample::record();
  record.material = "b\xc3\xa9ton";
  CHECK(why_not(record).find("ASCII") != std::string::npos);
  record = sample::record();
  record.provenance["a/b"] = "x";
  CHECK(why_not(record).find("a/b") != std::string::npos);
  record = sample::record();
  record.provenance["long"] = std::string(70000, 'x');
  CHECK(why_not(record).find("long") != std::string::npos);
  record = sample::record();
  record.series.columns[1].name = "../step";
  CHECK(why_not(record).find("../step") != std::string::npos);
}
