#include "measure/closing.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/units.hpp"
#include "measure/cells.hpp"
#include "measure/measure_set.hpp"
#include "mechanics/constraints/enclosed_volume.hpp"
#include "mechanics/contact/self_contact.hpp"
#include "tissue/faces.hpp"

namespace plica {
namespace {

constexpr double knee_up_to_um = 20;

// Length of the union of intervals.
double covered(std::vector<Extent> intervals) {
  std::ranges::sort(intervals, {}, &Extent::low);
  double sum = 0, end = -std::numeric_limits<double>::infinity();
  for (const auto& [low, high] : intervals) {
    sum += std::max(0.0, high - std::max(low, end));
    end = std::max(end, high);
  }
  return sum;
}

}  // namespace

std::optional<ContactState> contact_state(const Model& model, const State& state) {
  std::optional<ContactState> result;
  std::vector<Extent> closed;
  for (std::size_t l = 0; l < model.laws.size(); ++l) {
    const SelfContact* law = model.laws[l]->self_contact();
    if (law == nullptr) continue;
    if (!result) result.emplace();
    if (l >= state.internals.size()) continue;
    for (const SelfContact::Pair& pair : SelfContact::pairs_of(state.internals[l])) {
      result->least_gap_um = std::min(result->least_gap_um.value_or(pair.first_gap), pair.first_gap);
      if (pair.first_gap >= pair.distance) continue;
      ++result->pairs;
      if (law->side() != CellSide::apical) continue;
      const Vectors& at_rest = model.tissue.rest_positions;
      if (pair.p.at(at_rest).y() * pair.q.at(at_rest).y() >= 0) continue;  // both on one side
      Extent reach;
      for (const SurfacePlace* place : {&pair.p, &pair.q})
        for (const NodeId node : place->all_nodes()) reach.take(state.positions[node.index()].x());
      closed.push_back(reach);
      if (reach.low <= 0 && reach.high >= 0) result->middle_is_closed = true;
    }
  }
  if (!closed.empty()) {
    const Extent length = extent_along(model.tissue);
    result->closed_length_ratio = covered(std::move(closed)) / (length.high - length.low);
  }
  return result;
}

FluidOfModel enclosed_fluid(const Model& model) {
  FluidOfModel found;
  for_held_constraints(model, [&](const Constraint& constraint, std::size_t first, std::size_t) {
    if (const EnclosedFluid* fluid = constraint.enclosed_fluid()) found = {fluid, first};
  });
  for (const auto& law : model.laws)
    if (const EnclosedFluid* fluid = law->enclosed_fluid()) found = {fluid, std::nullopt};
  return found;
}

std::optional<Enclosed> enclosed(const Model& model, const State& state) {
  const auto [fluid, multiplier] = enclosed_fluid(model);
  if (fluid == nullptr) return std::nullopt;
  return Enclosed{fluid->volume().ratio(state.positions),
                  fluid->pressure(state.positions, multiplier ? state.multipliers[*multiplier] : 0)};
}

std::optional<double> fluid_under_shell_um3(const Model& model, std::span<const Vec3> positions) {
  const std::optional<double> inside = volume_inside_apices(model.tissue, positions);
  if (!inside) return std::nullopt;
  for (const auto& obstacle : model.obstacles)
    if (const OuterShape* shell = obstacle->shell()) return shell->volume() - *inside;
  return std::nullopt;
}

namespace {

constexpr double degree = std::numbers::pi / 180, flank_from = 60 * degree, flank_to = 120 * degree;

// Area between the cut of a surface at x = 0 and the axis on the flanks: signed triangles between each piece of the cut
// and the axis, clipped to the flanks.
double area_to_axis(std::span<const Facet> facets, std::span<const Vec3> positions) {
  using Place = Eigen::Vector2d;  // outward from the middle of the flank (y, on either side), upward (z)
  // Clip a piece by the line through the axis at this angle from the middle of the flank.
  const auto clip = [](Place& a, Place& b, const Place& inward) {
    const double of_a = inward.dot(a), of_b = inward.dot(b);
    if (of_a < 0 && of_b < 0) return false;
    if (of_a < 0) a += of_a / (of_a - of_b) * (b - a);
    if (of_b < 0) b += of_b / (of_b - of_a) * (a - b);
    return true;
  };
  const double half = 0.5 * (flank_to - flank_from);
  double sum = 0;
  const auto take = [&](const std::array<Vec3, 3>& corners) {
    std::array<Place, 2> ends;  // where the border of the triangle enters and leaves x >= 0
    int crossings = 0;
    for (int i = 0; i < 3; ++i) {
      const Vec3 &a = corners[i], &b = corners[(i + 1) % 3];
      if ((a.x() < 0) == (b.x() < 0)) continue;
      const Vec3 at = a + a.x() / (a.x() - b.x()) * (b - a);
      ends[a.x() < 0 ? 0 : 1] = {at.y(), at.z()};
      ++crossings;
    }
    if (crossings == 0) return;
    for (const double side : {-1.0, 1.0}) {
      Place a(side * ends[0].x(), ends[0].y()), b(side * ends[1].x(), ends[1].y());
      if (!clip(a, b, {std::sin(half), std::cos(half)}) || !clip(a, b, {std::sin(half), -std::cos(half)})) continue;
      sum += 0.5 * side * (a.x() * b.y() - a.y() * b.x());
    }
  };
  for (const Facet& facet : facets) {
    const std::array<Vec3, 4> x = gather(positions, facet);
    const Vec3 middle = 0.25 * (x[0] + x[1] + x[2] + x[3]);
    for (int i = 0; i < 4; ++i) take({x[i], x[(i + 1) % 4], middle});
  }
  return sum;
}

}  // namespace

std::optional<double> flank_section_area(const Tissue& tissue, std::span<const Vec3> positions) {
  if (!tissue.outer_shape) return std::nullopt;
  // Basal facets are oriented inward, so their area is subtracted.
  return std::abs(area_to_axis(tissue.apical_facets, positions) + area_to_axis(tissue.basal_facets, positions));
}

std::optional<double> flank_volume(const Tissue& tissue, std::span<const Vec3> positions) {
  if (!tissue.outer_shape) return std::nullopt;
  constexpr double from = flank_from, to = flank_to;
  const Extent length = extent_along(tissue);
  const double quarter = (length.high - length.low) / 4, middle = (length.high + length.low) / 2;
  double sum = 0;
  for (const Cell& cell : tissue.cells) {
    if (std::abs(cell_centre(cell, tissue.rest_positions).x() - middle) > quarter) continue;
    // Angles from the ventral midline: lower and upper half of the midpoints of apicobasal edges.
    const std::size_t sides = cell.sides(), half = sides / 2;
    std::vector<double> angles;
    for (std::size_t i = 0; i < sides; ++i) {
      const Vec3 edge = positions[cell.corners[i].index()] + positions[cell.corners[i + sides].index()];
      angles.push_back(std::atan2(std::abs(edge.y()), -edge.z()));
    }
    std::ranges::sort(angles);
    double low = 0, high = 0;
    for (std::size_t i = 0; i < half; ++i)
      low += angles[i] / static_cast<double>(half), high += angles[sides - 1 - i] / static_cast<double>(half);
    const double part = (std::min(high, to) - std::max(low, from)) / (high - low);
    if (part > 0) sum += part * cell_volume(tissue, cell, positions);
  }
  return sum;
}

std::optional<Knee> knee(std::span<const double> times_s, std::span<const double> depths_um) {
  std::size_t count = 0;
  while (count < depths_um.size() && depths_um[count] < knee_up_to_um) ++count;
  if (count == depths_um.size() || ++count < 8) return std::nullopt;
  // Weight: half of the time to either neighbour.
  const auto weight = [&](std::size_t i) {
    return 0.5 * (times_s[std::min(i + 1, count - 1)] - times_s[i == 0 ? 0 : i - 1]);
  };
  // Fit depth = a + b t + c max(0, t - break) with the break of least residual.
  std::optional<Knee> best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t at = 2; at + 2 < count; ++at) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Vec3 right = Vec3::Zero();
    const auto shape = [&](std::size_t i) { return Vec3(1, times_s[i], std::max(0.0, times_s[i] - times_s[at])); };
    for (std::size_t i = 0; i < count; ++i) {
      normal += weight(i) * shape(i) * shape(i).transpose();
      right += weight(i) * depths_um[i] * shape(i);
    }
    const Vec3 line = normal.ldlt().solve(right);
    double left = 0;
    for (std::size_t i = 0; i < count; ++i) left += weight(i) * std::pow(line.dot(shape(i)) - depths_um[i], 2);
    if (!(left < least)) continue;
    least = left;
    best = Knee{times_s[at], line[0] + line[1] * times_s[at]};
  }
  return best;
}

