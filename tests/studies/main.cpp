// fracfarm-study: measurements over patterns that are too long for a test, each with its figures and its verdict.
#include <CLI/CLI.hpp>

#include "common/base/exit_code.hpp"
#include "tests/studies/studies.hpp"

namespace fracfarm::studies {
namespace {

void add_choice(CLI::App& command, Choice& choice) {
  command.add_option("--materials", choice.materials, "Of the table")
      ->delimiter(',')
      ->check(CLI::IsMember({"pbx", "shale", "tungsten", "aluminum", "steel", "pbx5"}))
      ->capture_default_str();
  command.add_option("--loads", choice.loads, "uniaxial, biaxial")
      ->delimiter(',')
      ->check(CLI::IsMember({"uniaxial", "biaxial"}))
      ->capture_default_str();
  command.add_option("--patterns", choice.patterns, "Patterns 1 ... of the seed")->check(CLI::Range(1, 1'000'000))->capture_default_str();
  command.add_option("--seed", choice.seed, "Campaign seed of the patterns")->capture_default_str();
  command.add_option("--cells", choice.cells, "Across and up")->check(CLI::Range(4, 1000))->capture_default_str();
  command.add_option("--ramp", choice.ramp, "Seconds over which the loads' velocity rises")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command.add_option("--jobs", choice.jobs, "Threads")->check(CLI::Range(1, 1024))->capture_default_str();
}

void add_fdem_choice(CLI::App& command, FdemChoice& choice) {
  command.add_option("--materials", choice.materials, "Of the table")
      ->delimiter(',')
      ->check(CLI::IsMember({"pbx", "shale", "tungsten", "pbx5"}))
      ->capture_default_str();
  command.add_option("--patterns", choice.patterns, "Patterns 1 ... of the seed")->check(CLI::Range(1, 1'000'000))->capture_default_str();
  command.add_option("--seed", choice.seed, "Campaign seed of the patterns")->capture_default_str();
  command.add_option("--jobs", choice.jobs, "Threads")->check(CLI::Range(1, 1024))->capture_default_str();
}

// A study of FDEM: its command, and what answers it.
template <class Question>
CLI::App* add_fdem_study(CLI::App& app, std::string name, std::string words, Question& question, int (*answer)(const Question&),
                         int& status) {
  CLI::App* command = app.add_subcommand(std::move(name), std::move(words));
  add_fdem_choice(*command, question.choice);
  command->add_flag("--json", question.json, "Print one object");
  command->final_callback([&question, answer, &status] { status = answer(question); });
  return command;
}

struct FdemQuestions {
  FdemTiersQuestion tiers;
  FdemFloorQuestion floor;
  FdemRulesQuestion rules;
  FdemPickQuestion pick;
  FdemMeshQuestion mesh;
  FdemGmshQuestion gmsh;
  FdemStabilityQuestion stability;
  FdemMethodsQuestion methods;
};

void add_fdem_studies(CLI::App& app, FdemQuestions& q, int& status) {
  add_fdem_study(app, "fdem-tiers", "The cheaper tiers of FDEM against the reference tier; 1 where a pattern misses", q.tiers, fdem_tiers,
                 status);
  add_fdem_study(app, "fdem-floor", "How far FDEM's reference tier is from itself, pattern by pattern", q.floor, fdem_floor, status)
      ->add_option("--only", q.floor.only, "These patterns, in place of the first few")
      ->delimiter(',')
      ->check(CLI::Range(1, 1'000'000));
  add_fdem_study(app, "fdem-rules", "What each rule of FDEM costs and saves", q.rules, fdem_rules, status);
  CLI::App* pick_command = add_fdem_study(
      app, "fdem-pick", "What the five-step pick costs, and whether it settles on what the horizon gives", q.pick, fdem_pick, status);
  pick_command->add_option("--reach", q.pick.reach, "The last word is a run to so many times the stress drop")
      ->check(CLI::Range(2.0, 1000.0))
      ->capture_default_str();
  q.mesh.choice.patterns = 3;
  add_fdem_study(app, "fdem-mesh", "Mesh size and mesh seeds; 1 where the body's answer moves by more than 10 %", q.mesh, fdem_mesh, status)
      ->add_option("--meshes", q.mesh.meshes, "Seeds of each size")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  q.gmsh.choice.materials = {"shale", "tungsten"}, q.gmsh.choice.patterns = 8;
  add_fdem_study(app, "fdem-gmsh", "The body's answer on our meshes and on gmsh's; 1 where a mean moves by more than 2 %", q.gmsh,
                 fdem_gmsh, status)
      ->add_option("--folder", q.gmsh.folder, "For gmsh's files");
  q.stability.choice.patterns = 1;
  add_fdem_study(app, "fdem-stability", "The edge of FDEM's step, predicted and observed, and runs past it", q.stability, fdem_stability,
                 status)
      ->add_option("--picture", q.stability.picture, "A PNG file of the map");
  q.methods.choice.materials = {"shale", "tungsten", "pbx5"};
  CLI::App* methods_command =
      add_fdem_study(app, "fdem-methods", "Where FDEM and the phase field part ways on the same patterns", q.methods, fdem_methods, status);
  methods_command->add_option("--picture", q.methods.picture, "A PNG file of one pattern");
  methods_command->add_option("--picture-pattern", q.methods.picture_pattern, "Which")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
}

}  // namespace
}  // namespace fracfarm::studies

int main(int argc, char** argv) {
  using namespace fracfarm::studies;
  CLI::App app("Measurements over many patterns.", "fracfarm-study");
  app.require_subcommand(1);
  TimeStepQuestion step;
  CLI::App* step_command = app.add_subcommand("time-step", "Time to failure and cracks against the step; 1 where a pattern misses");
  add_choice(*step_command, step.choice);
  step_command->add_option("--cfl", step.cfl, "Steps to judge")->delimiter(',')->check(CLI::Range(0.001, 1.2))->capture_default_str();
  step_command->add_option("--reference", step.reference, "Step to judge by")->check(CLI::Range(0.001, 1.2))->capture_default_str();
  step_command->add_flag("--json", step.json, "Print one object");
  RulesQuestion rule;
  rule.choice.patterns = 50;
  CLI::App* rules_command = app.add_subcommand("rules", "What each rule of no more than needed costs and saves");
  add_choice(*rules_command, rule.choice);
  rules_command->add_option("--rules", rule.rules, "Some rules only")->delimiter(',')->check(CLI::IsMember(rule_names()));
  rules_command->add_flag("--json", rule.json, "Print one object");
  int status = fracfarm::exit_ok;
  FdemQuestions fdem;
  add_fdem_studies(app, fdem, status);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? fracfarm::exit_ok : fracfarm::exit_bad_input;
  }
  if (step_command->parsed()) return time_step(step);
  return rules_command->parsed() ? rules(rule) : status;
}
