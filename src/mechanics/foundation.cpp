#include "mechanics/foundation.hpp"

#include <cmath>

#include "tissue/hexahedron.hpp"
#include "tissue/tissue_change.hpp"

namespace plica {

Foundation::Foundation(const Tissue& tissue, CellPattern pattern, FoundationRule rule)
    : Foundation(tissue, std::move(pattern), std::move(rule), tissue.rest_positions) {}

Foundation::Foundation(const Tissue& tissue, CellPattern pattern, FoundationRule rule, Vectors anchors)
    : rule_(std::move(rule)), pattern_(std::move(pattern)), anchors_(std::move(anchors)) {
  std::vector<double> areas(tissue.node_count(), 0);
  Vectors area_vectors(tissue.node_count(), Vec3::Zero());
  for (const Facet& facet : tissue.facets(rule_.side)) {
    const std::array<Vec3, 4> corners = gather(anchors_, facet);
    for (const NodeId node : facet.nodes) {  // the images of a periodic sheet move as their originals
      const std::size_t n = tissue.original(node).index();
      areas[n] += pattern_.strengths[facet.cell.index()] * facet_area(corners) / 4;
      area_vectors[n] += facet_area_vector(corners);
    }
  }
  for (std::size_t n = 0; n < areas.size(); ++n) {
    if (areas[n] == 0) continue;
    // On a mirror plane, the faces beyond it cancel what their sum has across it.
    for (int axis = 0; axis < 3; ++axis)
      if (tissue.is_mirrored[axis] && anchors_[n][axis] == 0) area_vectors[n][axis] = 0;
    supports_.push_back({n, areas[n], area_vectors[n].normalized()});
  }
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

double Foundation::stored(const Step& step, double activity) const {
  double sum = 0;
  for (const Support& support : supports_)
    if (is_pressed(support, step)) sum += support.area * resisted(support, displacement(support, step)).squaredNorm();
  return 0.5 * activity * rule_.stiffness * sum;
}

double Foundation::energy(const Step& step) const {
  double sum = stored(step, rule_.program.at(step.end_time_s));
  if (rule_.drag > 0)
    for (const Support& support : supports_)
      sum += 0.5 * damper(support, step) * resisted(support, movement(support, step)).squaredNorm();
  return sum;
}

// A rising program supplies energy; a falling one dissipates what it releases.
EnergyFlow Foundation::energy_flow(const CompletedStep& completed) const {
  const double from = rule_.program.at(completed.begin.end_time_s), to = rule_.program.at(completed.end.end_time_s);
  const double before = stored(completed.begin, 1), after = stored(completed.end, 1);
  const double programmed = (to - from) * 0.5 * (before + after);
  EnergyFlow flow{.active = std::max(0.0, programmed),
                  .stored = to * after - from * before,
                  .dissipated = std::max(0.0, -programmed)};
  for (const Support& support : supports_)
    flow.dissipated +=
        damper(support, completed.motion) * resisted(support, movement(support, completed.motion)).squaredNorm();
  return flow;
}

void Foundation::add_forces(const Step& step, std::span<Vec3> forces) const {
  for (const Support& support : supports_) {
    Vec3 force = damper(support, step) * movement(support, step);
    if (is_pressed(support, step)) force += spring(support, step.end_time_s) * displacement(support, step);
    forces[support.node] -= resisted(support, force);
  }
}

void Foundation::add_tangent_product(const Step& step, std::span<const Vec3> direction, std::span<Vec3> product) const {
  for (const Support& support : supports_) {
    const double r = damper(support, step) + (is_pressed(support, step) ? spring(support, step.end_time_s) : 0);
    product[support.node] += r * resisted(support, direction[support.node]);
  }
}

void Foundation::add_tangent(const Step& step, TangentSink& tangent) const {
  for (const Support& support : supports_) {
    const double r = damper(support, step) + (is_pressed(support, step) ? spring(support, step.end_time_s) : 0);
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
    const double r = damper(support, step) + spring(support, step.end_time_s);
    sum += r * r;
  }
  return std::sqrt(sum) * position_rounding;
}

std::unique_ptr<Law> Foundation::after_change(const Tissue& tissue, const TissueChange& change,
                                              std::span<const Vec3> /*positions*/) const {
  Vectors anchors = with_new_nodes(tissue, change, anchors_);
  tissue.place_hanging_positions(anchors);
  return std::unique_ptr<Law>(new Foundation(tissue, pattern_.after_change(change), rule_, std::move(anchors)));
}

std::vector<double> Foundation::past() const {
  std::vector<double> past;
  for (const Vec3& anchor : anchors_) past.insert(past.end(), {anchor.x(), anchor.y(), anchor.z()});
  return past;
}

std::unique_ptr<Law> Foundation::restored(const Tissue& tissue, const TissueChange& change,
                                          std::span<const Vec3> /*positions*/, std::span<const double> past) const {
  if (past.size() != 3 * tissue.node_count()) throw InvalidNumbers();
  Vectors anchors;
  for (std::size_t n = 0; n < tissue.node_count(); ++n)
    anchors.emplace_back(past[3 * n], past[3 * n + 1], past[3 * n + 2]);
  return std::unique_ptr<Law>(new Foundation(tissue, pattern_.after_change(change), rule_, std::move(anchors)));
}

}  // namespace plica
