#include "mechanics/active/contraction.hpp"

#include <algorithm>

#include "tissue/polygon_cell.hpp"
#include "tissue/tissue_change.hpp"

namespace plica {
namespace {

double chain_length(std::span<const NodeId> nodes, std::span<const Vec3> positions) {
  double length = 0;
  for (std::size_t s = 1; s < nodes.size(); ++s)
    length += (positions[nodes[s].index()] - positions[nodes[s - 1].index()]).norm();
  return length;
}

// Segment of a chain: its direction and length. One shrunk to a point has no direction and pulls nowhere.
struct Segment {
  Vec3 direction;
  double length;
};

// The block of d2l/dx2 that a segment gives: (I - e e^T)/length.
Mat3 turning_stiffness(const Segment& s) {
  if (s.length <= 0) return Mat3::Zero();
  return (Mat3::Identity() - s.direction * s.direction.transpose()) / s.length;
}

// Area at rest of each cell's apical or basal face, or of its walls together, um^2.
std::vector<double> areas_at_rest(const Tissue& tissue, CellSide side) {
  if (side != CellSide::lateral) return rest_face_areas(tissue, side);
  std::vector<double> areas(tissue.cells.size(), 0.0);
  for (std::size_t c = 0; c < areas.size(); ++c)
    for (std::size_t i = 0, sides = tissue.cells[c].sides(); i < sides; ++i) {
      const auto at = [&](std::size_t corner) {
        return tissue.rest_positions[tissue.cells[c].corners[corner].index()];
      };
      const std::size_t next = (i + 1) % sides;
      areas[c] += facet_area({at(i), at(next), at(sides + next), at(sides + i)});
    }
  return areas;
}

// Width that a line of the cell represents: area of the face over the total length of its lines of that side and
// direction. Lines of a polygon run in all directions: under equal tension each contributes to the tension along and
// across, so the width is twice the area over the length of all.
double width_of(const Tissue& tissue, const Cell& cell, std::span<const ContractileLine> lines,
                const ContractileLine& like, double area) {
  double shares = 0, length = 0;
  for (const ContractileLine& line : lines) {
    if (cell.is_of_grid && line.direction != like.direction) continue;
    shares += line.share;
    length += line.share * chain_length(line.nodes, tissue.rest_positions);
  }
  if (!cell.is_of_grid && like.direction != EdgeDirection::lateral) return 2 * area / length;
  return area / (length / shares) / shares;
}

}  // namespace

std::vector<Spring> contraction_springs(const Tissue& tissue, const CellPattern& pattern, const ContractionRule& rule) {
  std::vector<Spring> springs;
  double factor = 1, delay = 0;  // of the cell at hand
  // One spring per segment, in series: a part of the chain is stiffer than the whole in inverse proportion to its
  // length.
  const auto add = [&](std::size_t cell, const std::vector<NodeId>& chain, double ratio, double share, double in_series,
                       double tension) {
    if (ratio <= 0) return;
    const double strength = factor * share * ratio, whole = in_series * chain_length(chain, tissue.rest_positions);
    for (std::size_t s = 1; s < chain.size(); ++s) {
      Spring spring{.nodes = {chain[s - 1], chain[s]}, .delay_s = delay, .cell = CellId(cell)};
      const double length = chain_length(spring.nodes, tissue.rest_positions), shorter = whole / length;
      spring.stiffness = shorter * (strength * rule.stiffness);
      spring.preload = strength * (rule.preload + tension);
      spring.damping = shorter * (share * rule.damping);
      spring.rest_length = rule.rest_length_ratio * length;
      springs.push_back(std::move(spring));
    }
  };
  const std::vector<double> areas = areas_at_rest(tissue, rule.side);
  const auto lines =
      rule.border ? border_lines(tissue, rule.side, pattern.cells, *rule.border) : contractile_lines(tissue, rule.side);
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) {
    if (!pattern.cells[c]) continue;
    const Cell& cell = tissue.cells[c];
    factor = pattern.strengths[c];
    delay = pattern.delays_s[c];
    for (const ContractileLine& line : lines[c]) {
      const double ratio =
          rule.side == CellSide::lateral ? 1 : line.along * rule.along_ratio + (1 - line.along) * rule.across_ratio;
      // Each line carries its share of tension times width.
      const double tension = rule.tension > 0 ? rule.tension * width_of(tissue, cell, lines[c], line, areas[c]) : 0;
      add(c, line.nodes, ratio, line.share, line.in_series, tension);
    }
    if (rule.diagonals && rule.side != CellSide::lateral && cell.sides() == 4) {
      const int first = rule.side == CellSide::apical ? 4 : 0;
      for (const int i : {0, 1})
        add(c, {cell.corners[first + i], cell.corners[first + i + 2]}, 0.5 * (rule.along_ratio + rule.across_ratio), 1,
            1, 0);
    }
  }
  return springs;
}

