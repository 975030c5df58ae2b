// How a law's functions are declared: always inlined, so that each instruction set compiles its own copy and a GPU compiler may add its
// words here.
#pragma once

#if defined(__GNUC__)
#define FRACFARM_POINTWISE [[gnu::always_inline]] inline
#else
#define FRACFARM_POINTWISE inline
#endif
