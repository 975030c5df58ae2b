// A register of numbers, as wide as the instruction set has it, and how rows in memory become registers and back. Included by the kernels
// only, which are compiled once for each instruction set and number type; everything is inlined, so that no instruction of a higher set
// leaks into shared code.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#ifdef __SSE2__
#include <immintrin.h>
#endif

#include "solver/fdem/kernels.hpp"

namespace fracfarm::fdem::FRACFARM_KERNELS {

#define INLINE __attribute__((always_inline)) inline
using Real = FRACFARM_REAL;
using View = fdem::View<Real>;
using Index = std::ptrdiff_t;

#ifdef __AVX512DQ__
#define FRACFARM_MASKS 1
inline constexpr int register_bytes = 64;
#elif defined(__AVX2__)
inline constexpr int register_bytes = 32;
#else
inline constexpr int register_bytes = 16;
#endif
inline constexpr int width = register_bytes / int(sizeof(Real)) > 4 ? register_bytes / int(sizeof(Real)) : 4;
inline constexpr int parts = lanes / width;  // registers in a block

typedef Real Raw __attribute__((vector_size(width * sizeof(Real))));

#ifdef FRACFARM_MASKS
using RawMask = std::conditional_t<width == 16, __mmask16, __mmask8>;
INLINE RawMask above(__m512 a, __m512 b) { return RawMask(_mm512_cmp_ps_mask(a, b, _CMP_GT_OQ)); }
INLINE RawMask above(__m512d a, __m512d b) { return RawMask(_mm512_cmp_pd_mask(a, b, _CMP_GT_OQ)); }
INLINE Raw pick(RawMask m, __m512 a, __m512 b) { return Raw(_mm512_mask_blend_ps(__mmask16(m), b, a)); }
INLINE Raw pick(RawMask m, __m512d a, __m512d b) { return Raw(_mm512_mask_blend_pd(__mmask8(m), b, a)); }
#else
using RawMask = decltype(Raw{} > Raw{});
INLINE RawMask above(Raw a, Raw b) { return a > b; }
INLINE Raw pick(RawMask m, Raw a, Raw b) { return m ? a : b; }
#endif

struct Mask {
  RawMask raw;
  friend INLINE Mask operator&(Mask a, Mask b) { return {RawMask(a.raw & b.raw)}; }
  friend INLINE Mask operator~(Mask a) { return {RawMask(~a.raw)}; }
  friend INLINE Mask operator|(Mask a, Mask b) { return {RawMask(a.raw | b.raw)}; }
};

struct Lanes {
  Raw raw;
  Lanes() = default;
  INLINE Lanes(Raw r) : raw(r) {}
  INLINE Lanes(Real a) : raw(a - Raw{}) {}
  template <class Number, class = std::enable_if_t<std::is_arithmetic_v<Number> && !std::is_same_v<Number, Real>>>
  explicit INLINE Lanes(Number a) : raw(Real(a) - Raw{}) {}
  friend INLINE Lanes operator+(Lanes a, Lanes b) { return a.raw + b.raw; }
  friend INLINE Lanes operator-(Lanes a, Lanes b) { return a.raw - b.raw; }
  friend INLINE Lanes operator*(Lanes a, Lanes b) { return a.raw * b.raw; }
  friend INLINE Lanes operator/(Lanes a, Lanes b) { return a.raw / b.raw; }
  friend INLINE Lanes operator-(Lanes a) { return -a.raw; }
  friend INLINE Mask operator>(Lanes a, Lanes b) { return {above(a.raw, b.raw)}; }
};

INLINE Lanes select(Mask m, Lanes a, Lanes b) { return pick(m.raw, a.raw, b.raw); }
INLINE Lanes larger(Lanes a, Lanes b) { return select(a > b, a, b); }
INLINE Lanes smaller(Lanes a, Lanes b) { return select(a > b, b, a); }

INLINE Lanes sqrt(Lanes a) {
#ifdef FRACFARM_MASKS
  if constexpr (sizeof(Real) == 4)
    return Raw(_mm512_mask_sqrt_ps(__m512(a.raw), __mmask16(-1), __m512(a.raw)));
  else
    return Raw(_mm512_mask_sqrt_pd(__m512d(a.raw), __mmask8(-1), __m512d(a.raw)));
#elif defined(__AVX2__)
  if constexpr (sizeof(Real) == 4)
    return Raw(_mm256_sqrt_ps(__m256(a.raw)));
  else
    return Raw(_mm256_sqrt_pd(__m256d(a.raw)));
#else
  Raw root{};
  for (int l = 0; l < width; ++l) root[l] = std::sqrt(a.raw[l]);
  return root;
#endif
}

INLINE bool any(Mask m) {
#ifdef FRACFARM_MASKS
  return m.raw != 0;
#elif defined(__AVX2__)
  return sizeof(Real) == 4 ? _mm256_movemask_ps(__m256(m.raw)) != 0 : _mm256_movemask_pd(__m256d(m.raw)) != 0;
#else
  bool found = false;
  for (int l = 0; l < width; ++l) found |= m.raw[l] != 0;
  return found;
#endif
}

// Lane l as bit l.
INLINE unsigned bits(Mask m) {
#ifdef FRACFARM_MASKS
  return m.raw;
#elif defined(__AVX2__)
  return unsigned(sizeof(Real) == 4 ? _mm256_movemask_ps(__m256(m.raw)) : _mm256_movemask_pd(__m256d(m.raw)));
#else
  unsigned found = 0;
  for (int l = 0; l < width; ++l) found |= unsigned(m.raw[l] != 0) << l;
  return found;
#endif
}

// Registers of consecutive numbers.
INLINE Lanes load(const Real* from) {
  Raw raw;
  __builtin_memcpy(&raw, from, sizeof raw);
  return raw;
}
INLINE void store(Real* to, Lanes a) { __builtin_memcpy(to, &a.raw, sizeof a.raw); }

template <class Vector, class Pattern, std::size_t... L>
INLINE Vector shuffle(Vector a, Vector b, Pattern, std::index_sequence<L...>) {
  return __builtin_shufflevector(a, b, Pattern::of(int(L))...);
}
template <class Pattern>
INLINE Raw shuffle(Raw a, Raw b) {
  return shuffle(a, b, Pattern{}, std::make_index_sequence<std::size_t(width)>{});
}

// Patterns on groups of four lanes: lane 4 g + j of the result is lane 4 g + in(j) of a or b.
template <int j0, int j1, int j2, int j3>
struct InGroups {  // 0...3 of a, 4...7 of b
  static constexpr int of(int l) {
    const int j = l % 4, from = j == 0 ? j0 : j == 1 ? j1 : j == 2 ? j2 : j3;
    return l - j + from % 4 + (from / 4) * width;
  }
};

struct Four4 {
  Raw a, b, c, d;
};

// Each group of four lanes as a 4 x 4 matrix, transposed.
INLINE Four4 transposed(const Four4& z) {
  if constexpr (sizeof(Real) == 4) {
    using Low = InGroups<0, 4, 1, 5>;
    using High = InGroups<2, 6, 3, 7>;
    const Raw ab_low = shuffle<Low>(z.a, z.b), ab_high = shuffle<High>(z.a, z.b);
    const Raw cd_low = shuffle<Low>(z.c, z.d), cd_high = shuffle<High>(z.c, z.d);
    using First = InGroups<0, 1, 4, 5>;
    using Second = InGroups<2, 3, 6, 7>;
    return {shuffle<First>(ab_low, cd_low), shuffle<Second>(ab_low, cd_low), shuffle<First>(ab_high, cd_high),
            shuffle<Second>(ab_high, cd_high)};
  } else {
    using Even = InGroups<0, 4, 2, 6>;
    using Odd = InGroups<1, 5, 3, 7>;
    const Raw ab_even = shuffle<Even>(z.a, z.b), ab_odd = shuffle<Odd>(z.a, z.b);
    const Raw cd_even = shuffle<Even>(z.c, z.d), cd_odd = shuffle<Odd>(z.c, z.d);
    using First = InGroups<0, 1, 4, 5>;
    using Second = InGroups<2, 3, 6, 7>;
    return {shuffle<First>(ab_even, cd_even), shuffle<First>(ab_odd, cd_odd), shuffle<Second>(ab_even, cd_even),
            shuffle<Second>(ab_odd, cd_odd)};
  }
}

// Of the branch that is compiled for the other number type.
template <class Number>
INLINE const Number* as(const Real* p) {
  return reinterpret_cast<const Number*>(p);
}
template <class Number>
INLINE Number* as(Real* p) {
  return reinterpret_cast<Number*>(p);
}

// Four numbers at each of at(first), at(first + 4), ... side by side in a register, and back.
template <class At>
INLINE Raw load_quads(const At& at, int first) {
#ifdef FRACFARM_MASKS
  if constexpr (width == 16) {
    const __m256 low =
        _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(as<float>(at(first)))), _mm_loadu_ps(as<float>(at(first + 4))), 1);
    const __m256 high =
        _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(as<float>(at(first + 8)))), _mm_loadu_ps(as<float>(at(first + 12))), 1);
    return Raw(_mm512_insertf32x8(_mm512_castps256_ps512(low), high, 1));
  } else {
    return Raw(
        _mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_loadu_pd(as<double>(at(first)))), _mm256_loadu_pd(as<double>(at(first + 4))), 1));
  }
