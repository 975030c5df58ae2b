#include "coordinator/enrolment.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "tests/coordinator/half_made.hpp"

using namespace fracfarm;
using namespace fracfarm::test;
using nlohmann::json;

namespace {

std::string text_with(const std::string& patterns, const std::string& more = "", const std::string& name = "test") {
  return fmt::format(
      R"({{"name": "{}", "seed": 7, "jobs": [{{"method": "phase_field", "materials": ["pbx", "steel"], "loads": ["uniaxial", "biaxial"],
    "patterns": {}{}}}], "budget": {{"wall_clock": "1h", "attempts": 3}}}})",
      name, patterns, more);
}

std::set<std::int64_t> lane_ids(Farm& farm) {
  std::set<std::int64_t> ids;
  for (const Lane& lane : lanes_where(farm.ledger.reading(), {}))
    for (std::int64_t id = lane.next; id <= lane.last; id += lane.stride) CHECK(ids.insert(id).second);
  return ids;
}

bool counters_agree(Farm& farm) {
  const auto a = count_rows(farm.ledger.reading()), b = recount_rows(farm.ledger.reading());
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](const CountRow& x, const CountRow& y) {
           return x.campaign == y.campaign && x.state == y.state && x.verdict == y.verdict && x.job_class == y.job_class && x.n == y.n;
         });
}

}  // namespace

TEST_CASE("A campaign's lanes are its jobs, each once, of the class that the campaign says") {
  Farm farm(0);
  const std::string text = text_with(R"({"orthogonal": "1-3,7-9", "oblique": "2-4"})", R"(, "set": {"phase_field.cfl": [0.8, 0.9]})");
  farm.submit(text);
  CHECK(lane_ids(farm).size() == 9 * 2 * 2 * 2);
  CHECK(*lane_ids(farm).begin() == 1);
  CHECK(*lane_ids(farm).rbegin() == 72);
  const Campaign campaign = parse_campaign(text, "test").value();
  for (const Lane& lane : lanes_where(farm.ledger.reading(), {}))
    for (std::int64_t id = lane.next; id <= lane.last; id += lane.stride) {
      const JobSpec spec = job_at(campaign, static_cast<std::uint64_t>(id - 1));
      CHECK(lane.job_class == JobClass{"phase_field", spec.material, spec.load});
    }
  CHECK(counters_agree(farm));
}

TEST_CASE("Jobs that an earlier campaign has are shared, whatever ranges overlap") {
  Farm farm(0);
  farm.submit(text_with(R"({"orthogonal": "5-10"})", "", "first"));
  const json second = farm.submit(text_with(R"({"orthogonal": "1-6,9-12", "oblique": "5-10"})", "", "second"));
  CHECK(second["total"] == 64);
  CHECK(second["shared"] == 4 * 4);  // patterns 5, 6, 9, 10 of four classes
  CHECK(farm.ask("status", json::object())["total"] == 24 + 64 - 16);
  CHECK(lane_ids(farm).size() == 72);
  CHECK(counters_agree(farm));
  const json known = farm.ask("known", {{"campaign", text_with(R"({"orthogonal": "4-13"})", "", "third")}});
  CHECK(known["present"] == 4 * 9);  // 4-12
}

TEST_CASE("A default that is written out is the same job; another seed, redraw or setting is another") {
  const auto shared_with = [](const std::string& other) {
    Farm farm(0);
    farm.submit(text_with(R"({"orthogonal": "1-4"})", "", "first"));
    return farm.submit(other)["shared"].get<int>();
  };
  CHECK(shared_with(text_with(R"({"orthogonal": "1-4"})", R"(, "set": {"phase_field.cfl": 0.9})", "x")) == 16);
  CHECK(shared_with(text_with(R"({"orthogonal": "1-4"})", R"(, "set": {"phase_field.cfl": 0.8})", "x")) == 0);
  CHECK(shared_with(text_with(R"({"orthogonal": "1-4", "redraw": true})", "", "x")) == 0);
}

TEST_CASE("Jobs that only their scenes show to be equal are done once: the second is counted as shared when it is reached") {
  Farm farm(0);
  farm.submit(text_with(R"({"orthogonal": "1-4"})", "", "first"));
  farm.hello("worker-a", "n1", "i1", {}, 64);
  std::set<std::string> keys;
  for (const wire::Assignment& it : farm.claim("worker-a", 16).assignments) {
    CHECK(keys.insert(it.key).second);
    farm.complete("worker-a", result_of(it));
  }
  farm.submit(text_with(R"({"orthogonal": "1-4", "redraw": true})", "", "second"));
  for (const wire::Assignment& it : farm.claim("worker-a", 16).assignments) {
    CHECK(keys.insert(it.key).second);
    farm.complete("worker-a", result_of(it));
  }
  const auto campaigns = farm.ask("status", json::object())["campaigns"];
  CHECK(campaigns[1]["shared"].get<int>() + static_cast<int>(keys.size()) == 32);
  CHECK(farm.reactor->settled());
  CHECK(counters_agree(farm));
}

