#include "mechanics/elasticity/corner_barrier.hpp"

#include <cmath>

#include "tissue/tissue_change.hpp"

namespace plica {
namespace {

// The neighbours of each corner along u, v and w.
constexpr int neighbours[8][3] = {{1, 3, 4}, {0, 2, 5}, {3, 1, 6}, {2, 0, 7},
                                  {5, 7, 0}, {4, 6, 1}, {7, 5, 2}, {6, 4, 3}};
// Whether its edges, in this order, are left-handed: then the product is taken with the other sign.
constexpr double handedness[8] = {1, -1, 1, -1, -1, 1, -1, 1};

struct Edges {
  Vec3 a, b, c;
  [[nodiscard]] double product() const { return a.dot(b.cross(c)); }
};

template <class At>
Edges edges_of(int corner, const At& at) {
  const Vec3& x = at(corner);
  return {at(neighbours[corner][0]) - x, at(neighbours[corner][1]) - x, at(neighbours[corner][2]) - x};
}

}  // namespace

CornerBarrier::CornerBarrier(const Tissue& tissue, double modulus, double threshold)
    : modulus_(modulus),
      threshold_(threshold),
      chunks_(tissue, tissue.elements),
      elements_(tissue.elements),
      scales_(tissue.elements.size()),
      rest_volumes_(tissue.elements.size()) {
  for (std::size_t e = 0; e < elements_.size(); ++e) fit(tissue, e);
}

void CornerBarrier::fit(const Tissue& tissue, std::size_t e) {
  const HexPoints& rest = tissue.element_rest_shape[e];
  rest_volumes_[e] = hex_volume(rest);
  const std::array<double, 8> jacobians = hex_corner_jacobians(rest);
  for (int corner = 0; corner < 8; ++corner)
    scales_[e][corner] = handedness[corner] / (8 * threshold_ * jacobians[corner]);
}

// The energy as a function of r, and r as one of the nodes: that of the corner, then its three neighbours.
struct CornerBarrier::Corner {
  std::array<NodeId, 4> nodes;
  std::array<Vec3, 4> gradient;  // dr/dx, 1/um
  Edges edges;
  double scale;                 // r over the product of the edges, 1/um^3
  double energy, slope, curve;  // E, dE/dr, d2E/dr2; nN um

  // d2r/dx_i dx_j as the vector a whose cross product it is; i < j.
  [[nodiscard]] Vec3 change(int i, int j) const {
    const auto& [a, b, c] = edges;
    if (i == 0) return scale * (j == 1 ? Vec3(b - c) : j == 2 ? Vec3(c - a) : Vec3(a - b));
    return scale * (i == 2 ? -a : j == 2 ? Vec3(-c) : b);
  }
};

template <class Take>
void CornerBarrier::for_pushed(std::span<const Vec3> positions, std::size_t e, const Take& take) const {
  const HexPoints points = gather(positions, elements_[e]);
  const auto at = [&](int i) -> const Vec3& { return points[i]; };
#pragma GCC unroll 8
  for (int corner = 0; corner < 8; ++corner) {
    const Edges edges = edges_of(corner, at);
    const double scale = scales_[e][corner], r = scale * edges.product();
    if (r >= 1) continue;
    const double k = modulus_ * rest_volumes_[e] / 8, log = std::log(r), less = r - 1;
    Corner pushed;
    for (int i = 0; i < 4; ++i) pushed.nodes[i] = elements_[e][i == 0 ? corner : neighbours[corner][i - 1]];
    pushed.edges = edges;
    pushed.scale = scale;
    pushed.gradient = {Vec3::Zero(), scale * edges.b.cross(edges.c), scale * edges.c.cross(edges.a),
                       scale * edges.a.cross(edges.b)};
    pushed.gradient[0] = -(pushed.gradient[1] + pushed.gradient[2] + pushed.gradient[3]);
    pushed.energy = -k * less * less * log;
    pushed.slope = -k * (2 * less * log + less * less / r);
    pushed.curve = k * (-2 * log - 4 * less / r + less * less / (r * r));
    take(pushed);
  }
}

double CornerBarrier::energy(const Step& step) const {
  return chunks_.sum_over_elements([&](std::size_t e) {
    double sum = 0;
    for_pushed(step.positions, e, [&](const Corner& corner) { sum += corner.energy; });
    return sum;
  });
}

void CornerBarrier::add_forces(const Step& step, std::span<Vec3> forces) const {
  chunks_.for_elements([&](std::size_t e) {
    for_pushed(step.positions, e, [&](const Corner& corner) {
      for (int i = 0; i < 4; ++i) forces[corner.nodes[i].index()] -= corner.slope * corner.gradient[i];
    });
  });
}

void CornerBarrier::add_tangent_product(const Step& step, std::span<const Vec3> direction,
                                        std::span<Vec3> product) const {
  chunks_.for_elements([&](std::size_t e) {
    for_pushed(step.positions, e, [&](const Corner& corner) {
      double change = 0;
      for (int i = 0; i < 4; ++i) change += corner.gradient[i].dot(direction[corner.nodes[i].index()]);
      for (int i = 0; i < 4; ++i) product[corner.nodes[i].index()] += corner.curve * change * corner.gradient[i];
      if (step.semidefinite_tangent) return;
      for (int i = 0; i < 4; ++i)
        for (int j = i + 1; j < 4; ++j) {
          const Vec3 a = corner.slope * corner.change(i, j);
          product[corner.nodes[i].index()] += a.cross(direction[corner.nodes[j].index()]);
          product[corner.nodes[j].index()] -= a.cross(direction[corner.nodes[i].index()]);
        }
    });
  });
}

void CornerBarrier::add_tangent(const Step& step, TangentSink& tangent) const {
  chunks_.for_elements(
      [&](std::size_t e) {
        for_pushed(step.positions, e, [&](const Corner& corner) {
          for (int i = 0; i < 4; ++i)
            for (int j = i; j < 4; ++j) {
              Mat3 block = corner.curve * corner.gradient[i] * corner.gradient[j].transpose();
              if (i != j && !step.semidefinite_tangent) block += cross_matrix(corner.slope * corner.change(i, j));
              tangent.add_block(corner.nodes[i], corner.nodes[j], block);
            }
        });
      },
      tangent.accepts_concurrent_blocks());
}

NodeGroups CornerBarrier::node_groups(std::span<const double> /*internal*/) const {
  NodeGroups groups;
  for (const auto& nodes : elements_) groups.add(nodes);
  return groups;
}

std::unique_ptr<Law> CornerBarrier::after_change(const Tissue& tissue, const TissueChange&,
                                                 std::span<const Vec3>) const {
  return std::make_unique<CornerBarrier>(tissue, modulus_, threshold_);
}

}  // namespace plica
