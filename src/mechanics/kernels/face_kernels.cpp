// Letters as in docs/theory/cortex.md, but a and b for dx/ds and dx/dt: at a Gauss point (s, t) of the bilinear face, n
// is their product and |n| the area that the point stands for. a depends on t alone, b on s alone.
#include "mechanics/kernels/hexahedron_lanes.hpp"
#include "mechanics/kernels/tables.hpp"

namespace plica::PLICA_KERNELS {
namespace {

constexpr double gauss = 0.57735026918962576;  // 1/sqrt(3)

// dx/ds at t = -gauss and gauss, dx/dt at s = -gauss and gauss: linear in the corners.
struct Slants {
  Vec a[2], b[2];
};

inline Slants slants(const Vec (&x)[4]) {
  constexpr double low = (1 - gauss) / 4, high = (1 + gauss) / 4;
  const Vec a0 = x[1] - x[0], a1 = x[2] - x[3], b0 = x[3] - x[0], b1 = x[2] - x[1];
  const Lanes l = broadcast(low), h = broadcast(high);
  return {{h * a0 + l * a1, l * a0 + h * a1}, {h * b0 + l * b1, l * b0 + h * b1}};
}

// Transpose of slants: corner values from values of a and b.
inline void to_corners(const Slants& g, Vec (&f)[4]) {
  constexpr double low = (1 - gauss) / 4, high = (1 + gauss) / 4;
  const Lanes l = broadcast(low), h = broadcast(high);
  const Vec a0 = h * g.a[0] + l * g.a[1], a1 = l * g.a[0] + h * g.a[1];
  const Vec b0 = h * g.b[0] + l * g.b[1], b1 = l * g.b[0] + h * g.b[1];
  f[0] = -(a0 + b0);
  f[1] = a0 - b1;
  f[2] = a1 + b1;
  f[3] = b0 - a1;
}

// A register's worth of a batch's faces, from `lane` on, of which the first `count` count.
struct Faces {
  const FaceBatch& batch;
  std::size_t first;  // face
  int lane, count;

