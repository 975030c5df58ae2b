#include "common/base/atomic_file.hpp"

#include <sys/stat.h>

#include <catch2/catch.hpp>

using namespace fracfarm;
namespace fs = std::filesystem;

TEST_CASE("an atomic write leaves the new bytes, the mode asked for and no part file") {
  const fs::path path = fs::temp_directory_path() / "fracfarm_atomic_test";
  REQUIRE(write_atomically(path, "one", 0600));
  REQUIRE(write_atomically(path, std::string("two\0three", 9), 0600));
  CHECK(read_file(path, 100).value() == std::string("two\0three", 9));
  struct stat info {};
  REQUIRE(::stat(path.c_str(), &info) == 0);
  CHECK((info.st_mode & 0777) == 0600);
  CHECK_FALSE(fs::exists(path.string() + ".part"));
  fs::remove(path);
}

TEST_CASE("a write without a sync leaves the new bytes and no part file too") {
  const fs::path path = fs::temp_directory_path() / "fracfarm_unsynced_test";
  REQUIRE(write_unsynced(path, "one"));
  REQUIRE(write_unsynced(path, "two"));
  CHECK(read_file(path, 100).value() == "two");
  CHECK_FALSE(fs::exists(path.string() + ".part"));
  CHECK(write_unsynced("/nonexistent-folder/file", "x").error().fault == Fault::node_lost);
  fs::remove(path);
}

TEST_CASE("a write into a folder that does not exist fails in words and leaves nothing") {
  const auto wrote = write_atomically("/nonexistent-folder/file", "x");
  REQUIRE_FALSE(wrote);
  CHECK(wrote.error().fault == Fault::node_lost);
  CHECK(wrote.error().message.find("No such file") != std::string::npos);
}

TEST_CASE("a file over the limit is refused, not cut") {
  const fs::path path = fs::temp_directory_path() / "fracfarm_limit_test";
  REQUIRE(write_atomically(path, std::string(1000, 'x')));
  CHECK(read_file(path, 1000).value().size() == 1000);
  CHECK_FALSE(read_file(path, 999));
  CHECK_FALSE(read_file(fs::temp_directory_path(), 999));
  fs::remove(path);
}
