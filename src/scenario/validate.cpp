#include "scenario/validate.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <set>

#include "core/clock.hpp"
#include "core/names.hpp"
#include "scenario/embryo_axes.hpp"
#include "scenario/suggest.hpp"
#include "scenario/words.hpp"

namespace plica {
namespace {

constexpr std::int64_t max_elements = 20'000'000;

/// Number of cells of a built shape. A closed sheet has cells on six sides, a slice on four.
std::int64_t cell_count(const EmbryoInput& embryo) {
  const std::int64_t a = embryo.cells[0], b = embryo.cells[1], c = embryo.cells[2];
  const bool has_ends = shape_of(embryo) != EmbryoShape::slice;
  return shape_of(embryo) == EmbryoShape::block ? a * b * c : 2 * (a * b + (has_ends ? b * c : 0) + c * a);
}

/// Keys that the shape does not use are errors if set together with the shape or later, and dropped if inherited from
/// a scenario of another shape.
void check_unused_keys(Scenario& scenario, Input& input) {
  const std::string shape = scenario.embryo.shape;
  for (const Row* row : rows_of("embryo")) {
    if (row->used_by(shape)) continue;
    const std::string address = fmt::format("embryo.{}", row->key);
    if (input.given_with(address, "embryo.shape")) {
      input.report(address, fmt::format("is not used with shape \"{}\"", shape),
                   fmt::format("remove {}, or set shape to {}", row->key, fmt::join(row->options.shapes, " or ")));
    }
    reset_to_default(*row, scenario, "");
  }
  if (shape_of(scenario.embryo) == EmbryoShape::sphere) scenario.embryo.length_um = scenario.embryo.diameter_um;
}

/// Drops inherited selectors that this shape lacks, in regions that have a newer selector.
void drop_unfit_selectors(Scenario& scenario, Input& input) {
  const EmbryoShape shape = shape_of(scenario.embryo);
  std::set<std::string_view> unfit;
  if (!is_of_grid(shape)) unfit = {"face", "cells_along", "cells_across"};
  if (!is_from_file(shape) && scenario.embryo.cell_arrays.empty()) unfit.insert({"array", "above", "below"});
  const std::vector<const Row*> rows = rows_of("region.*");
  for (const auto& named : scenario.regions) {
    const std::string& name = named.first;
    const auto is_new = [&](const Row* row) {
      return input.given_with(fmt::format("region.{}.{}", name, row->key), "embryo.shape");
    };
    if (std::ranges::any_of(rows, [&](const Row* row) { return !unfit.contains(row->key) && is_new(row); }))
      for (const Row* row : rows)
        if (unfit.contains(row->key) && !is_new(row)) reset_to_default(*row, scenario, name);
  }
}

void check_element_count(const EmbryoInput& embryo, Input& input) {
  const auto& per_cell = embryo.elements_per_cell;
  const std::int64_t elements = cell_count(embryo) * per_cell[0] * per_cell[1] * per_cell[2];
  if (elements > max_elements) {
    input.report("embryo.cells", fmt::format("requires {} elements, more than the limit of {}", elements, max_elements),
                 "reduce cells or elements_per_cell");
  }
}

void check_embryo(Scenario& scenario, Input& input) {
  if (!input.sound("embryo.shape")) return;
  check_unused_keys(scenario, input);
  drop_unfit_selectors(scenario, input);
  const EmbryoInput& embryo = scenario.embryo;
  const auto sound = [&](std::string_view key) { return input.sound(fmt::format("embryo.{}", key)); };
  if (is_from_file(shape_of(embryo))) {
    if (embryo.file.empty() && sound("file"))
      input.report("embryo.file", "is missing",
                   shape_of(embryo) == EmbryoShape::file     ? "set file to the mesh file for shape \"file\""
                   : shape_of(embryo) == EmbryoShape::points ? "set file to the table of points for shape \"points\""
                                                             : "set file to the polygon file for shape \"surface\"");
    if (embryo.scale.size() != 3 && sound("scale"))
      input.report("embryo.scale", fmt::format("has length {}", embryo.scale.size()),
                   "set scale to three numbers, along x, y and z");
    if (embryo.rotate_deg.size() != 3 && sound("rotate_deg"))
      input.report("embryo.rotate_deg", fmt::format("has length {}", embryo.rotate_deg.size()),
                   "set rotate_deg to three angles, about x, y and z");
    return;
  }
  if (embryo.curvature_per_um.size() != 2 && sound("curvature_per_um"))
    input.report("embryo.curvature_per_um", fmt::format("has length {}", embryo.curvature_per_um.size()),
                 "set curvature_per_um to two numbers, along x and y");
  if (embryo.belly_sag_um.has_value() != embryo.back_sag_um.has_value())
    input.report(embryo.belly_sag_um ? "embryo.belly_sag_um" : "embryo.back_sag_um",
                 fmt::format("requires {}", embryo.belly_sag_um ? "back_sag_um" : "belly_sag_um"),
                 "set both keys, or neither");
  if ((shape_of(embryo) == EmbryoShape::pill || shape_of(embryo) == EmbryoShape::egg) && sound("length_um") &&
      sound("diameter_um") && embryo.length_um < embryo.diameter_um) {
    input.report("embryo.length_um",
                 fmt::format("{} is less than the diameter, {}", embryo.length_um, embryo.diameter_um),
                 "set length_um to at least diameter_um");
  }
  if (!is_patch(shape_of(embryo)) && sound("cell_height_um") && sound("diameter_um") &&
      embryo.cell_height_um >= embryo.diameter_um / 2) {
    input.report("embryo.cell_height_um", fmt::format("{} leaves no room inside the embryo", embryo.cell_height_um),
                 fmt::format("set cell_height_um below half of diameter_um, {}", embryo.diameter_um / 2));
  }
  if (is_of_grid(shape_of(embryo)) && sound("cells") && sound("elements_per_cell")) check_element_count(embryo, input);
}

void check_axes(const EmbryoInput& embryo, Input& input) {
  if (embryo.axes.empty() || !input.sound("embryo.axes")) return;
  if (const std::string problem = axes_problem(embryo.axes); !problem.empty())
    input.report("embryo.axes", problem, "write, for example, [\"proximal-distal\", \"anterior-posterior\", \"z\"]");
}

void check_shell_drag(const Scenario& scenario, Input& input) {
  const std::string key = "vitelline.drag_Pa_s_per_um";
  if (scenario.vitelline.drag_Pa_s_per_um == 0 || !input.sound(key) || !input.sound("vitelline.enabled")) return;
  if (!scenario.vitelline.enabled)
    input.report(key, "is not used without a vitelline membrane",
                 is_patch(shape_of(scenario.embryo)) ? "remove drag_Pa_s_per_um"
                                                     : "remove drag_Pa_s_per_um, or set enabled to true");
  else if (is_as_in_the_paper(scenario))
    input.report(key, "requires time.scheme \"newton\" and a volume.method other than \"projection\"",
                 "remove drag_Pa_s_per_um, or change time.scheme or volume.method");
}

/// Checks a list of mirror planes or periodic directions (`key` of [embryo]): no repetition, division or projection.
/// `cells`, `feature`: how messages name them.
void check_repeats(const Scenario& scenario, const std::vector<std::string>& named, const std::string& key,
                   const std::string& cells, const std::string& feature, Input& input) {
  const std::string address = "embryo." + key;
  if (std::set(named.begin(), named.end()).size() < named.size())
    return input.report(address, fmt::format("\"{}\" occurs twice", named.back()), "list each direction once");
  if (!scenario.divisions.empty())
    input.report(address, cells + " cannot divide", fmt::format("remove {}, or [division]", key));
  if (is_as_in_the_paper(scenario))
    input.report(
        address, "the paper's algorithm does not support " + feature,
        fmt::format("remove {}, or set time.scheme to \"newton\" and volume.method to \"coupled\" or \"none\"", key));
}

void check_mirror(const Scenario& scenario, Input& input) {
  const std::string address = "embryo.mirror";
  if (scenario.embryo.mirror.empty() || !input.sound(address)) return;
  check_repeats(scenario, scenario.embryo.mirror, "mirror", "mirrored cells", "mirror planes", input);
}

void check_periods(const Scenario& scenario, Input& input) {
  const EmbryoInput& embryo = scenario.embryo;
  const std::string address = "embryo.periodic";
  if (embryo.periodic.empty() || !input.sound(address)) return;
  check_repeats(scenario, embryo.periodic, "periodic", "cells of a periodic sheet", "periodic sheets", input);
  for (const std::string& axis : embryo.periodic)
    if (input.sound("embryo.curvature_per_um") && embryo.curvature_per_um.size() == 2 &&
        embryo.curvature_per_um[meaning_of(words::periods, axis)] != 0)
      input.report("embryo.curvature_per_um",
                   fmt::format("a sheet curved along {} cannot be periodic along {}", axis, axis),
                   fmt::format("set its curvature there to 0, or remove \"{}\" from embryo.periodic", axis));
  if (embryo.periodic.size() == words::periods.size() && meaning_of(words::rims, embryo.rim) &&
      input.sound("embryo.rim"))
    input.report("embryo.rim", "a sheet periodic along x and y has no boundary",
                 "remove rim, or one direction of embryo.periodic");
}

void check_vitelline(Scenario& scenario, Input& input) {
  const EmbryoShape shape = shape_of(scenario.embryo);
  if ((!is_patch(shape) && shape != EmbryoShape::surface) || !input.sound("vitelline.enabled")) return;
  // The file determines whether a surface is closed.
  if (input.place("vitelline.enabled") == nullptr) scenario.vitelline.enabled = false;
  if (scenario.vitelline.enabled && is_patch(shape)) {
    input.report("vitelline.enabled",
                 fmt::format("a vitelline membrane requires a closed embryo, but a {} is open", scenario.embryo.shape),
                 "set enabled to false");
  }
}

void check_dynamics(const DynamicsInput& dynamics, Input& input) {
  if (!input.sound("dynamics.surface_drag_Pa_s_per_um") || !input.sound("dynamics.density_kg_per_m3")) return;
  if (dynamics.surface_drag_Pa_s_per_um == 0 && dynamics.density_kg_per_m3 == 0) {
    input.report("dynamics.surface_drag_Pa_s_per_um", "drag and density are both 0",
                 "set surface_drag_Pa_s_per_um or density_kg_per_m3 above 0");
  }
}

void check_time(const TimeInput& time, Input& input) {
  if (input.sound("time.end_s") && has_come(time.end_s, 0))
    input.report("time.end_s", fmt::format("the run would end before its first step, at {} s", time.end_s),
                 "set end_s to a later time");
  if (!input.sound("time.first_step_s") || !input.sound("time.max_step_s")) return;
  if (time.first_step_s > time.max_step_s) {
    input.report("time.first_step_s", fmt::format("{} is above max_step_s, {}", time.first_step_s, time.max_step_s),
                 "set first_step_s to at most max_step_s");
  }
}

void check_scheme(const Scenario& scenario, Input& input) {
  if (!input.sound("time.scheme") || !input.sound("volume.method") || !input.sound("embryo.shape")) return;
  if (scenario.time.scheme == "linearly-implicit" && method_of(scenario.volume) == VolumeMethod::coupled)
    input.report("time.scheme",
                 "\"linearly-implicit\" does not support volume constraints (volume.method is \"coupled\")",
                 "set volume.method to \"projection\" or \"none\", or scheme to \"newton\"");
  if (!scenario.divisions.empty() && is_as_in_the_paper(scenario))
    input.report(method_of(scenario.volume) == VolumeMethod::projection ? "volume.method" : "time.scheme",
                 "the paper's algorithm does not support division",
                 "set volume.method to \"coupled\" or \"none\" and time.scheme to \"newton\", or remove [division]");
  if (scenario.volume.projection_surface == "embryo" && is_patch(shape_of(scenario.embryo)) &&
      input.sound("volume.projection_surface"))
    input.report("volume.projection_surface", fmt::format("the apical surface of a {} is open", scenario.embryo.shape),
                 "set projection_surface to \"cells\" or \"tissue\"");
}

/// Replaces "automatic" by the value that fits the scenario. Call on a valid scenario.
void resolve_automatic(Scenario& scenario) {
  const bool may_invert = !is_of_grid(shape_of(scenario.embryo)) || !scenario.divisions.empty();
  if (!scenario.elasticity.corner_barrier_Pa)
    scenario.elasticity.corner_barrier_Pa =
        may_invert && !is_as_in_the_paper(scenario) ? scenario.elasticity.young_modulus_Pa / 10 : 0;
  if (scenario.time.integrator == "automatic")
    scenario.time.integrator = what_bars_second_order(scenario).empty() ? "bdf2" : "backward-euler";
}

void check_integrator(const Scenario& scenario, Input& input) {
  if (!input.sound("time.integrator") || scenario.time.integrator != "bdf2") return;
  if (const std::string why = what_bars_second_order(scenario); !why.empty())
    input.report("time.integrator", "\"bdf2\" does not support " + why, "set integrator to \"backward-euler\"");
}

void check_required_keys(const Scenario& scenario, Input& input) {
  for (const TableInfo& info : schema_tables()) {
    if (!info.named()) continue;
    for (const std::string& name : info.names(scenario)) {
      const std::string path = fmt::format("{}.{}", info.stem(), name);
      for (const Row* row : rows_of(info.path)) {
        const std::string address = fmt::format("{}.{}", path, row->key);
        if (row->options.required && input.sound(path) && input.place(address) == nullptr) {
          // A misspelt table name is a frequent cause.
          std::vector<std::string> others = info.names(scenario);
          std::erase(others, name);
          const std::optional<std::string> meant = nearest_name(name, others);
          const std::string table =
              meant ? fmt::format(", or rename the table to {}.{} (nearest match)", info.stem(), *meant) : "";
          input.report(address, "is missing", row->remedy() + table);
        }
      }
    }
  }
}

void check_expectations(const Scenario& scenario, Input& input) {
  for (const auto& [name, expected] : scenario.expect) {
    const std::string path = "expect." + name;
    if (!expected.within && !expected.within_percent && input.sound(path) && input.sound(path + ".within")) {
      input.report(path, "has no tolerance", "set within or within_percent");
    }
  }
}

void check_program(const std::string& table, const ProgramInput& program, Input& input,
                   const std::string& name = "program") {
  const std::string time = fmt::format("{}.{}.time_s", table, name);
  const std::string activity = fmt::format("{}.{}.activity", table, name);
  if (!input.sound(table) || !input.sound(time) || !input.sound(activity)) return;
  if (program.time_s.empty() && program.activity.empty()) return;
  if (program.time_s.empty()) return input.report(time, "is missing", "set time_s or time_min along with activity");
  if (program.activity.empty()) return input.report(activity, "is missing", "set activity to as many values as times");
  if (program.time_s.size() != program.activity.size()) {
    input.report(activity, fmt::format("has length {} for {} times", program.activity.size(), program.time_s.size()),
                 "set activity to as many values as times");
  }
  const auto& times = program.time_s;
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (times[i] < times[i - 1])
      return input.report(time, "the times do not increase",
                          "list times in increasing order; repeat a time once to mark a jump");
    if (i > 1 && times[i] == times[i - 2])
      return input.report(time, fmt::format("{} occurs three times", times[i]), "repeat a time once to mark a jump");
    if (times[i] != times[i - 1] && has_come(times[i], times[i - 1]))
      return input.report(time, fmt::format("{} and {} are closer than {} s", times[i - 1], times[i], instant_s),
                          "repeat a time once to mark a jump");
  }
}

/// Checks regions: selectors available for this embryo, existing names, no cycles.
class RegionCheck {
 public:
  RegionCheck(const Scenario& scenario, Input& input)
      : scenario_(scenario), input_(input), names_(keys_of(scenario.regions)) {
    names_.insert(names_.begin(), "all");
  }

