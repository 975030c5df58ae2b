#include "worker/outbox.hpp"

#include <catch2/catch.hpp>
#include <fstream>

#include "common/base/atomic_file.hpp"
#include "tests/wire/temp_farm.hpp"

using namespace fracfarm;
using namespace fracfarm::worker;

namespace {

wire::Completion completion(char c) {
  wire::Completion done;
  done.key = std::string(64, c);
  done.lease = {3, static_cast<std::uint64_t>(c)};
  done.shard = "shard.tar";
  return done;
}

std::vector<std::string> keys_in(const std::filesystem::path& file, std::string* warning = nullptr) {
  std::string said;
  const Outbox outbox = Outbox::open(file, said);
  if (warning) *warning = said;
  std::vector<std::string> keys;
  for (const auto& done : outbox.completions()) keys.push_back(done.key.substr(0, 1));
  return keys;
}

}  // namespace

TEST_CASE("what was added is there after any crash from then on") {
  const TempFarm folder;
  const auto file = folder.path / "outbox";
  std::string warning;
  Outbox outbox = Outbox::open(file, warning);
  REQUIRE(outbox.add({completion('a'), completion('b')}).has_value());
  CHECK(keys_in(file) == std::vector<std::string>{"a", "b"});
  outbox.acknowledge({completion('a').key});
  CHECK(keys_in(file) == std::vector<std::string>{"a", "b"});  // one too many is harmless: DUPLICATE
  REQUIRE(outbox.add({completion('c')}).has_value());
  CHECK(keys_in(file) == std::vector<std::string>{"b", "c"});
  CHECK(warning.empty());
}

TEST_CASE("a crash at any byte of the next write leaves the outbox as it was") {
  const TempFarm folder;
  const auto file = folder.path / "outbox";
  std::string warning;
  Outbox outbox = Outbox::open(file, warning);
  REQUIRE(outbox.add({completion('a')}).has_value());
  const std::string before = read_file(file, 1 << 20).value();
  REQUIRE(outbox.add({completion('b')}).has_value());
  const std::string after = read_file(file, 1 << 20).value();
  for (std::size_t written = 0; written <= after.size(); written += 17) {  // the part file, written so far, beside the old one
    std::ofstream(file, std::ios::binary) << before;
    std::ofstream(file.string() + ".part", std::ios::binary) << after.substr(0, written);
    CHECK(keys_in(file) == std::vector<std::string>{"a"});
  }
}

TEST_CASE("a damaged outbox is set aside and said, and nothing of it is believed") {
  const TempFarm folder;
  const auto file = folder.path / "outbox";
  std::string warning;
  {
    Outbox outbox = Outbox::open(file, warning);
    REQUIRE(outbox.add({completion('a')}).has_value());
  }
  std::string bytes = read_file(file, 1 << 20).value();
  const std::size_t at = GENERATE(0u, 20u, 60u, 120u);
  bytes[at] = static_cast<char>(bytes[at] ^ 1);
  std::ofstream(file, std::ios::binary) << bytes;
  CHECK(keys_in(file, &warning).empty());
  CHECK(warning.find("set aside") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(file));
  CHECK(std::filesystem::exists(file.string() + ".damaged"));
}

TEST_CASE("an outbox that was emptied leaves no file, one that was not leaves what is open") {
  const TempFarm folder;
  const auto file = folder.path / "outbox";
  std::string warning;
  Outbox outbox = Outbox::open(file, warning);
  REQUIRE(outbox.add({completion('a'), completion('b')}).has_value());
  outbox.acknowledge({completion('a').key});
  REQUIRE(outbox.close().has_value());
  CHECK(keys_in(file) == std::vector<std::string>{"b"});
  outbox.acknowledge({completion('b').key});
  REQUIRE(outbox.close().has_value());
  CHECK_FALSE(std::filesystem::exists(file));
}

TEST_CASE("a disk that refuses leaves the outbox in memory as it was") {
  const TempFarm folder;
  std::string warning;
  Outbox outbox = Outbox::open(folder.path / "no such folder" / "outbox", warning);
  CHECK(outbox.add({completion('a')}).error().fault == Fault::node_lost);
  CHECK(outbox.completions().empty());
}
