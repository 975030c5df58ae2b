// A run that is stopped and goes on has the bits of one that was not, whenever it stopped.
#include <catch2/catch.hpp>

#include "common/base/random.hpp"
#include "tests/solver/fdem/contact/bodies.hpp"

using namespace fracfarm;
using namespace fracfarm::fdem;
using namespace fracfarm::fdem::testing;

namespace {

constexpr double h = 3e-3;
const ContactSettings settings{30e9, 0.6, {}};

// Loose blocks that tumble into each other; a new edge of a block is exposed now and then.
template <class Real>
struct Tumble {
  RigidScene<Real> scene;
  std::vector<int> inner;

  Tumble() {
    RandomStream random(9, 1, 1);
    for (int body = 0; body < 6; ++body) {
      add_block(scene.triangles, body, {0.0, 0.0}, {2 * h, h}, {2, 1});
      RigidBody& block = scene.finish_body(2500.0);
      block.x = 2.1 * h * (body % 3), block.z = 1.3 * h * (body / 3);
      block.vx = random.uniform(-5.0, 5.0), block.vz = random.uniform(-5.0, 5.0), block.turning = random.uniform(-2000.0, 2000.0);
    }
    for (std::size_t s = 0; s < scene.triangles.neighbour.size(); ++s)
      if (scene.triangles.neighbour[s] > static_cast<int>(s)) inner.push_back(static_cast<int>(s));
    scene.place();
  }
  void step(Contact<Real>& contact, int n) {
    if (n == 0) scene.triangles.expose_boundary(contact);
    if (n % 100 == 50) {
      const int side = inner[static_cast<std::size_t>(n / 100) % inner.size()];
      contact.expose(side);
      contact.expose(scene.triangles.neighbour[static_cast<std::size_t>(side)]);
    }
    scene.step(contact, 1e-7);
  }
};

template <class Real>
void resumes_anywhere() {
  Tumble<Real> straight;
  Contact<Real> whole(straight.scene.triangles.corners, straight.scene.triangles.neighbour, settings);
  Tumble<Real> parts;
  Contact<Real> first(parts.scene.triangles.corners, parts.scene.triangles.neighbour, settings);
  std::size_t touches = 0;
  for (int n = 0; n < 2000; ++n) {
    straight.step(whole, n);
    parts.step(first, n);
    touches += whole.touches().size();
    if (n % 37 == 0) {
      ArchiveWriter archive;
      first.save(archive);
      first = Contact<Real>(parts.scene.triangles.corners, parts.scene.triangles.neighbour, settings);
      ArchiveReader reader(archive.bytes());
      first.load(reader);
      REQUIRE(reader.finished());
    }
    REQUIRE(straight.scene.triangles.force == parts.scene.triangles.force);
    REQUIRE(straight.scene.triangles.displacement == parts.scene.triangles.displacement);
  }
  CHECK(touches > 2000);
  CHECK(whole.energies().friction > 0.0);
  CHECK(whole.energies().friction == first.energies().friction);
  CHECK(whole.energies().stored == first.energies().stored);
  CHECK(whole.energies().jumped == first.energies().jumped);
}

}  // namespace

TEST_CASE("A run resumed every 37 steps has the bits of one that never stopped") {
  resumes_anywhere<double>();
  resumes_anywhere<float>();
}

TEST_CASE("A damaged archive is refused") {
  Tumble<double> tumble;
  Contact<double> contact(tumble.scene.triangles.corners, tumble.scene.triangles.neighbour, settings);
  for (int n = 0; n < 500; ++n) tumble.step(contact, n);
  ArchiveWriter archive;
  contact.save(archive);
  REQUIRE(!contact.touches().empty());
  std::string bytes = archive.bytes();
  for (std::size_t cut = 0; cut < bytes.size(); cut += 7) {
    Contact<double> other(tumble.scene.triangles.corners, tumble.scene.triangles.neighbour, settings);
    ArchiveReader reader(std::string_view(bytes).substr(0, cut));
    other.load(reader);
    CHECK_FALSE(reader.finished());
  }
  for (const std::size_t at : {std::size_t{8}, std::size_t{16}}) {  // sides that do not exist
    std::string broken = bytes;
    broken[at + 3] = '\x7f';
    Contact<double> other(tumble.scene.triangles.corners, tumble.scene.triangles.neighbour, settings);
    ArchiveReader reader(broken);
    other.load(reader);
    CHECK(reader.failed());
  }
}
