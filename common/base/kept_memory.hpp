// For processes that do the same work again and again.
#pragma once

namespace fracfarm {

// Freed memory stays with the process up to 128 MiB: the next job needs as much as the last one, and fresh pages would cost a fault each.
// Changes no number.
void keep_freed_memory();

}  // namespace fracfarm
