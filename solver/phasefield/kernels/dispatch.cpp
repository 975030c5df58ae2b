#include "solver/instruction_paths.hpp"
#include "solver/phasefield/kernels.hpp"

#define FRACFARM_TABLE(space, Real) \
  namespace space {                 \
  extern const Kernels<Real> table; \
  }

namespace fracfarm::phasefield {

FRACFARM_TABLE(baseline_double, double)
FRACFARM_TABLE(baseline_float, float)
template <class Real>
constexpr PathTables<Kernels<Real>> tables{};
#if defined(FRACFARM_X86_PATHS)
FRACFARM_TABLE(v4_double, double)
FRACFARM_TABLE(v4_float, float)
FRACFARM_TABLE(v3_double, double)
FRACFARM_TABLE(v3_float, float)
template <>
constexpr PathTables<Kernels<double>> tables<double>{&v4_double::table, &v3_double::table, &baseline_double::table};
template <>
constexpr PathTables<Kernels<float>> tables<float>{&v4_float::table, &v3_float::table, &baseline_float::table};
#else
template <>
constexpr PathTables<Kernels<double>> tables<double>{.baseline = &baseline_double::table};
template <>
constexpr PathTables<Kernels<float>> tables<float>{.baseline = &baseline_float::table};
#endif

namespace {

template <class Real>
const InstructionPaths<Kernels<Real>>& paths() {
  static const InstructionPaths<Kernels<Real>> found(tables<Real>);
  return found;
}

}  // namespace

template <class Real>
std::span<const Kernels<Real>* const> runnable_kernels() {
  return paths<Real>().runnable();
}

template <class Real>
const Kernels<Real>& chosen_kernels() {
  return paths<Real>().chosen();
}

template std::span<const Kernels<double>* const> runnable_kernels<double>();
template std::span<const Kernels<float>* const> runnable_kernels<float>();
template const Kernels<double>& chosen_kernels<double>();
template const Kernels<float>& chosen_kernels<float>();

}  // namespace fracfarm::phasefield
