#include "worker/identity.hpp"

#include <catch2/catch.hpp>
#include <optional>

#include "tests/wire/temp_farm.hpp"

using namespace fracfarm;
using namespace fracfarm::worker;

TEST_CASE("workers of one node number themselves, and a restarted one takes the name that became free") {
  const TempFarm farm;
  std::optional<Identity> first(Identity::claim(farm.path, "Node.Example").value());
  const Identity second = Identity::claim(farm.path, "Node.Example").value();
  CHECK(first->name() == "worker-node.example-0");
  CHECK(second.name() == "worker-node.example-1");
  first.reset();
  CHECK(Identity::claim(farm.path, "Node.Example").value().name() == "worker-node.example-0");
}

TEST_CASE("a host name that no key may have is mended, and two starts are told apart") {
  CHECK(name_of_node("Ünode/../x") == "__node_.._x");
  CHECK(name_of_node("") == "node");
  CHECK(name_of_node(std::string(80, 'a')).size() == 40);
  CHECK(random_instance() != random_instance());
}
