#include "coordinator/cli/verb.hpp"

#include <array>

namespace fracfarm::cli {

// record_verbs.cpp
int run_check(int argc, char** argv);
int run_show(int argc, char** argv);

// scene_verbs.cpp
int run_pattern(int argc, char** argv);
int run_scene(int argc, char** argv);

namespace {

constexpr auto table = std::to_array<Verb>({
    {"solve", "One simulation", "solve one scene and write its record", nullptr},
    {"check", "One simulation", "is this record sound: name every broken rule", run_check},
    {"show", "One simulation", "what a record holds, in words or as a picture", run_show},
    {"scene", "One simulation", "print the scene of one sample, or check a scene file", run_scene},
    {"pattern", "One simulation", "print one random crack pattern", run_pattern},
});

}  // namespace

std::span<const Verb> verbs() { return table; }

}  // namespace fracfarm::cli