#elif defined __AVX2__
  if constexpr (width == 8)
    return Raw(_mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(as<float>(at(first)))), _mm_loadu_ps(as<float>(at(first + 4))), 1));
  else
    return Raw(_mm256_loadu_pd(as<double>(at(first))));
#else
  Raw raw;
  for (int group = 0; group < width / 4; ++group)
    __builtin_memcpy(reinterpret_cast<char*>(&raw) + group * 4 * int(sizeof(Real)), at(first + 4 * group), 4 * sizeof(Real));
  return raw;
#endif
}

template <class At>
INLINE void store_quads(const At& at, int first, Raw a) {
#ifdef FRACFARM_MASKS
  if constexpr (width == 16) {
    _mm_storeu_ps(as<float>(at(first)), _mm512_castps512_ps128(__m512(a)));
    _mm_storeu_ps(as<float>(at(first + 4)), _mm512_extractf32x4_ps(__m512(a), 1));
    _mm_storeu_ps(as<float>(at(first + 8)), _mm512_extractf32x4_ps(__m512(a), 2));
    _mm_storeu_ps(as<float>(at(first + 12)), _mm512_extractf32x4_ps(__m512(a), 3));
  } else {
    _mm256_storeu_pd(as<double>(at(first)), _mm512_castpd512_pd256(__m512d(a)));
    _mm256_storeu_pd(as<double>(at(first + 4)), _mm512_extractf64x4_pd(__m512d(a), 1));
  }
#elif defined __AVX2__
  if constexpr (width == 8) {
    _mm_storeu_ps(as<float>(at(first)), _mm256_castps256_ps128(__m256(a)));
    _mm_storeu_ps(as<float>(at(first + 4)), _mm256_extractf128_ps(__m256(a), 1));
  } else {
    _mm256_storeu_pd(as<double>(at(first)), __m256d(a));
  }
#else
  for (int group = 0; group < width / 4; ++group)
    __builtin_memcpy(at(first + 4 * group), reinterpret_cast<const char*>(&a) + group * 4 * int(sizeof(Real)), 4 * sizeof(Real));
#endif
}

