#include "common/wire/endpoint.hpp"

#include <catch2/catch.hpp>
#include <fstream>

#include "tests/wire/temp_farm.hpp"

using namespace fracfarm;
using namespace fracfarm::wire;

TEST_CASE("who listens on every interface is reached by the host's name, who listens on one by that") {
  CHECK(reachable("tcp://0.0.0.0:4711", "head-1") == "tcp://head-1:4711");
  CHECK(reachable("tcp://127.0.0.1:4711", "head-1") == "tcp://127.0.0.1:4711");
  CHECK(reachable("tcp://10.0.0.0:4711", "head-1") == "tcp://10.0.0.0:4711");
}

TEST_CASE("who reads the endpoint again and again sees each new one, a broken one and none") {
  TempFarm farm;
  EndpointReader reader(farm.path);
  CHECK_FALSE(reader.read());
  for (std::uint64_t epoch = 1; epoch < 20; ++epoch) {
    REQUIRE(write_endpoint(farm.path, {"tcp://127.0.0.1:4711", epoch, 1}));
    REQUIRE(reader.read());
    CHECK(reader.read()->epoch == epoch);
  }
  std::ofstream(farm.path / "endpoint.json") << "{}";
  CHECK_FALSE(reader.read());
  std::filesystem::remove(farm.path / "endpoint.json");
  CHECK_FALSE(reader.read());
}
