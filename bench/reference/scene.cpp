#include "scene.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace plica::reference {

Scene::Scene(const Mesh& mesh, const Settings& settings)
    : mesh_(mesh), settings_(settings), elements_(mesh.nodes, mesh.hexes, settings.material) {
  turn_to(mesh.nodes);
  std::vector<int> groups;  // a spring's nodes are those of one hexahedron
  for (const auto& hex : mesh.hexes) groups.insert(groups.end(), hex.begin(), hex.end());
  pattern_ = pattern_of_groups(static_cast<int>(mesh.nodes.size() / 3), groups, 8);
  for (const auto& hex : mesh.hexes)
    for (int a = 0; a < 8; ++a)
      for (int b = 0; b <= a; ++b)
        places_.push_back(hex[a] < hex[b] ? ~pattern_.find(hex[b], hex[a]) : pattern_.find(hex[a], hex[b]));
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

void Scene::write_blocks(std::vector<float>& values) const {
  values.assign(9 * pattern_.columns.size(), 0);
  elements_.add_blocks(settings_.stiffness_factor(), places_, values);
  for (const auto& [i, j, block] : springs_)
    for (const auto& [row, column, sign] : {std::tuple{i, i, 1}, {j, j, 1}, {i, j, -1}}) {
      const int place = pattern_.find(std::max(row, column) / 3, std::min(row, column) / 3);
      for (int k = 0; k < 9; ++k)
        values[std::size_t{9} * place + k] += static_cast<float>(sign * block[k]);  // symmetric
    }
  for (int n = 0; n < pattern_.nodes(); ++n)
    for (int c = 0; c < 3; ++c)
      values[std::size_t{9} * pattern_.find(n, n) + 4 * c] += static_cast<float>(settings_.mass);
}

}  // namespace plica::reference
