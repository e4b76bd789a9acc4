// SIMD types for kernel sources. A Lanes holds the doubles of one register, one per element; Vec, Mat and Sym are
// vectors and matrices of them.
//
// Kernel sources (*_kernels.cpp) are compiled once for each instruction set (cmake/kernels.cmake), each time in another
// namespace PLICA_KERNELS with PLICA_LANES doubles per register, so functions of different builds are never confused.
// They include nothing with inline functions used in other sources, except intrinsics.
#pragma once

#include <cstddef>
#if PLICA_LANES > 2
#include <immintrin.h>
#endif

namespace plica::PLICA_KERNELS {

constexpr int width = PLICA_LANES;
constexpr int batch_size = 8;  // elements per batch: those of the widest register

/// Unroll factor of loops over corners, modes and blocks of an element: complete with 32 registers. With 16, spills
/// would double the instructions and exceed the decoded-instruction cache.
constexpr int copies = width == 8 ? 8 : 1;

#if PLICA_LANES != 1  // else a number type that counts operations (bench/counted_lanes.hpp)
typedef double Lanes __attribute__((vector_size(8 * PLICA_LANES), may_alias));  // NOLINT: no `using` for attributes
inline Lanes broadcast(double value) { return Lanes{} + value; }
#endif

#if PLICA_LANES > 2
/// Four numbers, of which memory holds the first three; the fourth is ignored.
typedef double Row __attribute__((vector_size(32)));  // NOLINT
#if PLICA_LANES == 8
inline Row load_row(const double* values) { return _mm256_maskz_loadu_pd(7, values); }
inline Lanes join(Row a, Row b) { return _mm512_insertf64x4(_mm512_castpd256_pd512(a), b, 1); }
#else
inline Row load_row(const double* values) { return _mm256_maskload_pd(values, __m256i{-1, -1, -1, 0}); }
#endif
#endif

#if PLICA_LANES > 1
/// Lanes 2 k and 2 k + 1.
typedef double Pair __attribute__((vector_size(16), aligned(8), may_alias));  // NOLINT
template <int k>
inline Pair pair(const Lanes& a) {
#if PLICA_LANES == 8
  return _mm512_extractf64x2_pd(a, k);
#elif PLICA_LANES == 4
  return _mm256_extractf128_pd(a, k);
#else
  return a;
#endif
}
#endif

inline Lanes load(const double* values) { return *reinterpret_cast<const Lanes*>(values); }

/// Lanes at any address, for unaligned loads and stores.
#if PLICA_LANES != 1
typedef double LooseLanes __attribute__((vector_size(8 * PLICA_LANES), aligned(8), may_alias));  // NOLINT
#else
using LooseLanes = Lanes;
#endif
inline Lanes load_loose(const double* values) { return *reinterpret_cast<const LooseLanes*>(values); }
inline void store_loose(Lanes a, double* values) { *reinterpret_cast<LooseLanes*>(values) = a; }

inline Lanes root(Lanes a) {
#if PLICA_LANES == 8
  return _mm512_sqrt_pd(a);
#elif PLICA_LANES == 4
  return _mm256_sqrt_pd(a);
#else
  for (int k = 0; k < width; ++k) a[k] = __builtin_sqrt(a[k]);
  return a;
#endif
}

/// Whether a comparison holds in any lane.
template <class Mask>
inline bool any(Mask mask) {
#if PLICA_LANES == 8
  return _mm512_movepi64_mask(reinterpret_cast<__m512i>(mask)) != 0;
#elif PLICA_LANES == 4
  return _mm256_movemask_pd(reinterpret_cast<__m256d>(mask)) != 0;
#else
  long long either = 0;
  for (int k = 0; k < width; ++k) either |= mask[k];
  return either != 0;
#endif
}

struct Vec {
  Lanes x, y, z;
};
/// x, y or z.
inline Lanes& component(Vec& a, int c) { return reinterpret_cast<Lanes*>(&a)[c]; }
inline Lanes component(const Vec& a, int c) { return reinterpret_cast<const Lanes*>(&a)[c]; }
inline Vec operator+(const Vec& a, const Vec& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec operator-(const Vec& a, const Vec& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec operator-(const Vec& a) { return {-a.x, -a.y, -a.z}; }
inline Vec operator*(Lanes s, const Vec& a) { return {s * a.x, s * a.y, s * a.z}; }
inline Lanes dot(const Vec& a, const Vec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec cross(const Vec& a, const Vec& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Vec load(const double (&values)[3][batch_size], int lane) {
  return {load(values[0] + lane), load(values[1] + lane), load(values[2] + lane)};
}

/// A matrix by its columns.
struct Mat {
  Vec x, y, z;
};
inline Mat operator+(const Mat& a, const Mat& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Mat operator-(const Mat& a, const Mat& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Mat operator*(Lanes s, const Mat& a) { return {s * a.x, s * a.y, s * a.z}; }
inline Vec operator*(const Mat& a, const Vec& v) { return v.x * a.x + v.y * a.y + v.z * a.z; }
inline Mat operator*(const Mat& a, const Mat& b) { return {a * b.x, a * b.y, a * b.z}; }
inline Mat transpose(const Mat& a) { return {{a.x.x, a.y.x, a.z.x}, {a.x.y, a.y.y, a.z.y}, {a.x.z, a.y.z, a.z.z}}; }
/// Return a^T v and a^T b.
inline Vec turn_back(const Mat& a, const Vec& v) { return {dot(a.x, v), dot(a.y, v), dot(a.z, v)}; }
inline Mat turn_back(const Mat& a, const Mat& b) { return {turn_back(a, b.x), turn_back(a, b.y), turn_back(a, b.z)}; }
inline Mat outer(const Vec& a, const Vec& b) { return {b.x * a, b.y * a, b.z * a}; }
/// Return [a]x b and a [b]x.
inline Mat cross(const Vec& a, const Mat& b) { return {cross(a, b.x), cross(a, b.y), cross(a, b.z)}; }
inline Mat cross(const Mat& a, const Vec& b) {
  return {b.z * a.y - b.y * a.z, b.x * a.z - b.z * a.x, b.y * a.x - b.x * a.y};
}
inline Mat cross_matrix(const Vec& a) {
  const Lanes zero = {};
  return {{zero, a.z, -a.y}, {-a.z, zero, a.x}, {a.y, -a.x, zero}};
}
/// Return sum_i u_i x v_i from sum_i u_i v_i^T.
inline Vec axial(const Mat& a) { return {a.z.y - a.y.z, a.x.z - a.z.x, a.y.x - a.x.y}; }

/// A symmetric matrix.
struct Sym {
  Lanes xx, yy, zz, xy, yz, zx;
};
inline Sym operator+(const Sym& a, const Sym& b) {
  return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.yz + b.yz, a.zx + b.zx};
}
inline Sym operator-(const Sym& a, const Sym& b) {
  return {a.xx - b.xx, a.yy - b.yy, a.zz - b.zz, a.xy - b.xy, a.yz - b.yz, a.zx - b.zx};
}
inline Sym operator*(Lanes s, const Sym& a) { return {s * a.xx, s * a.yy, s * a.zz, s * a.xy, s * a.yz, s * a.zx}; }
inline Lanes trace(const Sym& a) { return a.xx + a.yy + a.zz; }
inline Mat full(const Sym& a) { return {{a.xx, a.xy, a.zx}, {a.xy, a.yy, a.yz}, {a.zx, a.yz, a.zz}}; }
inline Vec operator*(const Sym& a, const Vec& v) {
  return {a.xx * v.x + a.xy * v.y + a.zx * v.z, a.xy * v.x + a.yy * v.y + a.yz * v.z,
          a.zx * v.x + a.yz * v.y + a.zz * v.z};
}
/// Return a : b.
inline Lanes contract(const Sym& a, const Sym& b) {
  const Lanes off = a.xy * b.xy + a.yz * b.yz + a.zx * b.zx;
  return a.xx * b.xx + a.yy * b.yy + a.zz * b.zz + (off + off);
}
/// Return a - tr(a)/3 I.
inline Sym deviator(const Sym& a) {
  const Lanes mean = (1.0 / 3) * trace(a);
  return {a.xx - mean, a.yy - mean, a.zz - mean, a.xy, a.yz, a.zx};
}
inline Sym symmetric_part(const Mat& a) {
  return {a.x.x, a.y.y, a.z.z, 0.5 * (a.x.y + a.y.x), 0.5 * (a.y.z + a.z.y), 0.5 * (a.z.x + a.x.z)};
}
/// Multiply matrices whose product is symmetric except for rounding.
inline Sym upper_part(const Mat& a) { return {a.x.x, a.y.y, a.z.z, a.y.x, a.z.y, a.z.x}; }
/// Return tr(S) I - S.
inline Sym turning(const Sym& S) { return {S.yy + S.zz, S.zz + S.xx, S.xx + S.yy, -S.xy, -S.yz, -S.zx}; }
inline Sym inverse(const Sym& a) {
  const Sym cofactors = {a.yy * a.zz - a.yz * a.yz, a.zz * a.xx - a.zx * a.zx, a.xx * a.yy - a.xy * a.xy,
                         a.yz * a.zx - a.xy * a.zz, a.zx * a.xy - a.yz * a.xx, a.xy * a.yz - a.zx * a.yy};
  return 1 / (a.xx * cofactors.xx + a.xy * cofactors.xy + a.zx * cofactors.zx) * cofactors;
}

}  // namespace plica::PLICA_KERNELS
