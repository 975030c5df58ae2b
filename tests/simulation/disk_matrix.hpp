// One thing goes wrong with the ledger's disk, at each call of a whole campaign in turn; the campaign must end with every job done and
// every promise kept.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tests/simulation/fault_disk.hpp"

namespace fracfarm::simulation {

struct MatrixRow {
  Trouble trouble = Trouble::none;
  std::uint64_t calls = 0;  // of the undisturbed campaign that can have it
  std::uint64_t runs = 0, violations = 0;
  std::string first;  // violation, with its call
};

inline constexpr int matrix_jobs = 50;

// Every `every`-th call that can have the trouble; 1: all. `told` hears of each row.
std::vector<MatrixRow> disk_matrix(std::uint64_t every, const std::function<void(const MatrixRow&)>& told);
std::string text_of(const MatrixRow& row);

}  // namespace fracfarm::simulation
