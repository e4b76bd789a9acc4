#include "output/recorder.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/errors.hpp"
#include "core/units.hpp"
#include "measure/cells.hpp"
#include "output/mesh_writer.hpp"
#include "output/report.hpp"
#include "scenario/print.hpp"

namespace plica {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t most_cells_by_default = 2000;  // with a row a cell a frame in cells.csv
constexpr const char* series_header =
    "time_s,furrow_depth_um,furrow_depth_below_lips_um,lip_distance_um,vml_speed_um_per_s,vce_speed_um_per_s,"
    "speed_ratio,vml_displacement_um,vce_displacement_um,vml_apical_area_ratio,vce_apical_area_ratio,"
    "max_node_speed_um_per_s,max_volume_error,lumen_volume_ratio,cells,step_s,newton_iterations,linear_iterations";
constexpr const char* midline_header = "time_s,ap_um,depth_um,normal_speed_um_per_s,apical_area_ratio";
constexpr const char* cells_header =
    "time_s,cell_id,mother_id,generation,x_um,y_um,z_um,volume_um3,apical_area_um2,basal_area_um2,height_um,"
    "apical_area_ratio,speed_um_per_s,pressure_Pa,activity";
constexpr const char* lineage_header = "cell_id,mother_id,generation,birth_s";
const std::vector<std::string> own_files = {"summary.json",  "series.csv",          "cells.csv",
                                            "midline.csv",   "lineage.csv",         "frames.pvd",
                                            "scenario.toml", "scenario.input.toml", "report.html"};

// A number for a CSV file; what has no value, or is not finite, is left empty.
std::string field(std::optional<double> value) {
  return value && std::isfinite(*value) ? fmt::format("{:.10g}", *value + 0.0) : "";  // + 0.0: no "-0"
}

std::string row_of(const std::vector<std::optional<double>>& values) {
  std::string row;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) row += ',';
    row += field(values[i]);
  }
  return row;
}

// A table that begins with its header, whole or not at all.
RowFile table(const fs::path& file, const std::string& header) {
  write_file(file, header + "\n");
  return RowFile(file, header.size() + 1);
}

std::string series_columns(const Observer& observer) {
  std::string header = series_header;
  for (const Monitor& monitor : observer.monitors()) header += fmt::format(",{}", monitor.column());
  return header;
}

// frame_00042.vtu and the like: what write_frame names.
bool is_frame(const fs::path& file) {
  const std::string name = file.stem().string();
  return file.extension() == ".vtu" && name.starts_with("frame_") && name.size() >= 11 &&
         name.find_first_not_of("0123456789", 6) == std::string::npos;
}

bool holds_results(const fs::path& directory) {
  for (const std::string& file : own_files)
    if (fs::exists(directory / file)) return true;
  return fs::exists(directory / "frames");
}

// The rest normal of a cell's apical surface, outward.
Vec3 apical_normal(const Tissue& tissue, CellId cell) {
  Vec3 sum = Vec3::Zero();
  for (const Facet& facet : tissue.apical_facets)
    if (facet.cell == cell) {
      std::array<Vec3, 4> points;
      for (int i = 0; i < 4; ++i) points[i] = tissue.rest_positions[facet.nodes[i].index()];
      sum += facet_area_vector(points);
    }
  return sum.normalized();
}

Vec3 mean_apical(const Cell& cell, const Vectors& vectors) {
  Vec3 sum = Vec3::Zero();
  for (int i = 4; i < 8; ++i) sum += vectors[cell.corners[i].index()] / 4;
  return sum;
}

}  // namespace

void prepare_directory(const fs::path& directory, bool overwrite) {
  std::error_code error;
  if (fs::exists(directory, error) && !fs::is_directory(directory, error))
    throw FileError(directory.string() + ": is a file, not a directory; give another --out");
  if (holds_results(directory)) {
    if (!overwrite)
      throw FileError(directory.string() +
                      ": holds results already; give another --out, or --overwrite to replace them");
    for (const std::string& file : own_files) fs::remove(directory / file, error);
    // Frames only: whatever else lies there is not ours.
    for (const auto& entry : fs::directory_iterator(directory / "frames", error))
      if (is_frame(entry.path())) fs::remove(entry.path(), error);
  }
  error.clear();
  fs::create_directories(directory / "frames", error);
  if (error) throw FileError(directory.string() + ": cannot be made: " + error.message());
}

