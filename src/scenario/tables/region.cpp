// [region.NAME]: named cell sets. regions.cpp finds their cells.
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "scenario/tables/table.hpp"

namespace plica {
namespace {

using R = RegionInput;

/// Drops inherited selectors that this shape lacks, in regions that have a newer selector.
void drop_unfit_selectors(Scenario& scenario, Input& input) {
  const EmbryoShape shape = shape_of(scenario.embryo);
  std::set<std::string_view> unfit;
  if (!is_of_grid(shape)) unfit = {"face", "cells_along", "cells_across"};
  if (!is_from_file(shape) && scenario.embryo.cell_arrays.empty()) unfit.insert({"array", "above", "below"});
  const std::span<const Row> rows = rows_of("region.*");
  for (const auto& named : scenario.regions) {
    const std::string& name = named.first;
    const auto is_new = [&](const Row& row) {
      return input.given_with(fmt::format("region.{}.{}", name, row.key), "embryo.shape");
    };
    if (std::ranges::any_of(rows, [&](const Row& row) { return !unfit.contains(row.key) && is_new(row); }))
      for (const Row& row : rows)
        if (unfit.contains(row.key) && !is_new(row)) reset_to_default(row, scenario, name);
  }
}

/// Checks regions: selectors available for this embryo, no cycles.
class RegionCheck {
 public:
  RegionCheck(const Scenario& scenario, Input& input) : scenario_(scenario), input_(input) {}

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
    const std::int64_t cells = built_cell_count(scenario_.embryo);
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
};

}  // namespace

ScenarioTable region_table() {
  ScenarioTable info{
      "region.*", "Named cell set: cells that meet all given selectors, in the reference state. `all` is predefined.",
      "Geometry"};
  const auto row = rows_in(info, &Scenario::regions);
  info.rows = {
      row("face", &R::face, one_of(words::sides), "Side of a built embryo."),
      row("cells_along", &R::cells_along, between(1, max_count),
          "Centred strip of the face: cells along x (y on end faces)."),
      row("cells_across", &R::cells_across, between(1, max_count),
          "Centred strip of the face: cells along y (z on side and end faces)."),
      row("ids", &R::ids, not_negative, "Cell numbers, from 0."),
      row("array", &R::array, anything, "Cell array: cells where it is not 0, or lies within `above` and `below`."),
      row("above", &R::above, anything, "Lower bound of the array."),
      row("below", &R::below, anything, "Upper bound of the array."),
      row("angle_deg", &R::angle_deg, anything,
          "Angle of the cell centre about the axis, -180 to 180; 0: ventral, 90: right."),
      row("length_percent", &R::length_percent, between(0, 100),
          "Position of the cell centre along the axis (% of length), from the anterior end."),
      row("x_um", &R::x_um, anything, "x of the cell centre (µm); 0 is the centre of a built embryo."),
      row("y_um", &R::y_um, anything, "y of the cell centre (µm)."),
      row("z_um", &R::z_um, anything, "z of the cell centre (µm)."),
      row("rows", &R::rows, between(1, max_count),
          "Number of cell rows about the ventral midline, both sides together. Rows are counted through lateral "
          "faces."),
      row("neighbours_of", &R::neighbours_of, anything, "Cells outside this region that share a lateral face with it."),
      row("rings", &R::rings, between(1, 1000), "Width of `neighbours_of` in cells; default 1."),
      row("union", &R::unite, anything, "Cells of any of these regions."),
      row("intersect", &R::intersect, anything, "Cells of each of these regions."),
      row("except", &R::except, anything, "No cells of these regions."),
  };
  info.regions = [](const Scenario& scenario, const TakeRegion& take) {
    for (const auto& [name, it] : scenario.regions) {
      const std::string table = "region." + name;
      take(table + ".neighbours_of", it.neighbours_of);
      for (const std::string& other : it.unite) take(table + ".union", other);
      for (const std::string& other : it.intersect) take(table + ".intersect", other);
      for (const std::string& other : it.except) take(table + ".except", other);
    }
  };
  info.rules = [](Scenario& scenario, Input& input) {
    if (input.sound("embryo.shape")) drop_unfit_selectors(scenario, input);
    RegionCheck check(scenario, input);
    for (const auto& [name, region] : scenario.regions) check.check_selectors(name, region);
    check.check_circles();
  };
  return info;
}

}  // namespace plica
