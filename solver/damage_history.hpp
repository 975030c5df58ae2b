// Damage of a mesh at every row of a run, kept as the first field and what changed since: a criterion may only later say which row it was.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "solver/archive.hpp"

namespace fracfarm {

class DamageHistory {
 public:
  // Rows are numbered from 0 in the order they come; every field is as long as the first.
  void add(const std::vector<float>& damage);
  std::size_t rows() const { return ends_.size(); }
  // The field of a row below rows().
  std::vector<float> at(std::size_t row) const;

  void save(ArchiveWriter& archive) const;
  void load(ArchiveReader& archive);

 private:
  struct Change {
    std::uint32_t edge;
    float damage;
  };
  std::vector<float> first_, last_;
  std::vector<Change> changes_;      // of all rows, in order
  std::vector<std::uint64_t> ends_;  // changes up to and with each row
};

}  // namespace fracfarm