double Contraction::activity(CellId cell, double delay_s, double time_s, std::span<const double> internal,
                             double following) const {
  const double part = pattern_.remaining(cell, time_s);
  if (const auto instead = given(internal).of(cell)) return part * *instead;
  return part * program_.delayed_at(delay_s, time_s) * pattern_.pulse(cell, time_s) * following;
}

double Contraction::activity(const Spring& spring, const Step& step) const {
  return activity(spring.cell, spring.delay_s, step.end_time_s, step.internal,
                  followed_.at(followed(step.internal), spring.cell));
}

std::optional<double> Contraction::activity_of(CellId cell, double time_s, std::span<const double> internal) const {
  if (pattern_.cells.empty() || !pattern_.cells[cell.index()]) return std::nullopt;
  return activity(cell, pattern_.delays_s[cell.index()], time_s, internal, followed_.at(followed(internal), cell));
}

std::vector<double> Contraction::delays_s() const {
  std::vector<double> delays;
  for (const Spring& spring : springs_) delays.push_back(spring.delay_s);
  return delays;
}

// The tension T(l) of a spring over a step, its derivative dT/dl, and the energy it derives from.
struct Contraction::Pulled {
  std::span<const NodeId> nodes;
  std::span<const Segment> segments;  // between them: where dl/dx and d2l/dx2 come from
  double energy = 0, tension = 0, slope = 0;
  double active_tension = 0;  // without the damper
  // The tension resists rotation of segments. A spring under pressure (a negative preload) is unstable
  // there, and the semidefinite tangent leaves that out.
  double turning_tension = 0;

  void respond(const Spring& spring, const Step& step, double activity) {
    double length = 0;
    for (const Segment& segment : segments) length += segment.length;
    const double stretch = std::max(0.0, length - spring.rest_length);
    energy = activity * (0.5 * spring.stiffness * stretch * stretch + spring.preload * length);
    tension = active_tension = activity * (spring.stiffness * stretch + spring.preload);
    slope = length > spring.rest_length ? activity * spring.stiffness : 0;
    if (spring.damping > 0) {
      const double change = length - step.before([this](std::span<const Vec3> x) { return chain_length(nodes, x); });
      const double rate = spring.damping / step.rate_s;
      energy += 0.5 * rate * change * change;
      tension += rate * change;
      slope += rate;
    }
    turning_tension = step.semidefinite_tangent ? std::max(0.0, tension) : tension;
  }

  // dl/dx of node i.
  [[nodiscard]] Vec3 length_gradient(std::size_t i) const {
    Vec3 gradient = Vec3::Zero();
    if (i > 0) gradient += segments[i - 1].direction;
    if (i < segments.size()) gradient -= segments[i].direction;
    return gradient;
  }
  // dl along a direction of all nodes.
  [[nodiscard]] double lengthening(std::span<const Vec3> direction) const {
    double sum = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) sum += length_gradient(i).dot(direction[nodes[i].index()]);
    return sum;
  }
};

Contraction::Contraction(std::vector<Spring> springs, Program program, CellPattern pattern, FollowedSignal followed)
    : springs_(std::move(springs)),
      program_(std::move(program)),
      pattern_(std::move(pattern)),
      followed_(std::move(followed)) {
  for (const Spring& spring : springs_) {
    groups_.add(spring.nodes);
    longest_ = std::max(longest_, spring.nodes.size());
  }
}

template <class Take>
void Contraction::for_springs(const Step& step, const Take& take) const {
  std::vector<Segment> segments(longest_);
  for (std::size_t k = 0; k < springs_.size(); ++k) {
    Pulled pulled;
    pulled.nodes = groups_[k];
    for (std::size_t s = 0; s + 1 < pulled.nodes.size(); ++s) {
      const Vec3 d = step.positions[pulled.nodes[s + 1].index()] - step.positions[pulled.nodes[s].index()];
      const double length = d.norm();
      segments[s] = {length > 0 ? Vec3(d / length) : Vec3(Vec3::Zero()), length};
    }
    pulled.segments = std::span(segments).first(pulled.nodes.size() - 1);
    pulled.respond(springs_[k], step, activity(springs_[k], step));
    take(pulled);
  }
}

double Contraction::energy(const Step& step) const {
  double sum = 0;
  for_springs(step, [&](const Pulled& p) { sum += p.energy; });
  return sum;
}

