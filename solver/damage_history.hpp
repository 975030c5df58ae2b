// Damage of a mesh at every row of a run, kept as the first field and what changed since: a criterion may only later say which row it was.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "solver/archive.hpp"

namespace fracfarm {

struct EdgeDamage {
  std::uint32_t edge;
  float damage;
};

class DamageHistory {
 public:
  // Rows are numbered from 0 in the order they come; every field is as long as the first. A row that is not the first may come as those
  // edges that may have changed since the row before.
  void add(const std::vector<float>& damage);
  void add_changes(const std::vector<EdgeDamage>& damage);
  std::size_t rows() const { return ends_.size(); }
  // The field of a row below rows().
  std::vector<float> at(std::size_t row) const;

  void save(ArchiveWriter& archive) const;
  void load(ArchiveReader& archive);

 private:
  void note(std::uint32_t edge, float damage) {
    if (damage != last_[edge]) changes_.push_back({edge, last_[edge] = damage});
  }

  std::vector<float> first_, last_;
  std::vector<EdgeDamage> changes_;  // of all rows, in order
  std::vector<std::uint64_t> ends_;  // changes up to and with each row
};

}  // namespace fracfarm
