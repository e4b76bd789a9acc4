#include "record/frame_record.hpp"

#include <limits>

#include "core/units.hpp"
#include "measure/cells.hpp"

namespace plica {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();  // an empty place of a row

// The rest normals of cells' apical surfaces, outward.
std::vector<Vec3> apical_normals(const Tissue& tissue, const std::vector<CellId>& cells) {
  std::vector<Vec3> of_all(tissue.cells.size(), Vec3::Zero());
  for (const Facet& facet : tissue.apical_facets)
    of_all[facet.cell.index()] += facet_area_vector(gather(tissue.rest_positions, facet));
  std::vector<Vec3> normals;
  normals.reserve(cells.size());
  for (const CellId cell : cells) normals.push_back(of_all[cell.index()].normalized());
  return normals;
}

Vec3 mean_apical(const Cell& cell, const Vectors& vectors) {
  Vec3 sum = Vec3::Zero();
  for (int i = 4; i < 8; ++i) sum += vectors[cell.corners[i].index()] / 4;
  return sum;
}

}  // namespace

FrameCells::FrameCells(const Tissue& tissue)
    : elements(tissue.elements),
      element_cell(tissue.element_cell),
      cells(tissue.cells.size()),
      nodes(tissue.node_count()) {
  std::vector<int> ids, mothers, generations;
  for (const Cell& cell : tissue.cells) {
    ids.push_back(cell.lineage.id);
    mothers.push_back(cell.lineage.mother);
    generations.push_back(cell.lineage.generation);
  }
  integers = {{"cell_id", ids}, {"mother_id", mothers}, {"generation", generations}};
  for (const auto& [name, set] : tissue.regions)
    integers.emplace_back("region_" + name, std::vector<int>(set.begin(), set.end()));
}

MeshElements FrameRecord::mesh() const { return {cells->elements, cells->element_cell, cells->cells, cells->nodes}; }

MeshArrays FrameRecord::arrays() const {
  return {{{"displacement_um", displacements}, {"velocity_um_per_s", velocities}, {"force_nN", forces}},
          scalars,
          cells->integers};
}

FrameTaker::FrameTaker(const Model& model, const FurrowSites& sites, bool with_cell_rows)
    : model_(model), sites_(sites), with_cell_rows_(with_cell_rows) {
  follow_division();
}

void FrameTaker::follow_division() {
  cells_ = std::make_shared<const FrameCells>(model_.tissue);
  midline_normals_ = apical_normals(model_.tissue, sites_.midline);
}

FrameRecord FrameTaker::take(const State& state) const {
  const Tissue& tissue = model_.tissue;
  FrameRecord frame{state.time_s, cells_, state.positions, {}, state.velocities, {}, {}, {}, {}};
  frame.displacements.resize(state.positions.size());
  for (std::size_t n = 0; n < state.positions.size(); ++n)
    frame.displacements[n] = state.positions[n] - tissue.rest_positions[n];
  // The active forces: what cells pull with, without their dampers.
  frame.forces.assign(state.positions.size(), Vec3::Zero());
  Step still{state.positions, state.positions, state.velocities, 1, state.time_s};
  still.internals = state.internals;
  for_laws(model_, still, [&](const Law& law, const Step& own) {
    if (law.is_active()) law.add_forces(own, frame.forces);
  });

  const std::vector<double> areas = apical_areas(tissue, state.positions), rest_areas = rest_apical_areas(tissue);
  const std::span<const double> of_cells = state.pressures(model_);
  std::vector<double> ratios = areas, pressures(of_cells.begin(), of_cells.end());
  for (std::size_t c = 0; c < ratios.size(); ++c) ratios[c] = rest_areas[c] > 0 ? ratios[c] / rest_areas[c] : 1;
  for (double& pressure : pressures) pressure /= units::pascal;
  frame.scalars = {{"volume_um3", model_.volumes().volumes(state.positions)},
                   {"volume_error", model_.volumes().relative_errors(state.positions)},
                   {"apical_area_ratio", std::move(ratios)},
                   {"pressure_Pa", std::move(pressures)},
                   {"activity", activities(model_, state.time_s)}};
  if (with_cell_rows_) add_cell_rows(state, areas, rest_areas, frame);
  add_midline_rows(state, areas, rest_areas, frame);
  return frame;
}

void FrameTaker::add_cell_rows(const State& state, const std::vector<double>& apical_areas,
                               const std::vector<double>& rest_areas, FrameRecord& frame) const {
  const Tissue& tissue = model_.tissue;
  const std::vector<double> basal = basal_areas(tissue, state.positions);
  const auto scalar = [&](const char* name) -> const std::vector<double>& {
    for (const auto& [known, values] : frame.scalars)
      if (known == name) return values;
    throw std::logic_error("a frame has no such values");
  };
  const std::vector<double>&volumes = scalar("volume_um3"), &pressures = scalar("pressure_Pa"),
        &activity = scalar("activity");
  frame.cell_rows.reserve(tissue.cells.size() * cells_columns);
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) {
    const Cell& cell = tissue.cells[c];
    const Vec3 centre = cell_centre(cell, state.positions);
    const double mother = cell.lineage.mother >= 0 ? cell.lineage.mother : none;
    const std::array<double, cells_columns> row = {state.time_s,
                                                   static_cast<double>(cell.lineage.id),
                                                   mother,
                                                   static_cast<double>(cell.lineage.generation),
                                                   centre.x(),
                                                   centre.y(),
                                                   centre.z(),
                                                   volumes[c],
                                                   apical_areas[c],
                                                   basal[c],
                                                   cell_height(cell, state.positions),
                                                   rest_areas[c] > 0 ? apical_areas[c] / rest_areas[c] : none,
                                                   cell_centre(cell, state.velocities).norm(),
                                                   pressures[c],
                                                   activity[c]};
    frame.cell_rows.insert(frame.cell_rows.end(), row.begin(), row.end());
  }
}

void FrameTaker::add_midline_rows(const State& state, const std::vector<double>& apical_areas,
                                  const std::vector<double>& rest_areas, FrameRecord& frame) const {
  const Tissue& tissue = model_.tissue;
  const auto depths = cell_depths_um(tissue, sites_.midline, state.positions);
  for (std::size_t i = 0; i < sites_.midline.size(); ++i) {
    const CellId id = sites_.midline[i];
    const Cell& cell = tissue.cells[id.index()];
    const std::array<double, midline_columns> row = {state.time_s, cell_centre(cell, tissue.rest_positions).x(),
                                                     depths[i].value_or(none),
                                                     -midline_normals_[i].dot(mean_apical(cell, state.velocities)),
                                                     apical_areas[id.index()] / rest_areas[id.index()]};
    frame.midline_rows.insert(frame.midline_rows.end(), row.begin(), row.end());
  }
}

}  // namespace plica
