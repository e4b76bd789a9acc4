#include "mechanics/constraints/ties.hpp"

#include <cmath>
#include <map>

namespace plica {

double Ties::energy(const Step& step) const {
  double sum = 0;
  for (const auto& [nodes, apart, share] : ties_)
    sum += share * (step.positions[nodes[1].index()] - step.positions[nodes[0].index()] - apart).squaredNorm();
  return 0.5 * stiffness_ * sum;
}

void Ties::add_forces(const Step& step, std::span<Vec3> forces) const {
  for (const auto& [nodes, apart, share] : ties_) {
    const Vec3 pull =
        share * stiffness_ * (step.positions[nodes[1].index()] - step.positions[nodes[0].index()] - apart);
    forces[nodes[0].index()] += pull;
    forces[nodes[1].index()] -= pull;
  }
}

void Ties::add_tangent_product(const Step& /*step*/, std::span<const Vec3> direction, std::span<Vec3> product) const {
  for (const auto& [nodes, apart, share] : ties_) {
    const Vec3 change = share * stiffness_ * (direction[nodes[1].index()] - direction[nodes[0].index()]);
    product[nodes[0].index()] -= change;
    product[nodes[1].index()] += change;
  }
}

void Ties::add_tangent(const Step& /*step*/, TangentSink& tangent) const {
  for (const auto& [nodes, apart, share] : ties_) {
    const Mat3 block = share * stiffness_ * Mat3::Identity();
    tangent.add_block(nodes[0], nodes[0], block);
    tangent.add_block(nodes[1], nodes[1], block);
    tangent.add_block(nodes[1], nodes[0], -block);
  }
}

NodeGroups Ties::node_groups(std::span<const double> /*internal*/) const {
  NodeGroups groups;
  for (const Tie& tie : ties_) groups.add(tie.nodes);
  return groups;
}

double Ties::rounding(const Step& /*step*/, double position_rounding) const {
  return 2 * stiffness_ * position_rounding * std::sqrt(static_cast<double>(ties_.size()));
}

std::unique_ptr<Law> Ties::after_division(const Tissue&, const Division&, std::span<const Vec3>) const {
  return std::make_unique<Ties>(std::vector<Tie>{}, stiffness_);
}

std::vector<Ties::Tie> ties_along_x(const Tissue& tissue) {
  // By the place in the plane, to a nanometre.
  std::map<std::array<long, 2>, std::vector<NodeId>> lines;
  for (std::size_t n = 0; n < tissue.node_count(); ++n) {
    const Vec3& x = tissue.rest_positions[n];
    lines[{std::lround(1e3 * x.y()), std::lround(1e3 * x.z())}].emplace_back(n);
  }
  std::vector<Ties::Tie> ties;
  for (const auto& [place, nodes] : lines)
    for (std::size_t i = 1; i < nodes.size(); ++i) {
      const std::array tied = {nodes[0], nodes[i]};
      ties.push_back({tied, tissue.rest_positions[nodes[i].index()] - tissue.rest_positions[nodes[0].index()],
                      tissue.own_share(tied)});
    }
  return ties;
}

}  // namespace plica
