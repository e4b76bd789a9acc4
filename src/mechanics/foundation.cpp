#include "mechanics/foundation.hpp"

#include <cmath>

#include "tissue/hexahedron.hpp"
#include "tissue/tissue_change.hpp"

namespace plica {

Foundation::Foundation(const Tissue& tissue, CellPattern pattern, FoundationRule rule)
    : SignalLaw({tissue, rule.follow}),
      rule_(std::move(rule)),
      pattern_(std::move(pattern)),
      anchors_(tissue.rest_positions),
      facets_(tissue.facets(rule_.side)) {
  measure(tissue);
  support(tissue);
}

// Areas of faces, and normals of nodes, of the faces as anchored.
void Foundation::measure(const Tissue& tissue) {
  areas_.clear();
  normals_.assign(tissue.node_count(), Vec3::Zero());
  for (const Facet& facet : facets_) {
    const std::array<Vec3, 4> corners = gather(anchors_, facet);
    areas_.push_back(facet_area(corners));
    // The images of a periodic sheet move as their originals.
    for (const NodeId node : facet.nodes) normals_[tissue.original(node).index()] += facet_area_vector(corners);
  }
  for (std::size_t n = 0; n < normals_.size(); ++n) {
    // On a mirror plane, the faces beyond it cancel what their sum has across it.
    for (int axis = 0; axis < 3; ++axis)
      if (tissue.is_mirrored[axis] && anchors_[n][axis] == 0) normals_[n][axis] = 0;
    normals_[n].normalize();
  }
}

// Where a cell keeps its faces, nothing changes, also at nodes that hang. Other faces of a cell, or of all its
// daughters, share its area by their present areas.
void Foundation::inherit_faces(const Foundation& before, const TissueChange& change, std::span<const Vec3> positions) {
  const auto former = former_facets(change, before.pattern_.cells.size(), before.facets_, facets_);
  const auto origin = [&](std::size_t f) { return change.origin[facets_[f].cell.index()].index(); };
  std::vector<double> wholes(before.pattern_.cells.size(), 0), present = wholes;
  for (std::size_t f = 0; f < before.facets_.size(); ++f) wholes[before.facets_[f].cell.index()] += before.areas_[f];
  for (std::size_t n = change.kept_nodes(); n < normals_.size(); ++n) normals_[n].normalize();
  areas_.clear();
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    if (!former[f]) {
      present[origin(f)] += areas_.emplace_back(facet_area(gather(positions, facets_[f])));
      continue;
    }
    areas_.push_back(before.areas_[*former[f]]);
    for (int i = 0; i < 4; ++i) {
      const std::size_t from = before.facets_[*former[f]].nodes[i].index(), to = facets_[f].nodes[i].index();
      anchors_[to] = before.anchors_[from];
      normals_[to] = before.normals_[from];
    }
  }
  for (std::size_t f = 0; f < facets_.size(); ++f)
    if (!former[f]) areas_[f] *= wholes[origin(f)] / present[origin(f)];
}

void Foundation::support(const Tissue& tissue) {
  std::vector<double> areas(tissue.node_count(), 0);
  std::vector<std::vector<std::pair<CellId, double>>> parts(followed_.is_used() ? areas.size() : 0);
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    const CellId cell = facets_[f].cell;
    for (const NodeId node : facets_[f].nodes) {
      const std::size_t n = tissue.original(node).index();
      const double part = pattern_.strengths[cell.index()] * areas_[f] / 4;
      areas[n] += part;
      if (followed_.is_used()) parts[n].emplace_back(cell, part);
    }
  }
  supports_.clear();
  for (std::size_t n = 0; n < areas.size(); ++n)
    if (areas[n] != 0)
      supports_.push_back(
          {n, areas[n], normals_[n], parts.empty() ? decltype(parts)::value_type() : std::move(parts[n])});
}

Vec3 Foundation::displacement(const Support& support, const Step& step) const {
  return step.positions[support.node] - anchors_[support.node];
}

Vec3 Foundation::movement(const Support& support, const Step& step) const {
  return step.positions[support.node] - step.before([&](std::span<const Vec3> x) { return x[support.node]; });
}

Vec3 Foundation::resisted(const Support& support, const Vec3& d) const {
  return rule_.resists == FoundationRule::Resists::all ? d : Vec3(support.normal.dot(d) * support.normal);
}

bool Foundation::is_pressed(const Support& support, const Step& step) const {
  return rule_.resists != FoundationRule::Resists::one_sided || support.normal.dot(displacement(support, step)) > 0;
}

double Foundation::active_area(const Support& support, std::span<const double> internal, Activity activity) const {
  if (!followed_.is_used()) return support.area;
  double sum = 0;
  for (const auto& [cell, area] : support.parts) sum += area * (followed_.*activity)(internal, cell);
  return sum;
}

// Energy of springs with given areas.
template <class AreaOf>
double Foundation::stored(const Step& step, double activity, const AreaOf& area_of) const {
  double sum = 0;
  for (const Support& support : supports_)
    if (is_pressed(support, step))
      sum += area_of(support) * resisted(support, displacement(support, step)).squaredNorm();
  return 0.5 * activity * rule_.stiffness * sum;
}

double Foundation::energy(const Step& step) const {
  double sum = stored(step, rule_.program.at(step.end_time_s),
                      [&](const Support& support) { return active_area(support, step.internal); });
  if (rule_.drag > 0)
    for (const Support& support : supports_)
      sum += 0.5 * damper(support, step) * resisted(support, movement(support, step)).squaredNorm();
  return sum;
}

