// Corotational elements, several per register: frame, deformation and response, for kernel sources. Letters as in
// docs/theory/corotational.md: F = R S the mean deformation gradient, h_a the hourglasses of the local displacement, T
// and q the responses to S - I and h.
#pragma once

#include "mechanics/kernels/hexahedron_lanes.hpp"
#include "mechanics/kernels/tables.hpp"

namespace plica::PLICA_KERNELS {

/// Elements of one register of a batch, from `lane` on.
struct Elements {
  const CorotationalBatch& batch;
  const ViscousBatch* viscous;  // null: not viscous
  double rate;
  int lane;

  [[nodiscard]] Vec b(int mode) const { return load(batch.gradients[mode], lane); }
  [[nodiscard]] Vec X(int a) const { return load(batch.hourglass[a], lane); }
  [[nodiscard]] Lanes shear() const { return load(batch.shear + lane); }
  [[nodiscard]] Lanes viscous_shear() const { return rate * load(viscous->shear + lane); }
};

/// Write the tangent blocks of a batch (CorotationalKernels).
void write_blocks(const CorotationalArrays& arrays, std::size_t batch, HexahedronBlocks& blocks);

/// Four vectors, one per hourglass.
struct Hourglass {
  Lanes at[12];
  Vec operator[](int a) const { return {at[3 * a], at[3 * a + 1], at[3 * a + 2]}; }
  void set(int a, const Vec& v) { at[3 * a] = v.x, at[3 * a + 1] = v.y, at[3 * a + 2] = v.z; }
};

/// Return sum_j m_j b_j^T.
inline Mat gradient(const Elements& e, const Vec (&m)[7]) {
  Mat F = outer(m[0], e.b(0));
#pragma GCC unroll copies
  for (int j = 1; j < 6; ++j) F = F + outer(m[j], e.b(j));
  return F;
}

/// Return tr S of F = R S from a = tr S^2, b = |cof S|^2 and J = det F: the largest root of the quartic (s^2 - a)^2/4
/// - b - 2 J s. All roots are real, so Halley's iteration descends to it from any larger number, with cubic
/// convergence.
inline Lanes stretch_trace(Lanes a, Lanes b, Lanes J) {
  const Lanes J2 = J + J;
  const auto halley = [&](Lanes s) {
    const Lanes s2 = s * s, u = s2 - a;
    const Lanes value = 0.25 * u * u - b - J2 * s, slope = s * u - J2, half_bend = s2 + 0.5 * u;
    return value * slope / (slope * slope - value * half_bend);
  };
  const Lanes first = 0.5 * a + 1.5;  // at least sqrt(3 a), and so at least the trace
  Lanes s = first - halley(first);
  for (int iteration = 1; iteration < 30; ++iteration) {  // hardly any element is done after the first
    const Lanes step = halley(s);
    s -= step;
    if (!any(step > 1e-5 * s)) break;
  }
  return s;
}

/// R and G = (s I - S)^-1, with s = tr S.
struct Frame {
  Mat R;
  Sym G;
};

// Handle elements one by one, whatever their shape. Separate, so that regular elements do not pay for it.
[[gnu::noinline, gnu::cold]] inline Mat nearest_rotation(const Mat& F) {
  Mat R;
  for (int k = 0; k < width; ++k) {
    const double from[9] = {F.x.x[k], F.x.y[k], F.x.z[k], F.y.x[k], F.y.y[k], F.y.z[k], F.z.x[k], F.z.y[k], F.z.z[k]};
    double to[9];
    plica::nearest_rotation(from, to);
    R.x.x[k] = to[0], R.x.y[k] = to[1], R.x.z[k] = to[2];
    R.y.x[k] = to[3], R.y.y[k] = to[4], R.y.z[k] = to[5];
    R.z.x[k] = to[6], R.z.y[k] = to[7], R.z.z[k] = to[8];
  }
  return R;
}

/// Compute R and G by the Cayley-Hamilton theorem: with K = cof F, C = F^T F = S^2, c = (s^2 - tr C)/2 (second
/// invariant of S) and D = s c - J = det(s I - S), D G = C + c I and D R = F ((s^2 - c) I - C) + s K. (Written in
/// place: without AVX-512, GCC 12 would copy a return value in pieces of 8 bytes.)
inline void set_frame(const Mat& F, Frame& result) {
  const Mat K = {cross(F.y, F.z), cross(F.z, F.x), cross(F.x, F.y)};
  const Sym C = {dot(F.x, F.x), dot(F.y, F.y), dot(F.z, F.z), dot(F.x, F.y), dot(F.y, F.z), dot(F.z, F.x)};
  const Lanes J = dot(F.x, K.x), s = stretch_trace(trace(C), dot(K.x, K.x) + dot(K.y, K.y) + dot(K.z, K.z), J);
  const Lanes s2 = s * s, c = 0.5 * (s2 - trace(C)), D = s * c - J;
  const Lanes scale = 1 / D, own = scale * c, rest = scale * (s2 - c);
  const Sym part = scale * C;
  result = {F * Mat{{rest - part.xx, -part.xy, -part.zx},
                    {-part.xy, rest - part.yy, -part.yz},
                    {-part.zx, -part.yz, rest - part.zz}} +
                (scale * s) * K,
            {part.xx + own, part.yy + own, part.zz + own, part.xy, part.yz, part.zx}};
  // Nearly or fully inverted, and very flat elements.
  if (any(~((J > 1e-3) & (D > 1e-3 * s * s2)))) {
    const Mat deformed = F, R = nearest_rotation(deformed);
    result = {R, inverse(turning(upper_part(turn_back(R, F))))};
  }
}

/// Velocities or small displacements in the frame: W = R^T sum m_j b_j^T and the remaining hourglasses w_a = R^T m_a -
/// W X_a.
inline Mat seen_from(const Elements& e, const Mat& R, const Mat& F, const Vec (&m)[7], Hourglass& w) {
#pragma GCC unroll copies
  for (int a = 0; a < 4; ++a) w.set(a, turn_back(R, m[3 + a] - F * e.X(a)));
  return turn_back(R, F);
}

/// S, h, and their frame.
struct Deformation : Frame {
  Sym S;
  Hourglass h;
};

inline Deformation deformation(const Elements& e, const double* positions) {
  Vec m[7];
  gather_modes(e.batch.nodes, e.lane, positions, m);
  const Mat F = gradient(e, m);
  Deformation now;
  set_frame(F, now);
  now.S = upper_part(seen_from(e, now.R, F, m, now.h));
  return now;
}

/// Compute q = H h for each of `n`, by 3 x 3 blocks (row by row, each entry would cost two loads and a store). Each
/// block is loaded once for all of them.
template <int n>
inline void multiply(const double (&H)[78][batch_size], int lane, const Hourglass* const (&h)[n],
                     Hourglass* const (&q)[n]) {
#pragma GCC unroll copies
  for (int a = 0; a < 4; ++a) {
    const auto entry = [&](int i, int j) { return load(H[i * (i + 1) / 2 + j] + lane); };
    const int i = 3 * a;
    const Sym own = {entry(i, i),     entry(i + 1, i + 1), entry(i + 2, i + 2),
                     entry(i + 1, i), entry(i + 2, i + 1), entry(i + 2, i)};
    Vec ha[n], qa[n];
#pragma GCC unroll 2
    for (int k = 0; k < n; ++k) {
      ha[k] = (*h[k])[a];
      qa[k] = own * ha[k];
    }
#pragma GCC unroll copies
    for (int b = 0; b < a; ++b) {
      const int j = 3 * b;
      const Mat H_ab = {{entry(i, j), entry(i + 1, j), entry(i + 2, j)},
                        {entry(i, j + 1), entry(i + 1, j + 1), entry(i + 2, j + 1)},
                        {entry(i, j + 2), entry(i + 1, j + 2), entry(i + 2, j + 2)}};
#pragma GCC unroll 2
      for (int k = 0; k < n; ++k) {
        qa[k] = qa[k] + H_ab * (*h[k])[b];
        q[k]->set(b, (*q[k])[b] + turn_back(H_ab, ha[k]));
      }
    }
#pragma GCC unroll 2
    for (int k = 0; k < n; ++k) q[k]->set(a, qa[k]);
  }
}

/// Deformation of a viscous element: rate of deformation times rate_s.
struct Strain {
  Sym S;
  Hourglass h;

