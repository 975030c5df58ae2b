// Copies of requests that were long under way: the simulation found that they got leases that nobody would ever work on, and took jobs from
// a worker that had started again.
#include <catch2/catch.hpp>

#include "tests/coordinator/farm_fixture.hpp"

using namespace fracfarm;
using namespace fracfarm::test;

namespace {

std::size_t leased(Farm& farm) { return leased_jobs(farm.ledger.reading()).size(); }

}  // namespace

TEST_CASE("A copy of a claim that comes after later requests of its worker gets nothing") {
  Farm farm(8);
  const wire::Next claim{{}, {}, {}, 1, -1.0};
  farm.tell("w", wire::Hello{"node", "i1", 4, 1u << 30, build, -1.0, {}}, 10);
  farm.tell("w", claim, 11);
  REQUIRE(leased(farm) == 1);
  SECTION("after another HELLO") { farm.tell("w", wire::Hello{"node", "i1", 4, 1u << 30, build, -1.0, {}}, 12); }
  SECTION("after more requests than replies are kept of") {
    for (std::uint64_t id = 12; id < 20; ++id) farm.tell("w", wire::Beat{}, id);
  }
  const std::size_t before = leased(farm);
  CHECK(std::holds_alternative<wire::Refusal>(farm.tell("w", claim, 11)));
  CHECK(leased(farm) == before);
  CHECK(std::get<wire::Jobs>(farm.tell("w", claim, 30)).assignments.size() == 1);
}

TEST_CASE("A request of an earlier life, whose ids lie elsewhere, gets nothing") {
  Farm farm(8);
  farm.tell("w", wire::Hello{"node", "i1", 4, 1u << 30, build, -1.0, {}}, std::uint64_t{1} << 40);
  CHECK(std::holds_alternative<wire::Refusal>(farm.tell("w", wire::Next{{}, {}, {}, 1, -1.0}, std::uint64_t{1} << 50)));
  CHECK(leased(farm) == 0);
}

TEST_CASE("A HELLO of an earlier life takes nothing from the later one") {
  Farm farm(8);
  farm.hello("w", "node", "i1");
  farm.hello("w", "node", "i2");
  const wire::Assignment it = farm.one("w");
  CHECK(std::holds_alternative<wire::Refusal>(farm.hello("w", "node", "i1")));
  CHECK(farm.job(it.job).state == State::leased);
  CHECK(attempts_of(farm.ledger.reading(), static_cast<std::int64_t>(it.job)).empty());
  CHECK(farm.beat("w", {held(it)}).rulings == std::vector{wire::Ruling::adopt});
}

TEST_CASE(
    "The first word of an earlier life takes nothing from the later one and does not shut it out, though nobody ever heard of that life") {
  Farm farm(8);
  farm.hello("w", "node", "i2");
  const wire::Assignment it = farm.one("w");
  CHECK(std::holds_alternative<wire::Refusal>(farm.hello("w", "node", "i1")));
  CHECK(farm.job(it.job).state == State::leased);
  farm.start();  // also after a restart
  CHECK(std::holds_alternative<wire::Refusal>(farm.hello("w", "node", "i1")));
  CHECK(std::holds_alternative<wire::Welcome>(farm.hello("w", "node", "i2", {held(it)})));
  CHECK(farm.complete("w", result_of(it)) == wire::Receipt::accepted);
}

TEST_CASE("A copy of the HELLO of a start that has said BYE makes no worker of it, and its claims get nothing") {
  Farm farm(8);
  const wire::Hello hello{"node", "i1", 4, 1u << 30, build, -1.0, {}};
  farm.tell("w", hello, 10);
  farm.tell("w", wire::Bye{}, 15);
  CHECK(std::holds_alternative<wire::Refusal>(farm.tell("w", hello, 10)));
  CHECK(std::holds_alternative<wire::Refusal>(farm.tell("w", wire::Next{{}, {}, {}, 1, -1.0}, 11)));
  CHECK(leased(farm) == 0);
  CHECK(std::holds_alternative<wire::Welcome>(farm.hello("w", "node", "i2")));
}
