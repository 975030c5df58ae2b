#include "coordinator/ledger.hpp"

#include <unistd.h>
#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>

#include <array>

#include "coordinator/ledger_schema.hpp"
#include "coordinator/queries.hpp"
#include "tests/coordinator/farm_fixture.hpp"

using namespace fracfarm;

namespace {

struct Folder {
  std::filesystem::path path = std::filesystem::temp_directory_path() / ("fracfarm-ledger-" + std::to_string(::getpid()));
  Folder() { std::filesystem::create_directories(path); }
  ~Folder() { std::filesystem::remove_all(path); }
};

NewJob job_named(const std::string& name, std::int64_t campaign) {
  return {test::digest_of(name), campaign, 0, {"phase_field", "pbx", "uniaxial"}, "orthogonal", 1};
}

bool counters_agree(Ledger& ledger) {
  const auto text = [](const std::vector<CountRow>& rows) {
    std::string all;
    for (const CountRow& row : rows)
      all += fmt::format("{} {} {} {} {}\n", row.campaign, state_row(row.state).name, row.verdict, row.job_class.material, row.n);
    return all;
  };
  return text(count_rows(ledger.reading())) == text(recount_rows(ledger.reading()));
}

JobFilter in_state(State state) {
  JobFilter filter;
  filter.state = state;
  return filter;
}

}  // namespace

TEST_CASE("A key is in the ledger once, however often it is added") {
  Ledger ledger = Ledger::in_memory();
  ledger.begin();
  const std::int64_t campaign = ledger.add_campaign("c", "{}", "b", 2, 0.0);
  CHECK(ledger.add_job(job_named("a", campaign)));
  CHECK_FALSE(ledger.add_job(job_named("a", campaign)));
  ledger.commit();
  CHECK(count_rows(ledger.reading()).at(0).n == 1);
}

TEST_CASE("What was not committed is gone after a crash, what was committed is there") {
  Folder folder;
  {
    Ledger ledger = Ledger::open({folder.path}, true).value();
    ledger.begin();
    const std::int64_t campaign = ledger.add_campaign("c", "{}", "b", 2, 0.0);
    ledger.add_job(job_named("kept", campaign));
    ledger.commit();
    ledger.begin();
    ledger.add_job(job_named("lost", campaign));
  }
  Ledger again = Ledger::open({folder.path}, false).value();
  CHECK(job_by_key(again.reading(), test::digest_of("kept")));
  CHECK_FALSE(job_by_key(again.reading(), test::digest_of("lost")));
  CHECK(counters_agree(again));
}

TEST_CASE("Two holders never share a ledger") {
  Folder folder;
  Ledger first = Ledger::open({folder.path}, true).value();
  const Result<Ledger> second = Ledger::open({folder.path}, false, 0.05);
  REQUIRE_FALSE(second);
  CHECK(second.error().message.find("held by another process") != std::string::npos);
}

TEST_CASE("A farm that is not there is said so, and not made by looking") {
  Folder folder;
  const Result<Ledger> ledger = Ledger::open({folder.path / "none"}, false);
  REQUIRE_FALSE(ledger);
  CHECK(ledger.error().message.find("there is no farm") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(folder.path / "none"));
}

TEST_CASE("The epoch rises at every start and outlives the program") {
  Folder folder;
  const std::uint64_t first = Ledger::open({folder.path}, true).value().raise_epoch();
  const std::uint64_t second = Ledger::open({folder.path}, true).value().raise_epoch();
  CHECK(second == first + 1);
}

TEST_CASE("The counters equal a recount after every kind of change") {
  test::Farm farm(6);
  farm.hello("worker-a", "n1");
  const wire::Jobs jobs = farm.claim("worker-a", 4);
  farm.complete("worker-a", test::result_of(jobs.assignments.at(0)));
  farm.fail_with("worker-a", jobs.assignments.at(1), Fault::solver_crash);
  farm.fail_with("worker-a", jobs.assignments.at(2), Fault::bad_request);
  farm.ask("cancel", {{"jobs", {jobs.assignments.at(3).job}}});
  CHECK(counters_agree(farm.ledger));
  const auto counts = farm.ask("status", nlohmann::json::object())["counts"];
  CHECK(counts ==
        nlohmann::json{{"held", 0}, {"ready", 2}, {"leased", 0}, {"done", 1}, {"retry_wait", 1}, {"quarantined", 1}, {"cancelled", 1}});
}

