#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>

#include <cstdio>
#include <filesystem>
#include <string>

#include "common/base/atomic_file.hpp"
#include "common/scene/parse.hpp"
#include "common/task/task.hpp"
#include "solver/program/duration.hpp"
#include "solver/solve.hpp"
#include "tests/solver/scenes.hpp"

using namespace fracfarm;
using namespace fracfarm::test;
namespace fs = std::filesystem;

namespace {

struct TempFolder {
  fs::path path = fs::temp_directory_path() / ("fracfarm_program_" + std::to_string(::getpid()));
  TempFolder() { fs::create_directory(path); }
  ~TempFolder() { fs::remove_all(path); }
};

struct Output {
  std::string text;
  int status = -1;
};

Output shell(const std::string& command) {
  Output output;
  std::FILE* pipe = ::popen(command.c_str(), "r");
  char bytes[4096];
  while (const std::size_t got = std::fread(bytes, 1, sizeof bytes, pipe)) output.text.append(bytes, got);
  output.status = WEXITSTATUS(::pclose(pipe));
  return output;
}

const std::string program = std::string(FRACFARM_BIN_DIR) + "/fracfarm-solve";

}  // namespace

TEST_CASE("one scene by hand ends with a record and a summary, and reads standard input") {
  const TempFolder folder;
  const fs::path scene = folder.path / "scene.json", record = folder.path / "record.h5";
  REQUIRE(write_atomically(scene, canonical_text(cracked("pbx", 16))));
  const Output output = shell(program + " - -o " + record.string() + " --json --quiet < " + scene.string());
  CHECK(output.status == 0);
  CHECK(output.text.find("\"verdict\": \"failed\"") != std::string::npos);
  CHECK(output.text.find("\"record_sha256\"") != std::string::npos);
  CHECK(fs::file_size(record) > 1000);
}

TEST_CASE("threads of one run sleep while they wait for each other, and the scene is still read from standard input") {
  const TempFolder folder;
  const fs::path scene = folder.path / "scene.json", record = folder.path / "record.h5";
  REQUIRE(write_atomically(scene, canonical_text(cracked("pbx", 16))));
  const std::string tail = " - -o " + record.string() + " --threads 2 --json --quiet 2>&1";
  const Output output = shell("cat " + scene.string() + " | OMP_DISPLAY_ENV=verbose " + program + tail);
  CHECK(output.status == 0);
  CHECK(output.text.find("\"verdict\": \"failed\"") != std::string::npos);
  const std::size_t last = output.text.rfind("GOMP_SPINCOUNT");
  REQUIRE(last != std::string::npos);
  CHECK(output.text.substr(last, output.text.find('\n', last) - last).find("'0'") != std::string::npos);
}

TEST_CASE("bad input ends with status 2, every problem at once and no record") {
  const TempFolder folder;
  const fs::path scene = folder.path / "scene.json", record = folder.path / "record.h5";
  REQUIRE(write_atomically(scene, R"({"schema": "fracfarm.scene/1", "materal": 1, "domain": {"width": -1}})"));
  const Output output = shell(program + " " + scene.string() + " -o " + record.string() + " --json");
  CHECK(output.status == 2);
  CHECK(output.text.find("materal") != std::string::npos);
  CHECK(output.text.find("domain.width") != std::string::npos);
  CHECK_FALSE(fs::exists(record));
  CHECK(shell(program + " 2>/dev/null").status == 2);
  CHECK(shell(program + " nowhere.json -o x.h5 2>/dev/null").status == 2);
  CHECK(shell(program + " - -o x.h5 --wall-budget soon 2>/dev/null </dev/null").status == 2);
}

TEST_CASE("a scene that diverges ends with status 1, the verdict and the evidence") {
  const TempFolder folder;
  Scene scene = pulled("aluminum", 40);
  scene.phase_field.plasticity = PlasticityModel::none;
  scene.phase_field.cfl = 0.9;
  const double edge = solve(scene, {})->dt / 0.9;
  scene.phase_field.dt = 1.1 * edge;
  scene.horizon = 1e-4;
  const fs::path path = folder.path / "scene.json";
  REQUIRE(write_atomically(path, canonical_text(scene)));
  const Output output = shell(program + " " + path.string() + " -o " + (folder.path / "r.h5").string() + " --json --quiet");
  CHECK(output.status == 1);
  CHECK(output.text.find("\"verdict\": \"diverged\"") != std::string::npos);
  CHECK(output.text.find("\"message\"") != std::string::npos);
}

TEST_CASE("the kept-alive child greets, answers each task, refuses rubbish and ends with its input") {
  const TempFolder folder;
  Task task;
  task.key = "job-1";
  task.scene = canonical_text(cracked("pbx", 12));
  task.output = folder.path / "record.h5";
  Task bad = task;
  bad.scene = "{}";
  REQUIRE(write_atomically(folder.path / "tasks", to_line(task) + "rubbish\n" + to_line(bad)));
  const Output output = shell(program + " --serve < " + (folder.path / "tasks").string());
  CHECK(output.status == 0);
  std::vector<Report> reports;
  for (std::size_t at = 0, end; (end = output.text.find('\n', at)) != std::string::npos; at = end + 1)
    reports.push_back(report_from_line(output.text.substr(at, end - at)).value());
  REQUIRE(reports.size() == 4);
  CHECK(reports[0].kind == Report::Kind::ready);
  CHECK_FALSE(reports[0].build_id.empty());
  CHECK(reports[1].kind == Report::Kind::done);
  CHECK(reports[1].key == "job-1");
  CHECK(reports[1].summary.record_sha256.size() == 64);
  CHECK(reports[2].kind == Report::Kind::fault);
  CHECK(reports[3].error->fault == Fault::bad_request);
  CHECK(fs::exists(task.output));
}

TEST_CASE("a stop signal leaves a checkpoint and status 3, and the same command goes on from it") {
  const TempFolder folder;
  Scene scene = pulled("steel", 300, 0.01);
  scene.horizon = 1.0;  // for ever, if nobody stops it
  scene.frame_interval = 0.5;
  const fs::path path = folder.path / "scene.json", kept = folder.path / "kept";
  REQUIRE(write_atomically(path, canonical_text(scene)));
  const std::string command =
      program + " " + path.string() + " -o " + (folder.path / "r.h5").string() + " --quiet --checkpoint " + kept.string();
  const Output output = shell("timeout -s TERM 0.5 " + command + " 2>/dev/null; echo $?");
  CHECK(output.text.find("124") != std::string::npos);  // timeout's own status: it had to send the signal
  CHECK(fs::exists(kept));
  CHECK(shell("timeout --preserve-status -s INT 0.5 " + command + " 2>/dev/null").status == 3);
}

TEST_CASE("durations are read as people type them") {
  CHECK(parse_duration("90") == 90.0);
  CHECK(parse_duration("8h") == 28800.0);
  CHECK(parse_duration("1.5m") == 90.0);
  for (const char* text : {"", "h", "-3", "0", "5x", "nan", "inf", "1h30"}) CHECK_FALSE(parse_duration(text));
}
