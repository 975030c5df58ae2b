// `fracfarm check` and `fracfarm show` as a person runs them.
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "common/base/atomic_file.hpp"
#include "common/record/writer.hpp"
#include "tests/record/sample_fdem.hpp"
#include "tests/record/sample_record.hpp"
#include "tests/record/temporary_folder.hpp"

using namespace fracfarm;

namespace {

struct Ended {
  int status = -1;
  std::string out;
};

// `fracfarm ARGUMENTS`, its standard output kept.
Ended fracfarm_run(const std::string& arguments) {
  std::FILE* pipe = ::popen((std::string(FRACFARM_BIN_DIR) + "/fracfarm " + arguments + " 2>/dev/null").c_str(), "r");
  Ended ended;
  char buffer[4096];
  while (const std::size_t got = std::fread(buffer, 1, sizeof buffer, pipe)) ended.out.append(buffer, got);
  const int status = ::pclose(pipe);
  ended.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return ended;
}

struct Files {
  test::TemporaryFolder folder;
  std::string sound = folder.path() / "sound.h5", wrong = folder.path() / "wrong.h5", cut = folder.path() / "cut.h5";

  Files() {
    Record record = sample::record();
    write_record(record, sound, Keeping::scratch).value();
    record.judgement.confidence = 0.99;
    record.phase_field.mask_initial[3] = 1;
    write_record(record, wrong, Keeping::scratch).value();
    std::ofstream(cut) << read_file(sound, 1 << 30).value().substr(0, 9000);
  }
};

}  // namespace

TEST_CASE("check says that a sound record is sound and ends with 0") {
  const Files files;
  const Ended ended = fracfarm_run("check " + files.sound);
  CHECK(ended.status == 0);
  CHECK(ended.out.find("rules hold") != std::string::npos);
}

TEST_CASE("check names every broken rule and ends with 1") {
  const Files files;
  const Ended ended = fracfarm_run("check " + files.sound + " " + files.wrong + " " + files.cut);
  CHECK(ended.status == 1);
  for (const char* rule : {"judgement", "mask_held", "complete"}) CHECK(ended.out.find(std::string(rule) + ":") != std::string::npos);
  CHECK(ended.out.find("damage_range") == std::string::npos);
}

TEST_CASE("check ends with 2 where a file cannot be read or nothing is asked") {
  const Files files;
  CHECK(fracfarm_run("check " + files.sound + " /nonexistent.h5").status == 2);
  CHECK(fracfarm_run("check").status == 2);
  CHECK(fracfarm_run("check --nonsense " + files.sound).status == 2);
}

TEST_CASE("check --key refuses another job's record") {
  const Files files;
  CHECK(fracfarm_run("check --key " + sample::record().key + " " + files.sound).status == 0);
  CHECK(fracfarm_run("check --key 00 " + files.sound).status == 1);
}

TEST_CASE("check --json has every rule of every file") {
  const Files files;
  const auto json = nlohmann::json::parse(fracfarm_run("check --json " + files.sound + " " + files.wrong).out);
  CHECK(json["passed"] == false);
  REQUIRE(json["records"].size() == 2);
  CHECK(json["records"][0]["passed"] == true);
  CHECK(json["records"][0]["rules"].size() >= 18);
  CHECK(json["records"][0]["rules"][0]["name"] == "complete");
}

TEST_CASE("show prints what the record holds, in words and as JSON") {
  const Files files;
  const Ended words = fracfarm_run("show " + files.sound);
  CHECK(words.status == 0);
  for (const char* word : {"pbx", "through_crack", "chosen", "peak stress", "kinetic_energy", "build_id"})
    CHECK(words.out.find(word) != std::string::npos);
  const auto json = nlohmann::json::parse(fracfarm_run("show --json " + files.sound).out);
  CHECK(json["time_to_failure"] == 4e-5);
  CHECK(json["times"]["through_crack"] == 4e-5);
  CHECK(json["scene"]["schema"] == "fracfarm.scene/1");
}

TEST_CASE("show -o draws a picture") {
  const Files files;
  const std::string picture = files.folder.path() / "x.png";
  CHECK(fracfarm_run("show " + files.sound + " -o " + picture).status == 0);
  CHECK(read_file(picture, 1 << 30).value().starts_with("\x89PNG"));
}

