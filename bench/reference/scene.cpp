#include "scene.hpp"

#include <algorithm>
#include <cmath>

namespace plica::reference {

Scene::Scene(const Mesh& mesh, const Settings& settings)
    : mesh_(mesh), settings_(settings), elements_(mesh.nodes, mesh.hexes, settings.material) {
  turn_to(mesh.nodes);
}

void Scene::turn_to(std::span<const double> x) {
  elements_.turn_to(x);
  springs_.clear();
  const double factor = settings_.stiffness_factor();
  for (const auto& spring : mesh_.springs) {
    const double* a = &x[3 * static_cast<std::size_t>(spring.i)];
    const double* b = &x[3 * static_cast<std::size_t>(spring.j)];
    const double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    const double squared = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    const double across = spring.stiffness * (1 - spring.rest_length / std::sqrt(squared));
    SpringTangent& tangent = springs_.emplace_back(SpringTangent{3 * spring.i, 3 * spring.j, {}});
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        tangent.block[3 * i + j] =
            factor * ((spring.stiffness - across) * d[i] * d[j] / squared + (i == j ? across : 0));
  }
}

void Scene::right_hand_side(std::span<const double> x, std::span<const double> v, std::span<double> b) const {
  const double h = settings_.step;
  std::fill(b.begin(), b.end(), 0.0);
  elements_.add_forces(x, b);
  for (const auto& spring : mesh_.springs) {
    const std::size_t i = 3 * static_cast<std::size_t>(spring.i), j = 3 * static_cast<std::size_t>(spring.j);
    const double d[3] = {x[i] - x[j], x[i + 1] - x[j + 1], x[i + 2] - x[j + 2]};
    const double length = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    const double tension = spring.stiffness * (length - spring.rest_length) / length;
    for (std::size_t c = 0; c < 3; ++c) {
      b[i + c] -= tension * d[c];
      b[j + c] += tension * d[c];
    }
  }
  std::vector<double> damping(b.size());
  add_stiffness(v, damping);
  for (std::size_t n = 0; n < b.size(); ++n) b[n] = h * b[n] - damping[n];  // h (h + r) K v
}

void Scene::add_stiffness(std::span<const double> p, std::span<double> y) const {
  elements_.add_product(settings_.stiffness_factor(), p, y);
  for (const auto& [i, j, block] : springs_) {
    const double d[3] = {p[i] - p[j], p[i + 1] - p[j + 1], p[i + 2] - p[j + 2]};
    for (int c = 0; c < 3; ++c) {
      const double g = block[3 * c] * d[0] + block[3 * c + 1] * d[1] + block[3 * c + 2] * d[2];
      y[i + c] += g;
      y[j + c] -= g;
    }
  }
}

void Scene::multiply(std::span<const double> p, std::span<double> y) const {
  for (std::size_t n = 0; n < p.size(); ++n) y[n] = settings_.mass * p[n];
  add_stiffness(p, y);
}

}  // namespace plica::reference
