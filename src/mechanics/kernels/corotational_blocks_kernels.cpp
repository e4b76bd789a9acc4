// The tangent of an element as 3 x 3 blocks of its corners (docs/theory/corotational.md, Tangent). All in global axes:
// what the element keeps in its frame is turned by R first. Then, with gamma_ai = h_ai - b_i . X_a,
//   K_ij = shear ((b_i . b_j) I + b_j b_i^T)/2 - b_i b_j^T/3) + sum gamma_ai gamma_bj H_ab + U_i [b_j]x - [b_i]x U_j^T,
// the last two from the turning of the frame, omega = G (b_i x dx_i): U_i = N_i G - [b_i]x G C G / 2.
#include "mechanics/kernels/corotational_lanes.hpp"

namespace plica::PLICA_KERNELS {
namespace {

// H turned: R H_ab R^T, and the viscosity's share added.
inline void turned_stiffness(const Elements& e, const Mat& R, Mat (&H)[4][4]) {
  const Mat back = transpose(R);
  const auto entry = [&](int row, int column) {
    const int at = row >= column ? row * (row + 1) / 2 + column : column * (column + 1) / 2 + row;
    const Lanes value = load(e.batch.stiffness[at] + e.lane);
    return e.viscous ? value + e.rate * load(e.viscous->stiffness[at] + e.lane) : value;
  };
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b <= a; ++b) {
      const auto column = [&](int k) {
        return Vec{entry(3 * a, 3 * b + k), entry(3 * a + 1, 3 * b + k), entry(3 * a + 2, 3 * b + k)};
      };
      H[a][b] = R * (Mat{column(0), column(1), column(2)} * back);
      if (b < a) H[b][a] = transpose(H[a][b]);
    }
}

// Quantities that rotate with the element: deformation and response, in global axes.
struct Turned {
  Sym S, T, G;
  Vec t;
  Vec h[4], q[4];
};

inline Turned turned(const Elements& e, const CorotationalArrays& arrays, const Deformation& now) {
  Hourglass q;
  multiply<1>(e.batch.stiffness, e.lane, {&now.h}, {&q});
  Sym T = e.shear() * deviator(now.S);
  if (e.viscous) add_viscous(e, arrays, now, T, q);
  const Mat back = transpose(now.R);
  const auto turn = [&](const Sym& a) { return upper_part(now.R * (full(a) * back)); };
  Turned result{turn(now.S), turn(T), {}, {}, {}, {}};
  result.G = inverse(turning(result.S));
  for (int a = 0; a < 4; ++a) {
    result.h[a] = now.R * now.h[a];
    result.q[a] = now.R * q[a];
  }
  Vec torque = axial(full(result.S) * full(result.T));
  for (int a = 0; a < 4; ++a) torque = torque + cross(result.h[a], result.q[a]);
  result.t = result.G * torque;
  return result;
}

// G C G / 2: half of what the turning costs by itself, as it acts on b_i x dx_i.
inline Mat half_turning_stiffness(const Turned& x, Lanes shear, const Mat (&H)[4][4]) {
  const Mat S = full(x.S), S2 = S * S, A = S * full(x.T);
  const Lanes s = trace(x.S), squares = contract(x.S, x.S);  // tr S and tr S^2
  const auto identity = [](Lanes d) { return Mat{{d, {}, {}}, {{}, d, {}}, {{}, {}, d}}; };
  // cof S = S^2 - tr(S) S + (tr(S)^2 - tr(S^2)) I / 2
  Mat C = 0.5 * shear * (identity(squares + squares - s * s) + (s + s) * S - (S2 + S2 + S2));
  C = C + A - identity(A.x.x + A.y.y + A.z.z) + cross(x.t, S);
  for (int a = 0; a < 4; ++a) {
    C = C + outer(x.q[a], x.h[a]) - identity(dot(x.h[a], x.q[a]));
    for (int b = 0; b < 4; ++b) C = C - cross(x.h[a], cross(H[a][b], x.h[b]));
  }
  const Mat G = full(x.G);
  return G * (full(symmetric_part(C)) * (broadcast(0.5) * G));
}

[[gnu::flatten]] void write_lanes(const Elements& e, const CorotationalArrays& arrays, HexahedronBlocks& blocks) {
  const bool exact = !arrays.semidefinite_tangent;
  const Deformation now = deformation(e, arrays.positions);
  Mat H[4][4];
  turned_stiffness(e, now.R, H);
  const Lanes shear = e.viscous ? e.shear() + e.viscous_shear() : e.shear();

  // b_i and gamma_ai of the corners.
  Vec modes[7], b[8];
  for (int j = 0; j < 6; ++j) modes[j] = now.R * e.b(j);
  modes[6] = Vec{};
  from_modes(modes, b);
  Lanes gamma[4][8];
  for (int a = 0; a < 4; ++a) {
    const Vec X = now.R * e.X(a);
    for (int i = 0; i < 8; ++i) gamma[a][i] = hourglass_sign(a, i) - dot(b[i], X);
  }

  Turned x{};
  Mat half{};
  if (exact) {
    x = turned(e, arrays, now);
    half = half_turning_stiffness(x, shear, H);
  }
  Mat U[8];
  for (int i = 0, pair = 0; i < 8; ++i) {
    Mat L[4];  // sum_a gamma_ai H_ab
    for (int k = 0; k < 4; ++k) {
      L[k] = gamma[0][i] * H[0][k];
      for (int a = 1; a < 4; ++a) L[k] = L[k] + gamma[a][i] * H[a][k];
    }
    if (exact) {
      // N_i: the work of dx_i as the frame turns.
      const Vec Sb = x.S * b[i], Tb = x.T * b[i];
      const Lanes bt = dot(b[i], x.t);
      Mat N = 0.5 * shear * (cross_matrix(Sb) - cross(full(x.S), b[i])) + outer(b[i], x.t) - cross_matrix(Tb);
      N.x.x -= bt, N.y.y -= bt, N.z.z -= bt;
      for (int a = 0; a < 4; ++a) N = N + cross(L[a], x.h[a]) - gamma[a][i] * cross_matrix(x.q[a]);
      U[i] = N * full(x.G) - cross(b[i], half);
    }
    for (int j = 0; j <= i; ++j, ++pair) {
      Mat K = (0.5 * shear) * outer(b[j], b[i]) - (1.0 / 3 * shear) * outer(b[i], b[j]);
      const Lanes bb = 0.5 * shear * dot(b[i], b[j]);
      K.x.x += bb, K.y.y += bb, K.z.z += bb;
      for (int a = 0; a < 4; ++a) K = K + gamma[a][j] * L[a];
      if (exact) K = K + cross(U[i], b[j]) - cross(b[i], transpose(U[j]));
      store(K, e.lane, blocks.blocks[pair]);
    }
  }
}

}  // namespace

void write_blocks(const CorotationalArrays& arrays, std::size_t batch, HexahedronBlocks& blocks) {
  const ViscousBatch* viscous = arrays.viscous_batches ? arrays.viscous_batches + batch : nullptr;
  for (int lane = 0; lane < batch_size; lane += width)
    write_lanes({arrays.batches[batch], viscous, arrays.rate, lane}, arrays, blocks);
}

}  // namespace plica::PLICA_KERNELS
