#include "mechanics/active/cortex.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "mechanics/growth.hpp"
#include "tissue/tissue_change.hpp"

namespace plica {
namespace {

double area_at_rest(const Tissue& tissue, const Face& face) {
  return facet_area(gather(tissue.rest_positions, face.nodes));
}

// Unit normal of a face in the rest shape of a cell that has it as a face of one element: reference positions mean
// nothing after an exchange of neighbours. By them where a face is cut in both cells.
Vec3 rest_normal(const Tissue& tissue, const Face& face) {
  for (const CellId of : {face.cell, face.beyond.value_or(face.cell)}) {
    const Cell& cell = tissue.cells[of.index()];
    for (int i = 0; i < cell.element_count; ++i) {
      const std::size_t e = cell.first_element.index() + static_cast<std::size_t>(i);
      const auto& nodes = tissue.elements[e];
      std::array<std::ptrdiff_t, 4> places;
      std::ranges::transform(face.nodes, places.begin(),
                             [&](NodeId node) { return std::ranges::find(nodes, node) - nodes.begin(); });
      if (std::ranges::count(places, std::ssize(nodes)) > 0) continue;
      std::array<Vec3, 4> corners;
      for (int k = 0; k < 4; ++k) corners[k] = tissue.element_rest_shape[e][static_cast<std::size_t>(places[k])];
      return facet_area_vector(corners).normalized();
    }
  }
  return facet_area_vector(gather(tissue.rest_positions, face.nodes)).normalized();
}

// Strength of a face: that of its cell, or the mean of both cells of a wall; times the share of the face in this
// tissue.
double strength_of(const Face& face, const CellPattern& pattern) {
  const double own = pattern.strengths[face.cell.index()];
  return face.share * (face.beyond ? 0.5 * (own + pattern.strengths[face.beyond->index()]) : own);
}

// Chunks of faces, each as an element that lists the corners of the face twice.
ElementChunks chunks_of(const Tissue& tissue, const std::vector<std::array<NodeId, 4>>& faces) {
  std::vector<std::array<NodeId, 8>> corners;
  for (const auto& n : faces) corners.push_back({n[0], n[1], n[2], n[3], n[0], n[1], n[2], n[3]});
  return {tissue, corners};
}

std::vector<double> joined(std::vector<double> a, std::span<const double> b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// Integral of v/(1 + q v) from 0 to w.
double integral_of_yielding(double w, double q) {
  const double x = q * w;
  if (std::abs(x) < 1e-3) return w * w * (1.0 / 2 - x / 3 + x * x / 4 - x * x * x / 5);
  return (x - std::log1p(x)) / (q * q);
}

}  // namespace

std::vector<Face> Cortex::acting_faces(const Tissue& tissue, CellSide side, const CellPattern& pattern) {
  std::vector<Face> faces = faces_of(tissue, side);
  std::erase_if(faces, [&](const Face& face) { return strength_of(face, pattern) == 0; });
  return faces;
}

Cortex::Cortex(const Tissue& tissue, CellPattern pattern, CortexRule rule, Kernels kernels)
    : BatchLaw({}, {tissue, {}}, kernels),
      rule_(std::move(rule)),
      pattern_(std::move(pattern)),
      faces_(acting_faces(tissue, rule_.side, pattern_)),
      activation_(tissue, rule_.activation),
      noise_(rule_.walls.noise) {
  for (const Face& face : faces_) {
    elements_.push_back(face.nodes);
    rest_areas_.push_back(area_at_rest(tissue, face));
    rest_normals_.push_back(rest_normal(tissue, face));
    strengths_.push_back(strength_of(face, pattern_));
    heights_.push_back(height_percent(tissue, face.cell, face.nodes));
  }
  if (rule_.walls.noise.spread > 0) pairs_ = pair_numbers(tissue, faces_);
  chunks_ = chunks_of(tissue, elements_);
  batches_.resize(chunks_.batch_count());
  take_stretches(std::vector<double>(faces_.size(), 1));
  if (rule_.fibres.share > 0) take_fibres(tissue);
}

void Cortex::take_fibres(const Tissue& tissue) {
  fibres_.resize(batches_.size());
  for (std::size_t place = 0; place < places(); ++place) {
    const Face& face = faces_[std::min(place, faces_.size() - 1)];
    write_fibres(rule_.fibres, face, rule_.side == CellSide::apical, gather(tissue.rest_positions, face.nodes),
                 fibres_[place / batch_size], place % batch_size);
  }
  if (!rule_.fibres.turn()) return;
  axes_ = CellAxes(tissue, rule_.side, rule_.fibres.axis);
  for (const Face& face : faces_) rest_corners_.push_back(gather(tissue.rest_positions, face.nodes));
}

// Turn fibres to the axes of their cells at the beginning of a step.
void Cortex::turn_fibres(const Step& step) const {
  if (!rule_.fibres.turn() || std::ranges::equal(turned_at_, step.previous_positions)) return;
  kept_ = {};
  turned_at_.assign(step.previous_positions.begin(), step.previous_positions.end());
  for (std::size_t place = 0; place < places(); ++place) {
    const std::size_t f = std::min(place, faces_.size() - 1);
    write_fibres(rule_.fibres.share, axes_.of(faces_[f].cell, turned_at_), rest_corners_[f],
                 gather(turned_at_, faces_[f].nodes), fibres_[place / batch_size], place % batch_size);
  }
}

void Cortex::take_rest_areas() {
  constexpr double blunt = 0.05;  // of the area at rest that a Gauss point has
  for (std::size_t place = 0; place < places(); ++place) {
    const std::size_t face = std::min(place, faces_.size() - 1);
    FaceBatch& batch = batches_[place / batch_size];
    batch.blunt[place % batch_size] = 0.25 * blunt * rest_areas_[face];
    for (int i = 0; i < 4; ++i) batch.nodes[i][place % batch_size] = 3 * faces_[face].nodes[i].number();
  }
}

std::optional<double> Cortex::activity_of(CellId cell, double time_s, std::span<const double> internal) const {
  if (!is_active() || !pattern_.cells[cell.index()]) return std::nullopt;
  return activity(cell, time_s, internal, {});
}

double Cortex::rest_area_before(std::size_t face, const Step& step) const {
  if (!flows()) return rest_areas_[face];
  const Memory remembered = memory(step.internal);
  return rest_areas_[face] * step.extrapolated(remembered.areas[face], remembered.areas_before[face]);
}

// Activity of a cell, without its strength.
double Cortex::activity(CellId cell, double time_s, std::span<const double> internal, Height height) const {
  const double part = pattern_.remaining(cell, time_s, height);
  const Memory remembered = memory(internal);
  if (const auto given = remembered.given.of(cell)) return part * *given;
  const double delay_s = pattern_.delays_s[cell.index()], factor = part * pattern_.pulse(cell, time_s);
  if (!activation_.is_used()) return factor * rule_.program.delayed_at(delay_s, time_s);
  const double state = remembered.activation[cell.index()];
  if (!activation_.starts()) return factor * state * rule_.program.delayed_at(delay_s, time_s);
  return state == ShapeActivation::not_yet ? 0 : factor * rule_.program.delayed_at(state, time_s);
}

// The factor on its stiffness.
double Cortex::stiffening(CellId cell, const Step& step, Height height) const {
  const double part = pattern_.remaining(cell, step.end_time_s, height);
  if (!activation_.starts()) return part * rule_.stiffness_program.at(step.end_time_s);
  const double start_s = memory(step.internal).activation[cell.index()];
  return part * rule_.stiffness_program.at(start_s == ShapeActivation::not_yet ? 0 : step.end_time_s - start_s);
}

// Value of a face: value times strength of its cell, or the mean of both cells of a wall; times the share of the face.
template <class OfCell>
double Cortex::of_face(std::size_t f, const OfCell& of_cell) const {
  const auto strong = [&](CellId cell) {
    const double strength = pattern_.strengths[cell.index()];
    return strength == 0 ? 0 : strength * of_cell(cell);
  };
  const Face& face = faces_[f];
  return face.share * (face.beyond ? 0.5 * (strong(face.cell) + strong(*face.beyond)) : strong(face.cell));
}

double Cortex::stiffening_of(std::size_t f, const Step& step) const {
  return of_face(f, [&](CellId cell) { return stiffening(cell, step, heights_[f]); });
}

double Cortex::activity_of_face(std::size_t f, const Step& step) const {
  return of_face(f, [&](CellId cell) { return activity(cell, step.end_time_s, step.internal, heights_[f]); });
}

// Compute what depends on the beginning of a step, before `areas` and `active` read it.
void Cortex::take_factors(const Step& step) const {
  turn_fibres(step);
  const auto& [direction, noise] = rule_.walls;
  if (!rule_.walls.is_used()) return;
  const std::span<const Vec3> positions = direction ? step.previous_positions : std::span<const Vec3>();
  if (factors_.time_s == step.end_time_s && std::ranges::equal(factors_.positions, positions)) return;
  kept_ = {};
  factors_ = {{positions.begin(), positions.end()}, step.end_time_s, std::vector<double>(faces_.size(), 1)};
  if (noise.spread > 0) noise_.go_to(step.end_time_s, pairs_);
  chunks_.for_elements([&](std::size_t f) {
    if (direction) factors_.of_face[f] *= direction_factor(*direction, gather(positions, faces_[f].nodes));
    if (noise.spread > 0) factors_.of_face[f] *= noise_.factor(pairs_[f]);
  });
}

// Let `active` read the mean of the factors at both ends of a step, whose forces do its work.
void Cortex::take_mean_factors(const CompletedStep& completed) const {
  if (!rule_.walls.is_used()) return;
  std::vector<double> mean(faces_.size(), 0);
  Step at = completed.motion;
  for (const double time_s : {completed.end.end_time_s, completed.begin.end_time_s}) {
    at.end_time_s = time_s;
    take_factors(at);
    for (std::size_t f = 0; f < mean.size(); ++f) mean[f] += 0.5 * factors_.of_face[f];
  }
  factors_ = {{}, -1, std::move(mean)};
}

Cortex::Response Cortex::active(std::size_t f, double area, const Step& step, bool with_energy) const {
  const double acting = activity_of_face(f, step);
  const double gamma = factor_of(f, step) * acting * rule_.tension, saturation = rule_.saturation * rest_areas_[f];
  if (saturation <= 0) return {gamma * area, gamma, 0};
  return {with_energy ? gamma * (area - saturation * std::log1p(area / saturation)) : 0,
          gamma * area / (area + saturation), gamma * saturation / ((area + saturation) * (area + saturation))};
}

// Response with the rest area at the end of the step, (A_b + r A)/(1 + r); A_b: previous one (docs/theory/cortex.md).
Cortex::Response Cortex::elastic(std::size_t f, double area, const Step& step, double b, bool with_energy) const {
  const double before = rest_area_before(f, step), r = flows() ? step.rate_s / rule_.relaxation_s : 0;
  const double yielding = before + r * area;
  double k = rule_.stiffness * b;
  if (area < before) k *= rule_.compression_ratio;
  return {with_energy ? k * before / (1 + r) * integral_of_yielding(area / before - 1, r / (1 + r)) : 0,
          k * (area - before) / yielding, k * (1 + r) * before / (yielding * yielding)};
}

Cortex::Response Cortex::crowded(std::size_t f, double area, bool with_energy) const {
  const double c = strengths_[f] * rule_.crowding, ratio = rest_areas_[f] / area;
  return {with_energy ? c * rest_areas_[f] * ratio : 0, -(c * ratio * ratio), 2 * c * ratio * ratio / area};
}

Cortex::Response Cortex::respond(std::size_t f, double area, const Step& step, bool with_energy) const {
  Response sum;
  const auto add = [&](const Response& more) {
    sum.energy += more.energy;
    sum.tension += more.tension;
    sum.slope += more.slope;
  };
  if (rule_.tension != 0) add(active(f, area, step, with_energy));
  if (rule_.stiffness != 0) add(elastic(f, area, step, stiffening_of(f, step), with_energy));
  if (rule_.crowding != 0) add(crowded(f, area, with_energy));
  return sum;
}

// The state of a law whose cells follow a state: the mean of the activities that balanced the beginning and the end of
// a step, since cells act by what they were at the beginning of a step.
std::vector<double> Cortex::acting_midway(std::span<const double> internal) const {
  std::vector<double> midway(internal.begin(), internal.end());
  const Memory remembered = memory(internal);
  const auto first = remembered.activation.data() - internal.data();
  for (std::size_t c = 0; c < remembered.activation_before.size(); ++c)
    midway[first + c] = 0.5 * (remembered.activation[c] + remembered.activation_before[c]);
  return midway;
}

EnergyFlow Cortex::energy_flow(const CompletedStep& completed) const {
  const std::vector<double> internal = acting_midway(completed.motion.internal);
  Step motion = completed.motion;
  motion.internal = internal;
  turn_fibres(completed.motion);
  take_mean_factors(completed);
  const std::vector<double> before = areas(completed.begin.positions), after = areas(completed.end.positions);
  std::vector<EnergyFlow> flows_of(faces_.size());
  chunks_.for_elements([&](std::size_t f) {
    EnergyFlow& flow = flows_of[f];
    if (rule_.tension != 0)
      flow.active = active(f, before[f], motion, true).energy - active(f, after[f], motion, true).energy;
    if (rule_.stiffness != 0) {
      // Responses to unit programs, at areas and rest areas before and after. A rising program supplies energy; a
      // falling one dissipates what it releases. Where the rest area relaxes, so does the work of the tension minus the
      // increase in stored energy.
      const double b0 = stiffening_of(f, completed.begin), b1 = stiffening_of(f, completed.end), mean = 0.5 * (b0 + b1);
      const Response from = elastic(f, before[f], completed.begin, 1, true),
                     to = elastic(f, after[f], completed.end, 1, true);
      const double programmed = (b1 - b0) * 0.5 * (from.energy + to.energy);
      flow.stored = b1 * to.energy - b0 * from.energy;
      flow.active += std::max(0.0, programmed);
      flow.dissipated = std::max(0.0, -programmed);
      if (flows())
        flow.dissipated +=
            mean * (0.5 * (from.tension + to.tension) * (after[f] - before[f]) - (to.energy - from.energy));
    }
    if (rule_.crowding != 0) flow.stored += crowded(f, after[f], true).energy - crowded(f, before[f], true).energy;
  });
  EnergyFlow sum;
  for (const EnergyFlow& flow : flows_of) sum += flow;
  return sum;
}

std::vector<double> Cortex::areas(std::span<const Vec3> positions) const {
  std::vector<double> areas(places());
  const FaceArrays at{batches_.data(), fibres(), faces_.size(), components(positions), nullptr, nullptr, false};
  chunks_.for_batches(
      [&](std::size_t first, std::size_t last) { kernels().write_areas(at, first, last, areas.data()); });
  areas.resize(faces_.size());
  return areas;
}

bool Cortex::FaceTensions::are_of(const Step& step) const {
  return times == std::array{step.end_time_s, step.rate_s, step.ahead} && std::ranges::equal(internal, step.internal) &&
         std::ranges::equal(positions, step.positions);
}

Cortex::FaceTensions Cortex::face_tensions(const Step& step) const {
  take_factors(step);
  FaceTensions faces{areas(step.positions),
                     std::vector<double>(places(), 0.0),
                     {step.positions.begin(), step.positions.end()},
                     {step.internal.begin(), step.internal.end()},
                     {step.end_time_s, step.rate_s, step.ahead}};
  faces.tensions.resize(places(), 0.0);
  chunks_.for_elements([&](std::size_t f) {
    const Response response = respond(f, faces.tensions[f], step, false);
    faces.tensions[f] = response.tension;
    faces.slopes[f] = response.slope;
  });
  return faces;
}

FaceArrays Cortex::kernel_arrays(const Step& step) const {
  take_factors(step);
  if (!kept_.are_of(step)) kept_ = face_tensions(step);
  return {batches_.data(),
          fibres(),
          faces_.size(),
          components(step.positions),
          kept_.tensions.data(),
          kept_.slopes.data(),
          step.semidefinite_tangent};
}

std::vector<double> Cortex::tensions(const Step& step) const {
  std::vector<double> tensions = face_tensions(step).tensions;
  tensions.resize(faces_.size());
  return tensions;
}

std::optional<double> Cortex::mean_tension(const Step& step) const {
  if (faces_.empty()) return std::nullopt;
  const std::vector<double> of_faces = tensions(step), now = areas(step.positions);
  double sum = 0, area = 0;
  for (std::size_t f = 0; f < now.size(); ++f) sum += now[f] * of_faces[f], area += now[f];
  return sum / area;
}

double Cortex::energy(const Step& step) const {
  take_factors(step);
  const std::vector<double> now = areas(step.positions);
  return chunks_.sum_over_elements([&](std::size_t f) { return respond(f, now[f], step, true).energy; });
}

Cortex::Memory Cortex::memory(std::span<const double> internal) const {
  const auto take = [&](bool is_used, std::size_t count) {
    const auto part = internal.first(is_used ? std::min(count, internal.size()) : 0);
    internal = internal.subspan(part.size());
    return part;
  };
  const auto areas = take(flows(), faces_.size()), areas_before = take(flows(), faces_.size());
  const auto activation = take(activation_.is_used(), pattern_.cells.size());
  const auto activation_before = take(follows(), pattern_.cells.size());
  const auto factors = take(internal.size() > pattern_.cells.size(), internal.size() - pattern_.cells.size());
  return {areas, areas_before, activation, activation_before, factors, GivenActivities(internal)};
}

std::vector<double> Cortex::first_internal(const Tissue& tissue) const {
  std::vector<double> internal;
  if (flows()) internal.assign(2 * faces_.size(), 1);
  const std::vector<double> activation = activation_.internal(tissue.rest_positions, 0, {});
  internal = joined(std::move(internal), activation);
  return follows() ? joined(std::move(internal), activation) : internal;
}

std::vector<double> Cortex::next_internal(const Step& step) const {
  const Memory before = memory(step.internal);
  std::vector<double> internal;
  if (flows()) {
    internal = areas(step.positions);
    const double r = step.rate_s / rule_.relaxation_s;
    for (std::size_t f = 0; f < faces_.size(); ++f)
      internal[f] = (rest_area_before(f, step) + r * internal[f]) / ((1 + r) * rest_areas_[f]);
    internal = joined(std::move(internal), before.areas);
  }
  if (activation_.is_used()) internal = joined(std::move(internal), activation_.after(step, before.activation));
  if (follows()) internal = joined(std::move(internal), before.activation);
  return joined(joined(std::move(internal), before.factors), before.given.internal());
}

std::vector<double> Cortex::with_signals(std::span<const double> internal, std::span<const CellArray> signals,
                                         double time_s) const {
  std::vector<double> result(internal.begin(), internal.end());
  const std::span<const double> before = memory(internal).activation;
  if (!before.empty())
    std::ranges::copy(activation_.of_signals(signals, time_s, before),
                      result.begin() + (before.data() - internal.data()));
  return result;
}

std::unique_ptr<Law> Cortex::with_strengths(std::span<const double> factors) const {
  auto law = std::make_unique<Cortex>(*this);
  for (std::size_t c = 0; c < factors.size(); ++c) law->pattern_.strengths[c] *= factors[c];
  for (std::size_t f = 0; f < faces_.size(); ++f) law->strengths_[f] = strength_of(faces_[f], law->pattern_);
  law->kept_ = {};
  return law;
}

std::vector<double> Cortex::program_points_s() const {
  if (activation_.starts()) return pattern_.with_ablation_points({});  // start times of cells are unknown in advance
  return pattern_.with_ablation_points(
      joined(rule_.stiffness_program.times_s(), rule_.program.delayed_points_s(pattern_.delays_s)));
}

std::vector<double> Cortex::program_jumps_s() const {
  if (activation_.starts()) return pattern_.with_ablation_jumps({});
  return pattern_.with_ablation_jumps(
      joined(rule_.stiffness_program.jumps_s(), rule_.program.delayed_jumps_s(pattern_.delays_s)));
}

}  // namespace plica
