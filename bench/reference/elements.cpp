#include "elements.hpp"

#include <algorithm>
#include <cmath>

namespace plica::reference {

namespace {

// Ends of the four edges along each local axis, in the order of the two other axes.
constexpr int edges[3][4][2] = {
    {{0, 1}, {3, 2}, {4, 5}, {7, 6}}, {{0, 3}, {1, 2}, {4, 7}, {5, 6}}, {{0, 4}, {1, 5}, {3, 7}, {2, 6}}};
// Which of the four interpolated differences along axis k belongs to point p = xi + 2 eta + 4 zeta.
constexpr int index_at(int k, int p) {
  const int xi = p & 1, eta = (p >> 1) & 1, zeta = p >> 2;
  return k == 0 ? eta + 2 * zeta : k == 1 ? xi + 2 * zeta : xi + 2 * eta;
}

}  // namespace

[[gnu::always_inline]] inline void Elements::gather(const Batch& batch, const double* p, Lanes (&u)[8][3]) {
  alignas(64) double buffer[8][3][width];
  for (int a = 0; a < 8; ++a)
    for (int lane = 0; lane < width; ++lane)
      for (int c = 0; c < 3; ++c) buffer[a][c][lane] = p[batch.nodes[a][lane] + c];
  for (int a = 0; a < 8; ++a)
    for (int c = 0; c < 3; ++c) u[a][c] = *reinterpret_cast<const Lanes*>(buffer[a][c]);
}

[[gnu::always_inline]] inline void Elements::scatter(const Batch& batch, const Lanes (&f)[8][3], double* y) {
  for (int a = 0; a < 8; ++a)
    for (int lane = 0; lane < width; ++lane)
      for (int c = 0; c < 3; ++c) y[batch.nodes[a][lane] + c] += f[a][c][lane];
}

// Batches are read once a product, from memory or a far cache: the next one's values are asked for in time.
template <class Part>
[[gnu::always_inline]] inline void fetch(const Part& part) {
  for (std::size_t at = 0; at < sizeof(Part); at += 64) __builtin_prefetch(reinterpret_cast<const char*>(&part) + at);
}

// From the corners of a square to its four Gauss points; its own transpose.
[[gnu::always_inline]] inline void Elements::interpolate(const Lanes (&v)[4], Lanes (&at_points)[4]) {
  constexpr double near = 0.78867513459481288225, far = 0.21132486540518711775;  // (1 +- 1/sqrt(3)) / 2
  const Lanes a = near * v[0] + far * v[1], b = far * v[0] + near * v[1];
  const Lanes c = near * v[2] + far * v[3], d = far * v[2] + near * v[3];
  at_points[0] = near * a + far * c;
  at_points[1] = near * b + far * d;
  at_points[2] = far * a + near * c;
  at_points[3] = far * b + near * d;
}

// along[k][c]: twice the derivative of component c along local axis k.
[[gnu::always_inline]] inline void Elements::reference_gradients(const Lanes (&u)[8][3], Lanes (&along)[3][3][4]) {
  for (int k = 0; k < 3; ++k)
    for (int c = 0; c < 3; ++c) {
      Lanes differences[4];
      for (int e = 0; e < 4; ++e) differences[e] = u[edges[k][e][1]][c] - u[edges[k][e][0]][c];
      interpolate(differences, along[k][c]);
    }
}

[[gnu::always_inline]] inline void Elements::respond(const Batch& batch, double lambda, double mu,
                                                     const Lanes (&u)[8][3], Lanes (&f)[8][3]) {
  Lanes along[3][3][4], back[3][3][4] = {};
  reference_gradients(u, along);
#pragma GCC unroll 8
  for (int p = 0; p < 8; ++p) {
    const Lanes(&G)[9] = batch.G[p];
    fetch((&batch + 1)->G[p]);
    Lanes H[3][3];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        H[i][j] = along[0][i][index_at(0, p)] * G[j] + along[1][i][index_at(1, p)] * G[3 + j] +
                  along[2][i][index_at(2, p)] * G[6 + j];
    const Lanes pressure = lambda * (H[0][0] + H[1][1] + H[2][2]);
    Lanes s[3][3];
    for (int i = 0; i < 3; ++i) {
      s[i][i] = pressure + (2 * mu) * H[i][i];
      for (int j = 0; j < i; ++j) s[i][j] = s[j][i] = mu * (H[i][j] + H[j][i]);
    }
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i < 3; ++i)
        back[k][i][index_at(k, p)] += s[i][0] * G[3 * k] + s[i][1] * G[3 * k + 1] + s[i][2] * G[3 * k + 2];
  }
  for (auto& node : f)
    for (auto& component : node) component = Lanes{};
  for (int k = 0; k < 3; ++k)
    for (int c = 0; c < 3; ++c) {
      Lanes differences[4];
      interpolate(back[k][c], differences);
      for (int e = 0; e < 4; ++e) {
        f[edges[k][e][1]][c] += differences[e];
        f[edges[k][e][0]][c] -= differences[e];
      }
    }
}