Recorder::Recorder(fs::path directory, const Scenario& scenario, const std::string& input_toml, const Model& model,
                   const Observer& observer, const State& rest)
    : directory_(std::move(directory)),
      scenario_(scenario),
      model_(model),
      observer_(observer),
      series_(table(directory_ / "series.csv", series_columns(observer))),
      midline_(table(directory_ / "midline.csv", midline_header)),
      report_(most_frame_bytes) {
  write_file(directory_ / "scenario.input.toml", input_toml);
  write_file(directory_ / "scenario.toml", resolved_toml(scenario));
  if (scenario.output.cells_csv.value_or(model.tissue.cells.size() <= most_cells_by_default))
    cells_ = table(directory_ / "cells.csv", cells_header);
  if (!scenario.divisions.empty()) lineage_ = table(directory_ / "lineage.csv", lineage_header);
  rows_.push_back(observer.observe_rest(rest));
  append_series(rows_.back());
  write_frame(rest, rest.velocities);
}

const Observation& Recorder::record(const AcceptedStep& step, double wall_s) {
  rows_.push_back(observer_.observe(step, wall_s));
  append_series(rows_.back());
  if (step.frame_is_due) write_frame(step.state, step.state.velocities);
  return rows_.back();
}

void Recorder::record_division(const Division& division, const State& state) {
  if (lineage_) append_lineage(division);
  write_frame(state, state.velocities);
}

nlohmann::ordered_json Recorder::finish(const RunResult& result, const WallTimes& wall) {
  if (last_frame_s_ != result.state.time_s) write_frame(result.state, result.state.velocities);
  nlohmann::ordered_json summary = make_summary(scenario_, model_, result, rows_, observer_.monitors(), wall);
  write_file(directory_ / "summary.json", summary.dump(2) + "\n");
  if (can_report()) write_file(directory_ / "report.html", report_page({make_report_run(directory_, report_)}));
  return summary;
}

void Recorder::append_series(const Observation& row) {
  std::string line = row_of(
      {row.time_s, row.furrow.depth_um, row.furrow.depth_below_lips_um, row.furrow.lip_distance_um,
       row.vml_speed_um_per_s, row.vce_speed_um_per_s, row.speed_ratio, row.vml_displacement_um,
       row.vce_displacement_um, row.vml_apical_area_ratio, row.vce_apical_area_ratio, row.max_node_speed_um_per_s,
       row.max_volume_error, row.lumen_volume_ratio, static_cast<double>(model_.tissue.cells.size()), row.step_s,
       static_cast<double>(row.newton_iterations), static_cast<double>(row.linear_solves)});
  for (const std::optional<double>& value : row.monitors) line += fmt::format(",{}", field(value));
  series_.append(line);
}