  void check_reference(const std::string& address, const std::string& region) {
    if (region.empty() || !input_.sound("region") || !input_.sound(address)) return;
    if (!input_.sound("region." + region)) return;  // not read; already reported
    if (std::ranges::find(names_, region) != names_.end()) return;
    const bool has_arrays = input_.sound("embryo.shape") && is_from_file(shape_of(scenario_.embryo));
    input_.report(
        address, fmt::format("region \"{}\" does not exist", region),
        did_you_mean(region, names_) +
            (has_arrays ? fmt::format("; if it is an array of the file, add [region.{0}] with array = \"{0}\"", region)
                        : ""));
  }

  void check_references() {
    const auto check_acting = [&](const std::string& table, const auto& it) {
      check_reference(table + ".region", it.region);
      check_reference(table + ".profile.about", it.profile.about);
    };
    for (const auto& [name, it] : scenario_.contractions) check_acting("contraction." + name, it);
    for (const auto& [name, it] : scenario_.cortices) check_acting("cortex." + name, it);
    for (const auto& [name, it] : scenario_.region_elasticities) check_acting("elasticity." + name, it);
    for (const auto& [name, it] : scenario_.holds) check_reference("hold." + name + ".region", it.region);
    for (const auto& [name, it] : scenario_.pressures) check_acting("pressure." + name, it);
    for (const auto& [name, it] : scenario_.divisions) check_reference("division." + name + ".region", it.region);
    for (const auto& [name, it] : scenario_.ablations) check_reference("ablation." + name + ".region", it.region);
    for (const auto& [name, it] : scenario_.monitors) {
      check_reference("monitor." + name + ".region", it.region);
      check_reference("monitor." + name + ".from", it.from);
    }
    check_reference("furrow.region", scenario_.furrow.region);
    for (const auto& [name, region] : scenario_.regions) {
      check_reference("region." + name + ".neighbours_of", region.neighbours_of);
      for (const std::string& other : region.unite) check_reference("region." + name + ".union", other);
      for (const std::string& other : region.intersect) check_reference("region." + name + ".intersect", other);
      for (const std::string& other : region.except) check_reference("region." + name + ".except", other);
    }
  }

