// One table of kernels for each instruction set: which of them this processor runs, and which one is taken. Both solvers choose theirs
// here.
#pragma once

#include <array>
#include <cstdlib>
#include <span>
#include <string_view>

namespace fracfarm {

// The tables that were built; null where this build has none. Table: any struct of kernels with a string `isa`.
template <class Table>
struct PathTables {
  const Table* v4 = nullptr;
  const Table* v3 = nullptr;
  const Table* baseline = nullptr;  // never null
};

namespace instruction_paths {

#if defined(__x86_64__)
// By features, since not every compiler knows the levels by name; processors with these have the rest of their level, too.
inline bool runs_v3() {
  __builtin_cpu_init();
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
}
inline bool runs_v4() {
  return runs_v3() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd") &&
         __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
}
#else
inline bool runs_v3() { return false; }
inline bool runs_v4() { return false; }
#endif

}  // namespace instruction_paths

template <class Table>
class InstructionPaths {
 public:
  explicit InstructionPaths(const PathTables<Table>& built) {
    if (built.v4 && instruction_paths::runs_v4()) tables_[count_++] = built.v4;
    if (built.v3 && instruction_paths::runs_v3()) tables_[count_++] = built.v3;
    tables_[count_++] = built.baseline;
  }

  // The tables that this processor runs, fastest first.
  std::span<const Table* const> runnable() const { return {tables_.data(), count_}; }

  // The fastest one, or the one that the environment's FRACFARM_ISA names.
  const Table& chosen() const {
    if (const char* wish = std::getenv("FRACFARM_ISA"))
      for (const Table* table : runnable())
        if (table->isa == std::string_view(wish)) return *table;
    return *tables_.front();
  }

 private:
  std::array<const Table*, 3> tables_{};
  std::size_t count_ = 0;
};

}  // namespace fracfarm
