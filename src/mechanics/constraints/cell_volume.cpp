#include "mechanics/constraints/cell_volume.hpp"

#include "core/parallel.hpp"
#include "tissue/tissue_change.hpp"

namespace plica {
namespace {

// Adds scale * d2V/dx2 of one element.
void add_volume_hessian(const std::array<NodeId, 8>& nodes, const HexPoints& points, double scale,
                        TangentSink& tangent) {
  const auto hessian = hex_volume_hessian(points);
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < i; ++j) tangent.add_block(nodes[i], nodes[j], cross_matrix(scale * hessian[i][j]));
}

// Sets the data of a place for an element; places after the last element repeat it. `owner`: index of the pressure or
// the bulk modulus of an element.
template <class Owner>
void fit(const Tissue& tissue, std::size_t place, const Owner& owner, std::vector<VolumeBatch>& batches) {
  const std::size_t e = std::min(place, tissue.elements.size() - 1), lane = place % ElementChunks::batch_size;
  VolumeBatch& batch = batches[place / ElementChunks::batch_size];
  for (int i = 0; i < 8; ++i) batch.nodes[i][lane] = 3 * tissue.elements[e][i].number();
  batch.owners[lane] = owner(e);
  batch.rest_volumes[lane] = hex_volume(tissue.element_rest_shape[e]);
}

}  // namespace

CellVolumes::CellVolumes(const Tissue& tissue, Kernels kernels)
    : elements_(tissue.elements),
      element_cell_(tissue.element_cell),
      targets_(tissue.cells.size(), 0.0),
      chunks_(tissue, tissue.elements, tissue.element_cell),
      batches_(chunks_.batch_count()),
      kernels_(&kernels_for(kernels, generic::volume_kernels, avx2::volume_kernels, avx512::volume_kernels)) {
  parallel_for(batches_.size() * ElementChunks::batch_size, [&](std::size_t place) {
    fit(
        tissue, place, [&](std::size_t e) { return element_cell_[e].number(); }, batches_);
  });
  for (std::size_t e = 0; e < elements_.size(); ++e)
    targets_[element_cell_[e].index()] += hex_volume(tissue.element_rest_shape[e]);
  take_targets(tissue);
}

void CellVolumes::take_targets(const Tissue& tissue) {
  for (std::size_t c = 0; c < targets_.size(); ++c) targets_[c] = tissue.cells[c].target_volume.value_or(targets_[c]);
}

CellVolumes CellVolumes::grown(const Tissue& tissue) const {
  CellVolumes after = *this;
  after.take_targets(tissue);
  return after;
}

VolumeArrays CellVolumes::kernel_arrays(std::span<const Vec3> positions, std::span<const double> pressures) const {
  return {.batches = batches_.data(),
          .elements = elements_.size(),
          .positions = components(positions),
          .pressures = pressures.data(),
          .bulk_moduli = nullptr,
          .semidefinite_tangent = false};
}

std::vector<double> CellVolumes::volumes(std::span<const Vec3> positions) const {
  std::vector<double> of_cells(targets_.size());
  values(positions, of_cells);
  return of_cells;
}

void CellVolumes::values(std::span<const Vec3> positions, std::span<double> of_cells) const {
  std::fill(of_cells.begin(), of_cells.end(), 0.0);
  const VolumeArrays at = kernel_arrays(positions, {});
  chunks_.for_batches(
      [&](std::size_t first, std::size_t last) { kernels_->add_volumes(at, first, last, of_cells.data()); });
}

std::vector<double> CellVolumes::relative_errors(std::span<const Vec3> positions) const {
  std::vector<double> errors = volumes(positions);
  for (std::size_t c = 0; c < errors.size(); ++c) errors[c] = errors[c] / targets_[c] - 1;
  return errors;
}

ConstraintParts CellVolumes::parts() const {
  ConstraintParts parts;
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    parts.nodes.add(elements_[e]);
    parts.function.push_back(element_cell_[e].number());
  }
  return parts;
}

double CellVolumes::rounding(const Tissue& tissue, double position_rounding) const {
  double thinnest = 0;  // largest of an element's faces over its volume: how much a shift of a face changes it
  for (const HexPoints& rest : tissue.element_rest_shape)
    thinnest = std::max(thinnest, largest_face(rest) / hex_volume(rest));
  return thinnest * position_rounding;
}

CellVolumes CellVolumes::divided(const Tissue& tissue, const TissueChange& change) const {
  CellVolumes after(tissue);
  after.targets_ = inherited(change, targets_);  // unchanged by other elements of cells beside a cut
  after.take_targets(tissue);
  after.is_held_ = is_held_;
  return after;
}

std::vector<double> CellVolumes::multipliers_after_division(std::span<const double> pressures,
                                                            const TissueChange& change) const {
  return inherited(change, std::vector<double>(pressures.begin(), pressures.end()));
}

void CellVolumes::gradients(std::span<const Vec3> positions, std::span<Vec3> of_elements) const {
  const VolumeArrays at = kernel_arrays(positions, {});
  chunks_.for_batches([&](std::size_t first, std::size_t last) {
    kernels_->write_gradients(at, first, last, components(of_elements));
  });
}

