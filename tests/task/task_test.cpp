#include "common/task/task.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

using namespace fracfarm;

namespace {

Task some_task() {
  Task task;
  task.key = "k1";
  task.scene = "{\"a\": \"line\nbreak\"}";
  task.output = "out/record.h5";
  task.checkpoint = "out/state.ckpt";
  task.wall_budget_s = 12.5;
  task.attempt = 3;
  task.step_scale = 0.5;
  return task;
}

Summary some_summary() {
  Summary summary;
  summary.verdict = Verdict::failed;
  summary.time_to_failure = 4.43e-4;
  summary.failure_rule = "through_crack";
  summary.times = {{"through_crack", 4.43e-4}, {"stress_drop", 3.9e-4}, {"five_step", std::nullopt}};
  summary.peak_stress = 6.9e6;
  summary.steps = 812;
  summary.dt = 5.87e-7;
  summary.energy_residual = 4e-4;
  summary.cpu_s = 0.1;
  summary.wall_s = 0.2;
  summary.stages = {{"damage", 0.03}};
  summary.kernel = "avx2 double";
  summary.record_sha256 = std::string(64, 'a');
  return summary;
}

Report done_report() {
  Report report;
  report.kind = Report::Kind::done;
  report.key = "k1";
  report.summary = some_summary();
  return report;
}

}  // namespace

TEST_CASE("a task survives the pipe as one line") {
  const std::string line = to_line(some_task());
  CHECK(line.find('\n') == line.size() - 1);
  const Task back = task_from_line(line).value();
  CHECK(back.key == "k1");
  CHECK(back.scene == some_task().scene);
  CHECK(back.output == "out/record.h5");
  CHECK(back.checkpoint == "out/state.ckpt");
  CHECK(back.wall_budget_s == 12.5);
  CHECK(back.attempt == 3);
  CHECK(back.step_scale == 0.5);
}

TEST_CASE("a done report carries the whole summary, times that are absent as null") {
  const std::string line = to_line(done_report());
  CHECK(line.find("\"five_step\":null") != std::string::npos);
  const Summary back = report_from_line(line).value().summary;
  CHECK(back.times == some_summary().times);
  CHECK(back.stages == some_summary().stages);
  CHECK(back.time_to_failure == 4.43e-4);
  CHECK(to_json_text(back) == to_json_text(some_summary()));
}

TEST_CASE("numbers that are not finite leave as null and come back as not a number") {
  Report report = done_report();
  report.summary.peak_stress = std::numeric_limits<double>::infinity();
  report.summary.energy_residual = std::nan("");
  report.summary.time_to_failure = std::nan("");
  const Summary back = report_from_line(to_line(report)).value().summary;
  CHECK(std::isnan(back.peak_stress));
  CHECK(std::isnan(back.energy_residual));
  CHECK_FALSE(back.time_to_failure);
}

TEST_CASE("each kind of report keeps its own fields") {
  Report ready;
  ready.build_id = "0.1.0-abc";
  CHECK(report_from_line(to_line(ready)).value().build_id == "0.1.0-abc");
  Report progress;
  progress.kind = Report::Kind::progress;
  progress.step = 77;
  progress.time = 1e-5;
  progress.horizon = 1e-3;
  const Report back = report_from_line(to_line(progress)).value();
  CHECK(back.kind == Report::Kind::progress);
  CHECK(back.step == 77);
  CHECK(back.time == 1e-5);
  CHECK(back.horizon == 1e-3);
  Report stopped;
  stopped.kind = Report::Kind::stopped;
  CHECK(report_from_line(to_line(stopped)).value().kind == Report::Kind::stopped);
}

TEST_CASE("every fault class survives the pipe") {
  for (const FaultRow& row : fault_table) {
    Report report;
    report.kind = Report::Kind::fault;
    report.error = Error{row.fault, "peak \"9\" above 8"};
    const Report back = report_from_line(to_line(report)).value();
    CHECK(back.error.value().fault == row.fault);
    CHECK(back.error.value().message == "peak \"9\" above 8");
  }
}

TEST_CASE("the summary printed for people has the documented keys") {
  const auto json = nlohmann::json::parse(to_json_text(some_summary()));
  for (const char* key : {"schema", "verdict", "time_to_failure", "failure_rule", "times", "peak_stress", "steps", "dt", "energy_residual",
                          "cpu_s", "wall_s", "stages", "kernel", "record_sha256"})
    CHECK(json.contains(key));
  CHECK(json["verdict"] == "failed");
}

TEST_CASE("bytes that are not UTF-8 do not stop a report") {
  Report report;
  report.kind = Report::Kind::fault;
  report.error = Error{Fault::solver_crash, "bad \xff\xfe name"};
  CHECK(report_from_line(to_line(report)).has_value());
}

TEST_CASE("lines that are no message are refused in words") {
  for (std::string line : {"", "{", "null", "[1]", "{}", "{\"schema\":\"fracfarm.task/2\"}",
                           "{\"schema\":\"fracfarm.task/1\",\"report\":\"dance\",\"key\":\"k\"}"}) {
    const auto report = report_from_line(line);
    REQUIRE_FALSE(report);
    CHECK_FALSE(report.error().message.empty());
    CHECK_FALSE(task_from_line(line));
  }
  CHECK(report_from_line(std::string(100000, '[')).error().fault == Fault::bad_request);
}

TEST_CASE("a field of the wrong type or out of range is named") {
  const auto with = [](const char* key, nlohmann::json value) {
    nlohmann::json json = nlohmann::json::parse(to_line(some_task()));
    json[key] = value;
    return task_from_line(json.dump());
  };
  CHECK(with("attempt", 1.5).error().message.find("attempt") != std::string::npos);
  CHECK(with("attempt", 4294967297LL).error().message.find("attempt") != std::string::npos);
  CHECK(with("attempt", 18446744073709551615ULL).error().message.find("attempt") != std::string::npos);
  CHECK(with("attempt", 0).error().message.find("attempt") != std::string::npos);
  CHECK(with("step_scale", 0.0).error().message.find("step_scale") != std::string::npos);
  CHECK(with("wall_budget_s", nullptr).error().message.find("wall_budget_s") != std::string::npos);
  CHECK(with("scene", 3).error().message.find("scene") != std::string::npos);
}

TEST_CASE("every truncation and every flipped byte of a line is either refused or read, never thrown") {
  const std::string line = to_line(done_report());
  for (std::size_t n = 0; n + 1 < line.size(); ++n) CHECK_FALSE(report_from_line(line.substr(0, n)));
  for (std::size_t n = 0; n < line.size(); ++n)
    for (unsigned char bit = 0; bit < 8; ++bit) {
      std::string mutant = line;
      mutant[n] = static_cast<char>(mutant[n] ^ (1 << bit));
      CHECK_NOTHROW(report_from_line(mutant));
    }
}
