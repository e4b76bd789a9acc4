// Penalty coupling: stiff springs that keep the reference offset between two nodes (docs/theory/ties.md), so that both
// planes of a slice move alike, as in an endless tissue.
#pragma once

#include <array>
#include <cmath>
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
  [[nodiscard]] double energy(const Step& step) const override {
    double sum = 0;
    for (const auto& [nodes, apart, share] : ties_)
      sum += share * (step.positions[nodes[1].index()] - step.positions[nodes[0].index()] - apart).squaredNorm();
    return 0.5 * stiffness_ * sum;
  }
  void add_forces(const Step& step, std::span<Vec3> forces) const override {
    for (const auto& [nodes, apart, share] : ties_) {
      const Vec3 pull =
          share * stiffness_ * (step.positions[nodes[1].index()] - step.positions[nodes[0].index()] - apart);
      forces[nodes[0].index()] += pull;
      forces[nodes[1].index()] -= pull;
    }
  }
  void add_tangent_product(const Step& /*step*/, std::span<const Vec3> direction,
                           std::span<Vec3> product) const override {
    for (const auto& [nodes, apart, share] : ties_) {
      const Vec3 change = share * stiffness_ * (direction[nodes[1].index()] - direction[nodes[0].index()]);
      product[nodes[0].index()] -= change;
      product[nodes[1].index()] += change;
    }
  }
  void add_tangent(const Step& /*step*/, TangentSink& tangent) const override {
    for (const auto& [nodes, apart, share] : ties_) {
      const Mat3 block = share * stiffness_ * Mat3::Identity();
      tangent.add_block(nodes[0], nodes[0], block);
      tangent.add_block(nodes[1], nodes[1], block);
      tangent.add_block(nodes[1], nodes[0], -block);
    }
  }
  [[nodiscard]] const LawDerivatives& derivatives() const override { return static_derivatives(); }
  [[nodiscard]] NodeGroups node_groups(std::span<const double> /*internal*/) const override {
    NodeGroups groups;
    for (const Tie& tie : ties_) groups.add(tie.nodes);
    return groups;
  }
  [[nodiscard]] double rounding(const Step& /*step*/, double position_rounding) const override {
    return 2 * stiffness_ * position_rounding * std::sqrt(static_cast<double>(ties_.size()));
  }
  /// Return a law without ties for a part of the tissue. (Cells of a slice do not divide.)
  [[nodiscard]] std::unique_ptr<Law> after_change(const Tissue&, const TissueChange&,
                                                  std::span<const Vec3>) const override {
    return std::make_unique<Ties>(std::vector<Tie>{}, stiffness_);
  }

 private:
  std::vector<Tie> ties_;
  double stiffness_;
};

/// Make ties between every node of a slice and the node at the same place of its first plane, along x.
std::vector<Ties::Tie> ties_along_x(const Tissue& tissue);

}  // namespace plica
