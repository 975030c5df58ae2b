#include "coordinator/cli/verb.hpp"

#include <array>

namespace fracfarm::cli {

// scene_verbs.cpp
int run_pattern(int argc, char** argv);
int run_scene(int argc, char** argv);

namespace {

constexpr auto table = std::to_array<Verb>({
    {"solve", "One simulation", "solve one scene and write its record", nullptr},
    {"scene", "One simulation", "print the scene of one sample, or check a scene file", run_scene},
    {"pattern", "One simulation", "print one random crack pattern", run_pattern},
});

}  // namespace

std::span<const Verb> verbs() { return table; }

}  // namespace fracfarm::cli
