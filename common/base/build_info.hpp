// What this build is: set by the build itself, printed by --version and written into every record.
#pragma once

#include <string>

namespace fracfarm {

struct BuildInfo {
  std::string version;   // of the project
  std::string build_id;  // version + digest of every source that can change a number, the compiler and its flags
  std::string compiler;
  std::string flags;
};

const BuildInfo& build_info();

}  // namespace fracfarm
