// Letters as in docs/theory/cortex.md, but a and b for dx/ds and dx/dt: at a Gauss point (s, t) of the bilinear face, n
// is their product, |n| the area that the point stands for, and f the vector of fibres of length 1 at rest. a depends
// on t alone, b on s alone.
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
  const FibreBatch* fibres;
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

inline Faces faces_at(const FaceArrays& arrays, std::size_t batch, int lane, int count) {
  return {arrays.batches[batch], arrays.fibres == nullptr ? nullptr : arrays.fibres + batch,
          batch * batch_size + static_cast<std::size_t>(lane), lane, count};
}

template <class Body>
inline void for_faces(const FaceArrays& arrays, std::size_t first, std::size_t last, const Body& body) {
  for_registers(arrays.faces, first, last,
                [&](std::size_t b, int lane, int count) { body(faces_at(arrays, b, lane, count)); });
}

// A vector v, and what follows from its softened length phi(|v|): dphi/dv, and d2phi/dv2 = p (I - q u u^T).
struct Length {
  Vec unit;        // u = dphi/dv = p v: v/|v| where |v| is not small
  Lanes length;    // phi
  Lanes inverse;   // p: 1/|v| there
  Lanes straight;  // q: 1 there

  // d2phi/dv2 times a change of v, times a tension.
  [[nodiscard]] Vec turning(Lanes tension, const Vec& change) const {
    return (tension * inverse) * (change - (straight * dot(unit, change)) * unit);
  }
};

inline Length length_of(const Vec& v, Lanes blunt) {
  const Lanes square = dot(v, v);
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
  return {inverse * v, length, inverse, straight};
}

// Fibres at a Gauss point: f = s a + t b, and the weights of |n| and |f| in the measure of the face.
struct Fibres {
  Lanes s, t, of_area, of_length;
  Length f;
};

// The measure of faces, of which forces and tangents are those: the area or, with fibres, a sum of |n| and |f|.
template <bool has_fibres>
struct Measure {
  Slants x;
  Length n[2][2];
  Fibres fibres[has_fibres ? 2 : 1][2];

  Measure(const Faces& faces, const double* positions) : x(faces.slants_of(positions)) {
    for (int s = 0; s < 2; ++s)
      for (int t = 0; t < 2; ++t) {
        n[s][t] = length_of(cross(x.a[t], x.b[s]), faces.blunt());
        if constexpr (has_fibres) {
          const FibreBatch& batch = *faces.fibres;
          const auto at = [&](const double(&values)[4][batch_size]) { return load(values[2 * s + t] + faces.lane); };
          Fibres& here = fibres[s][t];
          here.s = at(batch.s), here.t = at(batch.t);
          here.of_area = at(batch.of_area), here.of_length = at(batch.of_length);
          here.f = length_of(here.s * x.a[t] + here.t * x.b[s], broadcast(FibreBatch::blunt));
        }
      }
  }

  [[nodiscard]] Lanes weighed(int s, int t, Lanes value) const {
    if constexpr (has_fibres) return fibres[s][t].of_area * value;
    return value;
  }

  [[nodiscard]] Lanes value() const {
    const auto at = [&](int s, int t) { return weighed(s, t, n[s][t].length); };
    Lanes sum = at(0, 0) + at(0, 1) + at(1, 0) + at(1, 1);
    if constexpr (has_fibres)
      for (const auto& row : fibres)
        for (const Fibres& here : row) sum += here.of_length * here.f.length;
    return sum;
  }

  // By a and b.
  [[nodiscard]] Slants gradient() const {
    Slants g = {};
    for (int s = 0; s < 2; ++s)
      for (int t = 0; t < 2; ++t) {
        Vec unit = n[s][t].unit;
        if constexpr (has_fibres) unit = fibres[s][t].of_area * unit;
        g.a[t] = g.a[t] + cross(x.b[s], unit);
        g.b[s] = g.b[s] + cross(unit, x.a[t]);
        if constexpr (has_fibres) add_along(s, t, fibres[s][t].of_length * fibres[s][t].f.unit, g);
      }
    return g;
  }

