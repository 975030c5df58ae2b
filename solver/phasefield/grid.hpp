// The regular grid and its memory layout: nodes in rows from the bottom up, ghost columns left and right, a ghost row below and above.
// Rows start on a cache line and are padded to whole groups of `lanes`; pads hold finite values that nothing counts.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace fracfarm::phasefield {

inline constexpr int lanes = 16;  // numbers handled together; sums are made of this many partial sums whatever the machine

template <class T>
struct CacheLineAllocator {
  using value_type = T;
  CacheLineAllocator() = default;
  template <class U>
  CacheLineAllocator(const CacheLineAllocator<U>&) {}
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), std::align_val_t(64))); }
  void deallocate(T* p, std::size_t) { ::operator delete(p, std::align_val_t(64)); }
  bool operator==(const CacheLineAllocator&) const { return true; }
};

template <class Real>
using Field = std::vector<Real, CacheLineAllocator<Real>>;

struct Grid {
  int columns = 0;  // nodes in x
  int rows = 0;     // nodes in z
  double hx = 0.0;  // m
  double hz = 0.0;  // m

  int cells_x() const { return columns - 1; }
  int cells_z() const { return rows - 1; }
  int padded_columns() const { return (columns + lanes - 1) / lanes * lanes; }
  int tiles() const { return padded_columns() / lanes; }   // of a row: groups of `lanes` nodes
  int stride() const { return padded_columns() + lanes; }  // the pad between two rows holds the right ghost of one, the left of the next
  std::size_t origin() const { return static_cast<std::size_t>(stride() + lanes); }  // of node (0, 0) in a field
  std::size_t size() const { return static_cast<std::size_t>(stride()) * static_cast<std::size_t>(rows + 2) + lanes; }
  std::size_t index(int column, int row) const {
    return origin() + static_cast<std::size_t>(row) * static_cast<std::size_t>(stride()) + static_cast<std::size_t>(column);
  }
  double corner_area() const { return 0.25 * hx * hz; }  // weight of one corner of an element, m^2
  template <class Real = double>
  Field<Real> field(Real value = Real(0)) const {
    return Field<Real>(size(), value);
  }
};

}  // namespace fracfarm::phasefield