TEST_CASE("check and show take FDEM records: words, JSON and picture") {
  const test::TemporaryFolder folder;
  const std::string path = folder.path() / "mesh.h5", picture = folder.path() / "mesh.png";
  const Record record = sample::fdem_record();
  write_record(record, path, Keeping::scratch).value();
  CHECK(fracfarm_run("check " + path).status == 0);
  const Ended words = fracfarm_run("show " + path);
  CHECK(words.status == 0);
  for (const char* word : {"fdem", "triangles", "five_step", "drop10", "chosen", "criteria apart", "friction_energy"})
    CHECK(words.out.find(word) != std::string::npos);
  const auto json = nlohmann::json::parse(fracfarm_run("show --json " + path + " -o " + picture).out);
  CHECK(json["failure_rule"] == "five_step");
  CHECK(json["disagreement"].get<double>() == *record.failure_times[1].time - *record.failure_times[0].time);
  CHECK(json["mesh"]["edges"] == record.fdem.mesh.edge_nodes.size());
  CHECK(json["mesh"]["broken"].get<int>() > 0);
  CHECK(json["frames"] == record.fdem.time.size());
  CHECK(read_file(picture, 1 << 30).value().starts_with("\x89PNG"));
}

TEST_CASE("show refuses what is no sound file") {
  const Files files;
  CHECK(fracfarm_run("show " + files.cut).status == 1);
  CHECK(fracfarm_run("show /nonexistent.h5").status == 2);
  CHECK(fracfarm_run("show").status == 2);
}

TEST_CASE("the record of a real run breaks no rule and is drawn, for brittle and ductile material") {
  const Files files;
  for (const char* material : {"pbx", "aluminum"}) {
    const std::string scene = files.folder.path() / "scene.json", record = files.folder.path() / "real.h5",
                      picture = files.folder.path() / "real.png";
    std::ofstream(scene)
        << R"({"schema": "fracfarm.scene/1", "method": "phase_field", "material": ")" << material
        << R"(", "cracks": [[0.02, 0.12, 0.11, 0.12], [0.15, 0.11, 0.23, 0.11]], "domain": {"width": 0.25, "height": 0.25}, "phase_field": {"cells": [47, 47]},
      "loads": {"top": {"normal_velocity": 1.0}, "bottom": {"normal_velocity": 1.0}, "left": "free", "right": "free"}, "time": {"frame_interval": 2e-5}})";
    REQUIRE(fracfarm_run("solve " + scene + " -o " + record).status == 0);
    const Ended checked = fracfarm_run("check " + record);
    INFO(checked.out);
    CHECK(checked.status == 0);
    const auto shown = nlohmann::json::parse(fracfarm_run("show --json " + record + " -o " + picture).out);
    CHECK(shown["verdict"] == "failed");
    CHECK(shown["frames"] > 5);
    CHECK(std::filesystem::file_size(picture) > 10000);
  }
}

TEST_CASE("the record of a real FDEM run breaks no rule and is drawn, for brittle and ductile material") {
  const test::TemporaryFolder folder;
  const std::string scene = folder.path() / "scene.json", record = folder.path() / "real.h5", picture = folder.path() / "real.png";
  for (const char* material : {"shale", "tungsten"}) {
    std::ofstream(scene)
        << R"({"schema": "fracfarm.scene/1", "method": "fdem", "material": ")" << material
        << R"(", "cracks": [[0.02, 0.12, 0.11, 0.12], [0.15, 0.11, 0.23, 0.11]], "domain": {"width": 0.25, "height": 0.25}, "fdem": {"element_size": 0.01},
      "loads": {"top": {"normal_velocity": 1.0, "tangential": "fixed", "ramp": 1e-4}, "bottom": {"normal_velocity": 1.0, "tangential": "fixed", "ramp": 1e-4},
                "left": "free", "right": "free"}, "time": {"frame_interval": 2e-5}})";
    REQUIRE(fracfarm_run("solve " + scene + " -o " + record).status == 0);
    const Ended checked = fracfarm_run("check " + record);
    INFO(checked.out);
    CHECK(checked.status == 0);
    const auto shown = nlohmann::json::parse(fracfarm_run("show --json " + record + " -o " + picture).out);
    CHECK(shown["verdict"] == "failed");
    CHECK(shown["mesh"]["broken"] > 5);
    CHECK(std::filesystem::file_size(picture) > 10000);
  }
}
