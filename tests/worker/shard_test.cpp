#include "worker/shard.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>

#include "common/base/atomic_file.hpp"
#include "common/base/hash.hpp"
#include "tests/wire/temp_farm.hpp"
#include "worker/tar.hpp"

using namespace fracfarm;
using namespace fracfarm::worker;

namespace {

struct FixedClock final : Clock {
  double monotonic_s() override { return 0.0; }
  double wall_s() override { return 1.8e9; }
};

struct Store {
  TempFarm folder;
  FixedClock clock;
  ShardOptions options{folder.path / "store", "worker-a-0", 1000, 4ull << 30, {}};

  std::vector<std::filesystem::path> files() const {
    std::vector<std::filesystem::path> all;
    for (const auto& entry : std::filesystem::directory_iterator(options.store)) all.push_back(entry.path());
    return all;
  }
};

std::string record(int n) { return std::string(static_cast<std::size_t>(100 + 333 * n), static_cast<char>('a' + n)); }

Result<void> append(ShardWriter& shard, const std::string& name, const std::string& bytes) {
  return shard.append(name, bytes, sha256_hex(bytes));
}

}  // namespace

TEST_CASE("what is committed lies where it is said to lie, in a tar that tar itself reads") {
  Store store;
  ShardWriter shard(store.options, store.clock);
  for (int n = 0; n < 5; ++n) REQUIRE(append(shard, "key" + std::to_string(n) + ".h5", record(n)).has_value());
  const auto first = shard.commit();
  REQUIRE(append(shard, "key5.h5", record(5)).has_value());
  const auto second = shard.commit();
  REQUIRE(first.size() == 5);
  REQUIRE(second.size() == 1);
  const auto path = store.options.store / second[0]->shard;
  CHECK(path.filename() == "shard-worker-a-0-20270115T080000Z-0.tar");
  for (int n = 0; n < 6; ++n) {
    const Placed& placed = n < 5 ? *first[static_cast<std::size_t>(n)] : *second[0];
    CHECK(read_entry(path, placed.offset, placed.length).value() == record(n));
    CHECK(placed.sha256 == sha256_hex(record(n)));
  }
  const std::string out = (store.folder.path / "out").string();
  CHECK(std::system(("mkdir " + out + " && tar -C " + out + " -xf " + path.string()).c_str()) == 0);
  CHECK(read_file(out + "/key5.h5", 1 << 20).value() == record(5));
}

TEST_CASE("the same records give the same bytes") {
  std::string digests[2];
  for (std::string& digest : digests) {
    Store store;
    ShardWriter shard(store.options, store.clock);
    for (int n = 0; n < 3; ++n) REQUIRE(append(shard, "key" + std::to_string(n) + ".h5", record(n)).has_value());
    (void)shard.commit();
    digest = sha256_file(store.files().at(0)).value();
  }
  CHECK(digests[0] == digests[1]);
}

TEST_CASE("a full shard is followed by another, and a new run never appends to an old one") {
  Store store;
  store.options.records = 2;
  {
    ShardWriter shard(store.options, store.clock);
    for (int n = 0; n < 5; ++n) {
      REQUIRE(append(shard, "key" + std::to_string(n) + ".h5", record(n)).has_value());
      REQUIRE(shard.commit().at(0).has_value());
    }
  }
  CHECK(store.files().size() == 3);
  ShardWriter again(store.options, store.clock);
  REQUIRE(append(again, "key9.h5", record(9)).has_value());
  REQUIRE(again.commit().at(0).has_value());
  CHECK(store.files().size() == 4);
}

TEST_CASE("bytes that read back differently after the sync are OUTPUT_BAD, and the shard is left behind") {
  Store store;
  store.options.after_sync = [](const std::filesystem::path& path) {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(tar_block + 7);
    file.put('!');
  };
  ShardWriter shard(store.options, store.clock);
  REQUIRE(append(shard, "bad.h5", record(0)).has_value());
  REQUIRE(append(shard, "good.h5", record(1)).has_value());
  const auto results = shard.commit();
  CHECK(results[0].error().fault == Fault::output_bad);
  CHECK(results[1].has_value());
  REQUIRE(append(shard, "next.h5", record(2)).has_value());
  (void)shard.commit();
  CHECK(store.files().size() == 2);
}

TEST_CASE("a shard that was cut short is OUTPUT_BAD for what is missing") {
  Store store;
  ShardWriter shard(store.options, store.clock);
  REQUIRE(append(shard, "a.h5", record(4)).has_value());
  const auto placed = shard.commit().at(0).value();
  const auto path = store.files().at(0);
  std::filesystem::resize_file(path, tar_block + 50);
  CHECK(read_entry(path, placed.offset, placed.length).error().fault == Fault::output_bad);
  CHECK(read_entry(path, ~0ull - 10, 5).error().fault == Fault::output_bad);
}

TEST_CASE("a torn tail hides nothing that was committed") {
  Store store;
  ShardWriter shard(store.options, store.clock);
  for (int n = 0; n < 3; ++n) REQUIRE(append(shard, "key" + std::to_string(n) + ".h5", record(n)).has_value());
  (void)shard.commit();
  const auto path = store.files().at(0);
  const auto whole = list_entries(path).value();
  CHECK(whole.entries.size() == 3);
  CHECK_FALSE(whole.torn);
  REQUIRE(append(shard, "key3.h5", record(3)).has_value());  // and the writer is killed before its commit
  const auto end = std::filesystem::file_size(path);
  for (const std::uintmax_t cut : {end - 1, end - 700, end - 1500}) {
    std::filesystem::resize_file(path, cut);
    const auto torn = list_entries(path).value();
    CHECK(torn.torn);
    REQUIRE(torn.entries.size() >= 3);
    for (std::size_t n = 0; n < 3; ++n)
      CHECK(read_entry(path, torn.entries[n].offset, torn.entries[n].length).value() == record(static_cast<int>(n)));
  }
}

TEST_CASE("a store that is no folder and a disk that is full are the node's fault") {
  Store store;
  std::ofstream(store.folder.path / "file") << "x";
  store.options.store = store.folder.path / "file" / "store";
  ShardWriter shard(store.options, store.clock);
  CHECK(append(shard, "a.h5", record(1)).error().fault == Fault::node_lost);
  CHECK(shard.commit().empty());
}

TEST_CASE("a header of another kind, or with a wrong checksum, is no entry") {
  TarHeader header = tar_header({"a.h5", 77});
  CHECK(read_tar_header(header)->length == 77);
  CHECK(read_tar_header(header)->name == "a.h5");
  header[0] = 'b';
  CHECK_FALSE(read_tar_header(header));
  CHECK(is_zero_block(TarHeader{}));
}