  [[nodiscard]] Lanes blunt() const { return load(batch.blunt + lane); }
  [[nodiscard]] Slants slants_of(const double* vectors) const {
    Vec x[4];
    for (int i = 0; i < 4; ++i) x[i] = gather(vectors, batch.nodes[i] + lane);
    return slants(x);
  }
  void add(const Slants& g, double* vectors) const {
    Vec f[4];
    to_corners(g, f);
    if (count < width) {
      Lanes counts;
      for (int k = 0; k < width; ++k) counts[k] = k < count ? 1 : 0;
      for (Vec& v : f) v = counts * v;
    }
    for (int i = 0; i < 4; ++i) scatter(f[i], batch.nodes[i] + lane, vectors);
  }
};

template <class Body>
inline void for_faces(const FaceArrays& arrays, std::size_t first, std::size_t last, const Body& body) {
  for_registers(arrays.faces, first, last, [&](std::size_t b, int lane, int count) {
    body(Faces{arrays.batches[b], b * batch_size + static_cast<std::size_t>(lane), lane, count});
  });
}

// n, and what follows from the area phi(|n|) that it stands for: dphi/dn, and d2phi/dn2 = p (I - q u u^T).
struct Normal {
  Vec unit;        // u = dphi/dn = p n: n/|n| where |n| is not small
  Lanes length;    // phi
  Lanes inverse;   // p: 1/|n| there
  Lanes straight;  // q: 1 there
};

inline Normal normal(const Vec& a, const Vec& b, Lanes blunt) {
  const Vec n = cross(a, b);
  const Lanes square = dot(n, n);
  Lanes length = root(square), inverse = 1 / root(square), straight = broadcast(1);
  const Lanes whole = blunt * blunt;
  if (any(square < whole))
    for (int k = 0; k < width; ++k) {
      if (!(square[k] < whole[k])) continue;
      const double x = square[k] / whole[k], p = 1.5 - 0.5 * x;
      length[k] = blunt[k] * (0.375 + x * (0.75 - 0.125 * x));
      inverse[k] = p / blunt[k];
      straight[k] = 1 / (p * p * p);
    }
  return {inverse * n, length, inverse, straight};
}

// dA/da and dA/db at all points.
inline Slants area_gradient(const Slants& x, const Normal (&n)[2][2]) {
  Slants g = {};
  for (int s = 0; s < 2; ++s)
    for (int t = 0; t < 2; ++t) {
      g.a[t] = g.a[t] + cross(x.b[s], n[s][t].unit);
      g.b[s] = g.b[s] + cross(n[s][t].unit, x.a[t]);
    }
  return g;
}

inline void normals(const Slants& x, Lanes blunt, Normal (&n)[2][2]) {
  for (int s = 0; s < 2; ++s)
    for (int t = 0; t < 2; ++t) n[s][t] = normal(x.a[t], x.b[s], blunt);
}

inline Lanes positive_part(Lanes value) {
  for (int k = 0; k < width; ++k) value[k] = value[k] > 0 ? value[k] : 0;
  return value;
}

[[gnu::flatten]] void write_areas(const FaceArrays& arrays, std::size_t first, std::size_t last, double* areas) {
  for (std::size_t b = first; b < last; ++b)
    for (int lane = 0; lane < batch_size; lane += width) {
      const Faces faces{arrays.batches[b], 0, lane, width};
      const Slants x = faces.slants_of(arrays.positions);
      Normal n[2][2];
      normals(x, faces.blunt(), n);
      const Lanes area = n[0][0].length + n[0][1].length + n[1][0].length + n[1][1].length;
      store_loose(area, areas + b * batch_size + lane);
    }
}

[[gnu::flatten]] void add_forces(const FaceArrays& arrays, std::size_t first, std::size_t last, double* forces) {
  for_faces(arrays, first, last, [&](const Faces& faces) {
    const Slants x = faces.slants_of(arrays.positions);
    Normal n[2][2];
    normals(x, faces.blunt(), n);
    Slants g = area_gradient(x, n);
    const Lanes pull = -load_loose(arrays.tensions + faces.first);
    for (int k = 0; k < 2; ++k) {
      g.a[k] = pull * g.a[k];
      g.b[k] = pull * g.b[k];
    }
    faces.add(g, forces);
  });
}

// T d2A/dx2 times d, and dT/dA times dA/dx d along the gradient.
inline Slants product(const Slants& x, const Normal (&n)[2][2], const Slants& g, const Slants& d, Lanes tension,
                      Lanes slope, bool semidefinite) {
  Lanes change = {};
  for (int k = 0; k < 2; ++k) change += dot(g.a[k], d.a[k]) + dot(g.b[k], d.b[k]);
  const Lanes along = slope * change;
  Slants result;
  for (int k = 0; k < 2; ++k) {
    result.a[k] = along * g.a[k];
    result.b[k] = along * g.b[k];
  }
  for (int s = 0; s < 2; ++s)
    for (int t = 0; t < 2; ++t) {
      const Vec& unit = n[s][t].unit;
      const Vec turned = cross(d.a[t], x.b[s]) + cross(x.a[t], d.b[s]);
      const Vec tilted = (tension * n[s][t].inverse) * (turned - (n[s][t].straight * dot(unit, turned)) * unit);
      result.a[t] = result.a[t] + cross(x.b[s], tilted);
      result.b[s] = result.b[s] + cross(tilted, x.a[t]);
      if (semidefinite) continue;
      const Vec pull = tension * unit;
      result.a[t] = result.a[t] + cross(d.b[s], pull);
      result.b[s] = result.b[s] + cross(pull, d.a[t]);
    }
  return result;
}

[[gnu::flatten]] void add_product(const FaceArrays& arrays, std::size_t first, std::size_t last,
                                  const double* direction, double* product_of) {
  for_faces(arrays, first, last, [&](const Faces& faces) {
    const Slants x = faces.slants_of(arrays.positions), d = faces.slants_of(direction);
    Normal n[2][2];
    normals(x, faces.blunt(), n);
    Lanes tension = load_loose(arrays.tensions + faces.first), slope = load_loose(arrays.slopes + faces.first);
    if (arrays.semidefinite_tangent) tension = positive_part(tension), slope = positive_part(slope);
    faces.add(product(x, n, area_gradient(x, n), d, tension, slope, arrays.semidefinite_tangent), product_of);
  });
}

// Column by column: the tangent times unit vectors at a corner.
[[gnu::flatten]] void write_blocks(const FaceArrays& arrays, std::size_t batch, TangentBlocks<4>& blocks) {
  for (int lane = 0; lane < batch_size; lane += width) {
    const Faces faces{arrays.batches[batch], batch * batch_size + static_cast<std::size_t>(lane), lane, width};
    const Slants x = faces.slants_of(arrays.positions);
    Normal n[2][2];
    normals(x, faces.blunt(), n);
    const Slants g = area_gradient(x, n);
    Lanes tension = load_loose(arrays.tensions + faces.first), slope = load_loose(arrays.slopes + faces.first);
    if (arrays.semidefinite_tangent) tension = positive_part(tension), slope = positive_part(slope);
    for (int j = 0; j < 4; ++j)
      for (int c = 0; c < 3; ++c) {
        Vec unit[4] = {};
        component(unit[j], c) = broadcast(1);
        Vec f[4];
        to_corners(product(x, n, g, slants(unit), tension, slope, arrays.semidefinite_tangent), f);
        for (int i = j; i < 4; ++i)
          for (int r = 0; r < 3; ++r)
            store_loose(component(f[i], r), blocks.blocks[i * (i + 1) / 2 + j][3 * c + r] + lane);
      }
  }
}

}  // namespace

const FaceKernels face_kernels = {{add_forces, add_product, write_blocks}, write_areas};

}  // namespace plica::PLICA_KERNELS