struct Lanes4 {
  Lanes a, b, c, d;
};

// Four consecutive numbers at(l) of each lane l, as four registers, and back.
template <class At>
INLINE Lanes4 load_rows(const At& at) {
  const Four4 t = transposed({load_quads(at, 0), load_quads(at, 1), load_quads(at, 2), load_quads(at, 3)});
  return {t.a, t.b, t.c, t.d};
}
template <class At>
INLINE void store_rows(const At& at, const Lanes4& x) {
  const Four4 t = transposed({x.a.raw, x.b.raw, x.c.raw, x.d.raw});
  store_quads(at, 0, t.a), store_quads(at, 1, t.b), store_quads(at, 2, t.c), store_quads(at, 3, t.d);
}
#define LANE_AT [=](int l) __attribute__((always_inline))

inline constexpr int groups = width / 4;  // of four lanes in a register

template <int first, int stride>
struct OfGroups {  // groups first, first + stride, ... of a, then the same of b
  static constexpr int of(int l) {
    const int half = groups > 1 ? groups / 2 : 1, g = l / 4, from = first + stride * (g % half);
    return (g / half) * width + from * 4 + l % 4;
  }
};

// As many registers as there are groups in one, as the rows of a matrix of groups, transposed.
INLINE void transpose_groups(Raw* x) {
  if constexpr (groups == 4) {
    const Raw ab_low = shuffle<OfGroups<0, 1>>(x[0], x[1]), ab_high = shuffle<OfGroups<2, 1>>(x[0], x[1]);
    const Raw cd_low = shuffle<OfGroups<0, 1>>(x[2], x[3]), cd_high = shuffle<OfGroups<2, 1>>(x[2], x[3]);
    x[0] = shuffle<OfGroups<0, 2>>(ab_low, cd_low), x[1] = shuffle<OfGroups<1, 2>>(ab_low, cd_low);
    x[2] = shuffle<OfGroups<0, 2>>(ab_high, cd_high), x[3] = shuffle<OfGroups<1, 2>>(ab_high, cd_high);
  } else if constexpr (groups == 2) {
    const Raw a = x[0], b = x[1];
    x[0] = shuffle<OfGroups<0, 1>>(a, b), x[1] = shuffle<OfGroups<1, 1>>(a, b);
  }
}

