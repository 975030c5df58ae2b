// One thing that goes wrong in one program of a farm, at one call into the system, by the library kill_shim.cpp; and campaigns of drills
// that do nothing, so that what is tested is the farm.
#pragma once

#include <map>
#include <string>

#include "tests/system/farm_bench.hpp"

namespace fracfarm::bench {

struct Mishap {
  std::string program;
  int call = 0;                     // the number of the call in its life, from 0
  std::string trouble = "SIGKILL";  // kill_shim.cpp has the others
  std::string files = {};           // part of the paths of the files whose calls count; empty: every call
};

// What the programs of a farm are started with; it happens once, whatever is started again.
std::map<std::string, std::string> environment_of(const FarmBench& farm, const Mishap& mishap);
bool happened(const FarmBench& farm);

void submit_drills(FarmBench& farm, int jobs, double seconds = 0.0);

// A campaign in which this goes wrong: programs that end badly are started again, all jobs must come to be DONE and every record be sound.
// True where it came to it.
bool drills_with_a_mishap(int jobs, const Mishap& mishap);

int from_environment(const char* name, int otherwise);

}  // namespace fracfarm::bench
