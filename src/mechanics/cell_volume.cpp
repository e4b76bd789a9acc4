#include "mechanics/cell_volume.hpp"

#include "core/parallel.hpp"

namespace plica {
namespace {

HexPoints gather(std::span<const Vec3> positions, const std::array<NodeId, 8>& nodes) {
  HexPoints points;
  for (int i = 0; i < 8; ++i) points[i] = positions[nodes[i].index()];
  return points;
}

// Adds scale * d2V/dx2 of one element.
void add_volume_hessian(const std::array<NodeId, 8>& nodes, const HexPoints& points, double scale,
                        TangentSink& tangent) {
  const auto hessian = hex_volume_hessian(points);
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 8; ++j)
      if (i != j) tangent.add_block(nodes[i], nodes[j], cross_matrix(scale * hessian[i][j]));
}

void add_volume_hessian_product(const std::array<NodeId, 8>& nodes, const HexPoints& points, double scale,
                                std::span<const Vec3> direction, std::span<Vec3> product) {
  std::array<Vec3, 8> d;
  for (int i = 0; i < 8; ++i) d[i] = direction[nodes[i].index()];
  const auto change = hex_volume_hessian_product(points, d);
  for (int i = 0; i < 8; ++i) product[nodes[i].index()] += scale * change[i];
}

}  // namespace

CellVolumes::CellVolumes(const Tissue& tissue)
    : elements_(tissue.elements), element_cell_(tissue.element_cell), targets_(tissue.cells.size(), 0.0) {
  for (std::size_t e = 0; e < elements_.size(); ++e)
    targets_[element_cell_[e].index()] += hex_volume(tissue.element_rest_shape[e]);
}

std::vector<double> CellVolumes::volumes(std::span<const Vec3> positions) const {
  std::vector<double> of_elements(elements_.size()), of_cells(targets_.size(), 0.0);
  parallel_for(elements_.size(), [&](std::size_t e) { of_elements[e] = hex_volume(gather(positions, elements_[e])); });
  for (std::size_t e = 0; e < elements_.size(); ++e) of_cells[element_cell_[e].index()] += of_elements[e];
  return of_cells;
}

std::vector<double> CellVolumes::relative_errors(std::span<const Vec3> positions) const {
  std::vector<double> errors = volumes(positions);
  for (std::size_t c = 0; c < errors.size(); ++c) errors[c] = errors[c] / targets_[c] - 1;
  return errors;
}

std::vector<std::array<Vec3, 8>> CellVolumes::element_gradients(std::span<const Vec3> positions) const {
  std::vector<std::array<Vec3, 8>> gradients(elements_.size());
  parallel_for(elements_.size(),
               [&](std::size_t e) { gradients[e] = hex_volume_gradient(gather(positions, elements_[e])); });
  return gradients;
}

void CellVolumes::add_forces(std::span<const Vec3> positions, std::span<const double> pressures,
                             std::span<Vec3> forces) const {
  const auto gradients = element_gradients(positions);
  for (std::size_t e = 0; e < elements_.size(); ++e)
    for (int i = 0; i < 8; ++i)
      forces[elements_[e][i].index()] += pressures[element_cell_[e].index()] * gradients[e][i];
}

void CellVolumes::add_tangent_product(std::span<const Vec3> positions, std::span<const double> pressures,
                                      std::span<const Vec3> direction, std::span<Vec3> product) const {
  for (std::size_t e = 0; e < elements_.size(); ++e)
    add_volume_hessian_product(elements_[e], gather(positions, elements_[e]), -pressures[element_cell_[e].index()],
                               direction, product);
}

void CellVolumes::add_tangent(std::span<const Vec3> positions, std::span<const double> pressures,
                              TangentSink& tangent) const {
  for (std::size_t e = 0; e < elements_.size(); ++e)
    add_volume_hessian(elements_[e], gather(positions, elements_[e]), -pressures[element_cell_[e].index()], tangent);
}

Dilatation::Dilatation(const Tissue& tissue, double bulk_modulus)
    : elements_(tissue.elements), bulk_modulus_(bulk_modulus) {
  for (const HexPoints& rest : tissue.element_rest_shape) rest_volumes_.push_back(hex_volume(rest));
}

double Dilatation::energy(const Step& step) const {
  double sum = 0;
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const double strain = hex_volume(gather(step.positions, elements_[e])) / rest_volumes_[e] - 1;
    sum += 0.5 * bulk_modulus_ * rest_volumes_[e] * strain * strain;
  }
  return sum;
}

void Dilatation::add_forces(const Step& step, std::span<Vec3> forces) const {
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const HexPoints points = gather(step.positions, elements_[e]);
    const double pressure = bulk_modulus_ * (1 - hex_volume(points) / rest_volumes_[e]);
    const auto gradient = hex_volume_gradient(points);
    for (int i = 0; i < 8; ++i) forces[elements_[e][i].index()] += pressure * gradient[i];
  }
}

void Dilatation::add_tangent_product(const Step& step, std::span<const Vec3> direction, std::span<Vec3> product) const {
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const auto& nodes = elements_[e];
    const HexPoints points = gather(step.positions, nodes);
    const double pressure = bulk_modulus_ * (1 - hex_volume(points) / rest_volumes_[e]);
    if (!step.semidefinite_tangent) add_volume_hessian_product(nodes, points, -pressure, direction, product);
    const auto gradient = hex_volume_gradient(points);
    double rate = 0;
    for (int i = 0; i < 8; ++i) rate += gradient[i].dot(direction[nodes[i].index()]);
    for (int i = 0; i < 8; ++i) product[nodes[i].index()] += bulk_modulus_ / rest_volumes_[e] * rate * gradient[i];
  }
}

void Dilatation::add_tangent(const Step& step, TangentSink& tangent) const {
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const auto& nodes = elements_[e];
    const HexPoints points = gather(step.positions, nodes);
    const double pressure = bulk_modulus_ * (1 - hex_volume(points) / rest_volumes_[e]);
    if (!step.semidefinite_tangent) add_volume_hessian(nodes, points, -pressure, tangent);
    const auto gradient = hex_volume_gradient(points);
    for (int i = 0; i < 8; ++i)
      for (int j = 0; j < 8; ++j)
        tangent.add_block(nodes[i], nodes[j], bulk_modulus_ / rest_volumes_[e] * gradient[i] * gradient[j].transpose());
  }
}

NodeGroups Dilatation::node_groups() const {
  NodeGroups groups;
  for (const auto& nodes : elements_) groups.emplace_back(nodes.begin(), nodes.end());
  return groups;
}

std::unique_ptr<Law> Dilatation::after_division(const Tissue& tissue, const Division&, std::span<const Vec3>) const {
  return std::make_unique<Dilatation>(tissue, bulk_modulus_);
}

void Dilatation::take_rest_shapes(const Tissue& tissue, std::span<const ElementId> elements) {
  for (const ElementId e : elements) rest_volumes_[e.index()] = hex_volume(tissue.element_rest_shape[e.index()]);
}

}  // namespace plica