// All of every lane's numbers, `quads` times four, that lie side by side in memory, one lane after another: group g of x[quads j + k] is
// quad k of lane 4 g + j.
template <int quads>
INLINE void load_lines(const Real* at, Raw* x) {
  constexpr int sets = 4 * quads / groups;
#pragma GCC unroll 12
  for (int n = 0; n < sets; ++n) {
#pragma GCC unroll 4
    for (int g = 0; g < groups; ++g) x[n * groups + g] = load(at + (n + sets * g) * width).raw;
    transpose_groups(x + n * groups);
  }
}

// And back; x is used up.
template <int quads>
INLINE void store_lines(Real* at, Raw* x) {
  constexpr int sets = 4 * quads / groups;
#pragma GCC unroll 12
  for (int n = 0; n < sets; ++n) {
    transpose_groups(x + n * groups);
#pragma GCC unroll 4
    for (int g = 0; g < groups; ++g) store(at + (n + sets * g) * width, x[n * groups + g]);
  }
}

// Partial sums of a chunk, one a lane of the block.
struct LaneSums {
  Lanes part[parts];
  INLINE LaneSums() {
    for (Lanes& lane : part) lane = Lanes(Real(0));
  }
  INLINE double total() const {
    Real one[lanes];
    for (int s = 0; s < parts; ++s) store(one + s * width, part[s]);
    double eight[8], quarter[4];
    for (int l = 0; l < 8; ++l) eight[l] = double(one[l]) + double(one[l + 8]);
    for (int l = 0; l < 4; ++l) quarter[l] = eight[l] + eight[l + 4];
    return (quarter[0] + quarter[2]) + (quarter[1] + quarter[3]);
  }
};

}  // namespace fracfarm::fdem::FRACFARM_KERNELS