  void check_selectors(const std::string& name, const RegionInput& region) {
    const std::string path = "region." + name;
    const bool has_selector = !region.face.empty() || region.cells_along || region.cells_across ||
                              !region.ids.empty() || !region.array.empty() || region.x_um || region.y_um ||
                              region.z_um || region.angle_deg || region.length_percent || region.rows ||
                              !region.neighbours_of.empty() || region.rings || !region.unite.empty() ||
                              !region.intersect.empty() || !region.except.empty();
    const bool has_doubt = std::ranges::any_of(
        input_.doubtful, [&](const std::string& it) { return it == path || it.starts_with(path + "."); });
    if (!has_selector && !has_doubt) {
      input_.report(path, "has no selector",
                    "set face, ids, array, angle_deg, length_percent, x_um, y_um, z_um, rows, neighbours_of, union, "
                    "intersect or except");
    }
    if (region.rings && region.neighbours_of.empty() && input_.sound(path + ".neighbours_of"))
      input_.report(path + ".rings", "is not used without neighbours_of",
                    "set neighbours_of to the region inside the rings");
    if (!input_.sound("embryo.shape")) return;
    const EmbryoShape shape = shape_of(scenario_.embryo);
    for (const auto& [key, value] : {std::pair("above", region.above), {"below", region.below}})
      if (value && region.array.empty() && input_.sound(path + ".array"))
        input_.report(fmt::format("{}.{}", path, key), "is not used without array", "set array");
    if (!region.face.empty() && !is_of_grid(shape)) {
      input_.report(path + ".face", "cells of this shape have no named faces",
                    "use angle_deg, length_percent, ids, array, x_um, y_um or z_um" + instead_of(path + ".face"));
    }
    if (is_of_grid(shape) && input_.sound("embryo.cells")) check_cell_numbers(path, region);
  }

