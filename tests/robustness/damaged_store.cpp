// fracfarm-damaged-store: harms shards in every way that disks, copies and mix-ups do, thousands of times, and asks both judges of a store:
// the one that compares with a ledger (fracfarm verify) and the one that has only the shards (fracfarm rebuild). Neither may ever accept
// what is not the job's result. Exit status 1 where one did.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <map>
#include <random>
#include <set>

#include "common/base/atomic_file.hpp"
#include "common/base/build_info.hpp"
#include "common/base/terminal.hpp"
#include "common/record/check.hpp"
#include "common/record/reader.hpp"
#include "common/scene/parse.hpp"
#include "coordinator/cli/adopt_records.hpp"
#include "solver/program/drill.hpp"
#include "tests/coordinator/store_fixture.hpp"
#include "tests/record/sample_fdem.hpp"
#include "tests/wire/temp_farm.hpp"

using namespace fracfarm;

namespace {

namespace fs = std::filesystem;
constexpr std::uint64_t grids = 12;  // records of the phase field; beside them a few of FDEM and of drills
constexpr std::size_t block = 4096;

enum class Harm { flip, zero, garbage, truncate, swap, stale, wrong_job, shifted };
constexpr std::array<std::string_view, 8> harm_names{"flip", "zero", "garbage", "truncate", "swap", "stale", "wrong job", "shifted"};

// Sound records of every method, as a solver would leave them on this attempt.
std::vector<Record> sound_records(const Campaign& campaign, const fs::path& scratch, int attempt) {
  std::vector<Record> list;
  for (std::uint64_t n = 0; n < grids; ++n) list.push_back(test::stored_record(campaign, n, attempt));
  for (const int cells : {10, 20}) {
    Record record = sample::fdem_record({.cells_x = cells, .cells_z = 4 * cells / 5});
    record.provenance["attempt"] = std::to_string(attempt);
    list.push_back(std::move(record));
  }
  for (int n = 1; n <= 3; ++n) {
    const Scene scene =
        parse_scene(fmt::format(R"({{"schema": "fracfarm.scene/1", "method": "drill", "drill": {{"act": "sleep", "seconds": {}e-4}}}})", n))
            .value();
    Task task{job_key(canonical_text(scene), build_info().build_id), canonical_text(scene), scratch / "drill.h5", scratch / "drill.ckpt"};
    task.attempt = attempt;
    (void)run_drill(task, scene, Keeping::scratch, [](long long, double, double) {}).value();
    list.push_back(read_record(task.output).value());
  }
  return list;
}

struct Store {
  TempFarm temp;
  Campaign campaign = parse_campaign(test::store_campaign_text(grids + 4), "stored").value();
  std::vector<test::Stored> stored;
  fs::path shard;
  std::string bytes;
  std::map<std::string, const test::Stored*> by_key;
  std::vector<std::string> stale, others;  // records of the same jobs of another attempt; of jobs that are not in the store

  Store() {
    stored = test::store_all(sound_records(campaign, temp.path, 1), temp.path / "store", "w", 100);
    shard = stored.front().place.shard;
    bytes = read_file(shard, 1 << 30).value();
    for (const test::Stored& it : stored) by_key[it.place.key] = &it;
    for (const Record& record : sound_records(campaign, temp.path, 2)) stale.push_back(record_bytes(record).value());
    for (std::uint64_t n = 0; n < 4; ++n) others.push_back(record_bytes(test::stored_record(campaign, grids + n)).value());
  }
};

void fill(std::string& bytes, std::size_t from, std::size_t n, std::mt19937_64* engine) {
  for (std::size_t at = from; at < std::min(bytes.size(), from + n); ++at) bytes[at] = engine ? static_cast<char>((*engine)()) : '\0';
}

// Puts `what` where the record of `place` lies, cut or filled up to its length.
void lay(std::string& shard, const RecordPlace& place, std::string what) {
  what.resize(place.length, '\0');
  shard.replace(place.offset, place.length, what);
}

std::string harmed(const Store& store, Harm harm, std::mt19937_64& engine) {
  std::string bytes = store.bytes;
  const std::size_t at = engine() % bytes.size(), victim = engine() % store.stored.size(),
                    other = (victim + 1 + engine() % (store.stored.size() - 1)) % store.stored.size();
  const RecordPlace &a = store.stored[victim].place, &b = store.stored[other].place;
  switch (harm) {
    case Harm::flip:
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << engine() % 8));
      break;
    case Harm::zero:
      fill(bytes, at / block * block, block, nullptr);
      break;
    case Harm::garbage:
      fill(bytes, at / block * block, block, &engine);
      break;
    case Harm::truncate:
      bytes.resize(at);
      break;
    case Harm::swap: {
      const std::string first = bytes.substr(a.offset, a.length), second = bytes.substr(b.offset, b.length);
      lay(bytes, a, second), lay(bytes, b, first);
      break;
    }
    case Harm::stale:
      lay(bytes, a, store.stale[victim]);
      break;
    case Harm::wrong_job:
      lay(bytes, a, engine() % 2 ? store.others[engine() % store.others.size()] : store.bytes.substr(b.offset, b.length));
      break;
    case Harm::shifted:
      bytes.insert(at, 1 + engine() % 600, '\0');
      break;
  }
  return bytes;
}

