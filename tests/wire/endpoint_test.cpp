#include "common/wire/endpoint.hpp"

#include <catch2/catch.hpp>

using namespace fracfarm::wire;

TEST_CASE("who listens on every interface is reached by the host's name, who listens on one by that") {
  CHECK(reachable("tcp://0.0.0.0:4711", "head-1") == "tcp://head-1:4711");
  CHECK(reachable("tcp://127.0.0.1:4711", "head-1") == "tcp://127.0.0.1:4711");
  CHECK(reachable("tcp://10.0.0.0:4711", "head-1") == "tcp://10.0.0.0:4711");
}
