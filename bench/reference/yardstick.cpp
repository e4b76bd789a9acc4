#include "yardstick.hpp"

#include <algorithm>
#include <chrono>

namespace plica::reference {
namespace {

using Matrix24 = std::array<double, 24 * 24>;

// u = R^T x of the element's nodes, f = K u, y += R f. Plain loops: this is the measure, not the thing measured.
void product(const Mesh& mesh, const std::vector<Matrix24>& K, const double (&R)[9], std::vector<double>& y) {
  const double* x = mesh.nodes.data();
  std::fill(y.begin(), y.end(), 0.0);
  for (std::size_t e = 0; e < K.size(); ++e) {
    const auto& nodes = mesh.hexes[e];
    double u[24], f[24];
    for (int a = 0; a < 8; ++a)
      for (int i = 0; i < 3; ++i) {
        u[3 * a + i] = 0;
        for (int j = 0; j < 3; ++j) u[3 * a + i] += R[3 * j + i] * x[3 * nodes[a] + j];
      }
    for (int i = 0; i < 24; ++i) {
      f[i] = 0;
      for (int j = 0; j < 24; ++j) f[i] += K[e][24 * i + j] * u[j];
    }
    for (int a = 0; a < 8; ++a)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) y[3 * nodes[a] + i] += R[3 * i + j] * f[3 * a + j];
  }
}

}  // namespace

Yardstick::Yardstick(const Mesh& mesh) : mesh_(mesh), matrices_(mesh.hexes.size()), result_(mesh.nodes.size()) {
  for (std::size_t e = 0; e < matrices_.size(); ++e)
    for (std::size_t i = 0; i < 24; ++i)
      for (std::size_t j = 0; j < 24; ++j)
        matrices_[e][24 * i + j] = (i == j ? 1.0 : 0.0) + 1.0 / static_cast<double>(1 + e % 7 + i + j);
}

void Yardstick::product() {
  const double R[9] = {0.36, 0.48, -0.8, -0.8, 0.6, 0.0, 0.48, 0.64, 0.6};
  reference::product(mesh_, matrices_, R, result_);
  asm volatile("" : : "r"(result_.data()) : "memory");  // the product is wanted
}

double yardstick_us(const Mesh& mesh, int rounds) {
  Yardstick yardstick(mesh);
  std::vector<double> times;
  const std::size_t repeats = std::max<std::size_t>(3, 2'000'000 / mesh.hexes.size());
  for (int round = 0; round < rounds; ++round) {
    const auto start = std::chrono::steady_clock::now();
    for (std::size_t k = 0; k < repeats; ++k) yardstick.product();
    times.push_back(std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count() /
                    static_cast<double>(repeats));
  }
  std::sort(times.begin(), times.end());
  return times[times.size() / 2];
}

}  // namespace plica::reference
