// The mesh of one scene: made (or read), measured, drawn, written.
#pragma once

#include <filesystem>
#include <string>

namespace fracfarm {

struct MeshCommand {
  std::string scene;              // path, or - for standard input
  std::filesystem::path picture;  // PNG; empty: none
  std::filesystem::path msh;      // Gmsh MSH 2.2; empty: none
  bool json = false;
};

// Gives the exit status: exit_bad_input for a scene that is wrong or whose mesh the gate refuses.
int mesh_scene(const MeshCommand& command);

}  // namespace fracfarm
