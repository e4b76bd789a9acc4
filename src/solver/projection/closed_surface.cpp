#include "solver/projection/closed_surface.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace plica {
namespace {

std::vector<ClosedSurface::Quad> quads_of(std::span<const Facet> facets) {
  std::vector<ClosedSurface::Quad> quads;
  for (const Facet& facet : facets) quads.push_back(facet.nodes);
  return quads;
}

}  // namespace

ClosedSurface::ClosedSurface(std::span<const Facet> facets) : ClosedSurface(quads_of(facets)) {}

ClosedSurface::ClosedSurface(const std::vector<Quad>& facets) {
  // A shared facet comes with the same nodes from both sides.
  std::map<Quad, std::vector<std::size_t>> alike;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    Quad sorted = facets[f];
    std::sort(sorted.begin(), sorted.end());
    alike[sorted].push_back(f);
  }
  std::vector<char> inner(facets.size(), 0);
  for (const auto& [nodes, places] : alike)
    if (places.size() == 2) inner[places[0]] = inner[places[1]] = 1;
  for (std::size_t f = 0; f < facets.size(); ++f)
    if (!inner[f]) nodes_.insert(nodes_.end(), facets[f].begin(), facets[f].end());
  std::sort(nodes_.begin(), nodes_.end());
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
  for (std::size_t f = 0; f < facets.size(); ++f) {
    if (inner[f]) continue;
    std::array<int, 4>& places = facets_.emplace_back();
    for (int i = 0; i < 4; ++i)
      places[i] = static_cast<int>(std::lower_bound(nodes_.begin(), nodes_.end(), facets[f][i]) - nodes_.begin());
  }
}

void ClosedSurface::gather(std::span<const Vec3> positions, Vectors& points) const {
  points.resize(nodes_.size());
  const Vec3& origin = positions[nodes_.front().index()];
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = positions[nodes_[i].index()] - origin;
}

void ClosedSurface::gradient(const Vectors& points, Vectors& gradient) const {
  gradient.assign(nodes_.size(), Vec3::Zero());
  for (const auto& [ia, ib, ic, id] : facets_) {
    const Vec3 &a = points[ia], &b = points[ib], &c = points[ic], &d = points[id];
    // b x c + c x d + b x d for a, and so on around the facet.
    const Vec3 bd = b.cross(d), ca = c.cross(a);
    gradient[ia] += (b - d).cross(c) + bd;
    gradient[ib] += (c - a).cross(d) + ca;
    gradient[ic] += (d - b).cross(a) - bd;
    gradient[id] += (a - c).cross(b) - ca;
  }
  for (Vec3& of_node : gradient) of_node *= 1.0 / 12;
}

Cubic ClosedSurface::volume_along(const Vectors& points, const Vectors& gradient, const Vectors& direction,
                                  Vectors& scratch) const {
  this->gradient(direction, scratch);
  return {dot(direction, scratch) / 3, dot(points, scratch), dot(gradient, direction), dot(points, gradient) / 3};
}

}  // namespace plica
