// Letters as in docs/theory/neo_hookean.md. At a Gauss point D = dx/d(reference), K = cof D and J = det D; B is the
// inverse of the metric of the rest shape, flowed or not, in reference coordinates: tr(C C_p^-1) = tr(D B D^T). The
// energy's gradient by D is w (D B - K/J). A letter with a d: its change along a direction.
#include "mechanics/kernels/hexahedron_lanes.hpp"
#include "mechanics/kernels/tables.hpp"

namespace plica::PLICA_KERNELS {
namespace {

// A register's worth of a batch's elements, from `lane` on.
struct Elements {
  const NeoHookeanBatch& batch;
  const FlowBatch* flow;  // null: it does not flow
  std::size_t number;     // of the batch
  int lane;
};

template <class Body>
inline void for_elements(const NeoHookeanArrays& arrays, std::size_t first, std::size_t last, const Body& body) {
  for_registers(arrays.elements, first, last, [&](std::size_t b, int lane, int count) {
    body(Elements{arrays.batches[b], arrays.flows ? arrays.flows + b : nullptr, b, lane}, count);
  });
}

// A Gauss point's reference coordinates, in the order of the corners.
struct Place {
  double xi, eta, zeta;
};
inline Place gauss_place(int g) {
  constexpr double at = 0.57735026918962576451;  // 1 over the root of 3
  return {((g + 1) & 2) ? at : -at, (g & 2) ? at : -at, (g & 4) ? at : -at};
}

// dx/d(reference) at a place, from the modes of x; and its transpose: gradient by modes from the gradient H by
// dx/d(reference).
inline Mat slope(const Place& at, const Vec (&m)[7]) {
  const auto [xi, eta, zeta] = at;
  const Lanes eighth = broadcast(0.125), x = broadcast(xi), y = broadcast(eta), z = broadcast(zeta);
  return {eighth * (m[0] + y * m[3] + z * (m[5] + y * m[6])), eighth * (m[1] + z * m[4] + x * (m[3] + z * m[6])),
          eighth * (m[2] + x * m[5] + y * (m[4] + x * m[6]))};
}
inline void add_to_modes(const Place& at, const Mat& H, Vec (&g)[7]) {
  const Lanes x = broadcast(at.xi), y = broadcast(at.eta), z = broadcast(at.zeta);
  g[0] = g[0] + H.x;
  g[1] = g[1] + H.y;
  g[2] = g[2] + H.z;
  g[3] = g[3] + y * H.x + x * H.y;
  g[4] = g[4] + z * H.y + y * H.z;
  g[5] = g[5] + z * H.x + x * H.z;
  g[6] = g[6] + z * (y * H.x + x * H.y) + (x * y) * H.z;
}
inline void scatter_modes(const Elements& e, int count, Lanes scale, Vec (&g)[7], double* vectors) {
  for (Vec& v : g) v = scale * v;
  Vec f[8];
  from_modes(g, f);
  scatter(e.batch.nodes, e.lane, count, f, vectors);
}

inline Mat operator*(const Mat& a, const Sym& b) {
  return {b.xx * a.x + b.xy * a.y + b.zx * a.z, b.xy * a.x + b.yy * a.y + b.yz * a.z,
          b.zx * a.x + b.yz * a.y + b.zz * a.z};
}
/// a^T b, which is known to be symmetric.
inline Sym symmetric_product(const Mat& a, const Mat& b) {
  return {dot(a.x, b.x), dot(a.y, b.y), dot(a.z, b.z), dot(a.x, b.y), dot(a.y, b.z), dot(a.z, b.x)};
}
inline Lanes determinant(const Sym& a) {
  return a.xx * (a.yy * a.zz - a.yz * a.yz) - a.xy * (a.xy * a.zz - a.yz * a.zx) + a.zx * (a.xy * a.yz - a.yy * a.zx);
}
inline Sym load_symmetric(const double* values, int lane) {
  const auto at = [&](int k) { return load_loose(values + k * batch_size + lane); };
  return {at(0), at(1), at(2), at(3), at(4), at(5)};
}

// Cube roots of positive numbers, mostly near 1, by Halley's iteration, which descends from above. NaN for other
// numbers, so that no step ends there.
inline Lanes cube_root(Lanes q) {
  q = q > 0.0 ? q : broadcast(__builtin_nan(""));
  Lanes y = (1.0 / 3) * (q + 2.0);
  for (int iteration = 0; iteration < 40; ++iteration) {
    const Lanes cube = y * y * y, change = y * (cube - q) / (2.0 * cube + q);
    y -= change;
    if (!any((change > 1e-6 * y) | (change < -1e-6 * y))) break;
  }
  return y;
}

// Relaxation of a Gauss point: previous C_p, D0, and r.
struct Flow {
  Sym before;
  Mat frame;
  Lanes r;
};
inline Flow flow_at(const NeoHookeanArrays& arrays, const Elements& e, int g) {
  Sym before = load_symmetric(arrays.flowed[e.number].points[g][0], e.lane);
  if (arrays.ahead > 0)
    before = broadcast(1 + arrays.ahead) * before -
             broadcast(arrays.ahead) * load_symmetric(arrays.flowed_earlier[e.number].points[g][0], e.lane);
  const auto frame = [&](int k) { return load(e.flow->frames[g][k] + e.lane); };
  return {before,
          {{frame(0), frame(1), frame(2)}, {frame(3), frame(4), frame(5)}, {frame(6), frame(7), frame(8)}},
          arrays.rate_s * load(e.flow->rates + e.lane)};
}

// Data of a Gauss point: w, and B with what its change is made of, d = det(C_p + r C)^(1/3).
struct Rest {
  Lanes w;
  Sym B;
  Lanes r_over_d;
};
template <bool flows>
inline Rest rest_at(const NeoHookeanArrays& arrays, const Elements& e, int g, const Mat& D) {
  const Lanes w = load(e.batch.weights[g] + e.lane);
  if constexpr (!flows) return {w, load_symmetric(e.batch.metrics[g][0], e.lane), Lanes{}};
  const auto [before, D0, r] = flow_at(arrays, e, g);
  const Lanes J0 = dot(D0.x, cross(D0.y, D0.z));
  const Sym flowed = symmetric_product(D0, {before * D0.x, before * D0.y, before * D0.z}) + r * symmetric_product(D, D);
  const Lanes d = cube_root(determinant(flowed) / (J0 * J0));
  return {w, d * inverse(flowed), r / d};
}

// D^-T = K/J; NaN at inverted points, so that no step ends there.
inline Mat transposed_inverse(const Mat& D) {
  const Mat K = {cross(D.y, D.z), cross(D.z, D.x), cross(D.x, D.y)};
  const Lanes J = dot(D.x, K.x);
  return (J > 0.0 ? 1.0 / J : broadcast(__builtin_nan(""))) * K;
}

// Addition along rotations so that no direction has negative stiffness: with the two smallest eigenvalues
// s and t of b = D B D^T, (1 - s t)/(2 + s + t) if that is positive. Here with a bound on the largest in place of it.
inline Lanes missing_stiffness(const Mat& DB, const Mat& D) {
  const Mat b = DB * transpose(D);
  const Sym S = upper_part(b);
  const Sym deviation = deviator(S);
  const Lanes mean = (1.0 / 3) * trace(S), most = mean + 2.0 * root((1.0 / 6) * contract(deviation, deviation));
  const Lanes missing = (1.0 - determinant(S) / most) / (2.0 + 3.0 * mean - most);
  return missing > 0.0 ? missing : Lanes{};
}

template <bool flows>
[[gnu::flatten]] void add_forces(const NeoHookeanArrays& arrays, std::size_t first, std::size_t last, double* forces) {
  for_elements(arrays, first, last, [&](const Elements& e, int count) {
    Vec m[7], sum[7] = {};
    gather_modes(e.batch.nodes, e.lane, arrays.positions, m);
    for (int g = 0; g < 8; ++g) {
      const Place at = gauss_place(g);
      const Mat D = slope(at, m);
      const Rest rest = rest_at<flows>(arrays, e, g, D);
      add_to_modes(at, rest.w * (D * rest.B - transposed_inverse(D)), sum);
    }
    scatter_modes(e, count, broadcast(-0.125), sum, forces);
  });
}

template <bool flows>
[[gnu::flatten]] void add_product(const NeoHookeanArrays& arrays, std::size_t first, std::size_t last,
                                  const double* direction, double* product) {
  for_elements(arrays, first, last, [&](const Elements& e, int count) {
    Vec m[7], d[7], sum[7] = {};
    gather_modes(e.batch.nodes, e.lane, arrays.positions, m);
    gather_modes(e.batch.nodes, e.lane, direction, d);
    for (int g = 0; g < 8; ++g) {
      const Place at = gauss_place(g);
      const Mat D = slope(at, m), dD = slope(at, d);
      const Rest rest = rest_at<flows>(arrays, e, g, D);
      const Mat back = transposed_inverse(D);
      Mat dH = dD * rest.B + back * transpose(turn_back(back, dD));
      if (arrays.semidefinite_tangent) {
        const Vec turn =
            missing_stiffness(D * rest.B, D) * (cross(dD.x, back.x) + cross(dD.y, back.y) + cross(dD.z, back.z));
        dH = dH + Mat{cross(back.x, turn), cross(back.y, turn), cross(back.z, turn)};
      } else if (flows) {
        const Mat W = turn_back(D, dD);
        const Sym& B = rest.B;
        const Sym dC = {W.x.x + W.x.x, W.y.y + W.y.y, W.z.z + W.z.z, W.x.y + W.y.x, W.y.z + W.z.y, W.z.x + W.x.z};
        const Sym change = upper_part(full(B) * (full(dC) * full(B)));
        dH = dH + D * (rest.r_over_d * ((1.0 / 3) * contract(B, dC) * B - change));
      }
      add_to_modes(at, rest.w * dH, sum);
    }
    scatter_modes(e, count, broadcast(0.125), sum, product);
  });
}

// With c_i the reference gradient of a corner's shape function, k_i = D^-T c_i, n_i = B c_i and p_i = D n_i,
//   K_ij = w ((c_i . n_j) I + k_j k_i^T), and where the rest shape flows
//   + w r/d (2/3 p_i p_j^T - p_j p_i^T - (c_i . n_j) D B D^T).
template <bool flows>
[[gnu::flatten]] void write_lanes(const NeoHookeanArrays& arrays, const Elements& e, HexahedronBlocks& blocks) {
  Vec m[7];
  gather_modes(e.batch.nodes, e.lane, arrays.positions, m);
  Mat K[36] = {};
  for (int g = 0; g < 8; ++g) {
    const Place at = gauss_place(g);
    const Mat D = slope(at, m);
    const Rest rest = rest_at<flows>(arrays, e, g, D);
    const Mat back = transposed_inverse(D);
    const bool yields = flows && !arrays.semidefinite_tangent;
    const Lanes own = rest.w, missing = arrays.semidefinite_tangent ? missing_stiffness(D * rest.B, D) : Lanes{};
    const Mat b = yields ? (own * rest.r_over_d) * (D * rest.B * transpose(D)) : Mat{};
    Vec c[8], k[8], n[8], p[8];
    for (int i = 0; i < 8; ++i) {
      const double xi = ((i + 1) & 2) ? 1 : -1, eta = (i & 2) ? 1 : -1, zeta = (i & 4) ? 1 : -1;
      const double x = 1 + xi * at.xi, y = 1 + eta * at.eta, z = 1 + zeta * at.zeta;
      c[i] = {broadcast(0.125 * xi * y * z), broadcast(0.125 * eta * z * x), broadcast(0.125 * zeta * x * y)};
      k[i] = back * c[i];
      n[i] = rest.B * c[i];
      if (yields) p[i] = D * n[i];
    }
    for (int i = 0, pair = 0; i < 8; ++i)
      for (int j = 0; j <= i; ++j, ++pair) {
        const Lanes cn = dot(c[i], n[j]), diagonal = own * (cn + missing * dot(k[i], k[j]));
        Mat block = (own * (1.0 - missing)) * outer(k[j], k[i]);
        block.x.x += diagonal, block.y.y += diagonal, block.z.z += diagonal;
        if (yields)
          block = block + (own * rest.r_over_d) * (broadcast(2.0 / 3) * outer(p[i], p[j]) - outer(p[j], p[i])) - cn * b;
        K[pair] = K[pair] + block;
      }
  }
  for (int pair = 0; pair < 36; ++pair) store(K[pair], e.lane, blocks.blocks[pair]);
}

// All lanes of a batch, those that repeat its last element, too: kernels calculate there.
[[gnu::flatten]] void write_flowed(const NeoHookeanArrays& arrays, std::size_t first, std::size_t last,
                                   FlowedBatch* flowed) {
  for (std::size_t b = first; b < last; ++b)
    for (int lane = 0; lane < batch_size; lane += width) {
      const Elements e{arrays.batches[b], arrays.flows + b, b, lane};
      Vec m[7];
      gather_modes(e.batch.nodes, e.lane, arrays.positions, m);
      for (int g = 0; g < 8; ++g) {
        const auto [before, D0, r] = flow_at(arrays, e, g);
        const Mat F = slope(gauss_place(g), m) * transpose(transposed_inverse(D0));
        const Sym sum = before + r * symmetric_product(F, F), next = 1.0 / cube_root(determinant(sum)) * sum;
        const Lanes values[6] = {next.xx, next.yy, next.zz, next.xy, next.yz, next.zx};
        for (int k = 0; k < 6; ++k) store_loose(values[k], flowed[b].points[g][k] + lane);
      }
    }
}

void add_forces(const NeoHookeanArrays& arrays, std::size_t first, std::size_t last, double* forces) {
  (arrays.flows ? add_forces<true> : add_forces<false>)(arrays, first, last, forces);
}

void add_product(const NeoHookeanArrays& arrays, std::size_t first, std::size_t last, const double* direction,
                 double* product) {
  (arrays.flows ? add_product<true> : add_product<false>)(arrays, first, last, direction, product);
}

void write_blocks(const NeoHookeanArrays& arrays, std::size_t batch, HexahedronBlocks& blocks) {
  const Elements e{arrays.batches[batch], arrays.flows ? arrays.flows + batch : nullptr, batch, 0};
  for (int lane = 0; lane < batch_size; lane += width)
    (arrays.flows ? write_lanes<true> : write_lanes<false>)(arrays, {e.batch, e.flow, e.number, lane}, blocks);
}

}  // namespace

const NeoHookeanKernels neo_hookean_kernels = {{add_forces, add_product, write_blocks}, write_flowed};

}  // namespace plica::PLICA_KERNELS
