// `fracfarm-solve SCENE.json -o RECORD.h5`: one scene, one record, one summary for a person or a script.
#pragma once

#include <filesystem>
#include <string>

namespace fracfarm {

struct OneShot {
  std::string scene;  // path, or - for standard input
  std::filesystem::path output;
  std::filesystem::path checkpoint;
  double wall_budget_s = 8.0 * 3600.0;
  int threads = 1;  // of an FDEM run
  bool json = false;
  bool quiet = false;
};

// Returns an ExitCode.
int solve_one(const OneShot& options);

}  // namespace fracfarm
