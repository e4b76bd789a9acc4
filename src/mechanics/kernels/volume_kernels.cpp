// Letters as in docs/theory/cell_volume.md: V the volume as a cubic polynomial of the modes m_j, g its gradient by
// them.
#include "mechanics/kernels/hexahedron_lanes.hpp"
#include "mechanics/kernels/tables.hpp"

namespace plica::PLICA_KERNELS {
namespace {

// A register's worth of a batch's elements, from `lane` on, of which the first `count` count.
struct Elements {
  const VolumeBatch& batch;
  std::size_t first;  // element
  int lane, count;

  [[nodiscard]] Lanes rest_volume() const { return load(batch.rest_volumes + lane); }
};

template <class Body>
inline void for_elements(const VolumeArrays& arrays, std::size_t first, std::size_t last, const Body& body) {
  for_registers(arrays.elements, first, last, [&](std::size_t b, int lane, int count) {
    body(Elements{arrays.batches[b], b * batch_size + static_cast<std::size_t>(lane), lane, count});
  });
}

// Value of the cell of each element.
inline Lanes of_owners(const double* values, const Elements& e) {
  Lanes own = {};
  for (int k = 0; k < width; ++k) own[k] = values[e.batch.owners[e.lane + k]];
  return own;
}

inline Lanes pressure(const VolumeArrays& arrays, const Elements& e, const Vec (&m)[7]) {
  if (!arrays.pressures) return of_owners(arrays.bulk_moduli, e) * (1.0 - volume(m) / e.rest_volume());
  return of_owners(arrays.pressures, e);
}

inline void add_modes(const Elements& e, const Vec (&g)[7], double* vectors) {
  Vec f[8];
  from_modes(g, f);
  scatter(e.batch.nodes, e.lane, e.count, f, vectors);
}

[[gnu::flatten]] void add_volumes(const VolumeArrays& arrays, std::size_t first, std::size_t last, double* volumes) {
  for_elements(arrays, first, last, [&](const Elements& e) {
    Vec m[7];
    gather_modes(e.batch.nodes, e.lane, arrays.positions, m);
    const Lanes V = volume(m);
    for (int k = 0; k < e.count; ++k) volumes[e.batch.owners[e.lane + k]] += V[k];
  });
}

[[gnu::flatten]] void write_gradients(const VolumeArrays& arrays, std::size_t first, std::size_t last,
                                      double* gradients) {
  for_elements(arrays, first, last, [&](const Elements& e) {
    Vec m[7], g[7], f[8];
    gather_modes(e.batch.nodes, e.lane, arrays.positions, m);
    volume_gradient(m, g);
    from_modes(g, f);
    for (int k = 0; k < e.count; ++k)
      for (int i = 0; i < 8; ++i) {
        double* v = gradients + 24 * (e.first + static_cast<std::size_t>(k)) + 3 * i;
        v[0] = f[i].x[k];
        v[1] = f[i].y[k];
        v[2] = f[i].z[k];
      }
  });
}

[[gnu::flatten]] void add_forces(const VolumeArrays& arrays, std::size_t first, std::size_t last, double* forces) {
  for_elements(arrays, first, last, [&](const Elements& e) {
    Vec m[7], g[7];
    gather_modes(e.batch.nodes, e.lane, arrays.positions, m);
    volume_gradient(m, g);
    const Lanes p = pressure(arrays, e, m);
    for (Vec& v : g) v = p * v;
    add_modes(e, g, forces);
  });
}

[[gnu::flatten]] void add_product(const VolumeArrays& arrays, std::size_t first, std::size_t last,
                                  const double* direction, double* product) {
  const bool dilatation = !arrays.pressures;
  for_elements(arrays, first, last, [&](const Elements& e) {
    Vec m[7], d[7], result[7] = {};
    gather_modes(e.batch.nodes, e.lane, arrays.positions, m);
    gather_modes(e.batch.nodes, e.lane, direction, d);
    if (!dilatation || !arrays.semidefinite_tangent) {
      volume_gradient_change(m, d, result);
      const Lanes p = pressure(arrays, e, m);
      for (Vec& v : result) v = -p * v;
    }
    if (dilatation) {
      Vec g[7];
      volume_gradient(m, g);
      Lanes rate = dot(g[0], d[0]);
      for (int j = 1; j < 6; ++j) rate += dot(g[j], d[j]);
      const Lanes tension = of_owners(arrays.bulk_moduli, e) * rate / e.rest_volume();
      for (int j = 0; j < 6; ++j) result[j] = result[j] + tension * g[j];
    }
    add_modes(e, result, product);
  });
}

}  // namespace

const VolumeKernels volume_kernels = {{add_forces, add_product, nullptr}, add_volumes, write_gradients};

}  // namespace plica::PLICA_KERNELS
