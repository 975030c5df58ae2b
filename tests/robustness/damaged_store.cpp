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
#include "common/base/terminal.hpp"
#include "common/record/check.hpp"
#include "coordinator/cli/adopt_records.hpp"
#include "tests/coordinator/store_fixture.hpp"
#include "tests/wire/temp_farm.hpp"

using namespace fracfarm;

namespace {

namespace fs = std::filesystem;
constexpr std::uint64_t records = 12;
constexpr std::size_t block = 4096;

enum class Harm { flip, zero, garbage, truncate, swap, stale, wrong_job, shifted };
constexpr std::array<std::string_view, 8> harm_names{"flip", "zero", "garbage", "truncate", "swap", "stale", "wrong job", "shifted"};

struct Store {
  TempFarm temp;
  Campaign campaign = parse_campaign(test::store_campaign_text(records + 4), "stored").value();
  std::vector<test::Stored> stored = test::store_records(campaign, temp.path / "store", 0, records - 1, "w", 100);
  fs::path shard = stored.front().place.shard;
  std::string bytes = read_file(shard, 1 << 30).value();
  std::map<std::string, const test::Stored*> by_key;
  std::vector<std::string> stale, others;  // records of the same jobs of another attempt; of jobs that are not in the store

  Store() {
    for (const test::Stored& it : stored) by_key[it.place.key] = &it;
    for (std::uint64_t n = 0; n < records; ++n) stale.push_back(record_bytes(test::stored_record(campaign, n, 2)).value());
    for (std::uint64_t n = 0; n < 4; ++n) others.push_back(record_bytes(test::stored_record(campaign, records + n)).value());
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
  const std::size_t at = engine() % bytes.size(), victim = engine() % records, other = (victim + 1 + engine() % (records - 1)) % records;
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
