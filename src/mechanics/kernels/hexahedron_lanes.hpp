// Hexahedra per register, for kernel sources: gather and scatter, the seven modes of a trilinear hexahedron, its
// volume.
//
// The modes m_j = sum_i s_ji x_i have signs s_ji = xi, eta, zeta, xi eta, eta zeta, zeta xi and xi eta zeta at the
// reference place of node i (VTK order): three linear modes and four hourglasses. The eighth, the sum, is the place of
// the element, on which nothing here depends. With a gradient in modes g_j, that of the nodes is sum_j s_ji
// g_j (docs/theory/corotational.md).
#pragma once

#include "mechanics/kernels/lanes.hpp"

namespace plica::PLICA_KERNELS {

/// 3 x node index of each corner: [corner][element].
using BatchNodes = int[8][batch_size];

/// Return the number of elements of a batch: full, except for the last.
inline int count_in_batch(std::size_t elements, std::size_t batch) {
  const std::size_t left = elements - batch * batch_size;
  return left < batch_size ? static_cast<int>(left) : batch_size;
}

/// Call body(batch, lane, count) for every register's worth of elements of batches `first` to `last` - 1, from `lane`
/// on, of which the first `count` count.
template <class Body>
inline void for_registers(std::size_t elements, std::size_t first, std::size_t last, const Body& body) {
  for (std::size_t b = first; b < last; ++b) {
    const int count = count_in_batch(elements, b);
    for (int lane = 0; lane < count; lane += width) body(b, lane, count - lane < width ? count - lane : width);
  }
}

/// Write a block of tangents, by columns.
inline void store(const Mat& block, int lane, double (&numbers)[9][batch_size]) {
  const Lanes values[9] = {block.x.x, block.x.y, block.x.z, block.y.x, block.y.y,
                           block.y.z, block.z.x, block.z.y, block.z.z};
  for (int k = 0; k < 9; ++k) *reinterpret_cast<Lanes*>(numbers[k] + lane) = values[k];
}

/// Gather vectors of nodes: reads rows x y z and transposes.
inline Vec gather(const double* vectors, const int* at) {
#if PLICA_LANES == 8
  const auto rows = [&](int k, int l) { return join(load_row(vectors + at[k]), load_row(vectors + at[l])); };
  const Lanes a = rows(0, 2), b = rows(1, 3), c = rows(4, 6), d = rows(5, 7);
  // x and z of nodes 0 1 and 2 3, of 4 5 and 6 7; y the same.
  const Lanes xz = __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14);
  const Lanes xz_on = __builtin_shufflevector(c, d, 0, 8, 2, 10, 4, 12, 6, 14);
  const Lanes y = __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
  const Lanes y_on = __builtin_shufflevector(c, d, 1, 9, 3, 11, 5, 13, 7, 15);
  return {__builtin_shufflevector(xz, xz_on, 0, 1, 4, 5, 8, 9, 12, 13),
          __builtin_shufflevector(y, y_on, 0, 1, 4, 5, 8, 9, 12, 13),
          __builtin_shufflevector(xz, xz_on, 2, 3, 6, 7, 10, 11, 14, 15)};
#elif PLICA_LANES == 4
  const Lanes a = load_row(vectors + at[0]), b = load_row(vectors + at[1]);
  const Lanes c = load_row(vectors + at[2]), d = load_row(vectors + at[3]);
  const Lanes xz = __builtin_shufflevector(a, b, 0, 4, 2, 6), xz_on = __builtin_shufflevector(c, d, 0, 4, 2, 6);
  const Lanes y = __builtin_shufflevector(a, b, 1, 5, 3, 7), y_on = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  return {__builtin_shufflevector(xz, xz_on, 0, 1, 4, 5), __builtin_shufflevector(y, y_on, 0, 1, 4, 5),
          __builtin_shufflevector(xz, xz_on, 2, 3, 6, 7)};
#else
  Vec x;
  for (int k = 0; k < width; ++k) {
    x.x[k] = vectors[at[k]];
    x.y[k] = vectors[at[k] + 1];
    x.z[k] = vectors[at[k] + 2];
  }
  return x;
#endif
}

