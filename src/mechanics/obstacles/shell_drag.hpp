// Viscous drag of the shell on the apical surface in contact, from shear of a film (docs/theory/vitelline.md). Force on
// a node: -c (1 - g/film) T v, with gap g and tangent plane T of the shell at the beginning of the step; none if g
// exceeds the film.
#pragma once

#include <algorithm>

#include "mechanics/obstacles/vitelline.hpp"
#include "mechanics/surroundings.hpp"

namespace plica {

class ShellDrag final : public NodeLaw<ShellDrag>, public LawDerivatives {
 public:
  static constexpr double film_um = 0.1;

  /// Make the law with `drag` in nN s/um^3 (1 Pa s/um is 1e-3), per reference area.
  ShellDrag(const Tissue& tissue, const OuterShape& shell, double drag);

  [[nodiscard]] std::string_view name() const override { return "shell-drag"; }
  [[nodiscard]] const LawDerivatives& derivatives() const override { return *this; }
  void add_force_gradient(const Step& step, std::span<const Vec3> adjoint,
                          const BeginningGradient& gradient) const override;

 private:
  friend NodeLaw;
  static constexpr bool dissipates = true;
  [[nodiscard]] ShellDrag remade(const Tissue& tissue) const { return {tissue, *shell_.shell(), drag_}; }
  template <class Take>
  void resist(const Step& step, std::size_t node, const Take& take) const {
    if (coefficients_[node] == 0) return;
    const Obstacle::Gap gap = shell_.gap(step.previous_positions[node]);
    if (gap.value >= film_um) return;
    const double part = std::min(1.0, 1 - gap.value / film_um);
    const Mat3 along = Mat3::Identity() - gap.inward * gap.inward.transpose();
    take(node, Mat3(part * coefficients_[node] / step.rate_s * along));
  }

  Vitelline shell_;
  double drag_;
};

}  // namespace plica
