#include "coordinator/cli/farm_link.hpp"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "common/base/exit_code.hpp"
#include "common/wire/endpoint.hpp"
#include "coordinator/cli/farm_verbs.hpp"
#include "coordinator/cli/status_text.hpp"
#include "coordinator/cli/submission.hpp"
#include "coordinator/cli/verb.hpp"
#include "tests/coordinator/half_made.hpp"
#include "tests/wire/temp_farm.hpp"

using namespace fracfarm;
using namespace fracfarm::cli;
using nlohmann::json;

TEST_CASE("Without a coordinator a verb works on the ledger itself") {
  TempFarm temp;
  const Campaign campaign = parse_campaign(test::campaign_text(3), "test").value();
  {
    FarmLink link = FarmLink::open(temp.path, true).value();
    CHECK_FALSE(link.served());
    const Answered answer = submit(link, campaign, false);
    REQUIRE(answer.usable);
    CHECK(json::parse(answer.body)["complete"] == true);
  }
  FarmLink again = FarmLink::open(temp.path).value();
  const json status = json::parse(again.ask("status", json::object()).value().body);
  CHECK(status["counts"]["ready"] == 3);
  CHECK(status["serving"] == false);
}

TEST_CASE("A farm that is not there is not reachable, and looking does not make it") {
  TempFarm temp;
  const Result<FarmLink> link = FarmLink::open(temp.path / "none");
  REQUIRE_FALSE(link);
  CHECK(report_unreachable(link.error(), true) == exit_unreachable);
  CHECK_FALSE(std::filesystem::exists(temp.path / "none"));
}

// Its coordinator was ended while it made the campaign's jobs: the endpoint is of its earlier start.
TEST_CASE("A question that an ended coordinator left is answered over every job, also of a campaign that is half made") {
  TempFarm temp;
  const FarmPaths paths{temp.path};
  std::filesystem::create_directories(paths.ledger_folder());
  std::optional<LedgerLock> coordinator = LedgerLock::take(paths.lock(), 0.0, holder_coordinator).value();
  {
    Database database = Database::open(paths.ledger());
    REQUIRE(test::make_half(database));
  }
  REQUIRE(wire::load_or_make_key(temp.path, "server"));
  REQUIRE(wire::write_endpoint(temp.path, {"tcp://127.0.0.1:9", 1, ::getpid()}));
  FarmLink link = FarmLink::open(temp.path).value();
  REQUIRE(link.served());
  coordinator.reset();
  CHECK(json::parse(link.ask("jobs", json::object()).value().body)["jobs"].size() == 3);
  CHECK_FALSE(link.served());
}

TEST_CASE("Status in words has the counts by material and load, the faults and what to do") {
  test::Farm farm(3);
  farm.hello("worker-a", "n1");
  farm.complete("worker-a", test::result_of(farm.one("worker-a")));
  farm.fail_with("worker-a", farm.one("worker-a"), Fault::bad_request);
  const std::string text = status_text(farm.ask("status", json::object()), stdout);
  for (const char* part : {"1 of 3 jobs done", "pbx", "uniaxial", "BAD_REQUEST 1", "1 quarantined", "worker-a", "left, done at"}) {
    INFO(text << "\nlacks " << part);
    CHECK(text.find(part) != std::string::npos);
  }
}

TEST_CASE("Explain in words names every try with its node and message") {
  test::Farm farm(1);
  farm.hello("worker-a", "n1");
  farm.fail_with("worker-a", farm.one("worker-a"), Fault::solver_crash, "signal 11");
  const std::string text = explain_text(farm.ask("explain", {{"job", "1"}}), stdout);
  for (const char* part : {"SOLVER_CRASH", "n1", "signal 11", "said the test", "retry_wait"}) CHECK(text.find(part) != std::string::npos);
}

TEST_CASE("Every verb has a group and a summary, and a name of its own") {
  std::set<std::string_view> names;
  for (const Verb& verb : verbs()) {
    CHECK_FALSE(verb.group.empty());
    CHECK_FALSE(verb.summary.empty());
    CHECK(names.insert(verb.name).second);
  }
}
