// fracfarm-mesh: the FDEM mesh of a scene, or figures over the meshes of many random patterns.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "common/base/build_info.hpp"
#include "common/base/exit_code.hpp"
#include "solver/program/mesh_command.hpp"
#include "solver/program/mesh_survey.hpp"

int main(int argc, char** argv) {
  using namespace fracfarm;
  MeshCommand command;
  MeshSurvey survey;
  bool oblique = false;
  CLI::App app{"Makes the FDEM mesh of one scene; measures, draws and writes it.", "fracfarm mesh"};
  CLI::Option* scene = app.add_option("SCENE", command.scene, "scene file, - for standard input");
  app.add_option("-o,--output", command.picture, "picture to draw (PNG)");
  app.add_option("--msh", command.msh, "mesh to write (Gmsh MSH 2.2); fdem.mesh_file takes it back");
  app.add_flag("--json", command.json, "print one JSON object");
  CLI::Option* many = app.add_option("--survey", survey.patterns, "instead of a scene: mesh random patterns 1 ... N, and look at each")
                          ->check(CLI::Range(1, 10'000'000))
                          ->excludes(scene);
  app.add_flag("--oblique", oblique, "patterns of the oblique set")->needs(many);
  app.add_option("--seed", survey.seed, "of the patterns")->needs(many)->capture_default_str();
  app.add_option("--element-size", survey.element_size, "m")->needs(many)->check(CLI::Range(1e-4, 0.05))->capture_default_str();
  app.set_version_flag("--version", build_info().build_id);
  app.footer("exit status: 0 a good mesh, 1 cannot write (or a bad mesh in a survey), 2 bad input or a mesh that the gate refuses");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& mistake) {
    return app.exit(mistake) == 0 ? exit_ok : exit_bad_input;
  }
  survey.json = command.json;
  survey.set = oblique ? CrackSet::oblique : CrackSet::orthogonal;
  if (survey.patterns > 0) return survey_meshes(survey);
  if (command.scene.empty()) {
    fmt::print(stderr, "error: SCENE is missing: a scene file, or - for standard input\n");
    return exit_bad_input;
  }
  return mesh_scene(command);
}