inline void gather(const BatchNodes& nodes, int lane, const double* vectors, Vec (&x)[8]) {
#pragma GCC unroll copies
  for (int i = 0; i < 8; ++i) x[i] = gather(vectors, nodes[i] + lane);
}

#if PLICA_LANES == 1
inline void scatter(const Vec& f, const int* at, double* vectors) {
  double* v = vectors + at[0];
  v[0] += f.x[0];
  v[1] += f.y[0];
  v[2] += f.z[0];
}
#else
// Add lane k of z, and of x and y, which alternate in `xy`, lane k & ~1 first. Two stores per vector instead of three,
// since scattering is limited by stores. (Not one: a later load of x y z cannot be forwarded from a masked store.)
template <int k>
inline void add_lane(const Lanes& xy, const Lanes& z, double* vector) {
  *reinterpret_cast<Pair*>(vector) += pair<k / 2>(xy);
  vector[2] += z[k];
}

inline void scatter(const Vec& f, const int* at, double* vectors) {
#if PLICA_LANES == 8
  const Lanes even = __builtin_shufflevector(f.x, f.y, 0, 8, 2, 10, 4, 12, 6, 14);
  const Lanes odd = __builtin_shufflevector(f.x, f.y, 1, 9, 3, 11, 5, 13, 7, 15);
#elif PLICA_LANES == 4
  const Lanes even = __builtin_shufflevector(f.x, f.y, 0, 4, 2, 6), odd = __builtin_shufflevector(f.x, f.y, 1, 5, 3, 7);
#else
  const Lanes even = __builtin_shufflevector(f.x, f.y, 0, 2), odd = __builtin_shufflevector(f.x, f.y, 1, 3);
#endif
  add_lane<0>(even, f.z, vectors + at[0]);
  add_lane<1>(odd, f.z, vectors + at[1]);
#if PLICA_LANES > 2
  add_lane<2>(even, f.z, vectors + at[2]);
  add_lane<3>(odd, f.z, vectors + at[3]);
#endif
#if PLICA_LANES > 4
  add_lane<4>(even, f.z, vectors + at[4]);
  add_lane<5>(odd, f.z, vectors + at[5]);
  add_lane<6>(even, f.z, vectors + at[6]);
  add_lane<7>(odd, f.z, vectors + at[7]);
#endif
}
#endif

/// Add to the nodes of the first `count` lanes; adds nothing to those of the other lanes, which exist.
inline void scatter(const BatchNodes& nodes, int lane, int count, Vec (&f)[8], double* vectors) {
  if (count < width) {
    Lanes counts;
#pragma GCC unroll 8
    for (int k = 0; k < width; ++k) counts[k] = k < count ? 1 : 0;
#pragma GCC unroll 8
    for (Vec& v : f) v = counts * v;
  }
#pragma GCC unroll copies
  for (int i = 0; i < 8; ++i) scatter(f[i], nodes[i] + lane, vectors);
}

// Differences of neighbouring nodes first, so that their common part cancels without rounding.
inline void to_modes(const Vec (&x)[8], Vec (&m)[7]) {
#pragma GCC unroll copies
  for (int c = 0; c < 3; ++c) {
    const auto at = [&](int i) { return component(x[i], c); };
    const auto mode = [&](int j) -> Lanes& { return component(m[j], c); };
    const Lanes xi0 = at(1) - at(0), xi1 = at(2) - at(3), xi2 = at(5) - at(4), xi3 = at(6) - at(7);
    const Lanes low = xi0 + xi1, high = xi2 + xi3, low_twist = xi1 - xi0, high_twist = xi3 - xi2;
    const Lanes eta0 = (at(3) - at(0)) + (at(2) - at(1)), eta1 = (at(7) - at(4)) + (at(6) - at(5));
    mode(0) = low + high;
    mode(1) = eta0 + eta1;
    mode(2) = ((at(4) - at(0)) + (at(5) - at(1))) + ((at(7) - at(3)) + (at(6) - at(2)));
    mode(3) = low_twist + high_twist;
    mode(4) = eta1 - eta0;
    mode(5) = high - low;
    mode(6) = high_twist - low_twist;
  }
}

