// What results took: learned by class, and by class and type of node.
#include "coordinator/ledger.hpp"
#include "coordinator/queries.hpp"

namespace fracfarm {
namespace {

struct Bin {
  int number = 0;
  std::uint64_t n = 0;
  double wall_s = 0.0, bytes = 0.0;
};

Learned learned_from(const std::map<int, Bin>& bins) {
  Learned learned;
  for (const auto& [number, bin] : bins) {
    learned.n += bin.n;
    learned.mean_s += bin.wall_s;
    learned.mean_bytes += bin.bytes;
  }
  learned.mean_s /= static_cast<double>(learned.n);
  learned.mean_bytes /= static_cast<double>(learned.n);
  std::uint64_t seen = 0;
  for (const auto& [number, bin] : bins) {
    learned.p99_s = duration_bin_top(number);
    if (100 * (seen += bin.n) >= 99 * learned.n) break;
  }
  return learned;
}

// `key_of(class, node type)` says what is learned together.
template <class Key, class KeyOf>
std::map<Key, Learned> learned_by(Database& ledger, const KeyOf& key_of) {
  std::map<Key, std::map<int, Bin>> bins;
  Rows rows =
      ledger.query("SELECT method, material, load, node_type, bin, n, wall_s, bytes FROM durations JOIN classes ON classes.id = class");
  while (rows.next()) {
    Bin& bin = bins[key_of({rows.text(0), rows.text(1), rows.text(2)}, rows.text(3))][static_cast<int>(rows.integer(4))];
    bin.n += static_cast<std::uint64_t>(rows.integer(5));
    bin.wall_s += rows.real(6);
    bin.bytes += rows.real(7);
  }
  std::map<Key, Learned> learned;
  for (const auto& [key, list] : bins) learned[key] = learned_from(list);
  return learned;
}

}  // namespace

std::map<JobClass, Learned> learned_times(Database& ledger) {
  return learned_by<JobClass>(ledger, [](const JobClass& job_class, const std::string&) { return job_class; });
}

std::map<std::pair<JobClass, std::string>, Learned> learned_times_by_node(Database& ledger) {
  return learned_by<std::pair<JobClass, std::string>>(
      ledger, [](const JobClass& job_class, const std::string& node_type) { return std::pair(job_class, node_type); });
}

}  // namespace fracfarm
