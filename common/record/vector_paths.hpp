// Loops over whole fields of damage are compiled twice, and the machine that runs them chooses: with eight floats at a time half the time.
// Only for loops whose result does not depend on the order of operations.
#pragma once

#ifdef __x86_64__
#define FRACFARM_VECTOR_PATHS [[gnu::target_clones("avx2", "default")]]
#else
#define FRACFARM_VECTOR_PATHS
#endif
