// For processes that do the same work again and again, or little of it once.
#pragma once

namespace fracfarm {

// Freed memory stays with the process up to 128 MiB: the next job needs as much as the last one, and fresh pages would cost a fault each.
// Changes no number.
void keep_freed_memory();

// The same, and the next 32 MiB lie in large pages where the system has them: a run's first touch of a few MiB costs a fault for every
// 2 MiB in place of 4 KiB. To be called before much was allocated.
void use_large_pages();

}  // namespace fracfarm