  /// Reports every cycle of regions once, at its first member in alphabetical order.
  void check_circles() {
    std::set<std::string> done;
    for (const auto& [name, region] : scenario_.regions) {
      std::vector<std::string> path;
      follow(name, path, done);
    }
  }

 private:
  // Remedy for a selector inherited from a scenario of another shape.
  [[nodiscard]] std::string instead_of(const std::string& address) const {
    if (input_.given_with(address, "embryo.shape")) return "";
    const std::string region = address.substr(0, address.rfind('.'));
    return fmt::format("; a new selector in [{}] replaces the inherited {}", region, address.substr(region.size() + 1));
  }

  void check_cell_numbers(const std::string& path, const RegionInput& region) {
    const auto& [a, b, c] = scenario_.embryo.cells;
    if (region.face == "ventral" || region.face == "dorsal") check_strip(path, region, a, b);
    if (region.face == "left" || region.face == "right") check_strip(path, region, a, c);
    if (region.face == "anterior" || region.face == "posterior") check_strip(path, region, b, c);
    for (const std::string key : {".cells_along", ".cells_across"}) {
      const bool missing = region.face.empty() && input_.sound(path + ".face") && input_.sound(path + key);
      if (missing && input_.place(path + key) != nullptr) {
        input_.report(path + key, "is not used without face", "set face");
      }
    }
    const std::int64_t cells = cell_count(scenario_.embryo);
    if (!region.ids.empty() && *std::ranges::max_element(region.ids) >= cells) {
      input_.report(path + ".ids", fmt::format("cell {} does not exist", *std::ranges::max_element(region.ids)),
                    fmt::format("set ids to numbers from 0 to {}", cells - 1));
    }
  }

