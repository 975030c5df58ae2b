#include "solver/program/mesh_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/base/atomic_file.hpp"
#include "common/base/exit_code.hpp"
#include "common/base/hash.hpp"
#include "common/base/terminal.hpp"
#include "common/base/text.hpp"
#include "common/scene/parse.hpp"
#include "solver/fdem/mesh/msh_text.hpp"
#include "solver/fdem/mesh/scene_mesh.hpp"
#include "solver/program/mesh_picture.hpp"
#include "solver/program/scene_file.hpp"

namespace fracfarm {
namespace {

using Json = nlohmann::ordered_json;

void print_json(const Json& json) { fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace)); }

int report_error(std::string_view fault, const std::string& message, int status, const MeshCommand& command) {
  if (command.json)
    print_json({{"schema", "fracfarm.error/1"}, {"fault", fault}, {"message", message}});
  else
    fmt::print(stderr, "{} {} ({})\n", ink("error:", Ink::red, stderr), message, fault);
  return status;
}

int report_error(const Error& error, int status, const MeshCommand& command) {
  return report_error(fault_row(error.fault).name, error.message, status, command);
}

std::ptrdiff_t crack_edges(const TriangleMesh& mesh) { return std::count(mesh.edge_kind.begin(), mesh.edge_kind.end(), EdgeKind::crack); }

void print_report(const fdem::MadeMesh& made, const std::string& msh_sha256, const MeshCommand& command) {
  const fdem::MeshReport& r = made.report;
  const TriangleMesh& mesh = made.mesh;
  if (command.json) {
    Json cracks = Json::array();
    for (const Segment& s : made.cracks) cracks.push_back({s.x0, s.z0, s.x1, s.z1});
    Json json{{"schema", "fracfarm.mesh/1"},
              {"nodes", mesh.nodes.size()},
              {"triangles", mesh.triangles.size()},
              {"edges", mesh.edge_nodes.size()},
              {"crack_edges", crack_edges(mesh)},
              {"smallest_height", r.smallest_height},
              {"smallest_angle", r.smallest_angle},
              {"area_error", r.area_error},
              {"repairs", {{"moved", r.moved}, {"trimmed", r.trimmed}, {"extended", r.extended}, {"merged", r.merged}}},
              {"cracks", cracks},
              {"seconds", r.seconds}};
    if (!msh_sha256.empty()) json["msh_sha256"] = msh_sha256;
    return print_json(json);
  }
  std::vector<std::vector<std::string>> rows{{"quantity", "value"}};
  rows.push_back({"nodes", fmt::format("{}", mesh.nodes.size())});
  rows.push_back({"triangles", fmt::format("{}", mesh.triangles.size())});
  rows.push_back({"inner edges", fmt::format("{}, {} of them cracks", mesh.edge_nodes.size(), crack_edges(mesh))});
  rows.push_back({"smallest height", engineering(r.smallest_height, "m")});
  rows.push_back({"smallest angle", fmt::format("{:.1f} degrees", r.smallest_angle)});
  rows.push_back({"error of area", fmt::format("{:.1e}", r.area_error)});
  rows.push_back({"repairs", fmt::format("{} moved, {} trimmed, {} extended, {} merged", r.moved, r.trimmed, r.extended, r.merged)});
  rows.push_back({"time", duration_text(r.seconds)});
  if (!msh_sha256.empty()) rows.push_back({"SHA-256 of " + command.msh.string(), msh_sha256});
  fmt::print("{}", table_text(rows));
}

}  // namespace

int mesh_scene(const MeshCommand& command) {
  const Result<std::string> text = scene_text(command.scene);
  if (!text) return report_error(text.error(), exit_bad_input, command);
  const Parsed<Scene> scene = parse_scene(*text);
  if (!scene) return report_problems(scene.error(), command.scene, command.json);
  const Result<fdem::MeshResult> meshed = fdem::mesh_of(*scene);
  if (!meshed) return report_error(meshed.error(), exit_bad_input, command);
  if (!*meshed) return report_error("REJECTED_INPUT", meshed->error(), exit_bad_input, command);
  const fdem::MadeMesh& made = **meshed;
  if (!command.picture.empty()) {
    const Result<void> written = write_atomically(command.picture, picture::png_bytes(draw_mesh(made, fdem::mesh_choice(*scene))));
    if (!written) return report_error(written.error(), exit_failed, command);
  }
  std::string msh_sha256;
  if (!command.msh.empty()) {
    const std::string bytes = fdem::write_msh(made.mesh);
    if (const Result<void> written = write_atomically(command.msh, bytes); !written)
      return report_error(written.error(), exit_failed, command);
    msh_sha256 = sha256_hex(bytes);
  }
  print_report(made, msh_sha256, command);
  return exit_ok;
}

}  // namespace fracfarm
