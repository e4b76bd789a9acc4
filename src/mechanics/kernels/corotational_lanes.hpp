// Corotational elements side by side: frame, deformation, and what answers it. For kernel sources. Letters as in
// docs/theory/corotational.md: F = R S the mean deformation gradient, h_a the hourglasses of the local displacement, T
// and q what answers S - I and h.
#pragma once

#include "mechanics/kernels/corotational_kernels.hpp"
#include "mechanics/kernels/hexahedron_lanes.hpp"

namespace plica::PLICA_KERNELS {

/// A register's worth of a batch's elements, from `lane` on.
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

/// See CorotationalKernels.
void write_blocks(const CorotationalStep& step, std::size_t batch, CorotationalBlocks& blocks);

/// Four vectors, one a hourglass.
struct Hourglass {
  Lanes at[12];
  Vec operator[](int a) const { return {at[3 * a], at[3 * a + 1], at[3 * a + 2]}; }
  void set(int a, const Vec& v) { at[3 * a] = v.x, at[3 * a + 1] = v.y, at[3 * a + 2] = v.z; }
};

/// sum_j m_j b_j^T.
inline Mat gradient(const Elements& e, const Vec (&m)[7]) {
  Mat F = outer(m[0], e.b(0));
  for (int j = 1; j < 6; ++j) F = F + outer(m[j], e.b(j));
  return F;
}

/// The nearest rotation to F: Newton's iteration for the polar factor, X <- (X + X^-T)/2, as in polar(), which serves
/// the elements on which it fails. From the first step on no singular value is below 1, so det X - 1 is at least the
/// largest error; the next one is half its square.
inline Mat rotation(const Mat& F) {
  const Lanes half = broadcast(0.5), one = broadcast(1);
  Mat R = F;
  auto good = half == half;  // lanes that converge so far
  for (int iteration = 0; iteration < 20; ++iteration) {
    const Mat cofactors = {cross(R.y, R.z), cross(R.z, R.x), cross(R.x, R.y)};
    const Lanes determinant = dot(R.x, cofactors.x);
    R = half * R + (half / determinant) * cofactors;
    good &= determinant > 1e-3;
    if (iteration < 2) continue;  // hardly any element is done so soon
    const auto moving = good & (determinant - one > 1e-8);
    if (!any(moving)) break;
    if (iteration == 19) good &= ~moving;
  }
  if (!any(~good)) return R;
  for (int k = 0; k < width; ++k) {
    if (good[k]) continue;
    const double from[9] = {F.x.x[k], F.x.y[k], F.x.z[k], F.y.x[k], F.y.y[k], F.y.z[k], F.z.x[k], F.z.y[k], F.z.z[k]};
    double to[9];
    nearest_rotation(from, to);
    R.x.x[k] = to[0], R.x.y[k] = to[1], R.x.z[k] = to[2];
    R.y.x[k] = to[3], R.y.y[k] = to[4], R.y.z[k] = to[5];
    R.z.x[k] = to[6], R.z.y[k] = to[7], R.z.z[k] = to[8];
  }
  return R;
}

/// What moves with velocities or small displacements, seen in the frame: W = R^T sum m_j b_j^T and the hourglasses that
/// are not part of it, w_a = R^T m_a - W X_a.
struct Seen {
  Mat W;
  Hourglass w;
};

inline Seen seen_from(const Elements& e, const Mat& R, const Mat& F, const Vec (&m)[7]) {
  Seen s;
  s.W = turn_back(R, F);
  for (int a = 0; a < 4; ++a) s.w.set(a, turn_back(R, m[3 + a] - F * e.X(a)));
  return s;
}

/// S and h.
struct Deformation {
  Mat R;
  Sym S;
  Hourglass h;
};

inline Deformation deformation(const Elements& e, const double* positions) {
  Vec m[7];
  gather_modes(e.batch.nodes, e.lane, positions, m);
  const Mat F = gradient(e, m);
  const Mat R = rotation(F);
  const Seen s = seen_from(e, R, F, m);
  return {R, upper_part(s.W), s.w};
}

/// q = H h for each of `n`.
template <int n>
inline void multiply(const double (&H)[78][batch_size], int lane, const Hourglass* const (&h)[n],
                     Hourglass* const (&q)[n]) {
  for (int k = 0; k < n; ++k)
    for (Lanes& value : q[k]->at) value = Lanes{};
#pragma GCC unroll 12
  for (int row = 0; row < 12; ++row) {
#pragma GCC unroll 12
    for (int column = 0; column < row; ++column) {
      const Lanes entry = load(H[row * (row + 1) / 2 + column] + lane);
      for (int k = 0; k < n; ++k) {
        q[k]->at[row] += entry * h[k]->at[column];
        q[k]->at[column] += entry * h[k]->at[row];
      }
    }
    const Lanes entry = load(H[row * (row + 3) / 2] + lane);
    for (int k = 0; k < n; ++k) q[k]->at[row] += entry * h[k]->at[row];
  }
}

/// How a viscous element has deformed during the step.
struct Strain {
  Sym S;
  Hourglass h;
};

inline Strain strain(const Elements& e, const CorotationalStep& step, const Deformation& now) {
  const Deformation before = deformation(e, step.previous_positions);
  Strain change{now.S - before.S, now.h};
  for (int i = 0; i < 12; ++i) change.h.at[i] -= before.h.at[i];
  return change;
}

/// sum_a a_a . b_a and sum_a a_a x b_a.
inline Lanes dot(const Hourglass& a, const Hourglass& b) {
  Lanes sum = a.at[0] * b.at[0];
  for (int i = 1; i < 12; ++i) sum += a.at[i] * b.at[i];
  return sum;
}

inline Vec cross(const Hourglass& a, const Hourglass& b) {
  Vec sum = cross(a[0], b[0]);
  for (int k = 1; k < 4; ++k) sum = sum + cross(a[k], b[k]);
  return sum;
}

/// The viscosity's part: adds to T and q; returns the energy.
inline Lanes add_viscous(const Elements& e, const CorotationalStep& step, const Deformation& now, Sym& T,
                         Hourglass& q) {
  const Strain change = strain(e, step, now);
  Hourglass viscous;
  multiply<1>(e.viscous->stiffness, e.lane, {&change.h}, {&viscous});
  for (int i = 0; i < 12; ++i) q.at[i] += e.rate * viscous.at[i];
  const Sym D = deviator(change.S);
  T = T + e.viscous_shear() * D;
  return 0.5 * (e.viscous_shear() * contract(D, D) + e.rate * dot(change.h, viscous));
}

}  // namespace plica::PLICA_KERNELS