  void check_strip(const std::string& path, const RegionInput& region, int along, int across) {
    if (region.cells_along) check_centred(path + ".cells_along", *region.cells_along, along);
    if (region.cells_across) check_centred(path + ".cells_across", *region.cells_across, across);
  }

  void check_centred(const std::string& address, int wanted, int available) {
    if (wanted > available) {
      input_.report(address, fmt::format("{} exceeds the {} cells of the face in this direction", wanted, available),
                    fmt::format("set {} to at most {}", address.substr(address.rfind('.') + 1), available));
    } else if ((available - wanted) % 2 != 0) {
      const std::string fewer = wanted > 1 ? fmt::format("{} or ", wanted - 1) : "";
      input_.report(address, fmt::format("{} cells cannot be centred on {}", wanted, available),
                    fmt::format("set {} to {}{} (both numbers odd, or both even)",
                                address.substr(address.rfind('.') + 1), fewer, wanted + 1));
    }
  }

  void follow(const std::string& name, std::vector<std::string>& path, std::set<std::string>& done) {
    const auto region = scenario_.regions.find(name);
    if (region == scenario_.regions.end()) return;
    if (const auto start = std::ranges::find(path, name); start != path.end()) {
      const std::vector<std::string> cycle(start, path.end());
      input_.report("region." + *start, fmt::format("refers to itself: {} > {}", fmt::join(cycle, " > "), name),
                    "remove one of these references");
      return;
    }
    if (done.contains(name)) return;
    path.push_back(name);
    if (!region->second.neighbours_of.empty()) follow(region->second.neighbours_of, path, done);
    for (const auto* others : {&region->second.unite, &region->second.intersect, &region->second.except}) {
      for (const std::string& other : *others) follow(other, path, done);
    }
    path.pop_back();
    done.insert(name);
  }

