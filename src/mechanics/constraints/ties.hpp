// Penalty coupling: stiff springs that keep the reference offset between two nodes (docs/theory/ties.md), so that both
// planes of a slice move alike, as in an endless tissue.
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
    Vec3 apart;        // reference offset, second minus first; um
    double share = 1;  // fraction of this tissue: 1/2 on a mirror plane
  };

  /// Make the law with `stiffness` k, nN/um: E = k/2 |x_b - x_a - apart|^2 per tie, times its share.
  Ties(std::vector<Tie> ties, double stiffness) : ties_(std::move(ties)), stiffness_(stiffness) {}

  [[nodiscard]] std::string_view name() const override { return "ties"; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<Ties>(*this); }
  [[nodiscard]] double energy(const Step& step) const override;
  void add_forces(const Step& step, std::span<Vec3> forces) const override;
  void add_tangent_product(const Step& step, std::span<const Vec3> direction, std::span<Vec3> product) const override;
  void add_tangent(const Step& step, TangentSink& tangent) const override;
  [[nodiscard]] NodeGroups node_groups(std::span<const double> internal) const override;
  [[nodiscard]] double rounding(const Step& step, double position_rounding) const override;
  /// Return a law without ties for a part of the tissue. (Cells of a slice do not divide.)
  [[nodiscard]] std::unique_ptr<Law> after_division(const Tissue& tissue, const Division& division,
                                                    std::span<const Vec3> positions) const override;

 private:
  std::vector<Tie> ties_;
  double stiffness_;
};

/// Make ties between every node of a slice and the node at the same place of its first plane, along x.
std::vector<Ties::Tie> ties_along_x(const Tissue& tissue);

}  // namespace plica
