#include "scenario/check_tissue.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "scenario/acting.hpp"
#include "scenario/schema.hpp"
#include "scenario/words.hpp"
#include "tissue/faces.hpp"
#include "tissue/mesh_input.hpp"

namespace plica {
namespace {

// Checks that regions have the faces a table acts on; cells between two layers have neither apical nor basal faces.
void check_faces(const Scenario& scenario, const Acting& acting, const Tissue& tissue,
                 std::vector<Diagnostic>& errors) {
  const CellSide side = meaning_of(words::edges, acting.input.faces);
  if (acting.faces_key.empty() || side == CellSide::lateral) return;
  const CellSet& region = tissue.regions.at(acting.input.region);
  if (std::ranges::none_of(tissue.facets(side), [&](const Facet& facet) { return region[facet.cell.index()]; }))
    errors.push_back(diagnostic_at(
        scenario, acting.table + ".region",
        fmt::format("no cell of this region has {} {} face", side == CellSide::apical ? "an" : "a", acting.input.faces),
        fmt::format("set region to cells with this face, or change {}", acting.faces_key)));
}

constexpr double least_um = 1, most_um = 100;

bool is_of_a_cell(double size_um) { return size_um >= least_um && size_um <= most_um; }

double median_width_um(const Tissue& tissue) {
  std::vector<double> areas = face_areas(tissue, CellSide::apical, tissue.rest_positions);
  std::erase(areas, 0.0);  // cells between two layers
  if (areas.empty()) return least_um;
  std::ranges::nth_element(areas, areas.begin() + static_cast<std::ptrdiff_t>(areas.size() / 2));
  return std::sqrt(areas[areas.size() / 2]);
}

// A unit, if one fits, or else the power of ten nearest to 10 um.
double factor_for(double width_um) {
  for (const double unit : {1e3, 1e-3, 1e6, 1e-4, 1e4, 1e-6})
    if (is_of_a_cell(unit * width_um)) return unit;
  return std::pow(10, std::round(1 - std::log10(width_um)));
}

MirroredSide side_of(const Scenario& scenario, const Tissue& whole) {
  std::array<bool, 3> axes = {false, false, false};
  for (const std::string& axis : scenario.embryo.mirror) axes[meaning_of(words::mirror_planes, axis)] = true;
  try {
    return plica::side_of(whole, axes);
  } catch (const NotSymmetric& error) {
    throw_at(scenario, "embryo.mirror", error.what(), error.remedy);
  }
}

class SymmetryCheck {
 public:
  SymmetryCheck(const Scenario& scenario, const Tissue& whole, const Mirror& mirror)
      : scenario_(scenario), whole_(whole), mirror_(mirror) {}

  void check_acting(const Acting& acting) {
    if (!check_region(acting.table, acting.input.region)) return;
    const CellPattern pattern = make_pattern(acting.input, whole_);
    for (const auto& [of_cells, what] :
         {std::pair(&pattern.strengths,
                    "is not symmetric: the factor is {:.4g} in cell {} and {:.4g} in its mirror image, cell {}"),
          {&pattern.delays_s,
           "is not symmetric: the delay is {:.4g} s in cell {} and {:.4g} s in its mirror image, cell {}"},
          {&pattern.pulse_phases,
           "is not symmetric: the pulse phase is {:.4g} in cell {} and {:.4g} in its mirror image, cell {}"},
          {&pattern.pulse_periods_s,
           "is not symmetric: the pulse period is {:.4g} s in cell {} and {:.4g} s in its mirror image, cell {}"}}) {
      const std::vector<double>& numbers = *of_cells;
      if (numbers.empty()) continue;
      const double largest = std::abs(*std::ranges::max_element(numbers, {}, [](double a) { return std::abs(a); }));
      const auto differ = [&](std::size_t a, std::size_t b) {
        return std::abs(numbers[a] - numbers[b]) > 1e-9 * largest;
      };
      if (const auto cell = first_cell(differ))
        return refuse(acting.table,
                      fmt::format(fmt::runtime(what), numbers[cell->index()], cell->number(),
                                  numbers[mirror_.original(*cell).index()], mirror_.original(*cell).number()),
                      "make variation, delay, pulse and profile symmetric, or remove embryo.mirror");
    }
  }

  bool check_region(const std::string& table, const std::string& region) {
    const CellSet& cells = whole_.regions.at(region);
    const auto cell = first_cell([&](std::size_t a, std::size_t b) { return cells[a] != cells[b]; });
    if (!cell) return true;
    const CellId original = mirror_.original(*cell);
    const bool has_original = cells[original.index()];
    refuse(table + ".region",
           fmt::format("region \"{}\" is not symmetric: it contains cell {} but not its mirror image, cell {}", region,
                       (has_original ? original : *cell).number(), (has_original ? *cell : original).number()),
           "use a symmetric region, or remove embryo.mirror");
    return false;
  }