  const Scenario& scenario_;
  Input& input_;
  std::vector<std::string> names_;
};

}  // namespace

std::string what_bars_second_order(const Scenario& scenario) {
  if (scenario.time.scheme != "newton") return fmt::format("time.scheme = \"{}\"", scenario.time.scheme);
  if (method_of(scenario.volume) == VolumeMethod::projection) return "volume.method = \"projection\"";
  if (scenario.dynamics.density_kg_per_m3 > 0) return "dynamics.density_kg_per_m3 above 0";
  return "";
}

void validate(Scenario& scenario, Input& input) {
  check_embryo(scenario, input);
  check_mirror(scenario, input);
  check_periods(scenario, input);
  check_vitelline(scenario, input);
  check_axes(scenario.embryo, input);
  check_shell_drag(scenario, input);
  check_elasticity(scenario, input);
  check_region_elasticities(scenario, input);
  check_dynamics(scenario.dynamics, input);
  check_time(scenario.time, input);
  check_volume_and_time(scenario.volume, scenario.time, input);
  check_scheme(scenario, input);
  check_integrator(scenario, input);
  check_required_keys(scenario, input);
  check_expectations(scenario, input);
  check_monitors(scenario, input);
  for (auto& [name, it] : scenario.contractions) {
    const std::string table = "contraction." + name;
    check_program(table, it.program, input);
    check_profile(table, it.profile, input);
    check_delay(table, it.delay, input);
    check_pulse(table, it.pulse, scenario.time, input);
  }
  check_enclosed(scenario, input);
  check_contact(scenario, input);
  for (auto& [name, it] : scenario.cortices) {
    const std::string table = "cortex." + name;
    check_program(table, it.program, input);
    check_program(table, it.stiffness_program, input, "stiffness_program");
    check_profile(table, it.profile, input);
    check_delay(table, it.delay, input);
    check_pulse(table, it.pulse, scenario.time, input);
    check_cortex(table, it, input);
    check_own_state(table, it, input);
  }
  for (auto& [name, it] : scenario.pressures) {
    check_program("pressure." + name, it.program, input);
    check_profile("pressure." + name, it.profile, input);
  }
  for (const auto& [name, it] : scenario.divisions) check_division("division." + name, it, input);
  if (!scenario.divisions.empty() && input.sound("embryo.shape") && shape_of(scenario.embryo) == EmbryoShape::slice)
    input.report("embryo.shape", "cells of a slice cannot divide, since its cross-sections must stay alike",
                 "set shape to \"pill\", or remove [division]");
  for (const auto& [name, it] : scenario.ablations) check_ablation(name, scenario, input);
  RegionCheck regions(scenario, input);
  for (const auto& [name, region] : scenario.regions) regions.check_selectors(name, region);
  regions.check_references();
  regions.check_circles();
  if (input.diagnostics.empty()) resolve_automatic(scenario);
}

}  // namespace plica