std::optional<double> time_of_reaching(std::span<const double> times_s, std::span<const double> values, double level) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] < level) continue;
    if (i == 0) return times_s[0];
    const double part = (level - values[i - 1]) / (values[i] - values[i - 1]);
    return times_s[i - 1] + part * (times_s[i] - times_s[i - 1]);
  }
  return std::nullopt;
}

std::optional<double> FurrowSpeeds::speed_ratio() const {
  constexpr double rounding = 1e-12;  // relative to the speed of the ends: a slower centre counts as still
  if (!vml_speed_um_per_s || !vce_speed_um_per_s || !(*vml_speed_um_per_s > rounding * *vce_speed_um_per_s))
    return std::nullopt;
  return *vce_speed_um_per_s / *vml_speed_um_per_s;
}

SpeedHistory speed_history(std::span<const FurrowSpeeds> rows) {
  SpeedHistory history;
  double fastest_middle = 0;
  for (const FurrowSpeeds& row : rows) fastest_middle = std::max(fastest_middle, row.vml_speed_um_per_s.value_or(0));
  const auto lead = [](const FurrowSpeeds& row) { return *row.vce_speed_um_per_s - *row.vml_speed_um_per_s; };
  std::optional<std::size_t> peak;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!rows[i].vml_speed_um_per_s || *rows[i].vml_speed_um_per_s <= 0.01 * fastest_middle) continue;
    if (!peak || lead(rows[i]) > lead(rows[*peak])) peak = i;
  }
  if (!peak) return history;
  history.peak_ratio = rows[*peak].speed_ratio();
  history.peak_ratio_time_s = rows[*peak].time_s;
  if (lead(rows[*peak]) <= 0) return history;  // the ends never lead
  for (std::size_t i = *peak + 1; i < rows.size(); ++i) {
    const double before = lead(rows[i - 1]), after = lead(rows[i]);
    if (after > 0) continue;
    const double part = before > 0 ? before / (before - after) : 0;
    const auto between = [&](double a, double b) { return a + part * (b - a); };
    history.ends_lead_until_s = between(rows[i - 1].time_s, rows[i].time_s);
    history.vml_displacement_at_equal_speed_um =
        between(*rows[i - 1].vml_displacement_um, *rows[i].vml_displacement_um);
    history.vce_displacement_at_equal_speed_um =
        between(*rows[i - 1].vce_displacement_um, *rows[i].vce_displacement_um);
    break;
  }
  return history;
}