  void check_nodes(const std::string& table, const std::vector<bool>& held) {
    std::vector<NodeId> own(held.size());  // node of the whole, by node of the side
    for (std::size_t n = held.size(); n-- > 0;)
      if (const auto [node, signs] = mirror_.nodes[n]; signs == Vec3::Ones()) own[node.index()] = NodeId(n);
    for (std::size_t n = 0; n < held.size(); ++n) {
      if (held[n] == held[own[mirror_.nodes[n].node.index()].index()]) continue;
      const Vec3& x = whole_.rest_positions[n];
      return refuse(
          table,
          fmt::format(
              "is not symmetric: only one of the node at {:.6g}, {:.6g}, {:.6g} um and its mirror image is fixed",
              x.x(), x.y(), x.z()),
          "use a symmetric region and ranges, or remove embryo.mirror");
    }
  }

  void finish() const {
    if (!errors_.empty()) throw ScenarioError(errors_);
  }

 private:
  // Returns the first cell of the whole that differs from its mirror image on the side.
  template <class Differ>
  [[nodiscard]] std::optional<CellId> first_cell(const Differ& differ) const {
    for (std::size_t c = 0; c < whole_.cells.size(); ++c)
      if (differ(c, mirror_.original(CellId(c)).index())) return CellId(c);
    return std::nullopt;
  }
  void refuse(const std::string& key, std::string problem, std::string remedy) {
    errors_.push_back(diagnostic_at(scenario_, key, std::move(problem), std::move(remedy)));
  }

  const Scenario& scenario_;
  const Tissue& whole_;
  const Mirror& mirror_;
  std::vector<Diagnostic> errors_;
};

}  // namespace

void check_array(const Scenario& scenario, const std::string& key, const std::string& name, const std::string& region,
                 const Tissue& tissue, std::vector<Diagnostic>& errors) {
  if (!tissue.cell_arrays.contains(name)) {
    errors.push_back(no_array(scenario, key, name, tissue));
    return;
  }
  const CellSet& cells = tissue.regions.at(region);
  const CellArray& values = tissue.cell_arrays.at(name);
  for (std::size_t c = 0; c < cells.size(); ++c)
    if (cells[c] && !std::isfinite(values[c])) {
      errors.push_back(diagnostic_at(scenario, key,
                                     fmt::format("array \"{}\" has no value in {}", name, cell_at(tissue, CellId(c))),
                                     "provide a number for every cell of the region"));
      return;
    }
}

// Coarse, thick or short meshes have inverted cells where curvature is highest.
void check_rest_shape(const Scenario& scenario, const Tissue& tissue, std::vector<Diagnostic>& errors) {
  for (std::size_t e = 0; e < tissue.elements.size(); ++e)
    if (!(hex_scaled_jacobian(tissue.element_rest_shape[e]) > 0)) {
      const bool has_grid = is_of_grid(shape_of(scenario.embryo));
      const std::string doubt = unit_warning(scenario.embryo, tissue);
      errors.push_back(diagnostic_at(scenario, has_grid ? "embryo.cells" : "embryo.cell_height_um",
                                     fmt::format("the mesh is invalid: {} is inverted or flat in the reference state",
                                                 cell_at(tissue, tissue.element_cell[e])),
                                     has_grid ? "increase cells, or reduce cell_height_um"
                                     : doubt.empty()
                                         ? "reduce cell_height_um, or use a surface with a lower curvature there"
                                         : doubt));
      return;
    }
}

void check_tissue(const Scenario& scenario, const Tissue& tissue) {
  std::vector<Diagnostic> errors;
  const std::vector<Acting> acting = acting_tables(scenario);
  for (const Acting& one : acting) check_faces(scenario, one, tissue, errors);
  for (const Acting& one : acting)
    if (const auto& input = one.input; input.profile.shape == "array")
      check_array(scenario, one.table + ".profile.array", input.profile.array, input.region, tissue, errors);
  for (const ScenarioTable& table : scenario_tables())
    if (table.check) table.check(scenario, tissue, errors);
  if (!errors.empty()) throw ScenarioError(std::move(errors));
}

std::string unit_warning(const EmbryoInput& embryo, const Tissue& tissue) {
  if (!is_from_file(shape_of(embryo))) return "";
  const double width_um = median_width_um(tissue);
  if (is_of_a_cell(width_um)) return "";
  const double factor = factor_for(width_um);
  return fmt::format(
      "embryo.scale: cells of the file are {:.3g} um wide (median), but coordinates are read in um; if they have "
      "another unit, set embryo.scale = [{:g}, {:g}, {:g}]",
      width_um, factor * embryo.scale[0], factor * embryo.scale[1], factor * embryo.scale[2]);
}

MirroredSide mirrored_side(const Scenario& scenario, const Tissue& whole) {
  MirroredSide side = side_of(scenario, whole);
  SymmetryCheck check(scenario, whole, side.mirror);
  for (const Acting& acting : acting_tables(scenario)) check.check_acting(acting);
  for (const ScenarioTable& table : scenario_tables()) {
    if (table.mirrored_regions)
      table.regions(scenario, [&](const std::string& address, const std::string& region) {
        check.check_region(address.substr(0, address.rfind('.')), region);
      });
    if (table.held_nodes) table.held_nodes(scenario, whole, std::bind_front(&SymmetryCheck::check_nodes, &check));
  }
  check.finish();
  return side;
}

}  // namespace plica
