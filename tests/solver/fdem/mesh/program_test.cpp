#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>

#include <cstdio>
#include <filesystem>
#include <string>

#include "common/base/atomic_file.hpp"
#include "common/base/hash.hpp"
#include "common/scene/parse.hpp"
#include "common/scene/pattern.hpp"

using namespace fracfarm;
namespace fs = std::filesystem;
using Catch::Contains;

namespace {

struct TempFolder {
  fs::path path = fs::temp_directory_path() / ("fracfarm_mesh_" + std::to_string(::getpid()));
  TempFolder() { fs::create_directory(path); }
  ~TempFolder() { fs::remove_all(path); }
};

struct Output {
  std::string text;
  int status = -1;
};

// Standard output and error of fracfarm-mesh.
Output mesh(const std::string& arguments) {
  Output output;
  std::FILE* pipe = ::popen((std::string(FRACFARM_BIN_DIR) + "/fracfarm-mesh " + arguments + " 2>&1").c_str(), "r");
  char bytes[4096];
  while (const std::size_t got = std::fread(bytes, 1, sizeof bytes, pipe)) output.text.append(bytes, got);
  output.status = WEXITSTATUS(::pclose(pipe));
  return output;
}

// 0.1 x 0.1 m of shale with two cracks, elements of 4 mm.
Scene small_scene() {
  Scene scene = sample_scene({.material = find_material("shale"), .load = find_load("uniaxial")});
  scene.method = Method::fdem;
  scene.sample.reset();
  scene.width = scene.height = scene.layers.back().below = 0.1;
  for (auto& loads : scene.loads)
    for (SideLoad& load : loads) load.to = 0.1;
  scene.cracks = {{0.02, 0.03, 0.06, 0.03}, {0.05, 0.031, 0.05, 0.08}};
  scene.fdem.element_size = 0.004;
  return scene;
}

fs::path written(const TempFolder& folder, const Scene& scene, const std::string& name = "scene.json") {
  const fs::path path = folder.path / name;
  REQUIRE(write_atomically(path, canonical_text(scene)));
  return path;
}

}  // namespace

TEST_CASE("fracfarm mesh draws, writes and reports the mesh of a scene") {
  const TempFolder folder;
  const fs::path picture = folder.path / "x.png", msh = folder.path / "x.msh";
  const Output output = mesh(written(folder, small_scene()).string() + " --json -o " + picture.string() + " --msh " + msh.string());
  CHECK(output.status == 0);
  CHECK_THAT(output.text, Contains("\"schema\": \"fracfarm.mesh/1\"") && Contains("\"extended\": 1"));
  CHECK_THAT(read_file(picture, 1 << 24).value().substr(0, 4), Contains("PNG"));
  CHECK_THAT(read_file(msh, 1 << 24).value(), Contains("$MeshFormat") && Contains("\"cracks\""));
}

TEST_CASE("a mesh that was written is the mesh of a scene that names it, and of no other bytes") {
  const TempFolder folder;
  Scene scene = small_scene();
  const fs::path msh = folder.path / "x.msh", again = folder.path / "again.msh";
  REQUIRE(mesh(written(folder, scene).string() + " --msh " + msh.string()).status == 0);
  const std::string bytes = read_file(msh, 1 << 24).value();
  scene.fdem.mesh_file = msh.string();
  scene.fdem.mesh_sha256 = sha256_hex(bytes);
  CHECK(mesh(written(folder, scene, "from_file.json").string() + " --msh " + again.string()).status == 0);
  CHECK((read_file(again, 1 << 24).value() == bytes));
  REQUIRE(write_atomically(msh, bytes + "\n"));
  const Output other = mesh((folder.path / "from_file.json").string());
  CHECK(other.status == 2);
  CHECK_THAT(other.text, Contains("SHA-256"));
}

TEST_CASE("a wrong scene, a refused mesh and a file that cannot be written end with their own status and words") {
  const TempFolder folder;
  Scene scene = small_scene();
  const std::string good = written(folder, scene).string();
  scene.cracks.push_back({0.08, 0.08, 0.0805, 0.08});
  const Output refused = mesh(written(folder, scene, "short.json").string() + " --json");
  CHECK(refused.status == 2);
  CHECK_THAT(refused.text, Contains("REJECTED_INPUT") && Contains("crack 2 is 0.5 mm long; at least half an element, 2 mm"));
  REQUIRE(write_atomically(folder.path / "bad.json", R"({"schema": "fracfarm.scene/1", "method": "fdem", "material": 3, "cracks": 7})"));
  const Output bad = mesh((folder.path / "bad.json").string());
  CHECK(bad.status == 2);
  CHECK_THAT(bad.text, Contains("material = 3") && Contains("cracks = 7"));
  CHECK(mesh(good + " -o " + (folder.path / "no" / "x.png").string()).status == 1);
  CHECK(mesh("").status == 2);
  CHECK(mesh(good + " --survey 3").status == 2);
}

TEST_CASE("a survey of random patterns measures every mesh") {
  const Output output = mesh("--survey 3 --oblique --element-size 0.006 --json");
  CHECK(output.status == 0);
  CHECK_THAT(output.text, Contains("\"patterns\": 3") && Contains("\"refused\": []") && Contains("\"bad\": []"));
}
