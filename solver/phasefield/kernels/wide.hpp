// The numbers of one instruction, for loops that keep them in registers; arithmetic is by number and gives the same bits whatever the
// width. Included by the kernels only.
#pragma once

#include <cmath>
#include <type_traits>

#ifdef __AVX__
#include <immintrin.h>
#endif

#define INLINE [[gnu::always_inline]] inline

namespace fracfarm::phasefield::FRACFARM_KERNELS {

using Real = FRACFARM_REAL;
using Index = long;

#ifdef __AVX512F__
inline constexpr Index bytes_wide = 64;
#else
#ifdef __AVX__
inline constexpr Index bytes_wide = 32;
#else
inline constexpr Index bytes_wide = 16;
#endif
#endif
inline constexpr Index width = bytes_wide / Index(sizeof(Real));

using Flag = std::conditional_t<sizeof(Real) == 8, long, int>;
typedef Real Wide __attribute__((vector_size(bytes_wide)));
typedef Flag WideFlags __attribute__((vector_size(bytes_wide)));

// From and to any address; a vector may stand for its numbers, a copy of bytes for anything, and then all is read again.
typedef Real Anywhere __attribute__((vector_size(bytes_wide), aligned(sizeof(Real))));
INLINE Wide load(const Real* x) { return *reinterpret_cast<const Anywhere*>(x); }
INLINE void store(Real* x, Wide numbers) { *reinterpret_cast<Anywhere*>(x) = numbers; }
INLINE Wide all(Real number) { return Wide{} + number; }

// What the compiler has no operator for, or makes a comparison and a choice of: a > b ? a : b, a < b ? a : b, a root, any x > limit.
#ifdef __AVX512F__
INLINE __m512 maximum(__m512 a, __m512 b) { return _mm512_maskz_max_ps(0xffff, a, b); }
INLINE __m512d maximum(__m512d a, __m512d b) { return _mm512_maskz_max_pd(0xff, a, b); }
INLINE __m512 minimum(__m512 a, __m512 b) { return _mm512_maskz_min_ps(0xffff, a, b); }
INLINE __m512d minimum(__m512d a, __m512d b) { return _mm512_maskz_min_pd(0xff, a, b); }
INLINE __m512 square_root(__m512 x) { return _mm512_maskz_sqrt_ps(0xffff, x); }
INLINE __m512d square_root(__m512d x) { return _mm512_maskz_sqrt_pd(0xff, x); }
INLINE bool exceeds(__m512 x, __m512 limit) { return _mm512_cmp_ps_mask(x, limit, _CMP_GT_OQ) != 0; }
INLINE bool exceeds(__m512d x, __m512d limit) { return _mm512_cmp_pd_mask(x, limit, _CMP_GT_OQ) != 0; }
#else
#ifdef __AVX__
INLINE __m256 maximum(__m256 a, __m256 b) { return _mm256_max_ps(a, b); }
INLINE __m256d maximum(__m256d a, __m256d b) { return _mm256_max_pd(a, b); }
INLINE __m256 minimum(__m256 a, __m256 b) { return _mm256_min_ps(a, b); }
INLINE __m256d minimum(__m256d a, __m256d b) { return _mm256_min_pd(a, b); }
INLINE __m256 square_root(__m256 x) { return _mm256_sqrt_ps(x); }
INLINE __m256d square_root(__m256d x) { return _mm256_sqrt_pd(x); }
INLINE bool exceeds(__m256 x, __m256 limit) { return _mm256_movemask_ps(_mm256_cmp_ps(x, limit, _CMP_GT_OQ)) != 0; }
INLINE bool exceeds(__m256d x, __m256d limit) { return _mm256_movemask_pd(_mm256_cmp_pd(x, limit, _CMP_GT_OQ)) != 0; }
#else
INLINE Wide maximum(Wide a, Wide b) { return a > b ? a : b; }
INLINE Wide minimum(Wide a, Wide b) { return a < b ? a : b; }
INLINE Wide square_root(Wide x) {
  Wide r;
  for (Index l = 0; l < width; ++l) r[l] = std::sqrt(x[l]);
  return r;
}
INLINE bool exceeds(Wide x, Wide limit) {
  bool found = false;
  for (Index l = 0; l < width; ++l) found = found || x[l] > limit[l];
  return found;
}
#endif
#endif

INLINE Wide larger(Wide a, Wide b) { return maximum(a, b); }
INLINE Wide smaller(Wide a, Wide b) { return minimum(a, b); }
INLINE Wide root(Wide x) { return square_root(x); }
INLINE bool any_above(Wide x, Real limit) { return exceeds(x, all(limit)); }

}  // namespace fracfarm::phasefield::FRACFARM_KERNELS
