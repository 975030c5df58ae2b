#include "worker/keeper.hpp"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <fstream>

#include "common/base/atomic_file.hpp"
#include "common/base/hash.hpp"
#include "common/record/writer.hpp"
#include "tests/record/sample_record.hpp"
#include "tests/wire/temp_farm.hpp"
#include "worker/judge.hpp"

using namespace fracfarm;
using namespace fracfarm::worker;

namespace {

struct Bench {
  TempFarm farm;
  SystemClock clock;
  Record record = sample::record();
  std::optional<Keeper> keeper;

  Bench() { restart(); }
  void restart() {
    keeper.reset();
    std::string warning;
    keeper.emplace(KeeperOptions{farm.path, "worker-a-0", judge_record}, Outbox::open(farm.path / "outbox", warning), clock);
  }
  Summary summary(const std::string& bytes) const {
    Summary s;
    s.verdict = record.judgement.verdict;
    s.time_to_failure = record.judgement.time_to_failure;
    s.failure_rule = record.judgement.rule;
    s.peak_stress = as_stored(record).peak_stress;
    s.steps = 100;
    s.record_sha256 = sha256_hex(bytes);
    return s;
  }
  Finished finished(const std::string& bytes) {
    Finished f;
    f.job = 1;
    f.assignment.key = record.key;
    f.assignment.lease = {2, 3};
    f.summary = summary(bytes);
    f.record = farm.path / "record.h5";
    f.checkpoint = farm.path / "record.ckpt";
    std::ofstream(f.record, std::ios::binary) << bytes;
    std::ofstream(f.checkpoint) << "x";
    return f;
  }
  std::variant<JobKept, JobFailed> outcome() {
    for (int i = 0; i < 2000; ++i, ::usleep(5000))
      if (auto all = keeper->take(); !all.empty()) return all.front();
    FAIL("nothing came");
    return JobFailed{};
  }
  JobFailed refusal(Finished f) {
    keeper->give(std::move(f));
    const auto said = outcome();
    REQUIRE(std::holds_alternative<JobFailed>(said));
    CHECK(std::get<JobFailed>(said).fault == Fault::output_bad);
    return std::get<JobFailed>(said);
  }
};

std::string flipped(std::string bytes) {
  bytes[bytes.size() / 3] = static_cast<char>(bytes[bytes.size() / 3] ^ 16);
  return bytes;
}

}  // namespace

TEST_CASE("a sound record is in a shard and in the outbox before it is said to be kept") {
  Bench bench;
  const std::string bytes = record_bytes(bench.record).value();
  bench.keeper->give(bench.finished(bytes));
  const auto said = bench.outcome();
  REQUIRE(std::holds_alternative<JobKept>(said));
  const wire::Completion done = std::get<JobKept>(said).completion;
  CHECK(done.lease == wire::LeaseId{2, 3});
  CHECK(read_entry(bench.farm.path / "store" / done.shard, done.offset, done.length).value() == bytes);
  CHECK(done.sha256 == sha256_hex(bytes));
  CHECK_FALSE(std::filesystem::exists(bench.farm.path / "record.h5"));
  CHECK_FALSE(std::filesystem::exists(bench.farm.path / "record.ckpt"));
  bench.restart();  // it was not acknowledged: the next run of the worker knows of it
  std::string warning;
  CHECK(Outbox::open(bench.farm.path / "outbox", warning).completions().at(0).key == bench.record.key);
}

TEST_CASE("an acknowledged completion is forgotten") {
  Bench bench;
  bench.keeper->give(bench.finished(record_bytes(bench.record).value()));
  (void)bench.outcome();
  bench.keeper->acknowledge({bench.record.key});
  bench.restart();
  CHECK_FALSE(std::filesystem::exists(bench.farm.path / "outbox"));
}

TEST_CASE("a damaged record is OUTPUT_BAD with every broken rule in words, whoever is to blame") {
  Bench bench;
  const std::string bytes = record_bytes(bench.record).value();
  SECTION("bit flipped before the solver's digest was made") {
    CHECK_FALSE(bench.refusal(bench.finished(flipped(bytes))).signature.empty());
  }
  SECTION("bit flipped after it") {
    Finished f = bench.finished(flipped(bytes));
    f.summary.record_sha256 = sha256_hex(bytes);
    CHECK(bench.refusal(f).signature == "digest");
  }
  SECTION("truncated") { CHECK_FALSE(bench.refusal(bench.finished(bytes.substr(0, bytes.size() / 2))).message.empty()); }
  SECTION("not there") {
    Finished f = bench.finished(bytes);
    std::filesystem::remove(f.record);
    CHECK(bench.refusal(f).signature == "readable");
  }
  SECTION("of another job") {
    Finished f = bench.finished(bytes);
    f.assignment.key = std::string(64, '0');
    CHECK(bench.refusal(f).message.find("key") != std::string::npos);
  }
  SECTION("saying another time to failure than the solver") {
    Finished f = bench.finished(bytes);
    f.summary.time_to_failure = 1.0;
    CHECK(bench.refusal(f).signature == "summary");
  }
  CHECK_FALSE(std::filesystem::exists(bench.farm.path / "store"));  // nothing bad reached a shard
  CHECK_FALSE(std::filesystem::exists(bench.farm.path / "record.h5"));
}

TEST_CASE("the checkpoint of a run that its wall budget ended is kept") {
  Bench bench;
  bench.record.judgement = {Verdict::censored, std::nullopt, "wall_clock", 0.0};
  Finished f = bench.finished("some bytes");
  bench.keeper.reset();
  std::string warning;  // what the validator says of these bytes does not matter here
  const Judge anything = [](const std::string&, const std::string&, const Summary&) { return Result<void>(); };
  bench.keeper.emplace(KeeperOptions{bench.farm.path, "worker-a-0", anything}, Outbox::open(bench.farm.path / "outbox", warning),
                       bench.clock);
  bench.keeper->give(f);
  REQUIRE(std::holds_alternative<JobKept>(bench.outcome()));
  CHECK(std::filesystem::exists(f.checkpoint));
}

TEST_CASE("a rejected input is a result without a record") {
  Bench bench;
  Finished f = bench.finished("");
  f.summary.verdict = Verdict::rejected;
  f.summary.failure_rule = "crack outside the grid";
  f.summary.time_to_failure.reset();
  bench.keeper->give(f);
  const auto said = bench.outcome();
  REQUIRE(std::holds_alternative<JobKept>(said));
  CHECK(std::get<JobKept>(said).completion.shard.empty());
  CHECK(std::get<JobKept>(said).completion.failure_rule == "crack outside the grid");
}

TEST_CASE("a store that cannot be written is the node's fault, and so is an outbox that cannot") {
  Bench bench;
  Finished f = bench.finished(record_bytes(bench.record).value());
  SECTION("store") {
    std::ofstream(bench.farm.path / "blocked") << "x";
    f.assignment.store = "blocked/store";
  }
  SECTION("outbox") { std::filesystem::create_directories(bench.farm.path / "outbox.part"); }
  bench.keeper->give(f);
  const auto said = bench.outcome();
  REQUIRE(std::holds_alternative<JobFailed>(said));
  CHECK(std::get<JobFailed>(said).fault == Fault::node_lost);
}
