#include "record/recorder.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <omp.h>

#include "core/errors.hpp"
#include "core/version.hpp"
#include "measure/reference_run.hpp"
#include "record/archive.hpp"
#include "record/csv.hpp"
#include "record/mesh_writer.hpp"
#include "record/run_directory.hpp"
#include "record/series_rows.hpp"
#include "scenario/print.hpp"

namespace plica {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t most_cells_by_default = 2000;  // with one row per cell and frame in cells.csv
constexpr std::size_t most_waiting = 1;              // queued frames and steps, besides the one being written

// Open a table: new with its header, or truncated to its former size.
RowFile table(const fs::path& file, const std::vector<std::string>& names, std::uint64_t keep_bytes) {
  if (keep_bytes > 0) return RowFile(file, keep_bytes);
  const std::string header = fmt::format("{}\n", fmt::join(names, ","));
  write_file(file, header);
  return RowFile(file, header.size());
}

std::uint64_t bytes_of(const std::optional<RowFile>& table) { return table ? table->size_bytes() : 0; }

}  // namespace

Recorder::Recorder(fs::path directory, const Scenario& scenario, const Simulation& simulation, Clock::time_point start)
    : directory_(std::move(directory)),
      scenario_(scenario),
      simulation_(simulation),
      start_(start),
      frame_taker_(simulation.model().tissue, simulation.observer().kept<FurrowSites>("fold"),
                   scenario.output.cells_csv.value_or(simulation.model().tissue.cells.size() <= most_cells_by_default)),
      blank_{version(), resolved_toml(scenario), fingerprint(simulation.model().tissue), {}, {}},
      checkpoints_(directory_),
      writing_(most_waiting) {}

WallTimes Recorder::wall() const {
  const double since_start_s = std::chrono::duration<double>(Clock::now() - start_).count();
  return {earlier_s_ + since_start_s, simulation_.computing_s() - beside_s_};
}

void Recorder::open_tables(const RecordMemory& memory) {
  series_ = table(directory_ / "series.csv", series_header(simulation_.observer()), memory.series_bytes);
  if (frame_taker_.with_fold()) {
    midline_ = table(directory_ / "midline.csv", names_of(midline_columns()), memory.midline_bytes);
    section_ = table(directory_ / "cross_section.csv", names_of(section_columns()), memory.section_bytes);
  }
  if (frame_taker_.with_cell_rows()) cells_ = table(directory_ / "cells.csv", cells_csv_names(), memory.cells_bytes);
  if (!scenario_.divisions.empty())
    lineage_ = table(directory_ / "lineage.csv", names_of(lineage_columns()), memory.lineage_bytes);
}

void Recorder::save_checkpoint() {
  if (!can_archive()) return;
  const WallTimes so_far = wall();
  const auto checkpoint = std::make_shared<Checkpoint>(blank_);
  checkpoint->run = simulation_.memory();
  RecordMemory& record = checkpoint->record;
  record.rows = rows_;
  record.series_bytes = bytes_of(series_);
  record.lineage_bytes = bytes_of(lineage_);
  record.wall_s = so_far.total_s;
  record.solver_s = so_far.solver_s;
  writing_.add([this, checkpoint] { write(*checkpoint); });
}

void Recorder::begin(const std::string& input_toml) {
  open_tables({});
  write_file(directory_ / "scenario.input.toml", input_toml);
  write_file(directory_ / "scenario.toml", blank_.scenario);
  rows_.push_back(simulation_.measures());
  append_series(rows_.back());
  save_frame();
  save_checkpoint();
  writing_.finish();  // report write errors before the first step
}