EnergyFlow Contraction::energy_flow(const CompletedStep& completed) const {
  const Step& step = completed.motion;
  EnergyFlow flow;
  for (std::size_t k = 0; k < springs_.size(); ++k) {
    const Spring& spring = springs_[k];
    const std::span<const NodeId> nodes = groups_[k];
    const double before = chain_length(nodes, step.previous_positions), after = chain_length(nodes, step.positions);
    const auto potential = [&](double length) {
      const double stretch = std::max(0.0, length - spring.rest_length);
      return 0.5 * spring.stiffness * stretch * stretch + spring.preload * length;
    };
    const double following = followed_.mean(followed(step.internal), spring.cell),
                 acting = activity(spring.cell, spring.delay_s, step.end_time_s, step.internal, following);
    flow.active -= acting * (potential(after) - potential(before));
    flow.dissipated += spring.damping / step.rate_s * (after - before) * (after - before);
  }
  return flow;
}

void Contraction::add_forces(const Step& step, std::span<Vec3> forces) const {
  for_springs(step, [&](const Pulled& p) {
    for (std::size_t i = 0; i < p.nodes.size(); ++i) forces[p.nodes[i].index()] -= p.tension * p.length_gradient(i);
  });
}

void Contraction::add_tangent_product(const Step& step, std::span<const Vec3> direction,
                                      std::span<Vec3> product) const {
  for_springs(step, [&](const Pulled& p) {
    const double lengthening = p.lengthening(direction);
    for (std::size_t i = 0; i < p.nodes.size(); ++i)
      product[p.nodes[i].index()] += p.slope * lengthening * p.length_gradient(i);
    for (std::size_t s = 0; s < p.segments.size(); ++s) {
      const std::size_t a = p.nodes[s].index(), b = p.nodes[s + 1].index();
      const Vec3 change = p.turning_tension * turning_stiffness(p.segments[s]) * (direction[b] - direction[a]);
      product[a] -= change;
      product[b] += change;
    }
  });
}

void Contraction::add_tangent(const Step& step, TangentSink& tangent) const {
  for_springs(step, [&](const Pulled& p) {
    for (std::size_t i = 0; i < p.nodes.size(); ++i)
      for (std::size_t j = 0; j <= i; ++j)
        tangent.add_block(p.nodes[i], p.nodes[j], p.slope * p.length_gradient(i) * p.length_gradient(j).transpose());
    for (std::size_t s = 0; s < p.segments.size(); ++s) {
      const NodeId a = p.nodes[s], b = p.nodes[s + 1];
      const Mat3 block = p.turning_tension * turning_stiffness(p.segments[s]);
      tangent.add_block(a, a, block);
      tangent.add_block(b, b, block);
      tangent.add_block(a, b, -block);
    }
  });
}

namespace {

// Add `factor` times the gradient of the length of a chain.
void add_length_gradient(std::span<const NodeId> nodes, std::span<const Vec3> x, double factor,
                         std::span<Vec3> gradient) {
  for (std::size_t s = 1; s < nodes.size(); ++s) {
    const std::size_t a = nodes[s - 1].index(), b = nodes[s].index();
    const Vec3 pull = factor * (x[b] - x[a]).stableNormalized();
    gradient[a] -= pull;
    gradient[b] += pull;
  }
}

}  // namespace

// Forces are -T dl/dx, so adjoint . forces is -T times the lengthening of the spring along the adjoint.
void Contraction::add_force_gradient(const Step& step, std::span<const Vec3> adjoint,
                                     const BeginningGradient& gradient) const {
  std::size_t k = 0;
  for_springs(step, [&](const Pulled& p) {
    const double damping = springs_[k++].damping;
    if (damping == 0) return;
    const double of_before = damping / step.rate_s * p.lengthening(adjoint);
    add_length_gradient(p.nodes, step.previous_positions, (1 + step.ahead) * of_before, gradient.previous);
    if (step.ahead > 0) add_length_gradient(p.nodes, step.earlier_positions, -step.ahead * of_before, gradient.earlier);
  });
}

void Contraction::add_strength_gradient(const Step& step, std::span<const Vec3> adjoint,
                                        std::span<double> of_cells) const {
  std::size_t k = 0;
  for_springs(step, [&](const Pulled& p) {
    of_cells[springs_[k++].cell.index()] -= p.active_tension * p.lengthening(adjoint);
  });
}

std::unique_ptr<Law> Contraction::with_strengths(std::span<const double> factors) const {
  auto law = std::make_unique<Contraction>(*this);
  for (Spring& spring : law->springs_)
    for (double* strength : {&spring.stiffness, &spring.preload}) *strength *= factors[spring.cell.index()];
  for (std::size_t c = 0; c < law->pattern_.strengths.size(); ++c) law->pattern_.strengths[c] *= factors[c];
  return law;
}

