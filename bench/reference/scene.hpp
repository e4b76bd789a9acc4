// Forces and the linear system of one step of the reference scene.
#pragma once

#include "elements.hpp"
#include "mesh.hpp"
#include "solver/algebra/sparse_pattern.hpp"

namespace plica::reference {

struct Settings {
  double mass = 0.01, step = 0.1, damping_time = 0.1;  // damping_time: stiffness-proportional damping r
  Material material;
  [[nodiscard]] double stiffness_factor() const { return step * (step + damping_time); }
};

/// A dv = b at positions x: A = M + h (h + r) K, b = h (f - (h + r) K v), K the stiffness (minus the forces'
/// derivative).
class Scene {
 public:
  Scene(const Mesh& mesh, const Settings& settings);

  /// Turns elements and springs to positions `x`.
  void turn_to(std::span<const double> x);
  /// b at `x`, where turn_to() has been, and velocities `v`.
  void right_hand_side(std::span<const double> x, std::span<const double> v, std::span<double> b) const;
  /// y = A p.
  void multiply(std::span<const double> p, std::span<double> y) const;

  /// A as plica's preconditioners take it.
  [[nodiscard]] const BlockPattern& pattern() const { return pattern_; }
  void write_blocks(std::vector<float>& values) const;

  [[nodiscard]] const Settings& settings() const { return settings_; }

 private:
  // A spring's tangent, (k - t) u u^T + t I with t = k (d - l) / d, as A holds it: times h (h + r).
  struct SpringTangent {
    int i, j;  // 3 times the nodes' numbers
    double block[9];
  };
  void add_stiffness(std::span<const double> p, std::span<double> y) const;  // y += h (h + r) K p

  const Mesh& mesh_;
  Settings settings_;
  Elements elements_;
  std::vector<SpringTangent> springs_;
  BlockPattern pattern_;
  std::vector<int> places_;  // of the elements' blocks
};

}  // namespace plica::reference
