#include "coordinator/requests.hpp"

#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "tests/coordinator/farm_fixture.hpp"

using namespace fracfarm;
using namespace fracfarm::test;
using nlohmann::json;

TEST_CASE("Every request answers a JSON object that names its schema, also to nonsense") {
  Farm farm(2);
  for (const RequestRow& row : requests())
    for (const char* arguments : {"{}", "", "[1,2]", "nonsense \xff", R"({"joob": 3})",
                                  R"({"jobs": "x", "job": [], "limit": -5, "after": "a", "workers": 7, "keys": {}, "campaign": 5})"}) {
      INFO(row.verb << " " << arguments);
      const auto answer = std::get<wire::Answer>(farm.tell("client", wire::Ask{std::string(row.verb), arguments}));
      const json body = json::parse(answer.body);
      CHECK(body.at("schema").get<std::string>().find("fracfarm.") == 0);
    }
}

TEST_CASE("An unknown argument is refused with the nearest known one") {
  Farm farm(1);
  int exit_code = 0;
  const json body = farm.ask("jobs", {{"materiel", "pbx"}}, &exit_code);
  CHECK(exit_code == 2);
  CHECK(body["problems"][0]["suggestion"] == "did you mean 'material'?");
}

TEST_CASE("An unknown request is refused") {
  Farm farm(1);
  int exit_code = 0;
  farm.ask("stattus", json::object(), &exit_code);
  CHECK(exit_code == 2);
}

TEST_CASE("Status has what scripts rely on") {
  Farm farm(3);
  farm.hello("worker-a", "n1");
  farm.complete("worker-a", result_of(farm.one("worker-a")));
  const json it = farm.ask("status", json::object());
  CHECK(it["schema"] == "fracfarm.status/1");
  CHECK(it["counts"]["done"] == 1);
  CHECK(it["counts"]["ready"] == 2);
  CHECK(it["verdicts"] == json{{"failed", 1}, {"censored", 0}, {"rejected", 0}});
  CHECK(it["rate_per_s"].get<double>() > 0.0);
  CHECK(it["eta_s"].get<double>() == Approx(2.0 / it["rate_per_s"].get<double>()));
  CHECK(it["finish_time"].is_string());
  CHECK(it["faults"].is_object());
  CHECK(it["workers"][0]["name"] == "worker-a");
  CHECK(it["classes"][0]["material"] == "pbx");
  CHECK(it["settled"] == false);
}

TEST_CASE("Submitting twice changes nothing; an overlapping campaign adds only what is new") {
  Farm farm(4);
  const json twice = farm.submit(campaign_text(4));
  CHECK(twice["total"] == 4);
  CHECK(farm.ask("status", json::object())["total"] == 4);
  farm.submit(campaign_text(6));
  const json status = farm.ask("status", json::object());
  CHECK(status["total"] == 6);
  CHECK(status["campaigns"][1]["shared"] == 4);
}

TEST_CASE("Two million jobs are submitted at once and cost the ledger no row each") {
  Farm farm(0);
  const json answer = farm.submit(campaign_text(2090000));
  CHECK(answer["total"] == 2090000);
  CHECK(answer["complete"] == true);
  CHECK(farm.ask("status", json::object())["counts"]["ready"] == 2090000);
  CHECK(jobs_where(farm.ledger.reading(), {}).empty());
  farm.start();
  farm.hello("worker-a", "n1");
  CHECK(farm.one("worker-a").job == 1);
  CHECK(farm.ask("status", json::object())["counts"]["ready"] == 2089999);
  CHECK(farm.ask("explain", {{"job", "2090000"}})["pattern"] == "orthogonal 2090000");
}

TEST_CASE("A campaign with mistakes is refused with all of them and leaves nothing behind") {
  Farm farm(0);
  int exit_code = 0;
  const json body =
      farm.submit(R"({"name": "x", "seed": 1, "jobs": [{"materials": ["pbxx"], "loads": ["uniaxal"], "patterns": {"orthogonal": "1-2"}}]})",
                  &exit_code);
  CHECK(exit_code == 2);
  CHECK(body["problems"].size() >= 2);
  CHECK(farm.ask("status", json::object())["campaigns"].empty());
}

