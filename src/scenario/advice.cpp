#include "scenario/advice.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "core/units.hpp"
#include "measure/bending_error.hpp"
#include "measure/cells.hpp"
#include "mechanics/active/contraction.hpp"
#include "mechanics/elasticity/shape_memory.hpp"
#include "scenario/acting.hpp"
#include "scenario/check_tissue.hpp"
#include "scenario/embryo_axes.hpp"
#include "scenario/schema.hpp"
#include "scenario/words.hpp"
#include "tissue/faces.hpp"
#include "tissue/mesh_quality.hpp"

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

struct Messages {
  std::vector<std::string> lines;

  template <class... Items>
  void warn(fmt::format_string<Items...> text, Items&&... items) {
    lines.push_back("warning: " + fmt::format(text, std::forward<Items>(items)...));
  }
  template <class... Items>
  void note(fmt::format_string<Items...> text, Items&&... items) {
    lines.push_back("note: " + fmt::format(text, std::forward<Items>(items)...));
  }
};

void advise_on_shape_memory(const Scenario& scenario, const Model& model, Messages& out) {
  for (const auto& law : model.laws)
    if (const auto* springs = dynamic_cast<const ShapeMemory*>(law.get())) {
      const auto [least, most] = std::ranges::minmax(springs->stiffness());
      out.note("shape-memory springs have a stiffness of {:.4g} to {:.4g} nN/um{}", least, most,
               scenario.elasticity.attractor_stiffness_nN_per_um
                   ? "; Young's modulus and Poisson's ratio are not used"
                   : ", derived from Young's modulus and Poisson's ratio (equal mean shear modulus)");
      if (model.tissue.elements.size() > model.tissue.cells.size())
        out.warn(
            "shape memory acts on whole cells, so with several elements per cell the sheet bends up to three times "
            "more easily (docs/theory/shape_memory.md); {}",
            remedies_text({is_of_grid(shape_of(scenario.embryo))
                               ? Remedy{{{"embryo.elements_per_cell", "[1, 1, 1]"}}, "one element per cell"}
                               : Remedy{{{"elasticity.model", "\"corotational\""}}, "another law"}}));
    }
}

// Warns that one element per cell is too soft for neo-Hookean cells.
void advise_on_neo_hookean(const Scenario& scenario, const Tissue& tissue, Messages& out) {
  const ElasticityInput& elasticity = scenario.elasticity;
  if (model_of(elasticity) != ElasticModel::neo_hookean || elasticity.poisson_ratio <= 0.1 ||
      tissue.elements.size() != tissue.cells.size())
    return;
  std::vector<Remedy> remedies = {{{{"embryo.elements_per_cell", "[1, 1, 2]"}}, "two elements through the height"}};
  const auto relaxes = [](const auto& named) { return named.second.relaxation_s.has_value(); };
  if (!elasticity.relaxation_s && std::ranges::none_of(scenario.region_elasticities, relaxes))
    remedies.push_back({{{"elasticity.model", "\"corotational\""}}, "another law"});
  out.warn(
      "neo-hookean cells of one element bend {:.0f} % more easily than Poisson's ratio {} implies "
      "(docs/theory/neo_hookean.md); {}",
      100 * elasticity.poisson_ratio, elasticity.poisson_ratio, remedies_text(remedies));
}

std::set<std::string> used_regions(const Scenario& scenario) {
  std::set<std::string> used;
  for (const ScenarioTable& table : scenario_tables())
    if (table.regions)
      table.regions(scenario, [&](const std::string&, const std::string& region) { used.insert(region); });
  return used;
}

// Warns of a profile that is 0 in every cell. The usual cause is an array with an unexpected range.
void advise_on_profiles(const Scenario& scenario, const Tissue& tissue, Messages& out) {
  for (const Acting& acting : acting_tables(scenario)) {
    const ProfileInput& profile = acting.input.profile;
    const CellPattern pattern = make_pattern(acting.input, tissue);
    if (profile.shape.empty() || std::ranges::max(pattern.strengths) > 0) continue;
    std::string range;
    if (profile.shape == "array") {
      std::vector<double> values;
      for (std::size_t c = 0; c < tissue.cells.size(); ++c)
        if (pattern.cells[c]) values.push_back(tissue.cell_arrays.at(profile.array)[c]);
      const auto [least, most] = std::ranges::minmax(values);
      range = fmt::format(" ({} ranges from {:.4g} to {:.4g} there)", profile.array, least, most);
    }
    out.warn("{}: profile is 0 in every cell of region {}{}; change profile", acting.table, acting.input.region, range);
  }
}

