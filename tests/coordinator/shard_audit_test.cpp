#include "coordinator/shard_audit.hpp"

#include <catch2/catch.hpp>
#include <fstream>

#include "common/base/hash.hpp"
#include "tests/wire/temp_farm.hpp"

using namespace fracfarm;

namespace {

// A ustar header of a regular file, by the standard's field table.
std::string header(const std::string& name, std::size_t length) {
  std::string block(512, '\0');
  char text[16];
  block.replace(0, name.size(), name);
  block.replace(100, 7, "0000644");
  std::snprintf(text, sizeof text, "%011zo", length);
  block.replace(124, 11, text);
  block.replace(136, 11, "00000000000");
  block[156] = '0';
  block.replace(257, 8, std::string("ustar\0", 6) + "00");
  block.replace(148, 8, 8, ' ');
  unsigned sum = 0;
  for (const char c : block) sum += static_cast<unsigned char>(c);
  std::snprintf(text, sizeof text, "%06o", sum);
  block.replace(148, 8, std::string(text) + std::string("\0 ", 2));
  return block;
}

std::string entry(const std::string& name, const std::string& bytes) {
  return header(name, bytes.size()) + bytes + std::string((512 - bytes.size() % 512) % 512, '\0');
}

struct Shard {
  TempFarm folder;
  std::filesystem::path path = folder.path / "shard-0.tar";
  explicit Shard(const std::string& bytes) { std::ofstream(path, std::ios::binary) << bytes; }
  RecordPlace place(std::uint64_t offset, const std::string& bytes) const {
    return {1, "key", path, offset, bytes.size(), sha256_hex(bytes)};
  }
};

}  // namespace

TEST_CASE("A record is read from its place and its digest compared") {
  const Shard shard(entry("a.h5", "first") + entry("b.h5", "second"));
  CHECK(read_record(shard.place(1536, "second")).value() == "second");
}

TEST_CASE("Every kind of damage is found: other bytes, a short shard, none at all, a length that is none") {
  const Shard shard(entry("a.h5", "first"));
  CHECK(read_record(shard.place(512, "other")).error().message.find("other bytes") != std::string::npos);
  CHECK(read_record(shard.place(1020, "first")).error().message.find("ends before") != std::string::npos);
  RecordPlace absent = shard.place(512, "first"), huge = absent;
  absent.shard += ".gone";
  huge.length = 1ull << 50;
  CHECK(read_record(absent).error().message.find("missing") != std::string::npos);
  CHECK_FALSE(read_record(huge));
}

TEST_CASE("The entries of a shard are listed up to a torn tail") {
  const Shard shard(entry("a.h5", "first") + entry("b.h5", std::string(700, 'x')) + header("c.h5", 9).substr(0, 300));
  const std::vector<ShardEntry> entries = shard_entries(shard.path);
  REQUIRE(entries.size() == 2);
  CHECK(entries[1].name == "b.h5");
  CHECK(entries[1].offset == 1536);
  CHECK(entries[1].length == 700);
}

TEST_CASE("A header with a wrong checksum ends the list") {
  std::string bytes = entry("a.h5", "first") + entry("b.h5", "second");
  bytes[1024 + 3] ^= 1;
  CHECK(shard_entries(Shard(bytes).path).size() == 1);
}
