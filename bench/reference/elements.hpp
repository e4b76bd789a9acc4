// The scene's elements in SIMD batches: trilinear hexahedra with 2 x 2 x 2 Gauss points, linear in a frame that turns
// with each ("large": two mean edges).
//
// K_e is not kept. With G = J^-1 sqrt(det J) / 2 at each point, nine numbers, a product is: differences of u along
// edges, interpolated to the points (H), s = lambda tr(H G) I + mu (H G + (H G)^T), and the way back of s G^T. That is
// as much arithmetic as a dense 24 x 24 product and an eighth of the memory. As K is isotropic, R^T K R (with K in the
// element's rest frame R0) is Q K Q^T with K in the rest state's axes and Q = R^T R0.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace plica::reference {

struct Material {
  double young_modulus = 1000, poisson_ratio = 0.45;
  [[nodiscard]] double lambda() const {
    return young_modulus * poisson_ratio / ((1 + poisson_ratio) * (1 - 2 * poisson_ratio));
  }
  [[nodiscard]] double mu() const { return young_modulus / (2 * (1 + poisson_ratio)); }
};

/// Vectors are x y z of each node.
class Elements {
 public:
  static constexpr int width = 8;           // elements a batch
  static constexpr std::size_t pairs = 36;  // of an element's nodes: (0,0), (1,0), (1,1), (2,0), ...

  Elements(std::span<const double> rest, std::span<const std::array<int, 8>> hexes, const Material& material);

  /// Turns each element's frame to positions `x`.
  void turn_to(std::span<const double> x);

  /// y += scale * sum_e Q K Q^T p.
  void add_product(double scale, std::span<const double> p, std::span<double> y) const;

  /// f += sum_e Q K (X - Q^T x): elastic forces.
  void add_forces(std::span<const double> x, std::span<double> f) const;

  /// values += scale * sum_e Q K Q^T: nine numbers by rows a block, that of each pair of each element at its place, or
  /// transposed at ~ of it.
  void add_blocks(double scale, std::span<const int> places, std::span<float> values) const;

 private:
  typedef double Lanes __attribute__((vector_size(64)));
  struct Batch {
    Lanes G[8][9];
    Lanes Q[9];
    int nodes[8][width];  // 3 times their number
  };

  static void gather(const Batch& batch, const double* p, Lanes (&u)[8][3]);
  static void scatter(const Batch& batch, const Lanes (&f)[8][3], double* y);
  static void interpolate(const Lanes (&v)[4], Lanes (&at_points)[4]);
  static void reference_gradients(const Lanes (&u)[8][3], Lanes (&along)[3][3][4]);
  static void respond(const Batch& batch, double lambda, double mu, const Lanes (&u)[8][3], Lanes (&f)[8][3]);
  static void to_rest(const Batch& batch, Lanes (&u)[8][3]);
  static void to_current(const Batch& batch, Lanes (&u)[8][3]);
  static void frame(const Lanes (&x)[8][3], Lanes (&R)[9]);
  static void turned_gradients(const Batch& batch, int point, Lanes (&g)[8][3]);

  double lambda_, mu_;
  std::vector<double> rest_;
  std::vector<Batch> batches_;
};

}  // namespace plica::reference