TEST_CASE("A job that is held, cancelled or given a priority before anybody touched it leaves its lane") {
  Farm farm(10);
  farm.ask("hold", {{"jobs", {5}}});
  farm.ask("cancel", {{"jobs", {1}}});
  farm.ask("priority", {{"jobs", {9}}, {"priority", 5}});
  CHECK(lane_ids(farm) == std::set<std::int64_t>{2, 3, 4, 6, 7, 8, 10});
  CHECK(counters_agree(farm));
  farm.hello("worker-a", "n1", "i1", {}, 64);
  std::vector<std::uint64_t> order;
  for (const wire::Assignment& it : farm.claim("worker-a", 20).assignments) order.push_back(it.job);
  CHECK(order == std::vector<std::uint64_t>{9, 2, 3, 4, 6, 7, 8, 10});
  CHECK(farm.job(5u).state == State::held);
  CHECK(counters_agree(farm));
}

TEST_CASE("Whole classes are held, released and cancelled without a row, also by count") {
  Farm farm(0);
  farm.submit(text_with(R"({"orthogonal": "1-1000"})"));
  CHECK(farm.ask("hold", {{"material", "steel"}, {"dry_run", true}})["changed"] == 2000);
  CHECK(farm.ask("hold", {{"material", "steel"}})["changed"] == 2000);
  CHECK(farm.ask("release", {{"material", "steel"}, {"load", "biaxial"}, {"count", 10}})["changed"] == 10);
  CHECK(farm.ask("cancel", {{"state", "HELD"}, {"count", 100}})["changed"] == 100);
  const json counts = farm.ask("status", json::object())["counts"];
  CHECK(counts["ready"] == 2010);
  CHECK(counts["held"] == 1890);
  CHECK(counts["cancelled"] == 100);
  CHECK(jobs_where(farm.ledger.reading(), {}).empty());
  CHECK(counters_agree(farm));
}

TEST_CASE("Higher priorities come first, then lower ids, over lanes and rows alike") {
  Farm farm(0);
  farm.submit(text_with(R"({"orthogonal": "1-3"})"));
  farm.ask("priority", {{"material", "steel"}, {"load", "biaxial"}, {"priority", 7}});
  farm.hello("worker-a", "n1", "i1", {}, 64);
  std::vector<std::uint64_t> order;
  for (const wire::Assignment& it : farm.claim("worker-a", 6).assignments) order.push_back(it.job);
  CHECK(order == std::vector<std::uint64_t>{4, 8, 12, 1, 2, 3});
}

TEST_CASE("Listing shows jobs whether they were touched or not, in order and in pages") {
  Farm farm(6);
  farm.hello("worker-a", "n1");
  farm.claim("worker-a", 2);
  farm.ask("hold", {{"jobs", {5}}});
  std::vector<int> ids;
  for (int after = 0; ids.size() < 6;) {
    const json page = farm.ask("jobs", {{"limit", 2}, {"after", after}});
    for (const json& it : page["jobs"]) ids.push_back(it["id"]);
    after = ids.back();
  }
  CHECK(ids == std::vector<int>{1, 2, 3, 4, 5, 6});
  CHECK(farm.ask("jobs", {{"state", "ready"}})["jobs"].size() == 3);
}

TEST_CASE("Patterns outside of others' are found in spans of indices") {
  JobBlock block, other;
  block.patterns = {{CrackSet::orthogonal, 1, 10}, {CrackSet::oblique, 1, 5}};
  other.patterns = {{CrackSet::orthogonal, 4, 6}, {CrackSet::oblique, 1, 2}};
  CHECK(patterns_outside(block, {}) == std::vector<Span>{{0, 14}});
  CHECK(patterns_outside(block, {&other}) == std::vector<Span>{{0, 2}, {6, 9}, {12, 14}});
  CHECK(patterns_outside(block, {&other, &block}).empty());
}

TEST_CASE("A campaign that a release of the first schema left half made is made to its end, and what it had stays as it was") {
  Database database = Database::open({});
  REQUIRE(make_half(database));
  Ledger ledger = std::move(Ledger::over(std::move(database)).value());
  REQUIRE(enrol_the_rest(ledger));
  REQUIRE(enrol_the_rest(ledger));  // nothing more
  CampaignBook book;
  const std::vector<Job> jobs = list_jobs(ledger.reading(), book, {});
  REQUIRE(jobs.size() == 3);
  CHECK(jobs[0].id == 7);
  CHECK(jobs[1].state == State::quarantined);
  CHECK(jobs[2].id > 8);
  CHECK(jobs[2].position == 2);
  CHECK(jobs[2].sample_id == 3);
  CHECK(jobs[2].state == State::ready);
  std::uint64_t counted = 0, recounted = 0;
  for (const CountRow& row : count_rows(ledger.reading())) counted += row.n;
  for (const CountRow& row : recount_rows(ledger.reading())) recounted += row.n;
  CHECK(counted == 3);
  CHECK(recounted == 3);
  CHECK(campaign_row(ledger.reading(), 1)->expanded == 3);
}
