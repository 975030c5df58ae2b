// Backup, restore and rebuild, there and back; the judge of shard entries.
#include <catch2/catch.hpp>
#include <fstream>
#include <map>

#include "common/base/build_info.hpp"
#include "coordinator/cli/adopt_records.hpp"
#include "coordinator/ledger_backup.hpp"
#include "tests/coordinator/farm_fixture.hpp"
#include "tests/coordinator/store_fixture.hpp"
#include "tests/wire/temp_farm.hpp"

using namespace fracfarm;
using namespace fracfarm::cli;
using namespace fracfarm::test;

namespace {

// A ledger on the disk, and a reactor that is told of results.
struct DiskFarm {
  Ledger ledger;
  Campaign campaign;
  Instant now{1000.0, 1.7e9};
  Reactor reactor;
  std::uint64_t id = 1;

  DiskFarm(const std::filesystem::path& farm, int patterns)
      : ledger(Ledger::open({farm}, true).value()),
        campaign(parse_campaign(store_campaign_text(patterns), "stored").value()),
        reactor(ledger, {build_info().build_id, 5.0, 30.0, 512}, now) {
    tell("client", wire::Ask{"submit", nlohmann::json{{"campaign", store_campaign_text(patterns)}}.dump()});
    tell("w", wire::Hello{"n1", "i1", 8, 1u << 30, build_info().build_id, -1.0, {}});
  }
  wire::Reply tell(const std::string& peer, const wire::Request& request) {
    ledger.begin();
    wire::Reply reply = reactor.answer(peer, {id++, request}, now);
    ledger.commit();
    return reply;
  }
  // Jobs in order, each with its record of the store.
  void do_jobs(std::vector<Stored> stored) {
    for (Stored& it : stored) {
      const auto jobs = std::get<wire::Jobs>(tell("w", wire::Next{{}, {}, {}, 1, -1.0}));
      REQUIRE(jobs.assignments.at(0).key == it.completion.key);
      it.completion.lease = jobs.assignments[0].lease;
      REQUIRE(std::get<wire::Jobs>(tell("w", wire::Next{{it.completion}, {}, {}, 0, -1.0})).receipts.at(0) == wire::Receipt::accepted);
    }
  }
};

std::map<std::string, std::string> places(Ledger& ledger) {
  std::map<std::string, std::string> list;
  for (const Job& job : recorded_jobs(ledger.reading(), 0, 1000))
    list[job.key] = fmt::format("{} {} {} {} {} {}", job.outcome->shard, job.outcome->offset, job.outcome->length, job.outcome->sha256,
                                job.outcome->peak_stress, job.outcome->time_to_failure.value_or(-1.0));
  return list;
}

std::uint64_t count_of(Ledger& ledger, State state) {
  std::uint64_t n = 0;
  for (const CountRow& row : count_rows(ledger.reading()))
    if (row.state == state) n += row.n;
  return n;
}

}  // namespace

TEST_CASE("A ledger made from shards and the campaign has every result in its place, and what is still to be done") {
  TempFarm temp;
  std::map<std::string, std::string> before;
  {
    DiskFarm farm(temp.path, 20);
    farm.do_jobs(store_records(farm.campaign, temp.path / "store", 0, 11));
    before = places(farm.ledger);
  }
  REQUIRE(before.size() == 12);
  std::filesystem::rename(temp.path / "ledger", temp.path / "lost");
  DiskFarm farm(temp.path, 20);
  const AdoptedStores found = adopt_stores(farm.ledger, {temp.path / "store"});
  CHECK(found.entries == 12);
  CHECK(found.count.adopted == 12);
  CHECK(found.refused.empty());
  CHECK(places(farm.ledger) == before);
  CHECK(count_of(farm.ledger, State::ready) == 8);
  CHECK(job_by_id(farm.ledger.reading(), 3)->outcome->steps == 180);
  CHECK(adopt_stores(farm.ledger, {temp.path / "store"}).count.known == 12);  // again changes nothing
}

