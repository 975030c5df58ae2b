#include "worker/identity.hpp"

#include <catch2/catch.hpp>
#include <optional>

#include "tests/wire/temp_farm.hpp"

using namespace fracfarm;
using namespace fracfarm::worker;

namespace {

constexpr double now_s = 1.7e9;

}  // namespace

TEST_CASE("workers of one node number themselves, and a restarted one takes the name that became free") {
  const TempFarm farm;
  std::optional<Identity> first(Identity::claim(farm.path, "Node.Example", now_s).value());
  const Identity second = Identity::claim(farm.path, "Node.Example", now_s).value();
  CHECK(first->name() == "worker-node.example-0");
  CHECK(second.name() == "worker-node.example-1");
  first.reset();
  CHECK(Identity::claim(farm.path, "Node.Example", now_s).value().name() == "worker-node.example-0");
}

TEST_CASE("a later start sorts after an earlier one, also where the clock was set back or the number was lost") {
  const TempFarm farm;
  const auto instance_at = [&](double wall_s) { return Identity::claim(farm.path, "n", wall_s).value().instance(); };
  const std::string first = instance_at(now_s), second = instance_at(now_s), third = instance_at(now_s - 86400.0);
  CHECK(first < second);
  CHECK(second < third);
  std::filesystem::remove(farm.path / "keys/worker-n-0.lock");
  CHECK(third < instance_at(now_s + 1.0));
  CHECK(instance_of_start(9) < instance_of_start(10));
  CHECK(instance_of_start(9) != instance_of_start(9));
  CHECK(std::string("ffffffffffffffff") < first);  // as starts were called before they had numbers
}

TEST_CASE("a host name that no key may have is mended") {
  CHECK(name_of_node("Ünode/../x") == "__node_.._x");
  CHECK(name_of_node("") == "node");
  CHECK(name_of_node(std::string(80, 'a')).size() == 40);
}
