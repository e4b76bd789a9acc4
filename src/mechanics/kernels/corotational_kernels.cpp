// Letters as in docs/theory/corotational.md: F = R S the mean deformation gradient, h_a the hourglasses of the local
// displacement, T and q what answers S - I and h, t = G (sum h_a x q_a) with G = (tr(S) I - S)^-1, and
// P = T - sum q_a X_a^T - [t]x the energy's gradient by F in the frame. A letter with a d: its change along a
// direction.
#include "mechanics/kernels/corotational_lanes.hpp"

namespace plica::PLICA_KERNELS {
namespace {

// Calls body(elements, lanes that count) for every register's worth of the batches.
template <class Body>
inline void for_elements(const CorotationalArrays& arrays, std::size_t first, std::size_t last, const Body& body) {
  for_registers(arrays.elements, first, last, [&](std::size_t b, int lane, int count) {
    body(Elements{arrays.batches[b], arrays.viscous_batches ? arrays.viscous_batches + b : nullptr, arrays.rate, lane},
         count);
  });
}

// Nodal contributions for gradients P by F and r by hourglasses in the frame.
inline void add_turned(const Elements& e, int count, const Mat& R, const Mat& P, const Hourglass& r, double* vectors) {
  const Mat RP = R * P;
  Vec g[7];
#pragma GCC unroll copies
  for (int j = 0; j < 6; ++j) g[j] = RP * e.b(j);
#pragma GCC unroll copies
  for (int a = 0; a < 3; ++a) g[3 + a] = g[3 + a] + R * r[a];
  g[6] = R * r[3];
  Vec f[8];
  from_modes(g, f);
  scatter(e.batch.nodes, e.lane, count, f, vectors);
}

// (shear |dev S|^2 + h^T H h)/2.
template <class Batch>
inline Lanes half_product(const Elements& e, const Batch& batch, const Sym& S, const Hourglass& h) {
  Hourglass q;
  multiply<1>(batch.stiffness, e.lane, {&h}, {&q});
  const Sym D = deviator(S);
  const Lanes off = D.xy * D.xy + D.yz * D.yz + D.zx * D.zx;
  Lanes product = load(batch.shear + e.lane) * (D.xx * D.xx + D.yy * D.yy + D.zz * D.zz + off + off);
  for (int i = 0; i < 12; ++i) product += h.at[i] * q.at[i];
  return 0.5 * product;
}

template <bool viscous>
[[gnu::flatten]] void write_energies(const CorotationalArrays& arrays, std::size_t first, std::size_t last,
                                     double* energies) {
  for_elements(arrays, first, last, [&](const Elements& e, int) {
    const Deformation now = deformation(e, arrays.positions);
    Lanes energy = half_product(e, e.batch, now.S, now.h);
    if (viscous) {
      const Strain change = strain(e, arrays, now);
      energy += e.rate * half_product(e, *e.viscous, change.S, change.h);
    }
    store_loose(energy, energies + (&e.batch - arrays.batches) * batch_size + e.lane);
  });
}

template <bool viscous>
[[gnu::flatten]] void add_forces(const CorotationalArrays& arrays, std::size_t first, std::size_t last,
                                 double* forces) {
  for_elements(arrays, first, last, [&](const Elements& e, int count) {
    const Deformation now = deformation(e, arrays.positions);
    Hourglass q;
    multiply<1>(e.batch.stiffness, e.lane, {&now.h}, {&q});
    Sym T = e.shear() * deviator(now.S);
    Vec torque = cross(now.h, q);
    if (viscous) {
      add_viscous(e, arrays, now, T, q);
      torque = cross(now.h, q) + axial(full(now.S) * full(T));
    }
    const Vec t = now.G * torque;
    Mat P = cross_matrix(t) - full(T);
#pragma GCC unroll copies
    for (int a = 0; a < 4; ++a) P = P + outer(q[a], e.X(a));
    for (Lanes& value : q.at) value = -value;
    add_turned(e, count, now.R, P, q, forces);
  });
}

// R K R^T: the frame does not turn.
template <bool viscous>
[[gnu::flatten]] void add_warped_product(const CorotationalArrays& arrays, std::size_t first, std::size_t last,
                                         const double* direction, double* product) {
  for_elements(arrays, first, last, [&](const Elements& e, int count) {
    Vec m[7], d[7];
    gather_modes(e.batch.nodes, e.lane, arrays.positions, m);
    gather_modes(e.batch.nodes, e.lane, direction, d);
    Frame frame;
    set_frame(gradient(e, m), frame);
    const Mat& R = frame.R;
    Hourglass w, dq;
    const Mat W = seen_from(e, R, gradient(e, d), d, w);
    multiply<1>(e.batch.stiffness, e.lane, {&w}, {&dq});
    Lanes shear = e.shear();
    if (viscous) {
      Hourglass damped;
      multiply<1>(e.viscous->stiffness, e.lane, {&w}, {&damped});
      for (int i = 0; i < 12; ++i) dq.at[i] += e.rate * damped.at[i];
      shear += e.viscous_shear();
    }
    Mat dP = full(shear * deviator(symmetric_part(W)));
#pragma GCC unroll copies
    for (int a = 0; a < 4; ++a) dP = dP - outer(dq[a], e.X(a));
    add_turned(e, count, R, dP, dq, product);
  });
}

template <bool viscous>
[[gnu::flatten]] void add_exact_product(const CorotationalArrays& arrays, std::size_t first, std::size_t last,
                                        const double* direction, double* product) {
  for_elements(arrays, first, last, [&](const Elements& e, int count) {
    const Deformation now = deformation(e, arrays.positions);
    Vec d[7];
    gather_modes(e.batch.nodes, e.lane, direction, d);
    const Mat& R = now.R;
    const Sym &S = now.S, &G = now.G;
    const Hourglass& h = now.h;
    Hourglass dh;
    const Mat W = seen_from(e, R, gradient(e, d), d, dh);
    // Rotation of the frame, and the remaining deformation.
    const Vec omega = -(G * axial(W));
    const Sym dS = upper_part(W - cross(omega, full(S)));
#pragma GCC unroll copies
    for (int a = 0; a < 4; ++a) dh.set(a, dh[a] - cross(omega, h[a]));
    // Response.
    Hourglass q, dq;
    multiply<2>(e.batch.stiffness, e.lane, {&h, &dh}, {&q, &dq});
    Sym T = e.shear() * deviator(S), dT = e.shear() * deviator(dS);
    Vec torque = cross(h, q), dtorque = cross(dh, q) + cross(h, dq);
    if (viscous) {
      add_viscous(e, arrays, now, T, q);
      Hourglass damped;
      multiply<1>(e.viscous->stiffness, e.lane, {&dh}, {&damped});
      for (int i = 0; i < 12; ++i) dq.at[i] += e.rate * damped.at[i];
      dT = dT + e.viscous_shear() * deviator(dS);
      torque = cross(h, q) + axial(full(S) * full(T));
      dtorque = cross(dh, q) + cross(h, dq) + axial(full(dS) * full(T) + full(S) * full(dT));
    }
    const Vec t = G * torque, dt = G * (dtorque + dS * t - trace(dS) * t);
    // The turning of what was there, and the change.
    Mat dP = cross(omega, full(T) - cross_matrix(t)) + full(dT) - cross_matrix(dt);
#pragma GCC unroll copies
    for (int a = 0; a < 4; ++a) {
      dq.set(a, dq[a] + cross(omega, q[a]));
      dP = dP - outer(dq[a], e.X(a));
    }
    add_turned(e, count, R, dP, dq, product);
  });
}

// One kernel without viscosity, one with: most elements have none, and it must not cost them anything.
void write_energies(const CorotationalArrays& arrays, std::size_t first, std::size_t last, double* energies) {
  (arrays.viscous_batches ? write_energies<true> : write_energies<false>)(arrays, first, last, energies);
}

void add_forces(const CorotationalArrays& arrays, std::size_t first, std::size_t last, double* forces) {
  (arrays.viscous_batches ? add_forces<true> : add_forces<false>)(arrays, first, last, forces);
}

void add_product(const CorotationalArrays& arrays, std::size_t first, std::size_t last, const double* direction,
                 double* product) {
  const auto add = arrays.semidefinite_tangent
                       ? (arrays.viscous_batches ? add_warped_product<true> : add_warped_product<false>)
                       : (arrays.viscous_batches ? add_exact_product<true> : add_exact_product<false>);
  add(arrays, first, last, direction, product);
}

}  // namespace

const CorotationalKernels corotational_kernels = {{add_forces, add_product, write_blocks}, write_energies};

}  // namespace plica::PLICA_KERNELS
