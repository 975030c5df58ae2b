#include "common/wire/keys.hpp"

#include <sys/resource.h>
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <fstream>
#include <thread>

#include "common/wire/admission.hpp"
#include "tests/wire/temp_farm.hpp"

using namespace fracfarm;
using namespace fracfarm::wire;

namespace {
unsigned mode_of(const std::filesystem::path& path) {
  struct stat info {};
  REQUIRE(::stat(path.c_str(), &info) == 0);
  return info.st_mode & 0777u;
}
}  // namespace

TEST_CASE("a key is made once, kept private and found again") {
  const TempFarm farm;
  const auto made = load_or_make_key(farm.path, "worker-node-0");
  REQUIRE(made.has_value());
  const auto again = load_or_make_key(farm.path, "worker-node-0");
  CHECK(again->secret_key == made->secret_key);
  CHECK(made->public_key.size() == 40);
  CHECK(mode_of(farm.path / "keys") == 0700);
  CHECK(mode_of(farm.path / "keys/worker-node-0.key") == 0600);
  REQUIRE(allowed_keys(farm.path)->size() == 1);
  CHECK(allowed_keys(farm.path)->at(0).name == "worker-node-0");
  CHECK(allowed_keys(farm.path)->at(0).public_key == made->public_key);
}

TEST_CASE("the server's key is no peer's key") {
  const TempFarm farm;
  CHECK_FALSE(server_public_key(farm.path).has_value());
  const auto server = load_or_make_key(farm.path, "server");
  CHECK(*server_public_key(farm.path) == server->public_key);
  CHECK(allowed_keys(farm.path)->empty());
}

TEST_CASE("programs that start at once agree on one pair") {
  const TempFarm farm;
  std::vector<std::string> keys(8);
  std::vector<std::thread> threads;
  for (std::string& key : keys) threads.emplace_back([&] { key = load_or_make_key(farm.path, "client").value().public_key; });
  for (std::thread& thread : threads) thread.join();
  for (const std::string& key : keys) CHECK(key == allowed_keys(farm.path)->at(0).public_key);
}

TEST_CASE("a revoked peer keeps its pair but is not allowed again by loading it") {
  const TempFarm farm;
  REQUIRE(load_or_make_key(farm.path, "worker-x").has_value());
  std::filesystem::remove(farm.path / "keys/allowed/worker-x.pub");
  REQUIRE(load_or_make_key(farm.path, "worker-x").has_value());
  CHECK(allowed_keys(farm.path)->empty());
}

TEST_CASE("bad names, readable secrets and files that are no key are refused in words") {
  const TempFarm farm;
  for (const char* name : {"", "../server", ".hidden", "Upper", "a/b"})
    CHECK(load_or_make_key(farm.path, name).error().fault == Fault::bad_request);
  REQUIRE(load_or_make_key(farm.path, "w").has_value());
  ::chmod((farm.path / "keys/w.key").c_str(), 0644);
  CHECK(load_or_make_key(farm.path, "w").error().message.find("can be read by others") != std::string::npos);
  std::ofstream(farm.path / "keys/w.key") << "{}";
  ::chmod((farm.path / "keys/w.key").c_str(), 0600);
  CHECK(load_or_make_key(farm.path, "w").error().message.find("no CURVE key pair") != std::string::npos);
  std::ofstream(farm.path / "keys/allowed/odd.pub") << "not a key";
  CHECK(allowed_keys(farm.path)->size() == 1);
}

TEST_CASE("a moment in which no file can be opened takes nobody's key away, and one that was taken away meanwhile is seen after it") {
  const TempFarm farm;
  const std::string key = load_or_make_key(farm.path, "worker-x").value().public_key;
  Admission admission(farm.path);
  REQUIRE(admission.still_allowed("worker-x", key, 1000.0));
  rlimit before{};
  REQUIRE(::getrlimit(RLIMIT_NOFILE, &before) == 0);
  const rlimit none{0, before.rlim_max};
  REQUIRE(::setrlimit(RLIMIT_NOFILE, &none) == 0);
  const bool allowed = admission.still_allowed("worker-x", key, 2000.0), named = admission.name_of_key(key) == "worker-x";
  const bool read = allowed_keys(farm.path).has_value();
  REQUIRE(::setrlimit(RLIMIT_NOFILE, &before) == 0);
  CHECK(allowed);
  CHECK(named);
  CHECK_FALSE(read);
  std::filesystem::remove(farm.path / "keys/allowed/worker-x.pub");
  CHECK_FALSE(admission.still_allowed("worker-x", key, 3000.0));
}

TEST_CASE("the first message of a key that was made a moment ago is heard") {
  const TempFarm farm;
  REQUIRE(load_or_make_key(farm.path, "worker-x").has_value());
  Admission admission(farm.path);
  CHECK_FALSE(admission.still_allowed("worker-y", "no key", 1000.0));
  const std::string key = load_or_make_key(farm.path, "worker-y").value().public_key;
  CHECK(admission.still_allowed("worker-y", key, 1000.05));
}
