#include "scenario/regions.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "core/names.hpp"
#include "scenario/words.hpp"
#include "tissue/faces.hpp"

namespace plica {
namespace {

bool inside(const std::optional<Range>& range, double value) {
  return !range || (value >= (*range)[0] && value <= (*range)[1]);
}

// Whether position `place` lies in the centred strip of `wanted` cells out of `count`.
bool in_strip(int place, int count, const std::optional<int>& wanted) {
  return !wanted || std::abs(2 * place - (count - 1)) < *wanted;
}

// `low`, `high`: extent of the tissue along x.
bool selected(const RegionInput& region, std::size_t id, const Cell& cell, const Tissue& tissue, double low,
              double high) {
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
  if (!inside(region.length_percent, 100 * (centre.x() - low) / (high - low))) return false;
  return inside(region.x_um, centre.x()) && inside(region.y_um, centre.y()) && inside(region.z_um, centre.z());
}

// Extent of the tissue along x.
std::pair<double, double> extent_along(const Tissue& tissue) {
  std::pair extent(std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity());
  for (const Vec3& x : tissue.rest_positions) extent = {std::min(extent.first, x.x()), std::max(extent.second, x.x())};
  return extent;
}

/// Remarks once on cells without a value of an array.
void note_missing(const std::string& name, const CellArray& values, std::vector<std::string>& remarks) {
  const auto missing = std::ranges::count_if(values, [](double value) { return std::isnan(value); });
  if (missing == 0) return;
  const std::string remark = fmt::format(
      "array \"{}\" has no value in {} cells, which belong to no region by it; result files omit it", name, missing);
  if (std::ranges::find(remarks, remark) == remarks.end()) remarks.push_back(remark);
}

}  // namespace

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
  const std::vector<std::string> names = keys_of(tissue.cell_arrays);
  return diagnostic_at(scenario, key, fmt::format("the embryo has no array \"{}\"", array),
                       names.empty()
                           ? "set embryo.cell_arrays to a table with this column, or use a file with this array"
                           : fmt::format("set array to one of: {}", fmt::join(names, ", ")));
}

void add_regions(const Scenario& scenario, Tissue& tissue, std::vector<Diagnostic>& errors) {
  const std::size_t cells = tissue.cells.size();
  const auto [low, high] = extent_along(tissue);
  std::vector<int> from_midline;  // computed when a region needs it
  const std::function<const CellSet&(const std::string&)> resolve = [&](const std::string& name) -> const CellSet& {
    if (const auto known = tissue.regions.find(name); known != tissue.regions.end()) return known->second;
    const RegionInput& region = scenario.regions.at(name);
    CellSet set(cells, false);
    for (std::size_t c = 0; c < cells; ++c) set[c] = selected(region, c, tissue.cells[c], tissue, low, high);
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
      errors.push_back(diagnostic_at(scenario, fmt::format("region.{}.ids", name),
                                     fmt::format("cell {} does not exist", *none),
                                     fmt::format("set ids to numbers from 0 to {}", cells - 1)));
      continue;
    }
    const CellSet& set = resolve(name);
    if (std::ranges::find(set, true) == set.end())
      errors.push_back(diagnostic_at(scenario, "region." + name, "contains no cell of the embryo",
                                     "change its selectors; `plica mesh` writes the positions of cells"));
  }
}

}  // namespace plica
