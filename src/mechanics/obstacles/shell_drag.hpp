// Viscous drag of the shell on the apical surface in contact, from shear of a film (docs/theory/vitelline.md). Force on
// a node: -c (1 - g/film) T v, with gap g and tangent plane T of the shell at the beginning of the step; none if g
// exceeds the film.
#pragma once

#include <vector>

#include "mechanics/law.hpp"
#include "mechanics/obstacles/vitelline.hpp"

namespace plica {

class ShellDrag final : public Law {
 public:
  static constexpr double film_um = 0.1;

  /// Make the law with `drag` in nN s/um^3 (1 Pa s/um is 1e-3), per reference area.
  ShellDrag(const Tissue& tissue, const OuterShape& shell, double drag);

  [[nodiscard]] std::string_view name() const override { return "shell-drag"; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<ShellDrag>(*this); }
  [[nodiscard]] double energy(const Step& step) const override;
  [[nodiscard]] EnergyFlow energy_flow(const MadeStep& made) const override;
  void add_forces(const Step& step, std::span<Vec3> forces) const override;
  void add_tangent_product(const Step& step, std::span<const Vec3> direction, std::span<Vec3> product) const override;
  void add_tangent(const Step& step, TangentSink& tangent) const override;
  [[nodiscard]] std::unique_ptr<Law> after_division(const Tissue& tissue, const Division& division,
                                                    std::span<const Vec3> positions) const override;
  [[nodiscard]] std::unique_ptr<Law> grown(const Tissue& tissue, std::span<const ElementId> elements) const override;

 private:
  template <class Take>
  void for_touching(const Step& step, const Take& take) const;

  Vitelline shell_;
  double drag_;
  std::vector<double> coefficients_;  // nodes; nN s/um
};

}  // namespace plica
