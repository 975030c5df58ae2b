#include <array>
#include <cstdlib>
#include <string_view>

#include "solver/phasefield/kernels.hpp"

namespace fracfarm::phasefield {

#if defined(FRACFARM_X86_PATHS)
namespace v4 {
extern const Kernels table;
}
namespace v3 {
extern const Kernels table;
}
#endif
namespace baseline {
extern const Kernels table;
}

namespace {

struct Runnable {
  std::array<const Kernels*, 3> tables{};
  std::size_t count = 0;
};

Runnable probe() {
  Runnable found;
#if defined(FRACFARM_X86_PATHS)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("x86-64-v4")) found.tables[found.count++] = &v4::table;
  if (__builtin_cpu_supports("x86-64-v3")) found.tables[found.count++] = &v3::table;
#endif
  found.tables[found.count++] = &baseline::table;
  return found;
}

}  // namespace

std::span<const Kernels* const> runnable_kernels() {
  static const Runnable found = probe();
  return {found.tables.data(), found.count};
}

const Kernels& chosen_kernels() {
  const char* wish = std::getenv("FRACFARM_ISA");
  if (wish)
    for (const Kernels* kernels : runnable_kernels())
      if (kernels->isa == wish) return *kernels;
  return *runnable_kernels().front();
}

}  // namespace fracfarm::phasefield