// The axis along which a region ends inside the tissue, by most of the walls at its border; empty if it does not.
std::optional<std::string> axis_of_border(const Tissue& tissue, const CellSet& region) {
  const auto neighbours = wall_neighbours(tissue);
  std::array<int, 2> walls = {0, 0};
  for (std::size_t c = 0; c < region.size(); ++c)
    for (const CellId other : neighbours[c]) {
      if (!region[c] || region[other.index()]) continue;
      const Vec3 way = cell_centre(tissue.cells[other.index()], tissue.rest_positions) -
                       cell_centre(tissue.cells[c], tissue.rest_positions);
      ++walls[std::abs(way.x()) > std::hypot(way.y(), way.z()) ? 0 : 1];
    }
  if (walls[0] + walls[1] == 0) return std::nullopt;
  return walls[0] > walls[1] ? "along" : "across";
}

// Distance from the middle of the region to its border along an axis: that of the farthest centre and half a cell.
double half_width_um(const ActingInput& input, const Tissue& tissue, const std::string& axis) {
  constexpr double far_um = 1e6;
  ActingInput linear = input;
  linear.profile.shape = "linear";
  linear.profile.axis = axis;
  linear.profile.half_width_um = far_um;
  linear.variation.spread = 0;
  const CellPattern pattern = make_pattern(linear, tissue);
  double farthest = 0, volume = 0, height = 0;
  for (std::size_t c = 0; c < pattern.cells.size(); ++c) {
    if (!pattern.cells[c]) continue;
    farthest = std::max(farthest, (1 - pattern.strengths[c]) * far_um);
    volume += cell_volume(tissue, tissue.cells[c], tissue.rest_positions);
    height += cell_height(tissue.cells[c], tissue.rest_positions);
  }
  return farthest + 0.5 * std::sqrt(volume / height);
}

// Warns of each table whose tension is constant, whatever the deformation, and ends at full strength inside the tissue:
// without a profile, at a border of its region. Strains grow there without limit as elements get smaller
// (docs/decisions/0005-spread-springs.md). The remedy is a profile that ends at 0.
void advise_on_abrupt_loads(const Scenario& scenario, const Tissue& tissue, Messages& out) {
  for (const Acting& acting : acting_tables(scenario)) {
    const ActingInput& input = acting.input;
    if (!acting.is_constant || !input.profile.shape.empty()) continue;
    const auto axis = axis_of_border(tissue, tissue.regions.at(input.region));
    if (!axis) continue;
    out.warn(
        "{0}: a constant tension ends at full strength at the border of region {1}, so depth has no limit under "
        "refinement; set {0}.profile = {{ shape = \"linear\", axis = \"{2}\", half_width_um = {3:.3g} }}",
        acting.table, input.region, *axis, half_width_um(input, tissue, *axis));
  }
}

// Says along what the profiles run: the arc or y, by the tissue.
void note_profile_axes(const Scenario& scenario, const Tissue& tissue, Messages& out) {
  const char* across =
      goes_round(tissue) ? "the arc about x, since the tissue goes round it" : "y, since the tissue is open";
  for (const Acting& acting : acting_tables(scenario))
    if (const std::string& axis = acting.input.profile.axis; !acting.input.profile.shape.empty() && !axis.empty())
      out.note("{}: profile runs along {}", acting.table,
               axis == "along"    ? "x"
               : axis == "across" ? across
                                  : "the angle about x from ventral");
}

void advise_on_ablations(const Scenario& scenario, const Tissue& tissue, Messages& out) {
  for (const auto& [name, ablation] : scenario.ablations) {
    if (*ablation.at_s >= scenario.time.end_s)
      out.warn("ablation.{}: the ablation starts after the end of the run ({} s); change at_s or time.end_s", name,
               scenario.time.end_s);
    const CellSet& cells = tissue.regions.at(ablation.region);
    bool takes = false;
    for (const Acting& acting : acting_tables(scenario)) {
      if (!acting.can_be_ablated || !takes_from(ablation, acting.table, acting.input.faces)) continue;
      const CellSet& others = tissue.regions.at(acting.input.region);
      for (std::size_t c = 0; c < cells.size(); ++c) takes = takes || (cells[c] && others[c]);
    }
    if (!takes)
      out.warn(
          "ablation.{}: has no effect, since no selected cortex or contraction acts on these faces in region {}; "
          "change faces, only or region",
          name, ablation.region);
  }
}

int longest_axis(const Vectors& positions) {
  Eigen::AlignedBox3d box;
  for (const Vec3& position : positions) box.extend(position);
  int axis = 0;
  // The tolerance ignores rounding in a sphere.
  if (const Vec3 size = box.sizes(); size.maxCoeff(&axis) <= 1.05 * size.x()) axis = 0;
  return axis;
}

bool any_force_acts(const Scenario& scenario) {
  return std::ranges::any_of(acting_tables(scenario), [](const Acting& table) {
    return std::ranges::any_of(table.forces, [](const Acting::Force& force) { return force.value != 0; });
  });
}

