// Border of dense rows around a system solved without them: functions of thousands of nodes (enclosed volume), whose
// outer products would fill any matrix. Each costs one solve per direction.
//   [ K  -B^T ] [ x ]   [ f ]
//   [ -B   0  ] [ m ] = [ g ]     x = K^-1 f + Y m,  S m = -(g + B K^-1 f),  Y = K^-1 B^T,  S = B Y.
#pragma once

#include <Eigen/LU>
#include <functional>
#include <span>
#include <vector>

namespace plica {

class DenseBorder {
 public:
  /// Compute the border. `solve` applies the inverse of K, or an approximation, in place. `rows`: those of B, with the
  /// length of its argument.
  void begin(std::vector<std::vector<double>> rows, const std::function<void(std::span<double>)>& solve);

  [[nodiscard]] bool empty() const { return rows_.empty(); }

  /// Convert K^-1 f and g to x and m, in place.
  void apply(std::span<double> x, std::span<double> m) const;

 private:
  std::vector<std::vector<double>> rows_, columns_;  // B, Y
  std::vector<Eigen::Index> active_;                 // rows with a multiplier
  Eigen::PartialPivLU<Eigen::MatrixXd> complement_;  // S of active rows
};

}  // namespace plica
