#include <array>
#include <cstdlib>
#include <string_view>

#include "solver/fdem/kernels.hpp"

#define FRACFARM_TABLE(space, Real) \
  namespace space {                 \
  extern const Kernels<Real> table; \
  }

namespace fracfarm::fdem {

#if defined(FRACFARM_X86_PATHS)
FRACFARM_TABLE(v4_double, double)
FRACFARM_TABLE(v4_float, float)
FRACFARM_TABLE(v3_double, double)
FRACFARM_TABLE(v3_float, float)
#endif
FRACFARM_TABLE(baseline_double, double)
FRACFARM_TABLE(baseline_float, float)

namespace {

#if defined(FRACFARM_X86_PATHS)
// By features, since not every compiler knows the levels by name; processors with these have the rest of their level, too.
bool runs_v3() { return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2"); }
bool runs_v4() {
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd") &&
         __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
}
#endif

template <class Real>
struct Runnable {
  std::array<const Kernels<Real>*, 3> tables{};
  std::size_t count = 0;
  void add(const Kernels<double>& in_double, const Kernels<float>& in_float) {
    if constexpr (sizeof(Real) == sizeof(double))
      tables[count++] = &in_double;
    else
      tables[count++] = &in_float;
  }
};

template <class Real>
Runnable<Real> probe() {
  Runnable<Real> found;
#if defined(FRACFARM_X86_PATHS)
  __builtin_cpu_init();
  if (runs_v3() && runs_v4()) found.add(v4_double::table, v4_float::table);
  if (runs_v3()) found.add(v3_double::table, v3_float::table);
#endif
  found.add(baseline_double::table, baseline_float::table);
  return found;
}

}  // namespace

template <class Real>
std::span<const Kernels<Real>* const> runnable_kernels() {
  static const Runnable<Real> found = probe<Real>();
  return {found.tables.data(), found.count};
}

template <class Real>
const Kernels<Real>& chosen_kernels() {
  const char* wish = std::getenv("FRACFARM_ISA");
  if (wish)
    for (const Kernels<Real>* kernels : runnable_kernels<Real>())
      if (kernels->isa == wish) return *kernels;
  return *runnable_kernels<Real>().front();
}

template std::span<const Kernels<double>* const> runnable_kernels<double>();
template std::span<const Kernels<float>* const> runnable_kernels<float>();
template const Kernels<double>& chosen_kernels<double>();
template const Kernels<float>& chosen_kernels<float>();

}  // namespace fracfarm::fdem