TEST_CASE("An older ledger is brought to today's schema, a later one is refused in words") {
  Database database = Database::open({});
  const std::array<std::string_view, 1> old_steps{"CREATE TABLE a(x INTEGER) STRICT; INSERT INTO a VALUES(7);"};
  const std::array<std::string_view, 2> steps{old_steps[0], "ALTER TABLE a ADD COLUMN y INTEGER NOT NULL DEFAULT 3;"};
  REQUIRE(migrate(database, old_steps));
  REQUIRE(migrate(database, steps));
  {
    Rows rows = database.query("SELECT x, y FROM a");
    REQUIRE(rows.next());
    CHECK(rows.integer(0) == 7);
    CHECK(rows.integer(1) == 3);
  }
  const Result<void> refused = migrate(database, old_steps);
  REQUIRE_FALSE(refused);
  CHECK(refused.error().message.find("version 2, this program knows up to 1") != std::string::npos);
}

TEST_CASE("A ledger on a network file system is refused with words on where to put it") {
  for (const long type : {0x6969L, 0x0bd00bd0L, 0x47504653L, static_cast<long>(0xff534d42)}) {
    const Result<void> refused = demand_local_disk("/somewhere/ledger", type);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().message.find("local disk") != std::string::npos);
    CHECK(refused.error().message.find("ln -s") != std::string::npos);
  }
  CHECK(demand_local_disk("/somewhere/ledger", 0xEF53L));      // ext4
  CHECK(demand_local_disk("/somewhere/ledger", 0x58465342L));  // xfs
}

TEST_CASE("A file that is not a ledger ends with an error, not with a crash") {
  Folder folder;
  std::filesystem::create_directories(folder.path / "ledger");
  std::ofstream(folder.path / "ledger" / "ledger.db")
      << "this is no database at all, and long enough to be read as a header of one ......................";
  CHECK_THROWS_AS(Ledger::open({folder.path}, false), LedgerError);
}

TEST_CASE("A full disk ends with an error and leaves what was committed") {
  Folder folder;
  {
    Ledger ledger = Ledger::open({folder.path}, true).value();
    ledger.begin();
    const std::int64_t campaign = ledger.add_campaign("c", "{}", "b", 100000, 0.0);
    ledger.add_job(job_named("kept", campaign));
    ledger.commit();
    ledger.reading().script("PRAGMA max_page_count = 40");  // the disk is full from here
    ledger.begin();
    const auto fill = [&] {
      for (int n = 0; n < 5000; ++n) ledger.add_job(job_named(std::to_string(n), campaign));
      ledger.commit();
    };
    CHECK_THROWS_WITH(fill(), Catch::Contains("full"));
  }
  Ledger again = Ledger::open({folder.path}, false).value();
  CHECK(job_by_key(again.reading(), test::digest_of("kept")));
  CHECK(count_rows(again.reading()).at(0).n == 1);
}

TEST_CASE("Learned times are means and an upper edge of the 99th percentile") {
  test::Farm farm(30);
  farm.hello("worker-a", "n1", "i1", {}, 64);
  const wire::Jobs jobs = farm.claim("worker-a", 30);
  REQUIRE(jobs.assignments.size() == 30);
  for (std::size_t at = 0; at < 30; ++at) {
    wire::Completion result = test::result_of(jobs.assignments[at]);
    result.wall_s = at == 29 ? 9.0 : 1.1;
    farm.complete("worker-a", result);
  }
  const Learned learned = learned_times(farm.ledger.reading()).begin()->second;
  CHECK(learned.n == 30);
  CHECK(learned.mean_s == Approx((29 * 1.1 + 9.0) / 30));
  CHECK(learned.p99_s >= 9.0);
  CHECK(learned.p99_s <= 9.0 * 1.19);  // a quarter octave
}