void Recorder::go_on(const std::string& input_toml, RecordMemory memory) {
  for (const Observation& row : memory.rows)
    if (row.monitors.size() != simulation_.observer().monitors().size())
      throw FileError(directory_.string() + ": the checkpoint is damaged: its rows do not match the monitors");
  frame_taker_.follow_division(simulation_.model().tissue);
  earlier_s_ = memory.wall_s;
  beside_s_ = simulation_.computing_s() - memory.solver_s;
  remove_half_written(directory_);
  open_tables(memory);
  write_file(directory_ / "scenario.input.toml", input_toml);
  write_file(directory_ / "scenario.toml", blank_.scenario);
  rows_ = std::move(memory.rows);
  for (const double time_s : memory.frame_times_s) frames_.emplace_back(time_s, frame_file(frames_.size()));
  if (!frames_.empty()) last_frame_s_ = frames_.back().first;
  write_collection(directory_ / "frames.pvd", frames_);
  remove_what_came_after(directory_, frames_.size());
  if (!listeners_.empty() && !frames_.empty()) {
    const ReferenceRun run(directory_);
    for (std::size_t i = 0; i < frames_.size(); ++i) tell(run.frame(i), frames_[i].first);
  }
}

void Recorder::step_accepted(const AcceptedStep& step, const Observation& measures) {
  if (omp_get_num_procs() == 1) beside_s_ += writing_.processor_s() - written_s_;
  writing_.finish();
  rows_.push_back(measures);
  append_series(measures);
  if (step.frame_is_due) save_frame();
  if (simulation_.is_resumable()) save_checkpoint();
  written_s_ = writing_.processor_s();
}

void Recorder::write(Checkpoint& checkpoint) {
  RecordMemory& record = checkpoint.record;
  record.midline_bytes = bytes_of(midline_);
  record.section_bytes = bytes_of(section_);
  record.cells_bytes = bytes_of(cells_);
  for (const auto& [time_s, file] : frames_) record.frame_times_s.push_back(time_s);
  const Sync sync = checkpoints_.sync_is_due() ? Sync::now : Sync::later;
  if (sync == Sync::now)
    for (std::optional<RowFile>* file : {&series_, &lineage_, &midline_, &section_, &cells_})
      if (*file) (*file)->sync();
  checkpoints_.write(checkpoint, sync);
}

void Recorder::cells_divided(const Division& division) {
  frame_taker_.follow_division(simulation_.model().tissue);
  if (lineage_) append_lineage(division);
  save_frame();
}

nlohmann::ordered_json Recorder::finish() {
  if (last_frame_s_ != simulation_.time_s()) save_frame();
  writing_.finish();
  nlohmann::ordered_json summary = make_summary(scenario_, simulation_, rows_, wall());
  write_file(directory_ / "summary.json",
             summary.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
  for (RecordListener* listener : listeners_) listener->end();
  return summary;
}

void Recorder::append_series(const Observation& row) {
  series_->append(series_row(row, simulation_.observer().columns()));
}

void Recorder::save_frame() {
  last_frame_s_ = simulation_.time_s();
  writing_.add([this, frame = std::make_shared<const FrameRecord>(frame_taker_.take(
                          simulation_.model(), simulation_.state(), simulation_.outside_arrays()))] { write(*frame); });
}

void Recorder::write(const FrameRecord& frame) {
  const MeshArrays arrays = frame.arrays();
  const std::string file = frame_file(frames_.size());
  write_mesh(directory_ / file, frame.mesh(), frame.positions, arrays, frame.time_s);
  frames_.emplace_back(frame.time_s, file);
  write_collection(directory_ / "frames.pvd", frames_);
  if (!listeners_.empty()) tell(frame_of(frame.mesh(), frame.positions, arrays), frame.time_s);
  if (!frame.cell_rows.empty()) cells_->append(csv_rows(frame.cell_rows, cells_csv_names().size()));
  if (!frame.midline_rows.empty()) midline_->append(csv_rows(frame.midline_rows, midline_columns().size()));
  if (!frame.section_rows.empty()) section_->append(csv_rows(frame.section_rows, section_columns().size()));
}

void Recorder::tell(const Frame& frame, double time_s) {
  for (RecordListener* listener : listeners_) listener->add_frame(frame, time_s);
}

void Recorder::append_lineage(const Division& division) {
  for (const auto& daughters : division.daughters)
    for (const CellId daughter : daughters) {
      const Lineage& lineage = simulation_.model().tissue.cells[daughter.index()].lineage;
      std::vector<std::optional<double>> values;
      for (const LineageColumn& column : lineage_columns()) values.emplace_back(column.values(lineage));
      lineage_->append(csv_row(values));
    }
}

}  // namespace plica
