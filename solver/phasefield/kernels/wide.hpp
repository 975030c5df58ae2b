// The numbers of one instruction, for loops that keep them in registers; arithmetic is by number and gives the same bits whatever the
// width. Included by the kernels only.
#pragma once

#include <cmath>
#include <type_traits>

#if defined(__AVX__)
#include <immintrin.h>
#endif

#define INLINE [[gnu::always_inline]] inline

namespace fracfarm::phasefield::FRACFARM_KERNELS {

using Real = FRACFARM_REAL;
using Index = long;

#if defined(__AVX512F__)
inline constexpr Index width = 64 / sizeof(Real);
#elif defined(__AVX__)
inline constexpr Index width = 32 / sizeof(Real);
#else
inline constexpr Index width = 16 / sizeof(Real);
#endif

using Flag = std::conditional_t<sizeof(Real) == 8, long, int>;
typedef Real Wide __attribute__((vector_size(width * Index(sizeof(Real)))));
typedef Flag WideFlags __attribute__((vector_size(width * Index(sizeof(Real)))));

// From and to any address.
INLINE Wide load(const Real* x) {
  Wide numbers;
  __builtin_memcpy(&numbers, x, sizeof numbers);
  return numbers;
}
INLINE void store(Real* x, Wide numbers) { __builtin_memcpy(x, &numbers, sizeof numbers); }
INLINE Wide all(Real number) { return Wide{} + number; }

// a > b ? a : b, and a < b ? a : b, of which the compiler makes a comparison and a choice.
INLINE Wide larger(Wide a, Wide b) {
#if defined(__AVX512F__)
  if constexpr (sizeof(Real) == 8)
    return (Wide)_mm512_maskz_max_pd(0xff, (__m512d)a, (__m512d)b);
  else
    return (Wide)_mm512_maskz_max_ps(0xffff, (__m512)a, (__m512)b);
#elif defined(__AVX__)
  if constexpr (sizeof(Real) == 8)
    return (Wide)_mm256_max_pd((__m256d)a, (__m256d)b);
  else
    return (Wide)_mm256_max_ps((__m256)a, (__m256)b);
#else
  return a > b ? a : b;
#endif
}
INLINE Wide smaller(Wide a, Wide b) {
#if defined(__AVX512F__)
  if constexpr (sizeof(Real) == 8)
    return (Wide)_mm512_maskz_min_pd(0xff, (__m512d)a, (__m512d)b);
  else
    return (Wide)_mm512_maskz_min_ps(0xffff, (__m512)a, (__m512)b);
#elif defined(__AVX__)
  if constexpr (sizeof(Real) == 8)
    return (Wide)_mm256_min_pd((__m256d)a, (__m256d)b);
  else
    return (Wide)_mm256_min_ps((__m256)a, (__m256)b);
#else
  return a < b ? a : b;
#endif
}

INLINE Wide root(Wide x) {
#if defined(__AVX512F__)
  if constexpr (sizeof(Real) == 8)
    return (Wide)_mm512_maskz_sqrt_pd(0xff, (__m512d)x);
  else
    return (Wide)_mm512_maskz_sqrt_ps(0xffff, (__m512)x);
#elif defined(__AVX__)
  if constexpr (sizeof(Real) == 8)
    return (Wide)_mm256_sqrt_pd((__m256d)x);
  else
    return (Wide)_mm256_sqrt_ps((__m256)x);
#else
  Wide r;
  for (Index l = 0; l < width; ++l) r[l] = std::sqrt(x[l]);
  return r;
#endif
}

// True where a number of x is more than the limit.
INLINE bool any_above(Wide x, Real limit) {
  const Wide bound = all(limit);
#if defined(__AVX512F__)
  if constexpr (sizeof(Real) == 8)
    return _mm512_cmp_pd_mask((__m512d)x, (__m512d)bound, _CMP_GT_OQ) != 0;
  else
    return _mm512_cmp_ps_mask((__m512)x, (__m512)bound, _CMP_GT_OQ) != 0;
#elif defined(__AVX__)
  if constexpr (sizeof(Real) == 8)
    return _mm256_movemask_pd(_mm256_cmp_pd((__m256d)x, (__m256d)bound, _CMP_GT_OQ)) != 0;
  else
    return _mm256_movemask_ps(_mm256_cmp_ps((__m256)x, (__m256)bound, _CMP_GT_OQ)) != 0;
#else
  Flag found = 0;
  for (Index l = 0; l < width; ++l) found |= x[l] > bound[l];
  return found != 0;
#endif
}

}  // namespace fracfarm::phasefield::FRACFARM_KERNELS
