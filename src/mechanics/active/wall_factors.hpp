// Factors on the tension of lateral faces: by their direction (planar polarity), and noise in time.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "tissue/faces.hpp"

namespace plica {

/// Axis in the surface, to which the normal of a lateral face makes an angle a: the factor is
/// weakest + (strongest - weakest) cos^2 a.
struct WallDirection {
  bool across = false;  // of the axis y, else x
  double strongest = 1, weakest = 1;
};

/// Log-normal factors of mean 1 that fluctuate independently for each pair of cells: their logarithm is an
/// Ornstein-Uhlenbeck process.
struct WallNoise {
  double spread = 0;         // relative standard deviation; 0: none
  double correlation_s = 0;  // time after which the correlation of logarithms is 1/e
  std::uint64_t seed = 1;
};

struct WallFactorRule {
  std::optional<WallDirection> direction = {};
  WallNoise noise = {};

  [[nodiscard]] bool is_used() const { return direction || noise.spread > 0; }
};

/// Return the direction factor of a lateral face, from the base on, at these positions; where the surface is normal to
/// the axis, that of 45 degrees.
double direction_factor(const WallDirection& direction, const std::array<Vec3, 4>& face);

/// Return its derivatives by the four corners, 1/um.
std::array<Vec3, 4> direction_gradient(const WallDirection& direction, const std::array<Vec3, 4>& face);

/// Return the noise factor of a pair of cells, by any number that both share. A function of rule, pair and time only,
/// so that it needs no memory: it is linear between times a 32nd of the correlation time apart.
double noise_factor(const WallNoise& noise, std::uint64_t pair, double time_s);

/// The same factors of many pairs, at times that mostly follow each other: it keeps what they share.
class NoiseOfPairs {
 public:
  explicit NoiseOfPairs(WallNoise noise) : noise_(noise) {}

  /// Choose the time, and the pairs of which factors are asked then.
  void go_to(double time_s, std::span<const std::uint64_t> pairs);
  [[nodiscard]] double factor(std::uint64_t pair) const;

 private:
  WallNoise noise_;
  double time_s_ = 0;
  std::int64_t knot_ = -1;                                           // before this time
  std::unordered_map<std::uint64_t, std::array<double, 2>> values_;  // pairs: of the process at this knot and the next
};

/// Numbers of the pairs of cells of faces, which these keep as long as they live.
std::vector<std::uint64_t> pair_numbers(const Tissue& tissue, std::span<const Face> faces);

}  // namespace plica
