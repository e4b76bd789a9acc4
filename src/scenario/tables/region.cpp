// [region.NAME]: named cell sets.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <set>

#include "core/names.hpp"
#include "scenario/check_tissue.hpp"
#include "scenario/tables/table.hpp"
#include "scenario/words.hpp"
#include "tissue/faces.hpp"

namespace plica {
namespace of_region {

using R = RegionInput;

/// Drops inherited selectors that this shape lacks, in regions that have a newer selector.
void drop_unfit_selectors(Scenario& scenario, Input& input) {
  const EmbryoShape shape = shape_of(scenario.embryo);
  std::set<std::string_view> unfit;
  if (!is_of_grid(shape)) unfit = {"face", "cells_along", "cells_across"};
  if (!is_from_file(shape) && scenario.embryo.cell_arrays.empty()) unfit.insert({"array", "above", "below"});
  const std::span<const KeyRow> rows = rows_of("region.*");
  for (const auto& named : scenario.regions) {
    const std::string& name = named.first;
    const auto is_new = [&](const KeyRow& row) {
      return input.given_with(fmt::format("region.{}.{}", name, row.key), "embryo.shape");
    };
    if (std::ranges::any_of(rows, [&](const KeyRow& row) { return !unfit.contains(row.key) && is_new(row); }))
      for (const KeyRow& row : rows)
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
    if (!has_selector && !has_doubt)
      input_.report(path, "has no selector",
                    "set face, ids, array, angle_deg, length_percent, x_um, y_um, z_um, rows, neighbours_of, union, "
                    "intersect or except");
    if (region.rings && region.neighbours_of.empty() && input_.sound(path + ".neighbours_of"))
      input_.report(path + ".rings", "is not used without neighbours_of",
                    "set neighbours_of to the region inside the rings");
    if (!input_.sound("embryo.shape")) return;
    const EmbryoShape shape = shape_of(scenario_.embryo);
    for (const auto& [key, value] : {std::pair("above", region.above), {"below", region.below}})
      if (value && region.array.empty() && input_.sound(path + ".array"))
        input_.report(fmt::format("{}.{}", path, key), "is not used without array", "set array");
    if (!region.face.empty() && !is_of_grid(shape))
      input_.report(path + ".face", "cells of this shape have no named faces",
                    "use angle_deg, length_percent, ids, array, x_um, y_um or z_um" + instead_of(path + ".face"));
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
      if (missing && input_.place(path + key) != nullptr)
        input_.report(path + key, "is not used without face", "set face");
    }
    const std::int64_t cells = built_cell_count(scenario_.embryo);
    if (!region.ids.empty() && *std::ranges::max_element(region.ids) >= cells)
      input_.report(path + ".ids", fmt::format("cell {} does not exist", *std::ranges::max_element(region.ids)),
                    fmt::format("set ids to numbers from 0 to {}", cells - 1));
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

bool inside(const std::optional<Range>& range, double value) {
  return !range || (value >= (*range)[0] && value <= (*range)[1]);
}

// Whether position `place` lies in the centred strip of `wanted` cells out of `count`.
bool in_strip(int place, int count, const std::optional<int>& wanted) {
  return !wanted || std::abs(2 * place - (count - 1)) < *wanted;
}

// `length`: extent of the tissue along x.
bool selected(const RegionInput& region, std::size_t id, const Cell& cell, const Tissue& tissue, const Extent& length) {
  if (!region.face.empty()) {
    const auto& place = cell.grid_place;
    if (!place || place->face != meaning_of(words::sides, region.face) ||
        !in_strip(place->place[0], place->count[0], region.cells_along) ||
        !in_strip(place->place[1], place->count[1], region.cells_across))
      return false;
  }
  if (!region.ids.empty() && std::ranges::find(region.ids, static_cast<int>(id)) == region.ids.end()) return false;
  const Vec3 centre = cell_centre(cell, tissue.rest_positions);
  if (!inside(region.angle_deg, std::atan2(centre.y(), -centre.z()) * 180 / std::numbers::pi)) return false;
  if (!inside(region.length_percent, 100 * (centre.x() - length.low) / (length.high - length.low))) return false;
  return inside(region.x_um, centre.x()) && inside(region.y_um, centre.y()) && inside(region.z_um, centre.z());
}

/// "x 3 to 58, y -4 to 12, z 0 to 5 um": where centres of cells are.
std::string span_of_cells(const Tissue& tissue) {
  Eigen::AlignedBox3d box;
  for (const Cell& cell : tissue.cells) box.extend(cell_centre(cell, tissue.rest_positions));
  const Vec3 low = box.min(), high = box.max();
  return fmt::format("x {:.3g} to {:.3g}, y {:.3g} to {:.3g}, z {:.3g} to {:.3g} um", low.x(), high.x(), low.y(),
                     high.y(), low.z(), high.z());
}

/// Remarks once on cells without a value of an array.
void note_missing(const std::string& name, const CellArray& values, std::vector<std::string>& remarks) {
  const auto missing = std::ranges::count_if(values, [](double value) { return std::isnan(value); });
  if (missing == 0) return;
  const std::string remark = fmt::format(
      "array \"{}\" has no value in {} cells, which belong to no region by it; result files omit it", name, missing);
  if (std::ranges::find(remarks, remark) == remarks.end()) remarks.push_back(remark);
}

}  // namespace of_region

Diagnostic diagnostic_at(const Scenario& scenario, const std::string& key, std::string problem, std::string remedy) {
  GivenAt place{scenario.file, 0};
  for (std::string around = key;; around.resize(around.rfind('.'))) {
    if (const auto found = scenario.given_at.find(around); found != scenario.given_at.end()) {
      place = found->second;
      break;
    }
    if (around.find('.') == std::string::npos) break;
  }
  return {place.file, place.line, key, std::move(problem), std::move(remedy)};
}

void throw_at(const Scenario& scenario, const std::string& key, std::string problem, std::string remedy) {
  throw ScenarioError({diagnostic_at(scenario, key, std::move(problem), std::move(remedy))});
}

Diagnostic no_array(const Scenario& scenario, const std::string& key, const std::string& array, const Tissue& tissue) {
  using namespace of_region;
  const std::vector<std::string> names = keys_of(tissue.cell_arrays);
  return diagnostic_at(scenario, key, fmt::format("the embryo has no array \"{}\"", array),
                       names.empty()
                           ? "set embryo.cell_arrays to a table with this column, or use a file with this array"
                           : fmt::format("set array to one of: {}", fmt::join(names, ", ")));
}

void add_regions(const Scenario& scenario, Tissue& tissue, std::vector<Diagnostic>& errors) {
  using namespace of_region;
  const std::size_t cells = tissue.cells.size();
  const Extent extent = extent_along(tissue);
  std::vector<int> from_midline;  // computed when a region needs it
  const std::function<const CellSet&(const std::string&)> resolve = [&](const std::string& name) -> const CellSet& {
    if (const auto known = tissue.regions.find(name); known != tissue.regions.end()) return known->second;
    const RegionInput& region = scenario.regions.at(name);
    CellSet set(cells, false);
    for (std::size_t c = 0; c < cells; ++c) set[c] = selected(region, c, tissue.cells[c], tissue, extent);
    const auto combine = [&](const CellSet& other, auto operation) {
      std::transform(set.begin(), set.end(), other.begin(), set.begin(), operation);
    };
    if (region.rows) {
      if (from_midline.empty()) from_midline = half_cells_from_midline(tissue);
      for (std::size_t c = 0; c < cells; ++c) set[c] = set[c] && from_midline[c] >= 0 && from_midline[c] < *region.rows;
    }
    if (!region.neighbours_of.empty())
      combine(cells_around(tissue, resolve(region.neighbours_of), region.rings.value_or(1)), std::logical_and());
    if (!region.array.empty()) {
      const auto array = tissue.cell_arrays.find(region.array);
      if (array == tissue.cell_arrays.end()) {
        errors.push_back(no_array(scenario, "region." + name + ".array", region.array, tissue));
      } else {
        const auto is_wanted = [&](double value) {
          if (std::isnan(value)) return false;
          if (!region.above && !region.below) return value != 0;
          return (!region.above || value > *region.above) && (!region.below || value < *region.below);
        };
        for (std::size_t c = 0; c < cells; ++c) set[c] = set[c] && is_wanted(array->second[c]);
        note_missing(region.array, array->second, tissue.remarks);
      }
    }
    // A union without other selectors starts empty; otherwise the set starts from the selected cells.
    const bool only_others = region.face.empty() && region.ids.empty() && region.array.empty() && !region.x_um &&
                             !region.y_um && !region.z_um && !region.angle_deg && !region.length_percent &&
                             !region.rows && region.neighbours_of.empty();
    if (only_others && !region.unite.empty()) set.assign(cells, false);
    for (const std::string& other : region.unite) combine(resolve(other), std::logical_or());
    for (const std::string& other : region.intersect) combine(resolve(other), std::logical_and());
    for (const std::string& other : region.except)
      combine(resolve(other), [](bool in, bool out) { return in && !out; });
    return tissue.regions[name] = std::move(set);
  };
  for (const auto& [name, region] : scenario.regions) {
    if (const auto none = std::ranges::find_if(region.ids, [&](int id) { return id >= static_cast<int>(cells); });
        none != region.ids.end()) {
      std::string remedy = fmt::format("set ids to numbers from 0 to {}", cells - 1);
      if (tissue.cell_arrays.contains("label"))
        remedy +=
            fmt::format("; label {} is array = \"label\", above = {}, below = {}", *none, *none - 0.5, *none + 0.5);
      errors.push_back(diagnostic_at(scenario, fmt::format("region.{}.ids", name),
                                     fmt::format("cell {} does not exist", *none), remedy));
      continue;
    }
    const CellSet& set = resolve(name);
    if (std::ranges::find(set, true) == set.end())
      errors.push_back(diagnostic_at(scenario, "region." + name, "contains no cell of the embryo",
                                     fmt::format("change its selectors: cells lie at {}; `plica mesh` writes the "
                                                 "positions of all",
                                                 span_of_cells(tissue))));
  }
}

ScenarioTable region_table() {
  using namespace of_region;
  ScenarioTable info{
      "region.*", "Named cell set: cells that meet all given selectors, in the reference state. `all` is predefined.",
      "Geometry"};
  const auto row = key_rows(info, &Scenario::regions);
  info.rows = {
      row("face", &R::face, one_of(words::sides), "Side of a built embryo."),
      row("cells_along", &R::cells_along, between(1, max_count),
          "Centred strip of the face: cells along x (y on end faces)."),
      row("cells_across", &R::cells_across, between(1, max_count),
          "Centred strip of the face: cells along y (z on side and end faces)."),
      row("ids", &R::ids, not_negative, "Cell numbers, from 0."),
      row("array", &R::array, anything, "Cell array: cells where it is not 0, or lies within `above` and `below`."),
      row("above", &R::above, anything, "Lower bound of the array, excluded."),
      row("below", &R::below, anything, "Upper bound of the array, excluded."),
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
