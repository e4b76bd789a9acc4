#include "mechanics/contraction.hpp"

#include <algorithm>
#include <array>

#include "tissue/division.hpp"

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

std::vector<Spring> contraction_springs(const Tissue& tissue, const CellSet& cells, const ContractionRule& rule,
                                        const CellPattern& pattern) {
  std::vector<Spring> springs;
  double factor = 1, delay = 0;  // of the cell at hand
  const auto add = [&](std::size_t cell, std::vector<NodeId> nodes, double ratio, double share) {
    if (ratio <= 0) return;
    const double strength = factor * share * ratio;
    Spring spring{std::move(nodes), strength * rule.stiffness, strength * rule.preload, share * rule.damping, 0, delay,
                  CellId(cell)};
    spring.rest_length = rule.rest_length_ratio * chain_length(spring.nodes, tissue.rest_positions);
    springs.push_back(std::move(spring));
  };
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) {
    if (!cells[c]) continue;
    const Cell& cell = tissue.cells[c];
    if (!pattern.factors.empty()) factor = pattern.factors[c];
    if (!pattern.delays_s.empty()) delay = pattern.delays_s[c];
    for (const auto& [line, share] : cell.lines) {
      if (line.side != rule.side) continue;
      const double ratio = line.direction == EdgeDirection::along    ? rule.along_ratio
                           : line.direction == EdgeDirection::across ? rule.across_ratio
                                                                     : 1;
      add(c, line.nodes, ratio, share);
    }
    if (rule.diagonals && rule.side != EdgeSide::lateral) {
      const int first = rule.side == EdgeSide::apical ? 4 : 0;
      for (const int i : {0, 1})
        add(c, {cell.corners[first + i], cell.corners[first + i + 2]}, 0.5 * (rule.along_ratio + rule.across_ratio), 1);
    }
  }
  return springs;
}

double Contraction::activity(double delay_s, double time_s) const {
  const double own_time = time_s - delay_s;
  return own_time < -1e-9 ? 0 : program_.at(own_time);  // a step that ends on the delay does so but for rounding
}

double Contraction::activity_of(CellId cell, double time_s) const {
  return activity(cell_delays_s_.empty() ? 0 : cell_delays_s_[cell.index()], time_s);
}

std::vector<double> Contraction::points_s() const {
  std::vector<double> delays = {0};
  for (const Spring& spring : springs_) delays.push_back(spring.delay_s);
  std::ranges::sort(delays);
  const double apart = 0.01 * delays.back();
  std::vector<double> kept = {0};
  for (const double delay : delays)
    if (delay > 0 && (delay >= kept.back() + apart || delay == delays.back())) kept.push_back(delay);
  const std::vector<double> from_start = {0};  // a program without points: from nothing to 1 at its time 0
  std::vector<double> points;
  for (const double point : program_.times_s().empty() ? from_start : program_.times_s())
    for (const double delay : kept) points.push_back(point + delay);
  std::ranges::sort(points);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

double Contraction::energy(const Step& step) const {
  double sum = 0;
  for (const Spring& spring : springs_) sum += respond(spring, step, activity(spring.delay_s, step.end_time_s)).energy;
  return sum;
}

void Contraction::add_forces(const Step& step, std::span<Vec3> forces) const {
  for (const Spring& spring : springs_) {
    const double tension = respond(spring, step, activity(spring.delay_s, step.end_time_s)).tension;
    const Vectors gradient = length_gradient(spring, step.positions);
    for (std::size_t i = 0; i < spring.nodes.size(); ++i) forces[spring.nodes[i].index()] -= tension * gradient[i];
  }
}

void Contraction::add_tangent_product(const Step& step, std::span<const Vec3> direction,
                                      std::span<Vec3> product) const {
  for (const Spring& spring : springs_) {
    const Response r = respond(spring, step, activity(spring.delay_s, step.end_time_s));
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
  for (const Spring& spring : springs_) {
    const Response r = respond(spring, step, activity(spring.delay_s, step.end_time_s));
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

namespace {

bool is_corner(const Tissue& tissue, CellId cell, NodeId node) {
  const auto& corners = tissue.cells[cell.index()].corners;
  return std::ranges::find(corners, node) != corners.end();
}

// The chain with the nodes that cuts have put into it, its own cell's and its neighbours'.
std::vector<NodeId> with_midway_nodes(const std::vector<NodeId>& chain, const Division& division) {
  std::vector<NodeId> nodes = {chain.front()};
  for (std::size_t i = 1; i < chain.size(); ++i) {
    const auto midway = division.node_midway.find(std::minmax(chain[i - 1], chain[i]));
    if (midway != division.node_midway.end()) nodes.push_back(midway->second);
    nodes.push_back(chain[i]);
  }
  return nodes;
}

// The daughters' parts of their mother's spring: two in series where it was cut, else the whole.
std::vector<Spring> inherit(const Spring& spring, CellId low, CellId high, const Tissue& tissue,
                            std::span<const Vec3> positions) {
  const auto& nodes = spring.nodes;
  const auto both = [&](NodeId node) { return is_corner(tissue, low, node) && is_corner(tissue, high, node); };
  const auto cut = std::find_if(nodes.begin() + 1, nodes.end() - 1, both);
  std::vector<Spring> parts = {spring};
  if (cut != nodes.end() - 1) {
    parts.push_back(spring);
    parts[0].nodes.assign(nodes.begin(), cut + 1);
    parts[1].nodes.assign(cut, nodes.end());
  }
  for (Spring& part : parts) {
    const double share = chain_length(part.nodes, positions) / chain_length(nodes, positions);
    part.stiffness /= share;
    part.damping /= share;
    part.rest_length *= share;
    const bool is_low = is_corner(tissue, low, part.nodes.front()) && is_corner(tissue, low, part.nodes.back());
    part.cell = is_low ? low : high;
  }
  return parts;
}

}  // namespace

std::unique_ptr<Law> Contraction::after_division(const Tissue& tissue, const Division& division,
                                                 std::span<const Vec3> positions) const {
  std::map<CellId, CellId> now, other_daughter;
  for (std::size_t c = 0; c < division.origin.size(); ++c) now.try_emplace(division.origin[c], CellId(c));
  for (const auto& [low, high] : division.daughters) other_daughter[low] = high;
  std::vector<Spring> springs;
  for (Spring spring : springs_) {
    if (!now.contains(spring.cell)) continue;  // the cell is no part of the tissue any more
    spring.cell = now.at(spring.cell);
    spring.nodes = with_midway_nodes(spring.nodes, division);
    const auto daughter = other_daughter.find(spring.cell);
    if (daughter == other_daughter.end()) {
      springs.push_back(std::move(spring));
      continue;
    }
    for (Spring& part : inherit(spring, daughter->first, daughter->second, tissue, positions))
      springs.push_back(std::move(part));
  }
  return std::make_unique<Contraction>(
      std::move(springs), program_,
      cell_delays_s_.empty() ? std::vector<double>{} : inherited(division, cell_delays_s_));
}

}  // namespace plica