namespace {

using enum InSummary;
using M = ColumnInput;

std::optional<ContactState> contact_of_step(const M& m) { return contact_state(m.model, m.state); }
std::optional<Enclosed> enclosed_of_step(const M& m) { return enclosed(m.model, m.state); }

std::any begin_contact(const Subject& s) { return kept_if(contact_state(s.model, State()).has_value()); }

// Lumen volume; empty for an open sheet, also for a slice, whose symmetric boundaries pass the test of closure.
std::optional<double> rest_lumen_volume(const Subject& s) {
  const Tissue& tissue = s.model.tissue;
  return encloses(tissue, tissue.basal_facets) ? lumen_volume(tissue, tissue.rest_positions) : std::nullopt;
}

std::optional<double> lumen_ratio(const M& m) {
  const auto volume = lumen_volume(m.model.tissue, m.state.positions);
  return volume ? std::optional(*volume / m.of_set<double>()) : std::nullopt;
}

std::optional<double> pressure_Pa(const M& m) {
  const auto& enclosed = m.once(enclosed_of_step);
  return enclosed ? std::optional(enclosed->pressure_kPa / units::pascal) : std::nullopt;
}

struct Flanks {
  double volume_um3, section_um2;
};

Flanks flanks(const Tissue& tissue, std::span<const Vec3> positions) {
  return {flank_volume(tissue, positions).value_or(0), flank_section_area(tissue, positions).value_or(0)};
}

}  // namespace

