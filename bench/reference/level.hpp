// One mesh of the multigrid: the scene's operator A on it, in single precision.
#pragma once

#include "coarsening.hpp"
#include "scene.hpp"
#include "solver/algebra/block_cholesky.hpp"

namespace plica::reference {

class Level {
 public:
  /// The scene's own mesh.
  explicit Level(const Scene& scene);
  /// Every second line of `finer`. Elements are made anew on it, which for trilinear ones is P^T A P where they are
  /// parallelepipeds; masses are lumped, springs are P^T A P.
  Level(const Level& finer, CoarseMesh mesh, const Settings& settings);

  /// Turns elements to positions `x` of this level's nodes and springs to those of the scene; forgets the diagonal.
  void turn_to(std::span<const double> x, const Scene& scene);

  /// y = A p.
  void multiply(std::span<const float> p, std::span<float> y) const;

  /// Blocks of A at the pattern's places.
  [[nodiscard]] BlockPattern pattern() const;
  void assemble(const BlockPattern& pattern, std::vector<float>& values) const;
  /// Diagonal 3 x 3 blocks, nine numbers each.
  [[nodiscard]] std::vector<double> diagonal() const;

  [[nodiscard]] std::size_t nodes() const { return mass_.size(); }
  [[nodiscard]] const std::vector<std::array<int, 8>>& hexes() const { return hexes_; }

  /// Values of this level's nodes among the finer one's, and sums and means between the two.
  [[nodiscard]] std::vector<double> kept(std::span<const double> finer) const;
  void restrict_to(std::span<const float> finer, std::span<float> coarse) const;
  void add_interpolated(std::span<const float> coarse, std::span<float> finer) const;

 private:
  // Springs as 3 x 3 blocks of pairs of nodes, i >= j: sums of the springs' tangents times weights.
  struct Pair {
    int i, j;
    float block[9];
  };
  struct Share {
    std::size_t spring, pair;
    float weight;
  };
  using Weights = std::vector<std::pair<int, double>>;  // node and weight: a spring's stretch is their weighted sum

  void join_springs();

  std::vector<std::array<int, 8>> hexes_;
  CoarseMesh mesh_;
  double factor_;
  std::vector<float> mass_;
  Elements<float> elements_;
  std::vector<Weights> spring_weights_;
  std::vector<Pair> pairs_;
  std::vector<Share> shares_;
  mutable std::vector<float> blocks_;
};

}  // namespace plica::reference