const LawDerivatives& Contraction::derivatives() const {
  if (followed_.is_used()) refuse_gradient("a contraction that follows a signal has no gradient; remove follow");
  return *this;
}

std::vector<double> Contraction::first_internal(const Tissue& /*tissue*/) const {
  return std::vector<double>(followed_.size(), 0);
}

std::vector<double> Contraction::next_internal(const Step& step) const {
  std::vector<double> internal(step.internal.begin(), step.internal.end());
  followed_.move_on(followed(std::span(internal)));
  return internal;
}

std::vector<double> Contraction::internal_after_change(std::span<const double> internal, const Tissue& /*tissue*/,
                                                       const TissueChange& change, const ChangePositions&) const {
  std::vector<double> after = followed_.after_change(followed(internal), change);
  const std::vector<double> activities = given(internal).after_change(change);
  after.insert(after.end(), activities.begin(), activities.end());
  return after;
}

std::vector<double> Contraction::with_signals(std::span<const double> internal, std::span<const CellArray> signals,
                                              double time_s) const {
  std::vector<double> result(internal.begin(), internal.end());
  followed_.follow(signals, time_s, followed(std::span(result)));
  return result;
}

namespace {

bool has_node(const Tissue& tissue, CellId id, NodeId node) {
  const Cell& cell = tissue.cells[id.index()];
  const auto elements = std::span(tissue.elements).subspan(cell.first_element.index(), cell.element_count);
  return std::ranges::any_of(elements,
                             [&](const auto& nodes) { return std::ranges::find(nodes, node) != nodes.end(); });
}

// Chain with the nodes inserted by cuts of its own cell and of neighbours.
std::vector<NodeId> with_midway_nodes(const std::vector<NodeId>& chain, const TissueChange& change) {
  std::vector<NodeId> nodes = {chain.front()};
  for (std::size_t i = 1; i < chain.size(); ++i) {
    const auto midway = change.node_midway.find(std::minmax(chain[i - 1], chain[i]));
    if (midway != change.node_midway.end()) nodes.push_back(midway->second);
    nodes.push_back(chain[i]);
  }
  return nodes;
}

// Springs of the daughters: two in series if the spring of the mother was cut, else the same spring.
std::vector<Spring> inherit(const Spring& spring, CellId low, CellId high, const Tissue& tissue,
                            std::span<const Vec3> positions) {
  const auto& nodes = spring.nodes;
  const auto both = [&](NodeId node) { return has_node(tissue, low, node) && has_node(tissue, high, node); };
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
    const bool is_low = has_node(tissue, low, part.nodes.front()) && has_node(tissue, low, part.nodes.back());
    part.cell = is_low ? low : high;
  }
  return parts;
}

}  // namespace

std::unique_ptr<Law> Contraction::after_change(const Tissue& tissue, const TissueChange& change,
                                               std::span<const Vec3> positions) const {
  std::map<CellId, CellId> now, other_daughter;
  for (std::size_t c = 0; c < change.origin.size(); ++c) now.try_emplace(change.origin[c], CellId(c));
  for (const auto& [low, high] : change.daughters) other_daughter[low] = high;
  std::vector<Spring> springs;
  for (Spring spring : springs_) {
    if (!now.contains(spring.cell)) continue;  // the cell is no part of the tissue any more
    spring.cell = now.at(spring.cell);
    spring.nodes = with_midway_nodes(spring.nodes, change);
    const auto daughter = other_daughter.find(spring.cell);
    if (daughter == other_daughter.end()) {
      springs.push_back(std::move(spring));
      continue;
    }
    for (Spring& part : inherit(spring, daughter->first, daughter->second, tissue, positions))
      springs.push_back(std::move(part));
  }
  return std::make_unique<Contraction>(std::move(springs), program_, pattern_.after_change(change),
                                       followed_.on(tissue));
}

std::unique_ptr<Law> Contraction::restored(const Tissue& tissue, const TissueChange& change, std::span<const Vec3>,
                                           std::span<const double> past) const {
  std::vector<Spring> springs;
  take_numbers({past.begin(), past.end()}, springs);
  const auto is_node = [&](NodeId node) { return node.is_among(tissue.node_count()); };
  for (const Spring& spring : springs)
    if (spring.nodes.size() < 2 || !std::ranges::all_of(spring.nodes, is_node) ||
        !spring.cell.is_among(tissue.cells.size()))
      throw InvalidNumbers();
  return std::make_unique<Contraction>(std::move(springs), program_, pattern_.after_change(change),
                                       followed_.on(tissue));
}

}  // namespace plica