  // T d2M/dx2 times d, and dT/dM times dM/dx d along the gradient g.
  [[nodiscard]] Slants product(const Slants& g, const Slants& d, Lanes tension, Lanes slope, bool semidefinite) const {
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
        const Lanes of_area = weighed(s, t, tension);
        const Vec turned = n[s][t].turning(of_area, cross(d.a[t], x.b[s]) + cross(x.a[t], d.b[s]));
        result.a[t] = result.a[t] + cross(x.b[s], turned);
        result.b[s] = result.b[s] + cross(turned, x.a[t]);
        if constexpr (has_fibres) {
          const Fibres& here = fibres[s][t];
          add_along(s, t, here.f.turning(tension * here.of_length, here.s * d.a[t] + here.t * d.b[s]), result);
        }
        if (semidefinite) continue;
        const Vec pull = of_area * n[s][t].unit;
        result.a[t] = result.a[t] + cross(d.b[s], pull);
        result.b[s] = result.b[s] + cross(pull, d.a[t]);
      }
    return result;
  }

  void add_along(int s, int t, const Vec& of_fibre, Slants& sum) const {
    sum.a[t] = sum.a[t] + fibres[s][t].s * of_fibre;
    sum.b[s] = sum.b[s] + fibres[s][t].t * of_fibre;
  }
};

inline Lanes positive_part(Lanes value) {
  for (int k = 0; k < width; ++k) value[k] = value[k] > 0 ? value[k] : 0;
  return value;
}

struct Response {
  Lanes tension, slope;
};

inline Response response(const FaceArrays& arrays, std::size_t first) {
  const Lanes tension = load_loose(arrays.tensions + first), slope = load_loose(arrays.slopes + first);
  if (!arrays.semidefinite_tangent) return {tension, slope};
  return {positive_part(tension), positive_part(slope)};
}

// Calls body with whether faces have fibres, as a type.
template <class Body>
inline void by_kind(const FaceArrays& arrays, const Body& body) {
  if (arrays.fibres == nullptr) return body.template operator()<false>();
  body.template operator()<true>();
}

[[gnu::flatten]] void write_areas(const FaceArrays& arrays, std::size_t first, std::size_t last, double* areas) {
  by_kind(arrays, [&]<bool has_fibres>() {
    for (std::size_t b = first; b < last; ++b)
      for (int lane = 0; lane < batch_size; lane += width) {
        const Measure<has_fibres> measure(faces_at(arrays, b, lane, width), arrays.positions);
        store_loose(measure.value(), areas + b * batch_size + lane);
      }
  });
}

[[gnu::flatten]] void add_forces(const FaceArrays& arrays, std::size_t first, std::size_t last, double* forces) {
  by_kind(arrays, [&]<bool has_fibres>() {
    for_faces(arrays, first, last, [&](const Faces& faces) {
      Slants g = Measure<has_fibres>(faces, arrays.positions).gradient();
      const Lanes pull = -load_loose(arrays.tensions + faces.first);
      for (int k = 0; k < 2; ++k) {
        g.a[k] = pull * g.a[k];
        g.b[k] = pull * g.b[k];
      }
      faces.add(g, forces);
    });
  });
}

[[gnu::flatten]] void add_product(const FaceArrays& arrays, std::size_t first, std::size_t last,
                                  const double* direction, double* product_of) {
  by_kind(arrays, [&]<bool has_fibres>() {
    for_faces(arrays, first, last, [&](const Faces& faces) {
      const Measure<has_fibres> measure(faces, arrays.positions);
      const auto [tension, slope] = response(arrays, faces.first);
      faces.add(
          measure.product(measure.gradient(), faces.slants_of(direction), tension, slope, arrays.semidefinite_tangent),
          product_of);
    });
  });
}

// Column by column: the tangent times unit vectors at a corner.
[[gnu::flatten]] void write_blocks(const FaceArrays& arrays, std::size_t batch, TangentBlocks<4>& blocks) {
  by_kind(arrays, [&]<bool has_fibres>() {
    for (int lane = 0; lane < batch_size; lane += width) {
      const Faces faces = faces_at(arrays, batch, lane, width);
      const Measure<has_fibres> measure(faces, arrays.positions);
      const Slants g = measure.gradient();
      const auto [tension, slope] = response(arrays, faces.first);
      for (int j = 0; j < 4; ++j)
        for (int c = 0; c < 3; ++c) {
          Vec unit[4] = {};
          component(unit[j], c) = broadcast(1);
          Vec f[4];
          to_corners(measure.product(g, slants(unit), tension, slope, arrays.semidefinite_tangent), f);
          for (int i = j; i < 4; ++i)
            for (int r = 0; r < 3; ++r)
              store_loose(component(f[i], r), blocks.blocks[i * (i + 1) / 2 + j][3 * c + r] + lane);
        }
    }
  });
}

}  // namespace

const FaceKernels face_kernels = {{add_forces, add_product, write_blocks}, write_areas};

}  // namespace plica::PLICA_KERNELS