[[gnu::always_inline]] inline void Elements::to_rest(const Batch& batch, Lanes (&u)[8][3]) {
  const Lanes(&Q)[9] = batch.Q;
  for (auto& v : u) {
    const Lanes x = v[0], y = v[1], z = v[2];
    for (int i = 0; i < 3; ++i) v[i] = Q[i] * x + Q[3 + i] * y + Q[6 + i] * z;
  }
}

[[gnu::always_inline]] inline void Elements::to_current(const Batch& batch, Lanes (&u)[8][3]) {
  const Lanes(&Q)[9] = batch.Q;
  for (auto& v : u) {
    const Lanes x = v[0], y = v[1], z = v[2];
    for (int i = 0; i < 3; ++i) v[i] = Q[3 * i] * x + Q[3 * i + 1] * y + Q[3 * i + 2] * z;
  }
}

// Rows of R: e1 along the mean of the four edges of the first axis, e3 = e1 x (mean of the second), e2 = e3 x e1.
void Elements::frame(const Lanes (&x)[8][3], Lanes (&R)[9]) {
  Lanes e1[3], second[3];
  for (int c = 0; c < 3; ++c) {
    e1[c] = second[c] = Lanes{};
    for (int e = 0; e < 4; ++e) {
      e1[c] += x[edges[0][e][1]][c] - x[edges[0][e][0]][c];
      second[c] += x[edges[1][e][1]][c] - x[edges[1][e][0]][c];
    }
  }
  const auto normalise = [](Lanes(&v)[3]) {
    const Lanes squared = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    Lanes length;
    for (int lane = 0; lane < width; ++lane) length[lane] = std::sqrt(squared[lane]);
    for (auto& component : v) component /= length;
  };
  const auto cross = [](const Lanes(&a)[3], const Lanes(&b)[3], Lanes(&c)[3]) {
    for (int i = 0; i < 3; ++i) c[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
  };
  Lanes e2[3], e3[3];
  normalise(e1);
  cross(e1, second, e3);
  normalise(e3);
  cross(e3, e1, e2);
  for (int c = 0; c < 3; ++c) {
    R[c] = e1[c];
    R[3 + c] = e2[c];
    R[6 + c] = e3[c];
  }
}

Elements::Elements(std::span<const double> rest, std::span<const std::array<int, 8>> hexes, const Material& material)
    : lambda_(material.lambda()),
      mu_(material.mu()),
      rest_(rest.begin(), rest.end()),
      batches_((hexes.size() + width - 1) / width) {
  for (std::size_t b = 0; b < batches_.size(); ++b) {
    Batch& batch = batches_[b];
    for (int lane = 0; lane < width; ++lane)
      for (int a = 0; a < 8; ++a) batch.nodes[a][lane] = 3 * hexes[std::min(b * width + lane, hexes.size() - 1)][a];
    Lanes X[8][3], J[3][3][4];
    gather(batch, rest_.data(), X);
    reference_gradients(X, J);  // J[k][c]: twice dX_c / dxi_k
    for (int p = 0; p < 8; ++p)
      for (int lane = 0; lane < width; ++lane) {
        // G = (dxi_k / dX_j) sqrt(det J) / 2. Lanes past the last element have none: they add zeros.
        double D[3][3];
        for (int k = 0; k < 3; ++k)
          for (int c = 0; c < 3; ++c) D[k][c] = J[k][c][index_at(k, p)][lane] / 2;
        const auto cofactor = [&](int k, int c) {
          const int k1 = (k + 1) % 3, k2 = (k + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
          return D[k1][c1] * D[k2][c2] - D[k1][c2] * D[k2][c1];
        };
        const double det = D[0][0] * cofactor(0, 0) + D[0][1] * cofactor(0, 1) + D[0][2] * cofactor(0, 2);
        const bool there = b * width + lane < hexes.size();
        for (int k = 0; k < 3; ++k)
          for (int j = 0; j < 3; ++j) batch.G[p][3 * k + j][lane] = there ? cofactor(k, j) / std::sqrt(det) / 2 : 0;
      }
  }
  turn_to(rest);
}

void Elements::turn_to(std::span<const double> x) {
  for (auto& batch : batches_) {
    Lanes nodes[8][3], R[9], R0[9];
    gather(batch, rest_.data(), nodes);
    frame(nodes, R0);
    gather(batch, x.data(), nodes);
    frame(nodes, R);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)  // Q = R^T R0
        batch.Q[3 * i + j] = R[i] * R0[j] + R[3 + i] * R0[3 + j] + R[6 + i] * R0[6 + j];
  }
}

void Elements::add_product(double scale, std::span<const double> p, std::span<double> y) const {
  const double lambda = scale * lambda_, mu = scale * mu_;
  for (const auto& batch : batches_) {
    Lanes u[8][3], f[8][3];
    fetch((&batch + 1)->Q);
    fetch((&batch + 1)->nodes);
    gather(batch, p.data(), u);
    to_rest(batch, u);
    respond(batch, lambda, mu, u, f);
    to_current(batch, f);
    scatter(batch, f, y.data());
  }
}

void Elements::add_forces(std::span<const double> x, std::span<double> forces) const {
  for (const auto& batch : batches_) {
    Lanes u[8][3], X[8][3], f[8][3];
    fetch((&batch + 1)->Q);
    fetch((&batch + 1)->nodes);
    gather(batch, x.data(), u);
    gather(batch, rest_.data(), X);
    to_rest(batch, u);
    for (int a = 0; a < 8; ++a)
      for (int c = 0; c < 3; ++c) u[a][c] = X[a][c] - u[a][c];
    respond(batch, lambda_, mu_, u, f);
    to_current(batch, f);
    scatter(batch, f, forces.data());
  }
}

// g[a] = Q grad N_a sqrt(det J) at a Gauss point.
void Elements::turned_gradients(const Batch& batch, int point, Lanes (&g)[8][3]) {
  constexpr double near = 0.78867513459481288225, far = 0.21132486540518711775;
  for (auto& node : g)
    for (auto& component : node) component = Lanes{};
  for (int k = 0; k < 3; ++k) {
    const Lanes* G = &batch.G[point][3 * k];
    for (int i = 0; i < 3; ++i) {
      const Lanes turned = batch.Q[3 * i] * G[0] + batch.Q[3 * i + 1] * G[1] + batch.Q[3 * i + 2] * G[2];
      for (int e = 0; e < 4; ++e) {
        const int differ = e ^ index_at(k, point);
        const double weight = ((differ & 1) ? far : near) * ((differ & 2) ? far : near);
        g[edges[k][e][1]][i] += weight * turned;
        g[edges[k][e][0]][i] -= weight * turned;
      }
    }
  }
}

void Elements::add_blocks(double scale, std::span<const int> places, std::span<float> values) const {
  const double lambda = scale * lambda_, mu = scale * mu_;
  for (std::size_t b = 0; b < batches_.size(); ++b) {
    const std::size_t first = b * width, count = std::min<std::size_t>(width, places.size() / pairs - first);
    Lanes g[8][8][3];
    for (int p = 0; p < 8; ++p) turned_gradients(batches_[b], p, g[p]);
    std::size_t pair = 0;
    for (int n = 0; n < 8; ++n)
      for (int m = 0; m <= n; ++m, ++pair) {
        Lanes S[3][3] = {};
        for (int p = 0; p < 8; ++p)
          for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) S[i][j] += g[p][n][i] * g[p][m][j];
        const Lanes trace = mu * (S[0][0] + S[1][1] + S[2][2]);
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) {
            const Lanes value = lambda * S[i][j] + mu * S[j][i] + (i == j ? trace : Lanes{});
            for (std::size_t lane = 0; lane < count; ++lane) {
              const int place = places[pairs * (first + lane) + pair];
              float* block = &values[std::size_t{9} * (place < 0 ? ~place : place)];
              block[place < 0 ? 3 * j + i : 3 * i + j] += static_cast<float>(value[lane]);
            }
          }
      }
  }
}

}  // namespace plica::reference
