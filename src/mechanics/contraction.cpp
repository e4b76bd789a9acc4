#include "mechanics/contraction.hpp"

#include <algorithm>
#include <array>

namespace plica {
namespace {

double chain_length(const std::vector<NodeId>& nodes, std::span<const Vec3> positions) {
  double length = 0;
  for (std::size_t s = 1; s < nodes.size(); ++s)
    length += (positions[nodes[s].index()] - positions[nodes[s - 1].index()]).norm();
  return length;
}

// The tension T(l) of a spring over a step, its derivative dT/dl, and the energy it derives from.
struct Response {
  double energy, tension, slope;
};

Response respond(const Spring& spring, const Step& step, double activity) {
  const double length = chain_length(spring.nodes, step.positions);
  const double stretch = std::max(0.0, length - spring.rest_length);
  Response r{};
  r.energy = activity * (0.5 * spring.stiffness * stretch * stretch + spring.preload * length);
  r.tension = activity * (spring.stiffness * stretch + spring.preload);
  r.slope = length > spring.rest_length ? activity * spring.stiffness : 0;
  if (spring.damping > 0) {
    const double change = length - chain_length(spring.nodes, step.previous_positions);
    const double rate = spring.damping / step.duration_s;
    r.energy += 0.5 * rate * change * change;
    r.tension += rate * change;
    r.slope += rate;
  }
  return r;
}

// What resists the turning of a spring: its tension. A spring under pressure (a negative preload) is unstable there.
double turning_tension(const Response& response, const Step& step) {
  return step.semidefinite_tangent ? std::max(0.0, response.tension) : response.tension;
}

// Segment s of a chain: its direction and length. A segment shrunk to a point has no direction and pulls nowhere.
struct Segment {
  Vec3 direction;
  double length;
};

Segment segment(const Spring& spring, std::size_t s, std::span<const Vec3> positions) {
  const Vec3 d = positions[spring.nodes[s + 1].index()] - positions[spring.nodes[s].index()];
  const double length = d.norm();
  return {length > 0 ? Vec3(d / length) : Vec3(Vec3::Zero()), length};
}

// dl/dx of the chain's nodes.
Vectors length_gradient(const Spring& spring, std::span<const Vec3> positions) {
  Vectors gradient(spring.nodes.size(), Vec3::Zero());
  for (std::size_t s = 0; s + 1 < spring.nodes.size(); ++s) {
    const Vec3 direction = segment(spring, s, positions).direction;
    gradient[s] -= direction;
    gradient[s + 1] += direction;
  }
  return gradient;
}

// The block of d2l/dx2 that a segment gives: (I - e e^T)/length.
Mat3 turning_stiffness(const Segment& s) {
  if (s.length <= 0) return Mat3::Zero();
  return (Mat3::Identity() - s.direction * s.direction.transpose()) / s.length;
}

}  // namespace

std::vector<Spring> contraction_springs(const Tissue& tissue, const CellSet& cells, const ContractionRule& rule) {
  std::vector<Spring> springs;
  const auto add = [&](std::vector<NodeId> nodes, double ratio, double share) {
    if (ratio <= 0) return;
    Spring spring{std::move(nodes), share * ratio * rule.stiffness, share * ratio * rule.preload, share * rule.damping,
                  0};
    spring.rest_length = rule.rest_length_ratio * chain_length(spring.nodes, tissue.rest_positions);
    springs.push_back(std::move(spring));
  };
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) {
    if (!cells[c]) continue;
    const Cell& cell = tissue.cells[c];
    for (const auto& [line, share] : cell.lines) {
      if (line.side != rule.side) continue;
      const double ratio = line.direction == EdgeDirection::along    ? rule.along_ratio
                           : line.direction == EdgeDirection::across ? rule.across_ratio
                                                                     : 1;
      add(line.nodes, ratio, share);
    }
    if (rule.diagonals && rule.side != EdgeSide::lateral) {
      const int first = rule.side == EdgeSide::apical ? 4 : 0;
      for (const int i : {0, 1})
        add({cell.corners[first + i], cell.corners[first + i + 2]}, 0.5 * (rule.along_ratio + rule.across_ratio), 1);
    }
  }
  return springs;
}

double Contraction::energy(const Step& step) const {
  const double activity = program_.at(step.end_time_s);
  double sum = 0;
  for (const Spring& spring : springs_) sum += respond(spring, step, activity).energy;
  return sum;
}

void Contraction::add_forces(const Step& step, std::span<Vec3> forces) const {
  const double activity = program_.at(step.end_time_s);
  for (const Spring& spring : springs_) {
    const double tension = respond(spring, step, activity).tension;
    const Vectors gradient = length_gradient(spring, step.positions);
    for (std::size_t i = 0; i < spring.nodes.size(); ++i) forces[spring.nodes[i].index()] -= tension * gradient[i];
  }
}

void Contraction::add_tangent_product(const Step& step, std::span<const Vec3> direction,
                                      std::span<Vec3> product) const {
  const double activity = program_.at(step.end_time_s);
  for (const Spring& spring : springs_) {
    const Response r = respond(spring, step, activity);
    const Vectors gradient = length_gradient(spring, step.positions);
    double lengthening = 0;
    for (std::size_t i = 0; i < spring.nodes.size(); ++i)
      lengthening += gradient[i].dot(direction[spring.nodes[i].index()]);
    for (std::size_t i = 0; i < spring.nodes.size(); ++i)
      product[spring.nodes[i].index()] += r.slope * lengthening * gradient[i];
    for (std::size_t s = 0; s + 1 < spring.nodes.size(); ++s) {
      const NodeId a = spring.nodes[s], b = spring.nodes[s + 1];
      const Vec3 change = turning_tension(r, step) * turning_stiffness(segment(spring, s, step.positions)) *
                          (direction[b.index()] - direction[a.index()]);
      product[a.index()] -= change;
      product[b.index()] += change;
    }
  }
}

void Contraction::add_tangent(const Step& step, TangentSink& tangent) const {
  const double activity = program_.at(step.end_time_s);
  for (const Spring& spring : springs_) {
    const Response r = respond(spring, step, activity);
    const Vectors gradient = length_gradient(spring, step.positions);
    for (std::size_t i = 0; i < spring.nodes.size(); ++i)
      for (std::size_t j = 0; j < spring.nodes.size(); ++j)
        tangent.add_block(spring.nodes[i], spring.nodes[j], r.slope * gradient[i] * gradient[j].transpose());
    for (std::size_t s = 0; s + 1 < spring.nodes.size(); ++s) {
      const NodeId a = spring.nodes[s], b = spring.nodes[s + 1];
      const Mat3 block = turning_tension(r, step) * turning_stiffness(segment(spring, s, step.positions));
      tangent.add_block(a, a, block);
      tangent.add_block(b, b, block);
      tangent.add_block(a, b, -block);
      tangent.add_block(b, a, -block);
    }
  }
}

NodeGroups Contraction::node_groups() const {
  NodeGroups groups;
  for (const Spring& spring : springs_) groups.push_back(spring.nodes);
  return groups;
}

}  // namespace plica