void Recorder::write_frame(const State& state, const Vectors& velocities) {
  const Tissue& tissue = model_.tissue;
  Vectors displacements(state.positions.size()), forces(state.positions.size(), Vec3::Zero());
  for (std::size_t n = 0; n < displacements.size(); ++n)
    displacements[n] = state.positions[n] - tissue.rest_positions[n];
  // The active forces: what the contractions pull with, without their dampers.
  const Step still{state.positions, state.positions, velocities, 1, state.time_s};
  for (const Contraction* contraction : model_.contractions) contraction->add_forces(still, forces);

  MeshArrays arrays;
  arrays.node_vectors = {{"displacement_um", displacements}, {"velocity_um_per_s", velocities}, {"force_nN", forces}};
  std::vector<int> ids, mothers, generations;
  for (const Cell& cell : tissue.cells) {
    ids.push_back(cell.lineage.id);
    mothers.push_back(cell.lineage.mother);
    generations.push_back(cell.lineage.generation);
  }
  arrays.cell_integers = {{"cell_id", ids}, {"mother_id", mothers}, {"generation", generations}};
  for (const auto& [name, cells] : tissue.regions)
    arrays.cell_integers.emplace_back("region_" + name, std::vector<int>(cells.begin(), cells.end()));
  std::vector<double> ratios = apical_areas(tissue, state.positions), pressures = state.pressures;
  const std::vector<double> rest_areas = rest_apical_areas(tissue);
  for (std::size_t c = 0; c < ratios.size(); ++c) ratios[c] = rest_areas[c] > 0 ? ratios[c] / rest_areas[c] : 1;
  for (double& pressure : pressures) pressure /= units::pascal;
  arrays.cell_scalars = {{"volume_um3", model_.volumes.volumes(state.positions)},
                         {"volume_error", model_.volumes.relative_errors(state.positions)},
                         {"apical_area_ratio", std::move(ratios)},
                         {"pressure_Pa", std::move(pressures)},
                         {"activity", activities(model_, state.time_s)}};
  if (can_write_meshes()) {
    const std::string file = fmt::format("frames/frame_{:05}.vtu", frames_.size());
    write_mesh(directory_ / file, tissue, state.positions, arrays, state.time_s);
    frames_.emplace_back(state.time_s, file);
    write_collection(directory_ / "frames.pvd", frames_);
  }
  last_frame_s_ = state.time_s;
  report_.add(frame_of(tissue, state.positions, arrays), state.time_s);
  if (cells_) append_cells(state);
  append_midline(state);
}

void Recorder::append_lineage(const Division& division) {
  for (const auto& daughters : division.daughters)
    for (const CellId daughter : daughters) {
      const Lineage& lineage = model_.tissue.cells[daughter.index()].lineage;
      lineage_->append(row_of({static_cast<double>(lineage.id), static_cast<double>(lineage.mother),
                               static_cast<double>(lineage.generation), lineage.birth_s}));
    }
}

void Recorder::append_cells(const State& state) {
  const Tissue& tissue = model_.tissue;
  const auto volumes = model_.volumes.volumes(state.positions);
  const auto apical = apical_areas(tissue, state.positions), basal = basal_areas(tissue, state.positions);
  const auto activity = activities(model_, state.time_s), rest_areas = rest_apical_areas(tissue);
  std::string rows;
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) {
    const Cell& cell = tissue.cells[c];
    const Vec3 centre = cell_centre(cell, state.positions);
    const double rest_area = rest_areas[c];
    const std::optional<double> mother =
        cell.lineage.mother >= 0 ? std::optional<double>(cell.lineage.mother) : std::nullopt;
    if (c > 0) rows += '\n';
    rows += row_of({state.time_s, static_cast<double>(cell.lineage.id), mother,
                    static_cast<double>(cell.lineage.generation), centre.x(), centre.y(), centre.z(), volumes[c],
                    apical[c], basal[c], cell_height(cell, state.positions),
                    rest_area > 0 ? std::optional(apical[c] / rest_area) : std::nullopt,
                    cell_centre(cell, state.velocities).norm(), state.pressures[c] / units::pascal, activity[c]});
  }
  cells_->append(rows);
}

void Recorder::append_midline(const State& state) {
  const Tissue& tissue = model_.tissue;
  const auto apical = apical_areas(tissue, state.positions), rest_areas = rest_apical_areas(tissue);
  for (const CellId id : observer_.sites().midline) {
    const Cell& cell = tissue.cells[id.index()];
    midline_.append(
        row_of({state.time_s, cell_centre(cell, tissue.rest_positions).x(), cell_depth_um(tissue, id, state.positions),
                -apical_normal(tissue, id).dot(mean_apical(cell, state.velocities)),
                apical[id.index()] / rest_areas[id.index()]}));
  }
}

}  // namespace plica
