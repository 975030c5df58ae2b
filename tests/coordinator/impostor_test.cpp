// Peers that have a key of their own and say what others said: they get no job and end none.
#include <catch2/catch.hpp>

#include "tests/coordinator/farm_fixture.hpp"

using namespace fracfarm;
using namespace fracfarm::test;

namespace {

struct Burglary {
  Farm farm{4};
  wire::Assignment theirs;

  Burglary() {
    farm.hello("victim", "node-v");
    theirs = farm.one("victim");
  }
  void check_untouched() {
    CHECK(farm.job(theirs.job).state == State::leased);
    CHECK(attempts_of(farm.ledger.reading(), static_cast<std::int64_t>(theirs.job)).empty());
    CHECK(farm.complete("victim", result_of(theirs)) == wire::Receipt::accepted);
  }
};

}  // namespace

TEST_CASE("A peer that never said HELLO is refused whatever it repeats, and its BYE gives nothing back") {
  Burglary scene;
  Farm& farm = scene.farm;
  CHECK(std::holds_alternative<wire::Refusal>(farm.tell("thief", wire::Next{{result_of(scene.theirs)}, {}, {}, 4, -1.0})));
  CHECK(std::holds_alternative<wire::Refusal>(farm.tell("thief", wire::Beat{{held(scene.theirs)}})));
  farm.tell("thief", wire::Bye{{scene.theirs.lease}});
  scene.check_untouched();
}

TEST_CASE("A worker of the farm keeps, fails, returns and completes no lease of another") {
  Burglary scene;
  Farm& farm = scene.farm;
  farm.hello("thief", "node-t");
  CHECK(farm.beat("thief", {held(scene.theirs)}).rulings == std::vector{wire::Ruling::abandon});
  CHECK(farm.fail_with("thief", scene.theirs, Fault::solver_crash) == wire::Receipt::stale);
  farm.next("thief", {{}, {}, {scene.theirs.lease}, 0, -1.0});
  CHECK(farm.complete("thief", result_of(scene.theirs, "forged")) == wire::Receipt::refused);
  scene.check_untouched();
}

TEST_CASE("A result that is said again changes nothing, by whomever") {
  Burglary scene;
  Farm& farm = scene.farm;
  const wire::Completion result = result_of(scene.theirs);
  CHECK(farm.complete("victim", result) == wire::Receipt::accepted);
  const std::string first = farm.job(scene.theirs.job).outcome->sha256;
  CHECK(farm.complete("victim", result) == wire::Receipt::accepted);
  wire::Completion other = result_of(scene.theirs, "another record");
  CHECK(farm.complete("victim", other) == wire::Receipt::duplicate);
  farm.hello("thief", "node-t");
  CHECK(farm.complete("thief", other) == wire::Receipt::refused);
  CHECK(farm.job(scene.theirs.job).outcome->sha256 == first);
}

TEST_CASE("A worker that lost its lease still brings its result, and the first one wins") {
  Burglary scene;
  Farm& farm = scene.farm;
  farm.pass(100.0);
  REQUIRE(farm.job(scene.theirs.job).state != State::leased);
  farm.hello("victim", "node-v");
  CHECK(farm.complete("victim", result_of(scene.theirs)) == wire::Receipt::accepted);
}