// Warns of tables without effect, and of times after the end of the run.
void advise_on_effects(const Scenario& scenario, const Model& model, Messages& out) {
  if (!any_force_acts(scenario) && scenario.divisions.empty() && scenario.growths.empty())
    out.warn(
        "no force acts, so the embryo does not move; add [contraction], [cortex], [pressure], [growth] or [division]");
  for (const auto& [name, contraction] : scenario.contractions)
    if (contraction.stiffness_nN_per_um == 0 && contraction.preload_nN == 0 && contraction.tension_mN_per_m == 0)
      out.warn(
          "contraction.{}: has no effect, since stiffness, pre-tension and tension are 0; set stiffness_nN_per_um, "
          "preload_nN or tension_mN_per_m",
          name);
  const std::set<std::string> used = used_regions(scenario);
  for (const auto& [name, region] : scenario.regions)
    if (!used.contains(name)) out.note("region.{}: no table uses this region", name);
  for (const auto& [name, division] : scenario.divisions)
    if (division.at_s && *division.at_s >= scenario.time.end_s)
      out.warn("division.{}: the division occurs after the end of the run ({} s); change at_s or time.end_s", name,
               scenario.time.end_s);
  for (const auto& [name, monitor] : scenario.monitors)
    if (monitor.at_s && *monitor.at_s > scenario.time.end_s)
      out.warn("monitor.{}: at_s is after the end of the run ({} s); change at_s or time.end_s", name,
               scenario.time.end_s);
  advise_on_ablations(scenario, model.tissue, out);
  for (const auto& [name, contraction] : scenario.contractions)
    if (contraction.border.empty() && (contraction.stiffness_nN_per_um > 0 || contraction.preload_nN > 0))
      out.note(
          "contraction.{}: every edge carries a spring, so a region of smaller cells contracts more strongly; use "
          "tension_mN_per_m for a tension independent of cell size",
          name);
  for (const auto& [name, contraction] : scenario.contractions)
    if (!contraction.program.activity.empty() && std::ranges::max(contraction.program.activity) == 0)
      out.warn("contraction.{}: program is 0 at all times; set an activity above 0", name);
  for (const auto& law : model.laws)
    if (const auto* contraction = dynamic_cast<const Contraction*>(law.get());
        contraction != nullptr && contraction->last_program_point_s() > scenario.time.end_s)
      out.warn("{}: program extends beyond the end of the run ({} s); change program or time.end_s", law->label(),
               scenario.time.end_s);
  for (const auto& [name, cortex] : scenario.cortices)
    for (const ProgramInput* program : {&cortex.program, &cortex.stiffness_program})
      if (!program->time_s.empty() && program->time_s.back() > scenario.time.end_s)
        out.warn("cortex.{}: program extends beyond the end of the run ({} s); change program or time.end_s", name,
                 scenario.time.end_s);
  if (scenario.time.step_s && *scenario.time.step_s > scenario.time.end_s)
    out.warn("time.step_s: the time step is longer than the run; reduce step_s or increase end_s");
}

// Notes on elasticity, volumes and time steps.
void advise_on_solver(const Scenario& scenario, const Model& model, Messages& out) {
  advise_on_profiles(scenario, model.tissue, out);
  advise_on_abrupt_loads(scenario, model.tissue, out);
  note_profile_axes(scenario, model.tissue, out);
  advise_on_shape_memory(scenario, model, out);
  if (any_force_acts(scenario) && model_of(scenario.elasticity) == ElasticModel::corotational &&
      elements_through_height(model.tissue) == 1)
    out.note(
        "one element through the height bends too easily where cells bend far, so depth at given forces is uncertain "
        "by 5 to 20 %; compare with {}",
        finer_mesh(scenario, 1));
  if (method_of(scenario.volume) == VolumeMethod::coupled &&
      model_of(scenario.elasticity) != ElasticModel::shape_memory)
    out.note(
        "cell volumes are conserved exactly, so Poisson's ratio affects only the shear modulus and the dilatation "
        "within a cell");
  advise_on_neo_hookean(scenario, model.tissue, out);
  if (const auto onset = gradual_onset(scenario); onset && !is_of_grid(shape_of(scenario.embryo)))
    out.note("forces act in full from t = 0, so the first steps are short and lose energy; {}",
             remedies_text({*onset}));
  if (const std::string why = what_bars_second_order(scenario);
      !why.empty() && !scenario.given_at.contains("time.integrator"))
    out.note("time.integrator is \"backward-euler\", since \"bdf2\" does not support {}", why);
  if (method_of(scenario.volume) == VolumeMethod::projection) {
    out.note("volumes are projected after the forces act, so the equilibrium depends on time.step_s");
    if (!scenario.time.step_s && scenario.volume.projection_weights == "equal")
      out.warn(
          "the equilibrium of a projection with equal weights depends on the step length, so adaptive steps stay "
          "short; set time.step_s to a number");
  }
}