inline void gather_modes(const BatchNodes& nodes, int lane, const double* vectors, Vec (&m)[7]) {
  Vec x[8];
  gather(nodes, lane, vectors, x);
  to_modes(x, m);
}

inline void from_modes(const Vec (&g)[7], Vec (&f)[8]) {
#pragma GCC unroll copies
  for (int c = 0; c < 3; ++c) {
    const auto mode = [&](int j) { return component(g[j], c); };
    // Without xi, then with it, at (eta, zeta) = (-, -), (+, -), (-, +), (+, +).
    const Lanes up = mode(2) + mode(4), down = mode(2) - mode(4);
    const Lanes even[4] = {-(mode(1) + down), mode(1) - up, down - mode(1), mode(1) + up};
    const Lanes base_low = mode(0) - mode(3), base_high = mode(0) + mode(3);
    const Lanes low = mode(5) - mode(6), high = mode(5) + mode(6);
    const Lanes odd[4] = {base_low - low, base_high - high, base_low + low, base_high + high};
    const int corners[4][2] = {{0, 1}, {3, 2}, {4, 5}, {7, 6}};
    for (int k = 0; k < 4; ++k) {
      component(f[corners[k][0]], c) = even[k] - odd[k];
      component(f[corners[k][1]], c) = even[k] + odd[k];
    }
  }
}

/// Return the sign of hourglass a, mode 3 + a, at corner i.
inline double hourglass_sign(int a, int i) {
  const int xi = ((i + 1) & 2) ? 1 : -1, eta = (i & 2) ? 1 : -1, zeta = (i & 4) ? 1 : -1;
  const int signs[4] = {xi * eta, eta * zeta, zeta * xi, xi * eta * zeta};
  return signs[a];
}

/// Return the volume of the trilinear hexahedron, a cubic polynomial of its modes (docs/theory/cell_volume.md).
inline Lanes volume(const Vec (&m)[7]) {
  const Lanes blended = dot(m[0], cross(m[3], m[5])) + dot(m[1], cross(m[4], m[3])) + dot(m[2], cross(m[5], m[4]));
  return (1.0 / 64) * dot(m[0], cross(m[1], m[2])) + (1.0 / 192) * blended;
}

/// Return dV/dm. The last mode does not change the volume.
inline void volume_gradient(const Vec (&m)[7], Vec (&g)[7]) {
  const Lanes linear = broadcast(1.0 / 64), blended = broadcast(1.0 / 192);
  for (int k = 0; k < 3; ++k) {
    const int l = (k + 1) % 3, n = (k + 2) % 3;
    g[k] = linear * cross(m[l], m[n]) + blended * cross(m[3 + k], m[3 + n]);
    g[3 + k] = blended * (cross(m[3 + n], m[k]) + cross(m[l], m[3 + l]));
  }
  g[6] = Vec{};
}

/// Return the change of dV/dm when m changes by d.
inline void volume_gradient_change(const Vec (&m)[7], const Vec (&d)[7], Vec (&change)[7]) {
  const Lanes linear = broadcast(1.0 / 64), blended = broadcast(1.0 / 192);
  const auto product = [&](int a, int b) { return cross(m[a], d[b]) + cross(d[a], m[b]); };
  for (int k = 0; k < 3; ++k) {
    const int l = (k + 1) % 3, n = (k + 2) % 3;
    change[k] = linear * product(l, n) + blended * product(3 + k, 3 + n);
    change[3 + k] = blended * (product(3 + n, k) + product(l, 3 + l));
  }
  change[6] = Vec{};
}

}  // namespace plica::PLICA_KERNELS
