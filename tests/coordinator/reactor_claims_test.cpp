// What a worker is handed, and what it is told where nothing is for it.
#include <catch2/catch.hpp>

#include "tests/coordinator/farm_fixture.hpp"

using namespace fracfarm;
using namespace fracfarm::test;

TEST_CASE("An allocation that nothing fits any more is given back at once, but not while it holds something") {
  Farm farm(40);
  farm.hello("worker-a", "n1");
  for (std::uint64_t n = 0; n < enough_history; ++n) farm.complete("worker-a", result_of(farm.one("worker-a")));
  farm.pass(10.0);  // the times are learned
  farm.hello("worker-a", "n1");
  const wire::Assignment it = farm.claim("worker-a", 1, 4000.0).assignments.at(0);
  CHECK(farm.claim("worker-a", 1, 5.0).order == wire::Order::wait);
  farm.complete("worker-a", result_of(it));
  CHECK(farm.claim("worker-a", 1, 4.0).order == wire::Order::drain);
  farm.hello("worker-b", "n2");
  CHECK(farm.claim("worker-b", 1, -1.0).assignments.size() == 1);  // one without an end is not concerned
}

TEST_CASE("An allocation for which there is no work, or none whose time is known, waits a while before it is given back") {
  const bool unknown = GENERATE(false, true);
  Farm farm(unknown ? 2 : 1);
  farm.hello("worker-a", "n1");
  farm.hello("worker-b", "n2");
  const wire::Assignment it = farm.claim("worker-b", 1).assignments.at(0);
  const double left_s = unknown ? 3000.0 : 9000.0;  // the budget of a job is an hour
  for (double passed_s = 0.0; passed_s < farm.settings.idle_return_s; passed_s += 2.0) {
    CHECK(farm.claim("worker-a", 1, left_s).order == wire::Order::wait);
    farm.beat("worker-b", {held(it)});
    farm.pass(2.0);
  }
  CHECK(farm.claim("worker-a", 1, left_s).order == wire::Order::drain);
}

TEST_CASE("Explain says that the whole budget counts until results of the class are known") {
  Farm farm(3);
  farm.tell("worker-a", wire::Hello{"n1", "i1", 1, 1u << 30, build, 600.0, {}});
  const std::string why = farm.ask("explain", {{"job", "3"}})["why"];
  CHECK(why.find("whole wall-clock budget") != std::string::npos);
  CHECK(why.find("20 results") != std::string::npos);
}

TEST_CASE("What is held or of a paused class is not handed out, and holds up the others not") {
  Farm farm(4);
  farm.hello("worker-a", "n1");
  farm.ask("hold", {{"jobs", {1, 3}}});
  const wire::Jobs jobs = farm.claim("worker-a", 4);
  REQUIRE(jobs.assignments.size() == 2);
  CHECK(jobs.assignments[0].job == 2);
  farm.ask("release", {{"state", "HELD"}});
  CHECK(farm.claim("worker-a", 4).assignments.size() == 2);
}
