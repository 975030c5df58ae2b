#include "common/base/kept_memory.hpp"

#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>

namespace fracfarm {

void keep_freed_memory() {
#ifdef __GLIBC__
  ::mallopt(M_MMAP_THRESHOLD, 32 << 20);  // the most that glibc takes
  ::mallopt(M_TRIM_THRESHOLD, 128 << 20);
#endif
}

void use_large_pages() {
  keep_freed_memory();
#if defined(__GLIBC__) && defined(MADV_HUGEPAGE)
  constexpr std::uintptr_t ahead = 32 << 20, page = 2 << 20;
  ::mallopt(M_TOP_PAD, static_cast<int>(ahead));
  void* volatile block = std::malloc(1 << 20);  // more than is left of the heap, so that it grows, and stays
  std::free(block);
  const std::uintptr_t end = reinterpret_cast<std::uintptr_t>(::sbrk(0)) / page * page;
  ::madvise(reinterpret_cast<void*>(end - ahead + page), ahead - page, MADV_HUGEPAGE);  // where it may not, small pages do
#endif
}

}  // namespace fracfarm
