#include "scenario/remedies.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/units.hpp"
#include "scenario/acting.hpp"
#include "scenario/words.hpp"

namespace plica {
namespace {

using Status = StepReport::Status;
using Remedies = std::vector<Remedy>;

constexpr double onset_s = 180;  // within which forces rise

void add_barrier(const Scenario& scenario, Remedies& remedies) {
  if (scenario.elasticity.corner_barrier_Pa.value_or(0) > 0) return;
  remedies.push_back(
      {{{"elasticity.corner_barrier_Pa", fmt::format("{:g}", scenario.elasticity.young_modulus_Pa / 10)}},
       "inversion barrier"});
}

/// Half of each force, at most what strains cells by about 1.
struct WeakerForces {
  Remedy remedy{{}, "weaker forces, another result"};
  double largest_ratio = 0;  // of a force to that

  void reduce(const std::string& key, double value, double most) {
    if (value == 0) return;
    largest_ratio = std::max(largest_ratio, std::abs(value) / most);
    remedy.settings.push_back({key, fmt::format("{:.3g}", std::copysign(std::min(std::abs(value) / 2, most), value))});
  }
};

WeakerForces weaker_forces(const Scenario& scenario) {
  WeakerForces weaker;
  for (const Acting& acting : acting_tables(scenario))
    for (const auto& [key, value, most] : acting.forces)
      weaker.reduce(fmt::format("{}.{}", acting.table, key), value, most);
  return weaker;
}

/// Half the volume that daughters gain, where they have begun to grow.
Remedy less_growth(const Scenario& scenario, double failed_at_s) {
  constexpr double none = 0.5;
  Remedy remedy{{}, "less growth, another result"};
  for (const auto& [name, input] : scenario.divisions)
    if (input.daughter_volume_ratio > none && failed_at_s > input.at_s.value_or(0))
      remedy.settings.push_back({fmt::format("division.{}.daughter_volume_ratio", name),
                                 fmt::format("{:.3g}", std::max(none, input.daughter_volume_ratio / 2))});
  return remedy;
}

/// Remedies for elements that invert and forces that find no balance.
Remedies against_inversion(const Scenario& scenario, double failed_at_s) {
  Remedies remedies;
  const WeakerForces weaker = weaker_forces(scenario);
  constexpr double beyond_help = 1000;
  if (weaker.largest_ratio < beyond_help) {
    add_barrier(scenario, remedies);
    if (Remedy less = less_growth(scenario, failed_at_s); !less.settings.empty()) remedies.push_back(std::move(less));
    // Later failures have another cause than the onset.
    if (const auto onset = gradual_onset(scenario); onset && failed_at_s < onset_s) remedies.push_back(*onset);
  }
  if (!weaker.remedy.settings.empty()) remedies.push_back(weaker.remedy);
  return remedies;
}

/// A filled shell leaves no room for a fold that keeps the volume inside the apical surface.
Remedies more_room(const Scenario& scenario) {
  Remedies remedies;
  if (scenario.volume.projection_surface != "cells")
    remedies.push_back({{{"volume.projection_surface", "\"cells\""}}, "cell volumes only"});
  if (scenario.vitelline.enabled && scenario.vitelline.gap_um == 0)
    remedies.push_back({{{"vitelline.gap_um", "0.5"}}, "room inside the membrane"});
  return remedies;
}

}  // namespace

std::optional<Remedy> gradual_onset(const Scenario& scenario) {
  const double minutes = std::min(onset_s, scenario.time.end_s / 2) / units::minute;
  Remedy remedy{{}, "gradual onset"};
  for (const Acting& acting : acting_tables(scenario))
    if (acting.has_sudden_onset && acting.input.program.activity.empty())
      remedy.settings.push_back(
          {acting.table + ".program", fmt::format("{{ time_min = [0, {:g}], activity = [0, 1] }}", minutes)});
  return remedy.settings.empty() ? std::nullopt : std::optional(std::move(remedy));
}

std::vector<Remedy> remedies_of(const Scenario& scenario, const Failure& failure) {
  switch (failure.status) {
    case Status::inverted_element:
    case Status::no_convergence:
    case Status::singular_system:
    case Status::not_finite:
      return against_inversion(scenario, failure.time_s);
    case Status::no_linear_convergence:
      return {
          {{{"time.cg_max_iterations", fmt::format("{}", std::min(10 * scenario.time.cg_max_iterations, 1'000'000))}},
           "conjugate gradients"}};
    case Status::not_projected:
      return more_room(scenario);
    case Status::converged:
    case Status::interrupted:
      break;
  }
  return {};
}

std::string remedies_text(const std::vector<Remedy>& remedies) {
  std::vector<std::string> texts;
  for (const Remedy& remedy : remedies) {
    std::vector<std::string> settings;
    for (const auto& [key, value] : remedy.settings) settings.push_back(fmt::format("{} = {}", key, value));
    texts.push_back(fmt::format("{} ({})", fmt::join(settings, " and "), remedy.effect));
  }
  return texts.empty() ? "" : fmt::format("set {}", fmt::join(texts, ", or "));
}

std::string finer_mesh(const Scenario& scenario, int elements) {
  if (!scenario.divisions.empty()) return "runs of this mesh only (cells that divide have one element)";
  const EmbryoShape shape = shape_of(scenario.embryo);
  if (shape == EmbryoShape::file) return fmt::format("a mesh of {} elements through the height", 2 * elements);
  if (!is_of_grid(shape)) return fmt::format("embryo.layers = {}", 2 * elements);
  const auto& [along, across, high] = scenario.embryo.elements_per_cell;
  return fmt::format("embryo.elements_per_cell = [{}, {}, {}]", along, across, 2 * high);
}

}  // namespace plica