TEST_CASE("A ledger made from shards alone computes nothing twice when the campaign is submitted later") {
  TempFarm temp;
  const Campaign campaign = parse_campaign(store_campaign_text(6), "stored").value();
  store_records(campaign, temp.path / "store", 0, 3);
  {
    Ledger ledger = Ledger::open({temp.path}, true).value();
    CHECK(adopt_stores(ledger, {temp.path / "store"}).count.loose == 4);
    CHECK(count_of(ledger, State::done) == 4);
  }
  DiskFarm farm(temp.path, 6);
  const auto jobs = std::get<wire::Jobs>(farm.tell("w", wire::Next{{}, {}, {}, 6, -1.0}));
  CHECK(jobs.assignments.size() == 2);  // positions 4 and 5
  CHECK(count_of(farm.ledger, State::done) == 4);
  CHECK(count_of(farm.ledger, State::ready) == 0);
  CHECK(campaign_row(farm.ledger.reading(), 2)->shared == 4);
}

TEST_CASE("A copy is made while the ledger is in use, and put back it adopts what the shards have since; epochs are never used twice") {
  TempFarm temp;
  std::map<std::string, std::string> after;
  std::uint64_t epoch = 0;
  const std::filesystem::path copy = temp.path / "copy.db";
  {
    DiskFarm farm(temp.path, 10);
    farm.do_jobs(store_records(farm.campaign, temp.path / "store", 0, 3));
    farm.ledger.begin();  // in the midst of a transaction
    farm.ledger.set_meta("uncommitted", "1");
    REQUIRE(back_up_ledger(FarmPaths{temp.path}.ledger(), copy));
    farm.ledger.commit();
    farm.do_jobs(store_records(farm.campaign, temp.path / "store", 4, 7));
    after = places(farm.ledger);
    epoch = farm.reactor.epoch();
  }
  REQUIRE(put_back_ledger({temp.path}, copy));
  Ledger ledger = Ledger::open({temp.path}, false).value();
  CHECK(meta_value(ledger.reading(), "uncommitted").empty());
  CHECK(places(ledger).size() == 4);
  const AdoptedStores found = adopt_stores(ledger, stores_of(ledger, temp.path));
  CHECK(found.count.known == 4);
  CHECK(found.count.adopted == 4);
  CHECK(places(ledger) == after);
  CHECK(ledger.raise_epoch() > epoch);
}

TEST_CASE("A damaged copy is refused and leaves the ledger that is there alone") {
  TempFarm temp;
  { DiskFarm farm(temp.path, 300); }
  const std::filesystem::path copy = temp.path / "copy.db";
  REQUIRE(back_up_ledger(FarmPaths{temp.path}.ledger(), copy));
  {
    std::fstream file(copy, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(5000);
    for (int n = 0; n < 20000; ++n) file.put('\x5a');
  }
  CHECK_FALSE(put_back_ledger({temp.path}, copy));
  CHECK_FALSE(put_back_ledger({temp.path}, temp.path / "none.db"));
  Ledger ledger = Ledger::open({temp.path}, false).value();
  CHECK(count_of(ledger, State::ready) == 300);
}

TEST_CASE("A farm keeps its latest copies and no more") {
  TempFarm temp;
  { DiskFarm farm(temp.path, 3); }
  for (int n = 0; n < 5; ++n) REQUIRE(back_up_farm({temp.path}, 1.7e9 + n));
  const auto files = std::distance(std::filesystem::directory_iterator(temp.path / "backups"), {});
  CHECK(files == 3);
}

TEST_CASE("An entry under another name, of another scene's key or without its build is no result") {
  const Campaign campaign = parse_campaign(store_campaign_text(3), "stored").value();
  const Record record = stored_record(campaign, 0);
  const std::string bytes = record_bytes(record).value();
  REQUIRE(judge_entry(bytes, record.key + ".h5"));
  CHECK_FALSE(judge_entry(bytes, stored_record(campaign, 1).key + ".h5"));
  Record other = record;
  other.key = stored_record(campaign, 1).key;
  CHECK_FALSE(judge_entry(record_bytes(other).value(), other.key + ".h5"));
  CHECK_FALSE(judge_entry(bytes.substr(0, bytes.size() - 100), record.key + ".h5"));
  CHECK_FALSE(judge_entry("", record.key + ".h5"));
}