TEST_CASE("A second solver build waits until the first one's jobs are settled") {
  Farm farm(1);
  farm.settings.build_id = "build-b";
  farm.start();
  int exit_code = 0;
  const json refused = farm.submit(campaign_text(1), &exit_code);
  CHECK(exit_code == 2);
  CHECK(refused["message"].get<std::string>().find("build-a") != std::string::npos);
  farm.ask("cancel", {{"state", "READY"}});
  farm.submit(campaign_text(1), &exit_code);
  CHECK(exit_code == 0);
  CHECK(farm.ask("status", json::object())["build_id"] == "build-b");
}

TEST_CASE("Jobs can be listed by state, material and load, in pages") {
  Farm farm(5);
  farm.hello("worker-a", "n1");
  farm.complete("worker-a", result_of(farm.one("worker-a")));
  const json done = farm.ask("jobs", {{"state", "done"}})["jobs"];
  REQUIRE(done.size() == 1);
  CHECK(done[0]["verdict"] == "failed");
  CHECK(done[0]["time_to_failure"] == 4.5e-5);
  CHECK(done[0]["pattern"] == "orthogonal 1");
  const json page = farm.ask("jobs", {{"limit", 2}, {"after", 2}});
  CHECK(page["jobs"][0]["id"] == 3);
  CHECK(page["more"] == true);
  CHECK(farm.ask("jobs", {{"material", "steel"}})["jobs"].empty());
}

TEST_CASE("Explain finds a job by id and by the beginning of its key, and can give its scene") {
  Farm farm(3);
  const std::string key = farm.ask("explain", {{"job", "2"}})["key"];
  int unknown_key = 0;
  CHECK(farm.ask("explain", {{"job", key.substr(0, 9)}}, &unknown_key)["message"].get<std::string>().find("by its id") !=
        std::string::npos);
  CHECK(unknown_key == 2);
  farm.hello("worker-a", "n1");
  farm.claim("worker-a", 2);  // it has a row from now on
  CHECK(farm.ask("explain", {{"job", "2"}})["key"] == key);
  const json by_key = farm.ask("explain", {{"job", key.substr(0, 9)}, {"scene", true}});
  CHECK(by_key["id"] == 2);
  CHECK(by_key["scene"].get<std::string>().find("fracfarm.scene/1") != std::string::npos);
  int exit_code = 0;
  farm.ask("explain", {{"job", "99"}}, &exit_code);
  CHECK(exit_code == 2);
}

TEST_CASE("Retry gives a quarantined job every budget anew; a dry run changes nothing") {
  Farm farm(1);
  farm.hello("worker-a", "n1");
  const wire::Assignment it = farm.one("worker-a");
  farm.fail_with("worker-a", it, Fault::bad_request);
  REQUIRE(farm.job(it.job).state == State::quarantined);
  CHECK(farm.ask("retry", {{"class", "BAD_REQUEST"}, {"dry_run", true}})["changed"] == 1);
  CHECK(farm.job(it.job).state == State::quarantined);
  CHECK(farm.ask("retry", {{"state", "QUARANTINED"}})["changed"] == 1);
  CHECK(farm.job(it.job).state == State::ready);
  farm.fail_with("worker-a", farm.one("worker-a"), Fault::solver_crash);
  CHECK(farm.job(it.job).state == State::retry_wait);
}

TEST_CASE("After a retry earlier faults neither use up a budget nor keep a node from the job") {
  Farm farm(1);
  farm.hello("worker-a", "n1");
  for (int n = 0; n < 2; ++n) {
    farm.fail_with("worker-a", farm.one("worker-a"), Fault::solver_numeric);
    farm.pass(3.0);
  }
  REQUIRE(farm.job(1u).state == State::quarantined);
  farm.hello("worker-b", "n2");
  farm.ask("retry", {{"jobs", {1}}});
  const wire::Assignment again = farm.one("worker-a");
  CHECK(again.step_scale == 1.0);
  farm.fail_with("worker-a", again, Fault::solver_numeric);
  CHECK(farm.job(1u).state == State::retry_wait);
}

