#include "coordinator/cli/verb.hpp"

#include <array>

namespace fracfarm::cli {
namespace {

constexpr std::array<Verb, 1> table{{
    {"solve", "One simulation", "solve one scene and write its record", nullptr},
}};

}  // namespace

std::span<const Verb> verbs() { return table; }

}  // namespace fracfarm::cli
