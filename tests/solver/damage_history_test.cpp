// Damage of every row from the first field and what changed since.
#include "solver/damage_history.hpp"

#include <catch2/catch.hpp>

using namespace fracfarm;

namespace {

const std::vector<std::vector<float>> fields{{0.0f, 2.0f, 0.0f}, {0.0f, 2.0f, 0.0f}, {0.25f, 2.0f, 0.0f}, {1.0f, 2.0f, 0.5f}};

DamageHistory filled() {
  DamageHistory history;
  for (const auto& field : fields) history.add(field);
  return history;
}

DamageHistory loaded(const std::string& bytes, bool& sound) {
  DamageHistory history;
  ArchiveReader archive(bytes);
  history.load(archive);
  sound = archive.finished();
  return history;
}

}  // namespace

TEST_CASE("a history of damage gives every field back as it was") {
  const DamageHistory history = filled();
  REQUIRE(history.rows() == fields.size());
  for (std::size_t row = 0; row < fields.size(); ++row) CHECK(history.at(row) == fields[row]);
}

TEST_CASE("a history of damage that is told what may have changed is the one that sees every field") {
  DamageHistory history;
  history.add(fields[0]);
  for (const auto& changes : std::vector<std::vector<EdgeDamage>>{{}, {{2, 0.0f}, {0, 0.25f}}, {{0, 1.0f}, {2, 0.5f}}})
    history.add_changes(changes);
  for (std::size_t row = 0; row < fields.size(); ++row) CHECK(history.at(row) == fields[row]);
  ArchiveWriter one, other;
  history.save(one), filled().save(other);
  CHECK(one.bytes() == other.bytes());
}

TEST_CASE("a history of damage goes on after a restart as if there had been none") {
  ArchiveWriter archive;
  filled().save(archive);
  bool sound = false;
  DamageHistory again = loaded(archive.bytes(), sound);
  REQUIRE(sound);
  again.add({1.0f, 2.0f, 0.75f});
  CHECK(again.at(2) == fields[2]);
  CHECK(again.at(4) == std::vector<float>{1.0f, 2.0f, 0.75f});
}

TEST_CASE("a saved history of damage whose parts do not fit together is refused") {
  ArchiveWriter archive;
  filled().save(archive);
  const std::string good = archive.bytes();
  for (std::size_t at = 0; at < good.size(); ++at) {
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ 0x40);
    bool sound = false;
    const DamageHistory history = loaded(bad, sound);
    if (sound)
      for (std::size_t row = 0; row < history.rows(); ++row) CHECK(history.at(row).size() == 3);
    else
      CHECK(history.rows() == 0);
  }
  bool sound = true;
  loaded(good.substr(0, good.size() - 3), sound);
  CHECK_FALSE(sound);
}