TEST_CASE("What cannot be tried again or cancelled is said, one reason each") {
  Farm farm(1);
  farm.hello("worker-a", "n1");
  const wire::Assignment it = farm.one("worker-a");
  farm.complete("worker-a", result_of(it));
  int exit_code = 0;
  const json retried = farm.ask("retry", {{"jobs", {it.job}}}, &exit_code);
  CHECK(exit_code == 1);
  CHECK(retried["refused"][0]["why"].get<std::string>().find("done") != std::string::npos);
  farm.ask("cancel", {{"jobs", {it.job}}}, &exit_code);
  CHECK(exit_code == 1);
  farm.ask("retry", json::object(), &exit_code);
  CHECK(exit_code == 2);
}

TEST_CASE("Records say where the bytes of every DONE job lie") {
  Farm farm(3);
  farm.hello("worker-a", "n1");
  const wire::Assignment it = farm.one("worker-a");
  farm.complete("worker-a", result_of(it));
  const json list = farm.ask("records", json::object())["records"];
  REQUIRE(list.size() == 1);
  CHECK(list[0]["key"] == it.key);
  CHECK(list[0]["offset"] == 512);
  CHECK(list[0]["store"] == "store");
  CHECK(farm.ask("known", {{"campaign", campaign_text(5)}}) == json{{"schema", "fracfarm.known/2"}, {"present", 3}, {"done", 1}});
}

TEST_CASE("Each request's answer has the schema and version that scripts rely on") {
  const std::map<std::string, std::string> schemas{
      {"status", "fracfarm.status/1"},   {"jobs", "fracfarm.jobs/1"},         {"explain", "fracfarm.explain/1"},
      {"worker", "fracfarm.worker/1"},   {"failures", "fracfarm.failures/1"}, {"cases", "fracfarm.cases/1"},
      {"records", "fracfarm.records/1"}, {"learned", "fracfarm.learned/1"},   {"known", "fracfarm.known/2"},
      {"submit", "fracfarm.submit/1"},   {"retry", "fracfarm.change/1"},      {"release", "fracfarm.change/1"},
      {"hold", "fracfarm.change/1"},     {"priority", "fracfarm.change/1"},   {"cancel", "fracfarm.change/1"},
      {"drain", "fracfarm.change/1"},    {"pause", "fracfarm.change/1"},      {"resume", "fracfarm.change/1"},
      {"recheck", "fracfarm.change/1"}};
  Farm farm(2);
  farm.hello("worker-a", "n1");
  for (const RequestRow& row : requests()) {
    json arguments = json::object();
    if (row.verb == "worker") arguments = {{"worker", "worker-a"}};
    if (row.verb == "explain") arguments = {{"job", 1}};
    if (row.verb == "known" || row.verb == "submit") arguments = {{"campaign", campaign_text(2)}};
    for (const char* verb : {"retry", "release", "hold", "priority", "cancel", "recheck"})
      if (row.verb == verb) arguments = {{"jobs", {1}}, {"dry_run", true}};
    if (row.verb == "priority") arguments["priority"] = 3;
    INFO(row.verb);
    REQUIRE(schemas.contains(std::string(row.verb)));
    CHECK(farm.ask(std::string(row.verb), arguments)["schema"] == schemas.at(std::string(row.verb)));
  }
}

TEST_CASE("Failures are grouped by class, fault and signature, and the cases say which jobs failed") {
  Farm farm(6);
  farm.hello("worker-a", "n1");
  farm.hello("worker-b", "n2");
  farm.fail_with("worker-a", farm.one("worker-a"), Fault::solver_crash, "signal 11");
  farm.fail_with("worker-b", farm.one("worker-b"), Fault::solver_crash, "signal 11");
  farm.complete("worker-a", result_of(farm.one("worker-a")));
  const json groups = farm.ask("failures", json::object())["groups"];
  REQUIRE(groups.size() == 1);
  CHECK(groups[0]["attempts"] == 2);
  CHECK(groups[0]["jobs"] == 2);
  CHECK(groups[0]["nodes"] == 2);
  const json cases = farm.ask("cases", json::object());
  CHECK(cases["failed"] == json{{1, 0}, {1, 1}});
  CHECK(cases["sound"] == json{{1, 2}});
}
