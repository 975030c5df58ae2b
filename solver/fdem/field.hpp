// Arrays whose first number starts a cache line.
#pragma once

#include <new>
#include <vector>

namespace fracfarm::fdem {

template <class T>
struct CacheLineAllocator {
  using value_type = T;
  static constexpr std::align_val_t alignment{64};

  CacheLineAllocator() = default;
  template <class U>
  CacheLineAllocator(const CacheLineAllocator<U>&) {}
  T* allocate(std::size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), alignment)); }
  void deallocate(T* at, std::size_t) { ::operator delete(at, alignment); }
  template <class U>
  bool operator==(const CacheLineAllocator<U>&) const {
    return true;
  }
};

template <class Real>
using Field = std::vector<Real, CacheLineAllocator<Real>>;

}  // namespace fracfarm::fdem
