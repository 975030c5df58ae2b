#include "common/base/hash.hpp"

#include <catch2/catch.hpp>

#include <filesystem>

#include "common/base/atomic_file.hpp"

using namespace fracfarm;

TEST_CASE("SHA-256 gives the digests of FIPS 180-4's examples") {
  CHECK(sha256_hex("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(sha256_hex("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST_CASE("base64 gives the examples of RFC 4648") {
  CHECK(base64("") == "");
  CHECK(base64("f") == "Zg==");
  CHECK(base64("foobar") == "Zm9vYmFy");
}

TEST_CASE("a file's digest is that of its bytes, and a missing file is an error in words") {
  const auto path = std::filesystem::temp_directory_path() / "fracfarm_hash_test";
  REQUIRE(write_atomically(path, "abc"));
  CHECK(sha256_file(path).value() == sha256_hex("abc"));
  std::filesystem::remove(path);
  CHECK(sha256_file(path).error().message.find("fracfarm_hash_test") != std::string::npos);
}