// Notes on the vitelline membrane.
void advise_on_shell(const Scenario& scenario, const Tissue& tissue, Messages& out) {
  if (scenario.vitelline.enabled && scenario.vitelline.gap_um > 0)
    out.note("the initial gap to the vitelline membrane is {} um", scenario.vitelline.gap_um);

  if (scenario.vitelline.enabled && shape_of(scenario.embryo) == EmbryoShape::file) {
    const Capsule& mesh = *tissue.outer_shape->capsule();
    const double radius_um = mesh.radius_um + scenario.vitelline.gap_um;
    out.note("the vitelline membrane is the spherocylinder along x around the mesh, {:.4g} um long and {:.4g} um wide",
             2 * (mesh.half_axis_um + radius_um), 2 * radius_um);
    if (const int axis = longest_axis(tissue.rest_positions); axis != 0)
      out.warn(
          "the mesh is longest along {}, but the axis of the vitelline membrane is x, so the membrane is far wider "
          "than the mesh; rotate the mesh so that its long axis is x",
          axis == 1 ? "y" : "z");
  }
}

// Warns of units and of a furrow that is not measured where cells contract.
void advise_on_furrow(const Scenario& scenario, const Tissue& tissue, Messages& out) {
  if (const std::string text = unit_warning(scenario.embryo, tissue); !text.empty()) out.warn("{}", text);
  for (const std::string& remark : tissue.remarks) out.note("{}", remark);
  const std::vector<std::string> regions = contracting_regions(scenario, tissue);
  const std::string& measured = scenario.furrow.region;
  const bool is_furrow = have_furrow(axes_of(scenario.embryo));
  const char* fold = is_furrow ? "furrow" : "fold";
  if (measured.empty() && regions.size() > 1)
    out.warn(
        "contractions act on the regions {}, and the {} is measured on the largest, {}; set furrow.region to measure "
        "another",
        fmt::join(regions, ", "), fold, regions.front());
  if (!measured.empty() && !regions.empty() && std::ranges::find(regions, measured) == regions.end())
    out.warn(
        "furrow.region: the {} is measured on region {}, but apical surfaces contract in {}; set furrow.region to a "
        "contracting region",
        fold, measured, fmt::join(regions, ", "));
  const bool is_off_centre = is_from_file(shape_of(scenario.embryo)) && !scenario.embryo.centre;
  if (!measured.empty() || !regions.empty())
    if (make_furrow_sites(scenario, tissue).vml.empty())
      out.warn(
          "region {} does not intersect the plane y = 0, so {} no value; use [monitor.NAME] with quantity = "
          "\"depth\"{}",
          measured.empty() ? regions.front() : measured,
          is_furrow ? "furrow depth, furrow lips and VML have" : "the fold depth has",
          is_off_centre ? ", or set embryo.centre = true" : "");
}

void advise_on_mesh(const Scenario& scenario, const Tissue& tissue, Messages& out) {
  const MeshQuality quality = mesh_quality(tissue, tissue.rest_positions);
  out.note("{} cells, {} elements, {} nodes; cell volume {:.0f} to {:.0f} um3, apical area {:.0f} to {:.0f} um2",
           tissue.cells.size(), tissue.elements.size(), tissue.node_count(), quality.volume_um3.min,
           quality.volume_um3.max, quality.apical_area_um2.min, quality.apical_area_um2.max);
  if (const std::size_t planes = scenario.embryo.mirror.size(); planes > 0)
    out.note("{} of these cells are solved, the others are mirror images (embryo.mirror)",
             tissue.cells.size() >> planes);
  if (quality.min_scaled_jacobian < 0.2)
    out.warn(
        "the lowest scaled Jacobian of an element is {:.2f} (1: cuboid), so results near it are inaccurate; improve "
        "the mesh",
        quality.min_scaled_jacobian);
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
  const EmbryoShape shape = shape_of(scenario.embryo);
  if (shape == EmbryoShape::file) return fmt::format("a mesh of {} elements through the height", 2 * elements);
  if (!is_of_grid(shape)) return fmt::format("embryo.layers = {}", 2 * elements);
  const auto& [along, across, high] = scenario.embryo.elements_per_cell;
  return fmt::format("embryo.elements_per_cell = [{}, {}, {}]", along, across, 2 * high);
}

std::vector<std::string> advice(const Scenario& scenario, const Model& model) {
  Messages out;
  advise_on_effects(scenario, model, out);
  advise_on_solver(scenario, model, out);
  advise_on_shell(scenario, model.tissue, out);
  advise_on_furrow(scenario, model.tissue, out);
  advise_on_mesh(scenario, model.tissue, out);
  return out.lines;
}

}  // namespace plica