// Springs that become stiffer, by program or signal, supply energy; those that become softer dissipate what they
// release.
EnergyFlow Foundation::energy_flow(const CompletedStep& completed) const {
  const auto& [begin, end, motion] = completed;
  const auto was = [&](const Support& support) {
    return active_area(support, begin.internal, &FollowedSignal::before);
  };
  const auto is = [&](const Support& support) { return active_area(support, begin.internal); };
  const double from = rule_.program.at(begin.end_time_s), to = rule_.program.at(end.end_time_s);
  const double before = stored(begin, from, was), after = stored(end, to, is);
  const double programmed = 0.5 * (stored(begin, to, is) - before + after - stored(end, from, was));
  EnergyFlow flow{
      .active = std::max(0.0, programmed), .stored = after - before, .dissipated = std::max(0.0, -programmed)};
  for (const Support& support : supports_)
    flow.dissipated += damper(support, motion) * resisted(support, movement(support, motion)).squaredNorm();
  return flow;
}

void Foundation::add_forces(const Step& step, std::span<Vec3> forces) const {
  for (const Support& support : supports_) {
    Vec3 force = damper(support, step) * movement(support, step);
    if (is_pressed(support, step)) force += spring(support, step) * displacement(support, step);
    forces[support.node] -= resisted(support, force);
  }
}

void Foundation::add_tangent_product(const Step& step, std::span<const Vec3> direction, std::span<Vec3> product) const {
  for (const Support& support : supports_) {
    const double r = damper(support, step) + (is_pressed(support, step) ? spring(support, step) : 0);
    product[support.node] += r * resisted(support, direction[support.node]);
  }
}

void Foundation::add_tangent(const Step& step, TangentSink& tangent) const {
  for (const Support& support : supports_) {
    const double r = damper(support, step) + (is_pressed(support, step) ? spring(support, step) : 0);
    Mat3 block;
    for (int axis = 0; axis < 3; ++axis) block.col(axis) = r * resisted(support, Vec3::Unit(axis));
    tangent.add_block(NodeId(support.node), NodeId(support.node), block);
  }
}

void Foundation::add_force_gradient(const Step& step, std::span<const Vec3> adjoint,
                                    const BeginningGradient& gradient) const {
  for (const Support& support : supports_)
    gradient.add_before(support.node, damper(support, step) * resisted(support, adjoint[support.node]));
}

double Foundation::rounding(const Step& step, double position_rounding) const {
  double sum = 0;
  for (const Support& support : supports_) {
    const double r = damper(support, step) + spring(support, step);
    sum += r * r;
  }
  return std::sqrt(sum) * position_rounding;
}

std::unique_ptr<Law> Foundation::after_change(const Tissue& tissue, const TissueChange& change,
                                              std::span<const Vec3> positions) const {
  auto after = std::make_unique<Foundation>(*this);
  after->pattern_ = pattern_.after_change(change);
  after->followed_ = followed_.on(tissue);
  after->anchors_ = with_new_nodes(tissue, change, anchors_);
  tissue.place_hanging_positions(after->anchors_);
  after->facets_ = tissue.facets(rule_.side);
  after->is_remeshed_ = is_remeshed_ || !change.remeshed.empty();
  if (after->is_remeshed_) {
    after->normals_ = with_new_nodes(tissue, change, normals_);
    after->inherit_faces(*this, change, positions);
  } else {
    after->measure(tissue);
  }
  after->support(tissue);
  return after;
}

const LawDerivatives& Foundation::derivatives() const {
  if (followed_.is_used()) refuse_gradient("a foundation that follows a signal has no gradient; remove follow");
  return *this;
}

std::vector<double> Foundation::past() const {
  std::vector<double> past;
  const auto append = [&](const Vectors& vectors) {
    for (const Vec3& vector : vectors) past.insert(past.end(), {vector.x(), vector.y(), vector.z()});
  };
  append(anchors_);
  if (!is_remeshed_) return past;
  append(normals_);
  past.insert(past.end(), areas_.begin(), areas_.end());
  return past;
}

std::unique_ptr<Law> Foundation::restored(const Tissue& tissue, const TissueChange& change,
                                          std::span<const Vec3> /*positions*/, std::span<const double> past) const {
  const std::size_t numbers = 3 * tissue.node_count(), faces = tissue.facets(rule_.side).size();
  if (past.size() != numbers && past.size() != 2 * numbers + faces) throw InvalidNumbers();
  const auto vectors_from = [&](std::size_t first) {
    Vectors vectors;
    for (std::size_t i = first; i < first + numbers; i += 3) vectors.emplace_back(past[i], past[i + 1], past[i + 2]);
    return vectors;
  };
  auto law = std::make_unique<Foundation>(*this);
  law->pattern_ = pattern_.after_change(change);
  law->followed_ = followed_.on(tissue);
  law->anchors_ = vectors_from(0);
  law->facets_ = tissue.facets(rule_.side);
  law->is_remeshed_ = past.size() > numbers;
  if (law->is_remeshed_) {
    law->normals_ = vectors_from(numbers);
    law->areas_.assign(past.begin() + static_cast<std::ptrdiff_t>(2 * numbers), past.end());
  } else {
    law->measure(tissue);
  }
  law->support(tissue);
  return law;
}

}  // namespace plica
