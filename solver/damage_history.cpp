#include "solver/damage_history.hpp"

#include <algorithm>
#include <cassert>

namespace fracfarm {

void DamageHistory::add(const std::vector<float>& damage) {
  if (ends_.empty()) first_ = last_ = damage;
  assert(damage.size() == last_.size());
  for (std::size_t edge = 0; edge < damage.size(); ++edge) note(static_cast<std::uint32_t>(edge), damage[edge]);
  ends_.push_back(changes_.size());
}

void DamageHistory::add_changes(const std::vector<EdgeDamage>& damage) {
  assert(!ends_.empty());
  for (const EdgeDamage& now : damage) note(now.edge, now.damage);
  ends_.push_back(changes_.size());
}

std::vector<float> DamageHistory::at(std::size_t row) const {
  assert(row < rows());
  std::vector<float> damage = first_;
  for (std::size_t k = 0; k < ends_[row]; ++k) damage[changes_[k].edge] = changes_[k].damage;
  return damage;
}

void DamageHistory::save(ArchiveWriter& archive) const {
  archive.put_array(first_);
  archive.put_array(changes_);
  archive.put_array(ends_);
}

// Bytes that do not fit together are refused: at() would read outside.
void DamageHistory::load(ArchiveReader& archive) {
  archive.get_array(first_);
  archive.get_array(changes_);
  archive.get_array(ends_);
  const bool edges = std::all_of(changes_.begin(), changes_.end(), [&](const EdgeDamage& change) { return change.edge < first_.size(); });
  const bool rows = std::is_sorted(ends_.begin(), ends_.end()) && (ends_.empty() ? changes_.empty() : ends_.back() == changes_.size());
  if (!edges || !rows) archive.reject();
  if (archive.failed()) {
    *this = {};
    return;
  }
  last_ = first_;
  for (const EdgeDamage& change : changes_) last_[change.edge] = change.damage;
}

}  // namespace fracfarm