  void add(double weight, const Deformation& other) {
    S = S + broadcast(weight) * other.S;
    for (int i = 0; i < 12; ++i) h.at[i] += weight * other.h.at[i];
  }
};

inline Strain strain(const Elements& e, const CorotationalArrays& arrays, const Deformation& now) {
  Strain change{now.S, now.h};
  change.add(-(1 + arrays.ahead), deformation(e, arrays.previous_positions));
  if (arrays.ahead > 0) change.add(arrays.ahead, deformation(e, arrays.earlier_positions));
  return change;
}

/// Return sum_a a_a x b_a.
inline Vec cross(const Hourglass& a, const Hourglass& b) {
  Vec sum = cross(a[0], b[0]);
  for (int k = 1; k < 4; ++k) sum = sum + cross(a[k], b[k]);
  return sum;
}

/// Add the viscous part of T and q.
inline void add_viscous(const Elements& e, const CorotationalArrays& arrays, const Deformation& now, Sym& T,
                        Hourglass& q) {
  const Strain change = strain(e, arrays, now);
  Hourglass viscous;
  multiply<1>(e.viscous->stiffness, e.lane, {&change.h}, {&viscous});
  for (int i = 0; i < 12; ++i) q.at[i] += e.rate * viscous.at[i];
  T = T + e.viscous_shear() * deviator(change.S);
}

}  // namespace plica::PLICA_KERNELS
