#include "common/base/kept_memory.hpp"

#include <malloc.h>

namespace fracfarm {

void keep_freed_memory() {
#ifdef __GLIBC__
  ::mallopt(M_MMAP_THRESHOLD, 32 << 20);  // the most that glibc takes
  ::mallopt(M_TRIM_THRESHOLD, 128 << 20);
#endif
}

}  // namespace fracfarm
