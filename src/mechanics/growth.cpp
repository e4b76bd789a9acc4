#include "mechanics/growth.hpp"

#include <algorithm>
#include <cmath>

#include "mechanics/model.hpp"
#include "tissue/mesher.hpp"
#include "tissue/polygon_cell.hpp"
#include "tissue/tissue_change.hpp"

namespace plica {
namespace {

// Exactly `to` at the end, and if both are equal: stiffness is recomputed only for shapes that change.
double between(double from, double to, double part) { return part < 1 ? from + part * (to - from) : to; }

struct CellShape {
  std::vector<Vec3> rest;
  double target;
};

CellShape shape_of(const Growth& growth, double time_s) {
  const double part = growth.part(time_s);
  CellShape shape{growth.rest_from, between(growth.target_from, growth.target_to, part)};
  for (std::size_t i = 0; i < shape.rest.size(); ++i)
    for (int axis = 0; axis < 3; ++axis)
      shape.rest[i][axis] = between(growth.rest_from[i][axis], growth.rest_to[i][axis], part);
  return shape;
}

void stretch(const GrowthTensor& tensor, auto& points) {
  for (Vec3& point : points) point = tensor.G * point;
}

void stretch(const GrowthTensor& tensor, CellShape& shape) {
  stretch(tensor, shape.rest);
  shape.target *= tensor.volume;
}

// Daughters that still grow do so from shapes that have grown since.
void stretch(const GrowthTensor& tensor, Growth& growth) {
  stretch(tensor, growth.rest_from);
  stretch(tensor, growth.rest_to);
  growth.target_from *= tensor.volume;
  growth.target_to *= tensor.volume;
}

// From the centre of the base to that of the apex; x, seen along that; and across both.
ByCell<Mat3> axes_of(const Tissue& tissue) {
  ByCell<Mat3> axes;
  for (const Cell& cell : tissue.cells) {
    const PrismCorners rest = rest_prism(cell);
    Vec3 up = Vec3::Zero();
    for (std::size_t i = 0; i < rest.apical.size(); ++i) up += rest.apical[i] - rest.basal[i];
    up.normalize();
    Vec3 along = Vec3::UnitX() - up.x() * up;
    if (along.norm() < 1e-6) along = Vec3::UnitZ() - up.z() * up;  // at a pole of the embryo, any will do
    along.normalize();
    axes.emplace_back() << along, up.cross(along), up;
  }
  return axes;
}

}  // namespace

double Growth::part(double time_s) const {
  if (time_s >= end_s) return 1;
  return time_s <= start_s ? 0 : (time_s - start_s) / (end_s - start_s);
}

CellGrowth::CellGrowth(const Tissue& tissue, CellPattern pattern, GrowthRule rule)
    : rule_(std::move(rule)), pattern_(std::move(pattern)), followed_(tissue, rule_.follow), axes_(axes_of(tissue)) {}

const LawDerivatives& CellGrowth::derivatives() const {
  if (followed_.is_used()) refuse_gradient("growth that follows a signal has no gradient; remove follow");
  return *this;
}

std::unique_ptr<Law> CellGrowth::with_strengths(std::span<const double> factors) const {
  auto law = std::make_unique<CellGrowth>(*this);
  for (std::size_t c = 0; c < factors.size(); ++c) law->pattern_.strengths[c] *= factors[c];
  return law;
}

double CellGrowth::active_s(CellId cell, std::span<const double> internal, double time_s) const {
  const double from_s = internal.front();
  const auto factor = given(internal).of(cell);
  if (factor) return internal[1 + cell.index()] + *factor * (time_s - from_s);
  return internal[1 + cell.index()] + followed_.at(followed(internal), cell) * rule_.program.integral(from_s, time_s);
}

void CellGrowth::grow(std::span<const double> internal, double time_s, std::vector<GrowthTensor>& tensors) const {
  tensors.resize(pattern_.cells.size());
  for (std::size_t c = 0; c < tensors.size(); ++c) {
    const double ln_volume = pattern_.strengths[c] * rule_.rate_per_s * active_s(CellId(c), internal, time_s);
    if (ln_volume == 0) continue;
    const Vec3 stretches = (ln_volume * rule_.shares).array().exp();
    tensors[c].G = tensors[c].G * axes_[c] * stretches.asDiagonal() * axes_[c].transpose();
    tensors[c].volume *= std::exp(ln_volume);
  }
}

bool CellGrowth::is_growing(std::span<const double> internal, double time_s) const {
  constexpr double soon_s = 1e-3;  // also where the program jumps
  for (std::size_t c = 0; c < pattern_.cells.size(); ++c)
    if (pattern_.strengths[c] * rule_.rate_per_s != 0 &&
        active_s(CellId(c), internal, time_s + soon_s) != active_s(CellId(c), internal, time_s))
      return true;
  return false;
}

std::vector<double> CellGrowth::first_internal(const Tissue& /*tissue*/) const {
  return std::vector<double>(1 + pattern_.cells.size() + followed_.size(), 0);
}

std::vector<double> CellGrowth::next_internal(const Step& step) const {
  std::vector<double> internal(step.internal.begin(), step.internal.end());
  internal[0] = step.end_time_s;
  for (std::size_t c = 0; c < pattern_.cells.size(); ++c)
    internal[1 + c] = active_s(CellId(c), step.internal, step.end_time_s);
  followed_.move_on(followed(std::span(internal)));
  return internal;
}

std::vector<double> CellGrowth::with_signals(std::span<const double> internal, std::span<const CellArray> signals,
                                             double time_s) const {
  std::vector<double> result(internal.begin(), internal.end());
  followed_.follow(signals, time_s, followed(std::span(result)));
  return result;
}

std::unique_ptr<Law> CellGrowth::after_change(const Tissue& tissue, const TissueChange& change,
                                              std::span<const Vec3> /*positions*/) const {
  auto law = std::make_unique<CellGrowth>(*this);
  law->followed_ = FollowedSignal(tissue, rule_.follow);
  follow(change, law->pattern_);
  follow(change, law->axes_);
  return law;
}

std::vector<double> CellGrowth::internal_after_change(std::span<const double> internal, const Tissue& /*tissue*/,
                                                      const TissueChange& change, const ChangePositions&) const {
  std::vector<double> after(1 + change.origin.size(), 0);
  after[0] = internal.front();
  for (const std::vector<double>& part :
       {followed_.after_change(followed(internal), change), given(internal).after_change(change)})
    after.insert(after.end(), part.begin(), part.end());
  return after;
}

std::optional<double> CellGrowth::activity_of(CellId cell, double time_s, std::span<const double> internal) const {
  if (!pattern_.cells[cell.index()]) return std::nullopt;
  return given(internal).of(cell).value_or(followed_.at(followed(internal), cell) * rule_.program.at(time_s));
}

bool cells_grow(const Model& model, std::span<const std::vector<double>> internals, double time_s) {
  for (std::size_t l = 0; l < internals.size(); ++l)
    if (model.laws[l]->is_growing(internals[l], time_s)) return true;
  return false;
}

std::optional<Model> grown(const Model& model, const Model& present, std::span<const std::vector<double>> internals,
                           double time_s) {
  std::vector<GrowthTensor> tensors;
  for (std::size_t l = 0; l < internals.size(); ++l) model.laws[l]->grow(internals[l], time_s, tensors);
  std::vector<const Growth*> daughters(model.growths.empty() ? 0 : model.tissue.cells.size());
  for (const Growth& growth : model.growths) daughters[growth.cell.index()] = &growth;
  std::vector<ElementId> reshaped;
  std::optional<Tissue> tissue;
  for (std::size_t c = 0; c < std::max(tensors.size(), daughters.size()); ++c) {
    const Growth* daughter = daughters.empty() ? nullptr : daughters[c];
    if (!daughter && tensors.empty()) continue;
    CellShape shape = daughter ? shape_of(*daughter, time_s)
                               : CellShape{model.tissue.cells[c].rest_shape, model.volumes.targets()[c]};
    if (!tensors.empty()) stretch(tensors[c], shape);
    const Cell& before = present.tissue.cells[c];
    const bool is_reshaped = shape.rest != before.rest_shape;
    if (!is_reshaped && before.target_volume.value_or(present.volumes.targets()[c]) == shape.target) continue;
    if (!tissue) tissue = present.tissue;
    Cell& cell = tissue->cells[c];
    cell.target_volume = shape.target;
    if (!is_reshaped) continue;
    cell.rest_shape = std::move(shape.rest);
    if (daughter) set_element_rest_shapes(*tissue, CellId(c));
    for (int e = 0; e < cell.element_count; ++e) {
      const ElementId element = reshaped.emplace_back(cell.first_element.index() + e);
      if (daughter) continue;
      HexPoints& rest = tissue->element_rest_shape[element.index()];
      rest = model.tissue.element_rest_shape[element.index()];
      stretch(tensors[c], rest);
    }
  }
  if (!tissue) return std::nullopt;
  Model later(present, std::move(*tissue), reshaped, tensors);
  later.growths = model.growths;
  if (!tensors.empty())
    for (Growth& growth : later.growths) stretch(tensors[growth.cell.index()], growth);
  return later;
}

}  // namespace plica