void CellVolumes::add_forces(std::span<const Vec3> positions, std::span<const double> pressures,
                             std::span<Vec3> forces) const {
  const VolumeArrays at = kernel_arrays(positions, pressures);
  chunks_.for_batches(
      [&](std::size_t first, std::size_t last) { kernels_->add_forces(at, first, last, components(forces)); });
}

void CellVolumes::add_tangent_product(std::span<const Vec3> positions, std::span<const double> pressures,
                                      std::span<const Vec3> direction, std::span<Vec3> product) const {
  const VolumeArrays at = kernel_arrays(positions, pressures);
  chunks_.for_batches([&](std::size_t first, std::size_t last) {
    kernels_->add_product(at, first, last, components(direction), components(product));
  });
}

void CellVolumes::add_tangent(std::span<const Vec3> positions, std::span<const double> pressures,
                              TangentSink& tangent) const {
  chunks_.for_elements(
      [&](std::size_t e) {
        const double pressure = pressures[element_cell_[e].index()];
        add_volume_hessian(elements_[e], gather(positions, elements_[e]), -pressure, tangent);
      },
      tangent.accepts_concurrent_blocks());
}

Dilatation::Dilatation(const Tissue& tissue, std::vector<double> bulk_moduli, bool cells_are_exact, Kernels kernels)
    : BatchLaw({}, {tissue, {}}, kernels),
      bulk_moduli_(tissue, std::move(bulk_moduli)),
      cells_are_exact_(cells_are_exact) {
  if (cells_are_exact && tissue.elements.size() <= tissue.cells.size()) return;
  elements_ = tissue.elements;
  chunks_ = {tissue, tissue.elements, tissue.element_cell};
  batches_.resize(chunks_.batch_count());
  parallel_for(places(), [&](std::size_t place) { fit(tissue, place); });
  take_target_volumes(tissue);
}

void Dilatation::fit(const Tissue& tissue, std::size_t place) {
  plica::fit(
      tissue, place, [](std::size_t e) { return static_cast<int>(e); }, batches_);
}

VolumeArrays Dilatation::kernel_arrays(const Step& step) const {
  return {.batches = batches_.data(),
          .elements = elements_.size(),
          .positions = components(step.positions),
          .pressures = nullptr,
          .bulk_moduli = bulk_moduli_.data(),
          .semidefinite_tangent = step.semidefinite_tangent};
}

double Dilatation::energy(const Step& step) const {
  return chunks_.sum_over_elements([&](std::size_t e) {
    const double rest_volume = batches_[e / batch_size].rest_volumes[e % batch_size];
    const double strain = hex_volume(gather(step.positions, elements_[e])) / rest_volume - 1;
    return bulk_moduli_[e] * rest_volume * strain * strain / 2;
  });
}

void Dilatation::add_tangent(const Step& step, TangentSink& tangent) const {
  chunks_.for_elements(
      [&](std::size_t e) {
        const auto& nodes = elements_[e];
        const HexPoints points = gather(step.positions, nodes);
        const double rest_volume = batches_[e / batch_size].rest_volumes[e % batch_size];
        const double bulk_modulus = bulk_moduli_[e];
        const double pressure = bulk_modulus * (1 - hex_volume(points) / rest_volume);
        if (!step.semidefinite_tangent) add_volume_hessian(nodes, points, -pressure, tangent);
        const auto gradient = hex_volume_gradient(points);
        for (int i = 0; i < 8; ++i)
          for (int j = 0; j <= i; ++j)
            tangent.add_block(nodes[i], nodes[j], bulk_modulus / rest_volume * gradient[i] * gradient[j].transpose());
      },
      tangent.accepts_concurrent_blocks());
}

std::unique_ptr<Law> Dilatation::after_change(const Tissue& tissue, const TissueChange& change,
                                              std::span<const Vec3>) const {
  return std::make_unique<Dilatation>(tissue, bulk_moduli_.after_change(tissue, change), cells_are_exact_, kernels_);
}

std::unique_ptr<Law> Dilatation::grown(const Tissue& tissue, std::span<const ElementId> elements,
                                       std::span<const GrowthTensor> /*tensors*/) const {
  auto law = std::make_unique<Dilatation>(*this);
  if (elements_.empty()) return law;
  for (const ElementId e : elements) law->fit(tissue, e.index());
  law->take_target_volumes(tissue);
  return law;
}

// The held volume of a growing daughter differs from its rest shape. Relative to the latter, each of its elements would
// exert pressure, and the multiplier (the reported cell pressure) would only cancel that.
void Dilatation::take_target_volumes(const Tissue& tissue) {
  if (!cells_are_exact_) return;
  for (const Cell& cell : tissue.cells) {
    if (!cell.target_volume) continue;
    const double part = *cell.target_volume / rest_volume(tissue, cell);
    for (int e = 0; e < cell.element_count; ++e) {
      const std::size_t element = cell.first_element.index() + e;
      const double rest = hex_volume(tissue.element_rest_shape[element]);
      const std::size_t end = element + 1 == elements_.size() ? places() : element + 1;
      for (std::size_t place = element; place < end; ++place)
        batches_[place / batch_size].rest_volumes[place % batch_size] = std::abs(part - 1) < 1e-12 ? rest : part * rest;
    }
  }
}

}  // namespace plica
