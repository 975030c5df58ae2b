// What operators see beside the farm's answers: what stands out, metrics, the checkup, notices.
#include <catch2/catch.hpp>
#include <chrono>
#include <fstream>
#include <thread>

#include "coordinator/cli/checkup.hpp"
#include "coordinator/cli/metrics_text.hpp"
#include "coordinator/cli/overrepresented.hpp"
#include "coordinator/notifier.hpp"
#include "tests/coordinator/farm_fixture.hpp"
#include "tests/wire/temp_farm.hpp"

using namespace fracfarm;
using namespace fracfarm::cli;
using nlohmann::json;

TEST_CASE("Fisher's tail and Wilson's interval are those of the books") {
  CHECK(fisher_tail(3, 4, 4, 8) == Approx(17.0 / 70.0));  // the lady tasting tea, R. A. Fisher 1935
  CHECK(fisher_tail(4, 4, 4, 8) == Approx(1.0 / 70.0));
  CHECK(fisher_tail(0, 4, 4, 8) == Approx(1.0));
  CHECK(wilson(0, 10).low == 0.0);
  CHECK(wilson(0, 10).high == Approx(0.2775).epsilon(1e-3));
  CHECK(wilson(5, 10).low == Approx(0.2366).epsilon(1e-3));
  CHECK(wilson(5, 10).high == Approx(0.7634).epsilon(1e-3));
}

TEST_CASE("The one value that makes jobs fail stands out, the others do not") {
  std::vector<Features> failed, sound;
  for (int n = 0; n < 400; ++n) {
    const Features job{{"material", n % 5 == 0 ? "steel" : "pbx"}, {"number of cracks", std::to_string(n % 7)}};
    (n % 5 == 0 && n % 3 == 0 ? failed : sound).push_back(job);
  }
  const std::vector<Standing> list = standing_out(failed, sound, 1.0);
  CHECK(list.front().feature == "material");
  CHECK(list.front().value == "steel");
  CHECK(list.front().lift == Approx(5.0));
  CHECK(list.front().p < 1e-12);
  for (std::size_t at = 1; at < list.size(); ++at) CHECK(list[at].p > 0.01);
}

TEST_CASE("Sound jobs that stand for many weigh as many in the lift") {
  const std::vector<Features> failed(10, {{"load", "biaxial"}}), sound{{{"load", "biaxial"}}, {{"load", "uniaxial"}}};
  CHECK(standing_out(failed, sound, 1.0).front().lift == Approx(12.0 / 11.0));
  CHECK(standing_out(failed, sound, 100.0).front().lift == Approx(210.0 / 110.0));
}

TEST_CASE("Metrics are Prometheus text: a help and a type for each name, numbers that status has") {
  test::Farm farm(3);
  farm.hello("worker-a", "n\"1");
  farm.complete("worker-a", test::result_of(farm.one("worker-a")));
  const std::string text = metrics_text(farm.ask("status", json::object()));
  for (const char* line :
       {"fracfarm_up 1\n", "fracfarm_jobs{method=\"phase_field\",material=\"pbx\",load=\"uniaxial\",state=\"ready\"} 2\n",
        "fracfarm_results_total{method=\"phase_field\",material=\"pbx\",load=\"uniaxial\",verdict=\"failed\"} 1\n", "node=\"n\\\"1\"",
        "# TYPE fracfarm_jobs gauge\n"}) {
    INFO(text << "\nlacks " << line);
    CHECK(text.find(line) != std::string::npos);
  }
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) CHECK((line.starts_with("# ") || line.starts_with("fracfarm_")));
}

TEST_CASE("The checkup says what is bad and what to do") {
  using Verdict = CheckupLine::Verdict;
  CHECK(judge_disk("d", 1e12, 1e6, 1e7).verdict == Verdict::good);
  CHECK(judge_disk("d", 10e9, 1e6, 1e7).verdict == Verdict::warning);
  CHECK(judge_disk("d", 1e9, 1e6, 1e7).verdict == Verdict::bad);
  CHECK(judge_disk("d", 1e12, 10, 1e7).verdict == Verdict::bad);
  CHECK(judge_disk("d", 1e12, 0, 0).verdict == Verdict::good);  // a file system that counts none
  CHECK(judge_file_limit(256).verdict == Verdict::warning);
  CHECK(judge_clock(true, 0.01).verdict == Verdict::good);
  CHECK(judge_clock(false, 0.0).verdict == Verdict::warning);
  CHECK(judge_key("k", 0600).verdict == Verdict::good);
  CHECK(judge_key("k", 0640).verdict == Verdict::bad);
  for (const CheckupLine& line : {judge_key("k", 0644), judge_disk("d", 0, 0, 0), judge_file_limit(1)}) CHECK_FALSE(line.advice.empty());
}

TEST_CASE("A notice reaches the command as one line of JSON; one that fails or hangs is said and holds up nobody") {
  TempFarm temp;
  const auto file = temp.path / "told";
  {
    Notifier notifier(fmt::format("cat >> {}", file.string()));
    notifier.tell({{"quarantined", "job 3: SOLVER_NUMERIC", 3}, {"suspect", "n1 \xff", 0, "n1"}}, 1.7e9);
  }
  std::ifstream in(file);
  std::vector<json> told;
  for (std::string line; std::getline(in, line);) told.push_back(json::parse(line));
  REQUIRE(told.size() == 2);
  CHECK(told[0]["schema"] == "fracfarm.notice/1");
  CHECK(told[0]["job"] == 3);
  CHECK(told[1]["node"] == "n1");
  Notifier failing("exit 3", 5.0), hanging("sleep 100", 0.05);
  failing.tell({{"alarm", "x"}}, 0.0);
  hanging.tell({{"alarm", "x"}}, 0.0);
  const auto complaint = [](Notifier& notifier) {
    for (int n = 0; n < 1000; ++n) {
      if (const auto words = notifier.take_complaints(); !words.empty()) return words.front();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return std::string();
  };
  CHECK(complaint(failing).find("status 3") != std::string::npos);
  CHECK(complaint(hanging).find("killed") != std::string::npos);
}
