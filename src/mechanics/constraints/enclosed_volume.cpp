#include "mechanics/constraints/enclosed_volume.hpp"

#include <algorithm>
#include <cmath>

#include "tissue/faces.hpp"
#include "tissue/tissue_change.hpp"

namespace plica {
namespace {

using Corners = std::array<Vec3, 4>;

// Twelve times the cone from the origin to a bilinear facet is a.(b x c) + a.(c x d) + a.(b x d) + b.(c x d). Basal
// facets look into the lumen, so their cones count with the other sign.
constexpr double cone_share = -1.0 / 12;
// Six times that to a triangle is its triple product.
constexpr double rim_share = -1.0 / 6;

double cone(const Corners& x) {
  const auto& [a, b, c, d] = x;
  return cone_share * (a.dot(b.cross(c) + c.cross(d) + b.cross(d)) + b.dot(c.cross(d)));
}

Corners cone_gradient(const Corners& x) {
  const auto& [a, b, c, d] = x;
  return {cone_share * (b.cross(c) + c.cross(d) + b.cross(d)), cone_share * (c.cross(a) + d.cross(a) + c.cross(d)),
          cone_share * (a.cross(b) + d.cross(a) + d.cross(b)), cone_share * (a.cross(c) + a.cross(b) + b.cross(c))};
}

// d2/dx_i dx_j, i < j, as the vector whose cross product it is.
Vec3 cone_hessian(const Corners& x, int i, int j) {
  const auto& [a, b, c, d] = x;
  if (i == 0) return -cone_share * (j == 1 ? Vec3(c + d) : j == 2 ? Vec3(d - b) : Vec3(-b - c));
  if (i == 1) return -cone_share * (j == 2 ? Vec3(a + d) : Vec3(a - c));
  return -cone_share * (a + b);
}

}  // namespace

EnclosedVolume::EnclosedVolume(const Tissue& tissue) : EnclosedVolume(tissue, 0) {
  target_ = volume(tissue.rest_positions);
}

std::vector<EnclosedVolume::RimEdge> EnclosedVolume::open_rim(const Tissue& tissue) {
  std::vector<RimEdge> rim;
  for (const auto& [from, to] : rim_of(tissue, tissue.basal_facets))
    // The cap in a mirror plane contains the origin, so its cone has no volume.
    if (tissue.side_share(std::array{from, to}) == 1)
      rim.push_back({from, to, Vec3(tissue.rest_positions[from.index()].x(), 0, 0)});
  return rim;
}

bool EnclosedVolume::is_closed(const Tissue& tissue) {
  const std::vector<RimEdge> rim = open_rim(tissue);
  const auto is_across = [&](const RimEdge& edge) {
    return std::abs(tissue.rest_positions[edge.to.index()].x() - edge.place.x()) < 1e-9;
  };
  return !tissue.basal_facets.empty() && !tissue.is_periodic() && std::ranges::all_of(rim, is_across);
}

EnclosedVolume::EnclosedVolume(const Tissue& tissue, double target) : rim_(open_rim(tissue)), target_(target) {
  for (const Facet& facet : tissue.basal_facets) facets_.push_back(facet.nodes);
  Vectors gradient(tissue.node_count(), Vec3::Zero());
  add_forces(tissue.rest_positions, std::array{1.0}, gradient);
  for (const Vec3& g : gradient) gradient_scale_ += g.squaredNorm();
}

double EnclosedVolume::volume(std::span<const Vec3> positions) const {
  double volume = 0;
  values(positions, {&volume, 1});
  return volume;
}

void EnclosedVolume::values(std::span<const Vec3> x, std::span<double> values) const {
  values[0] = 0;
  for (const auto& nodes : facets_) values[0] += cone(gather(x, nodes));
  for (const auto& [from, to, place] : rim_) values[0] += rim_share * place.dot(x[to.index()].cross(x[from.index()]));
}

ConstraintParts EnclosedVolume::parts() const {
  ConstraintParts parts;
  for (const auto& nodes : facets_) {
    parts.nodes.add(nodes);
    parts.function.push_back(0);
  }
  for (const RimEdge& edge : rim_) {
    parts.nodes.add(std::array{edge.from, edge.to});
    parts.function.push_back(0);
  }
  return parts;
}

void EnclosedVolume::gradients(std::span<const Vec3> x, std::span<Vec3> of_parts) const {
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    const Corners gradient = cone_gradient(gather(x, facets_[f]));
    std::copy(gradient.begin(), gradient.end(), of_parts.begin() + static_cast<std::ptrdiff_t>(4 * f));
  }
  for (std::size_t e = 0; e < rim_.size(); ++e) {
    const auto& [from, to, place] = rim_[e];
    of_parts[4 * facets_.size() + 2 * e] = rim_share * place.cross(x[to.index()]);
    of_parts[4 * facets_.size() + 2 * e + 1] = rim_share * x[from.index()].cross(place);
  }
}

void EnclosedVolume::for_parts(const std::function<void(std::size_t)>& body, bool /*shared*/) const {
  for (std::size_t part = 0; part < facets_.size() + rim_.size(); ++part) body(part);
}

void EnclosedVolume::add_forces(std::span<const Vec3> x, std::span<const double> multipliers,
                                std::span<Vec3> forces) const {
  for (const auto& nodes : facets_) {
    const Corners gradient = cone_gradient(gather(x, nodes));
    for (int i = 0; i < 4; ++i) forces[nodes[i].index()] += multipliers[0] * gradient[i];
  }
  for (const auto& [from, to, place] : rim_) {
    forces[from.index()] += multipliers[0] * rim_share * place.cross(x[to.index()]);
    forces[to.index()] += multipliers[0] * rim_share * x[from.index()].cross(place);
  }
}

template <class Take>
void EnclosedVolume::for_blocks(std::span<const Vec3> x, double pressure, const Take& take) const {
  for (const auto& nodes : facets_) {
    const Corners corners = gather(x, nodes);
    for (int i = 0; i < 4; ++i)
      for (int j = i + 1; j < 4; ++j) take(nodes[i], nodes[j], Vec3(-pressure * cone_hessian(corners, i, j)));
  }
  for (const auto& [from, to, place] : rim_) take(from, to, Vec3(-pressure * rim_share * place));
}

void EnclosedVolume::add_tangent_product(std::span<const Vec3> x, std::span<const double> multipliers,
                                         std::span<const Vec3> direction, std::span<Vec3> product) const {
  for_blocks(x, multipliers[0], [&](NodeId a, NodeId b, const Vec3& turn) {
    product[a.index()] += turn.cross(direction[b.index()]);
    product[b.index()] -= turn.cross(direction[a.index()]);
  });
}

void EnclosedVolume::add_tangent(std::span<const Vec3> x, std::span<const double> multipliers,
                                 TangentSink& tangent) const {
  for_blocks(x, multipliers[0],
             [&](NodeId a, NodeId b, const Vec3& turn) { tangent.add_block(a, b, cross_matrix(turn)); });
}

double EnclosedVolume::rounding(const Tissue& /*tissue*/, double position_rounding) const {
  return std::sqrt(gradient_scale_) * position_rounding / target_;
}

std::unique_ptr<Constraint> EnclosedVolume::after_change(const Tissue& tissue, const TissueChange& /*change*/,
                                                         std::span<const Vec3> /*positions*/) const {
  return std::make_unique<EnclosedVolume>(tissue, target_);
}

}  // namespace plica