struct Tally {
  int mutants = 0, refused = 0, harmless = 0, accepted = 0;
};

// What verify says of every record whose bytes are no longer those that were acknowledged.
void ask_verify(const Store& store, const std::string& bytes, const fs::path& file, Tally& tally) {
  for (const test::Stored& it : store.stored) {
    RecordPlace place = it.place;
    place.shard = file;
    const bool same = place.offset + place.length <= bytes.size() &&
                      bytes.compare(place.offset, place.length, store.bytes, place.offset, place.length) == 0;
    if (same) continue;
    const Result<std::string> read = read_record(place);
    read&& all_passed(check_record_bytes(*read, {place.key}).checks) ? ++tally.accepted : ++tally.refused;
  }
}

// What rebuild makes of every entry that is not as it was. A record of the same job from another attempt is a result of that job.
void ask_rebuild(const Store& store, const std::string& bytes, const fs::path& file, Tally& tally) {
  for (const ShardEntry& entry : shard_entries(file)) {
    const std::string content = entry.offset + entry.length <= bytes.size() ? bytes.substr(entry.offset, entry.length) : std::string();
    const auto own =
        std::find_if(store.stored.begin(), store.stored.end(), [&](const test::Stored& it) { return it.place.key + ".h5" == entry.name; });
    if (own != store.stored.end() && store.bytes.compare(own->place.offset, own->place.length, content) == 0) continue;
    const Result<FoundRecord> found = cli::judge_entry(content, entry.name);
    if (!found) {
      ++tally.refused;
      continue;
    }
    const auto known = store.by_key.find(found->key);
    const wire::Completion* truth = known == store.by_key.end() ? nullptr : &known->second->completion;
    const bool same_physics = truth && found->outcome.verdict == truth->verdict &&
                              found->outcome.time_to_failure == truth->time_to_failure &&
                              found->outcome.peak_stress == truth->peak_stress && found->key + ".h5" == entry.name;
    same_physics ? ++tally.harmless : ++tally.accepted;
  }
}

}  // namespace

int main(int argc, char** argv) {
  int mutants = 10000;
  std::uint64_t seed = 1;
  CLI::App app{"Damaged shards, thousands of them: nothing of them may be accepted.", "fracfarm-damaged-store"};
  app.add_option("--mutants", mutants, "how many")->capture_default_str();
  app.add_option("--seed", seed, "the first of theirs")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  const Store store;
  const fs::path file = store.temp.path / "mutant.tar";
  std::map<Harm, Tally> verify, rebuild;
  ProgressLine line;
  for (int n = 0; n < mutants; ++n) {
    std::mt19937_64 engine(seed + static_cast<std::uint64_t>(n));
    const auto harm = static_cast<Harm>(n % static_cast<int>(harm_names.size()));
    const std::string bytes = harmed(store, harm, engine);
    std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes;
    ++verify[harm].mutants;
    ask_verify(store, bytes, file, verify[harm]);
    ask_rebuild(store, bytes, file, rebuild[harm]);
    if (n % 200 == 199) line.show(fmt::format("{} of {} mutants", n + 1, mutants));
  }
  int accepted = 0;
  std::vector<std::vector<std::string>> rows{
      {"harm", "mutants", "verify: refused", "accepted", "rebuild: refused", "the job's own", "accepted"}};
  for (auto& [harm, tally] : verify) {
    const Tally& other = rebuild[harm];
    accepted += tally.accepted + other.accepted;
    rows.push_back({std::string(harm_names[static_cast<std::size_t>(harm)]), std::to_string(tally.mutants), std::to_string(tally.refused),
                    std::to_string(tally.accepted), std::to_string(other.refused), std::to_string(other.harmless),
                    std::to_string(other.accepted)});
  }
  fmt::print("{}{} accepted\n", table_text(rows), accepted);
  return accepted == 0 ? 0 : 1;
}