TEST_CASE("A ledger of the first schema keeps its jobs, results, history and counters") {
  Database database = Database::open({});
  REQUIRE(migrate(database, migrations().first(1)));
  database.script(
      "INSERT INTO campaigns VALUES(1, 'old', '{}', 'b', 3, 3, 0, 0.0);"
      "INSERT INTO workers VALUES(1, 'worker-a', 'i1', 'n1', 4, 1000, 'b', 0.0, NULL, 0, 1, 1);"
      "INSERT INTO shards VALUES(1, 's.tar');"
      "INSERT INTO jobs(id, key, campaign, position, method, material, load, crack_set, sample_id, state) VALUES"
      "(1, randomblob(32), 1, 0, 'phase_field', 'pbx', 'uniaxial', 'orthogonal', 1, 'READY'),"
      "(2, randomblob(32), 1, 1, 'phase_field', 'steel', 'biaxial', 'oblique', 2, 'READY');"
      "UPDATE jobs SET state = 'DONE', verdict = 'failed', time_to_failure = 4.5e-5, failure_rule = 'through_crack', peak_stress = 7e6, "
      "steps = 180,"
      " shard = 1, offset = 512, length = 9, sha256 = zeroblob(32), worker = 1 WHERE id = 2;"
      "INSERT INTO attempts VALUES(1, 1, 1, 1, 'SOLVER_CRASH', 'signal 11', 'it crashed', 0.0, 1.0);"
      "INSERT INTO alarms VALUES(1, 'NONDETERMINISM', 2, 'differs', 0.0);"
      "INSERT INTO durations VALUES('phase_field', 'steel', 'biaxial', 3, 30, 60.0, 900);");
  REQUIRE(migrate(database));
  const Job job = job_by_id(database, 2).value();
  CHECK(job.job_class == JobClass{"phase_field", "steel", "biaxial"});
  CHECK(job.crack_set == "oblique");
  CHECK(job.outcome->failure_rule == "through_crack");
  CHECK(job.outcome->shard == "s.tar");
  CHECK(attempts_of(database, 1).at(0).signature == "signal 11");
  CHECK(alarm_rows(database, 5).at(0).job == 2);
  CHECK(fault_counts(database) == std::map<std::string, std::uint64_t>{{"SOLVER_CRASH", 1}});
  CHECK(learned_times(database).at(job.job_class).n == 30);
  CHECK(count_rows(database).size() == 2);
  CHECK(recount_rows(database).size() == 2);
  database.run("UPDATE jobs SET state = 'CANCELLED' WHERE id = 1");
  CHECK(count_rows(database).at(0).state == State::cancelled);
}

TEST_CASE("A ledger of the second schema keeps every row as it was, its checks and its counters") {
  Database database = Database::open({});
  REQUIRE(migrate(database, migrations().first(2)));
  database.script(
      "INSERT INTO campaigns(id, name, text, build_id, total, submitted_at) VALUES(1, 'old', '{}', 'b', 2, 0.0);"
      "INSERT INTO workers(id, peer, instance, node, slots, memory_bytes, build_id, began_at) VALUES(1, 'w', 'i', 'n', 4, 1000, 'b', 0.0);"
      "INSERT INTO classes(id, method, material, load) VALUES(1, 'fdem', 'pbx', 'uniaxial');"
      "INSERT INTO jobs(id, key, campaign, position, class, oblique, sample_id, state) VALUES"
      "(1, randomblob(32), 1, 0, 1, 0, 1, 'QUARANTINED'), (2, randomblob(32), 1, 1, 1, 1, 2, 'READY');"
      "UPDATE jobs SET state = 'LEASED', lease_epoch = 3, lease_counter = 4, worker = 1 WHERE id = 2;");
  const std::string before = job_by_id(database, 2)->key;
  REQUIRE(migrate(database));
  CHECK(job_by_lease(database, {3, 4})->key == before);
  CHECK(jobs_where(database, in_state(State::quarantined)).size() == 1);
  CHECK_THROWS_AS(database.run("UPDATE jobs SET state = 'LOST' WHERE id = 1"), LedgerError);
  CHECK_THROWS_AS(database.run("UPDATE jobs SET state = 'DONE', verdict = 'perhaps' WHERE id = 1"), LedgerError);
  database.run("UPDATE jobs SET state = 'CANCELLED' WHERE id = 1");
  CHECK(jobs_where(database, in_state(State::cancelled)).size() == 1);
  CHECK(count_rows(database).size() == recount_rows(database).size());
  CHECK(count_rows(database).at(0).state == State::cancelled);
}

// A list of three or more words in a check is such a table, made anew for each row.
TEST_CASE("Writing a job's row makes no table of SQLite's own, so that it stays cheap") {
  test::Farm farm(4);
  for (const char* sql :
       {"UPDATE jobs SET state = 'DONE', verdict = ?2, worker = ?3, shard = ?4 WHERE id = ?1",
        "INSERT INTO jobs(id, key, campaign, position, class, oblique, sample_id, state) VALUES(1, ?1, 1, 1, 1, 0, 1, 'READY')"}) {
    Rows steps = farm.ledger.reading().query(std::string("EXPLAIN ") + sql);
    int seen = 0, tables = 0;
    for (; steps.next(); ++seen) tables += steps.text(1) == "OpenEphemeral";
    CHECK(seen > 50);
    CHECK(tables == 0);
  }
}
