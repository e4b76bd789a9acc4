// Pairs of nodes that move alike: stiff springs that keep the way from one to the other as it is at rest
// (docs/theory/ties.md). A slice's two planes, so that it is as if it were endless.
#pragma once

#include <array>
#include <vector>

#include "mechanics/law.hpp"
#include "tissue/tissue.hpp"

namespace plica {

class Ties final : public Law {
 public:
  struct Tie {
    std::array<NodeId, 2> nodes;
    Vec3 apart;        // the second less the first, at rest; um
    double share = 1;  // how much of it is this tissue's: a half on a mirror plane
  };

  /// `stiffness` k in nN/um: E = k/2 |x_b - x_a - apart|^2 a tie, times its share.
  Ties(std::vector<Tie> ties, double stiffness) : ties_(std::move(ties)), stiffness_(stiffness) {}

  [[nodiscard]] std::string_view name() const override { return "ties"; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<Ties>(*this); }
  [[nodiscard]] double energy(const Step& step) const override;
  void add_forces(const Step& step, std::span<Vec3> forces) const override;
  void add_tangent_product(const Step& step, std::span<const Vec3> direction, std::span<Vec3> product) const override;
  void add_tangent(const Step& step, TangentSink& tangent) const override;
  [[nodiscard]] NodeGroups node_groups(std::span<const double> internal) const override;
  [[nodiscard]] double rounding(const Step& step, double position_rounding) const override;
  /// Of a part of the tissue: none, since ties are no cell's own. (A slice's cells do not divide.)
  [[nodiscard]] std::unique_ptr<Law> after_division(const Tissue& tissue, const Division& division,
                                                    std::span<const Vec3> positions) const override;

 private:
  std::vector<Tie> ties_;
  double stiffness_;
};

/// Every node of a slice with the one at the same place of its first plane, along x.
std::vector<Ties::Tie> ties_along_x(const Tissue& tissue);

}  // namespace plica