MeasureSet contact_set() {
  return set_of(
      "contact", "self_contact.surface", begin_contact,
      {count(
           {"contact_pairs", largest, "Contact pairs under pressure.", part_of(contact_of_step, &ContactState::pairs)}),
       {"min_contact_distance_um", least, "Smallest gap between facing places of a surface; negative for penetration.",
        [](const M& m) { return m.once(contact_of_step)->least_gap_um; }}});
}

MeasureSet closing_set() {
  return set_of(
      "closing", "self_contact.surface", begin_contact,
      {{"closed_length_ratio", last,
        "Fraction of the embryo's length with furrow closure: apical surfaces left and right of the midline in "
        "contact.",
        part_of(contact_of_step, &ContactState::closed_length_ratio)},
       count({"lips_closed", last,
              "Furrow closure at x = 0: 1 if apical surfaces of both sides are in contact there, whichever cells "
              "meet.",
              part_of(contact_of_step, &ContactState::middle_is_closed)})},
      of_embryo);
}

MeasureSet lumen_set() {
  return set_of(
      "lumen", "a closed basal surface", [](const Subject& s) { return kept_if(rest_lumen_volume(s)); },
      {costly({"lumen_volume_ratio", last, "Volume inside the basal surface / reference volume.", lumen_ratio})});
}

MeasureSet enclosed_set() {
  return set_of("enclosed", "[enclosed.NAME]",
                [](const Subject& s) { return kept_if(enclosed(s.model, rest_state(s.model)).has_value()); },
                {{"enclosed_volume_ratio", last, "Enclosed volume (yolk or lumen) / target volume.",
                  part_of(enclosed_of_step, &Enclosed::volume_ratio)},
                 {"yolk_pressure_Pa", last, "Pressure of the enclosed volume, relative to the perivitelline fluid.",
                  pressure_Pa}});
}

MeasureSet shell_set() {
  return set_of("shell", "a vitelline membrane", [](const Subject& s) { return kept_if(!s.model.obstacles.empty()); },
                {{"max_shell_penetration_um", largest, "Largest distance of a node outside the vitelline membrane.",
                  of(shell_penetration)}});
}

MeasureSet perivitelline_set() {
  return set_of("perivitelline", "a vitelline membrane around a closed tissue",
                [](const Subject& s) {
                  // The shell's caps are not those of a slice.
                  return kept_if(rest_lumen_volume(s) && fluid_under_shell_um3(s.model, s.model.tissue.rest_positions));
                },
                {costly({"shell_fluid_um3", last,
                         "Perivitelline volume, between apical surface and vitelline membrane; its pressure is 0.",
                         of(fluid_under_shell_um3)})});
}

MeasureSet flanks_set() {
  return set_of(
      "flanks", "a built embryo",
      [](const Subject& s) {
        const Flanks at_rest = flanks(s.model.tissue, s.model.tissue.rest_positions);
        return at_rest.volume_um3 > 0 && at_rest.section_um2 > 0 ? std::any(at_rest) : std::any();
      },
      {costly({"flank_volume_ratio", last,
               "Volume of the lateral ectoderm / reference volume: cells at 60–120° from the ventral midline, "
               "middle half of the length, weighted by their part of the angle.",
               [](const M& m) {
                 return *flank_volume(m.model.tissue, m.state.positions) / m.of_set<Flanks>().volume_um3;
               }}),
       costly({"flank_section_area_ratio", last,
               "Cross-sectional area of the lateral ectoderm at x = 0 (60–120° from the ventral midline, both "
               "sides) / reference area; comparable with micrographs and two-dimensional models.",
               [](const M& m) {
                 return *flank_section_area(m.model.tissue, m.state.positions) / m.of_set<Flanks>().section_um2;
               }})},
      of_embryo);
}

}  // namespace plica
