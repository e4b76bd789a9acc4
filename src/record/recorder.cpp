#include "record/recorder.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <chrono>

#include "core/errors.hpp"
#include "core/version.hpp"
#include "measure/reference_run.hpp"
#include "record/archive.hpp"
#include "record/csv.hpp"
#include "record/mesh_writer.hpp"
#include "record/run_directory.hpp"
#include "scenario/print.hpp"

namespace plica {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t most_cells_by_default = 2000;  // with one row per cell and frame in cells.csv

// The list of frames is written as a whole. A killed run's may lack those of this time, until it is resumed.
constexpr std::chrono::seconds between_lists{1};

constexpr const char *series_csv = "series.csv", *lineage_csv = "lineage.csv";

}  // namespace

Recorder::Recorder(fs::path directory, const Scenario& scenario, const Simulation& simulation, Clock::time_point start)
    : directory_(std::move(directory)),
      scenario_(scenario),
      simulation_(simulation),
      start_(start),
      frame_taker_(simulation.model(), simulation.observer().kept<FurrowSites>("fold"),
                   scenario.output.cells_csv.value_or(simulation.model().tissue.cells.size() <= most_cells_by_default)),
      blank_{version(), resolved_toml(scenario), fingerprint(simulation.model().tissue), {}, {}},
      checkpoints_(directory_) {}

WallTimes Recorder::wall() const {
  const double since_start_s = std::chrono::duration<double>(Clock::now() - start_).count();
  return {earlier_s_ + since_start_s, simulation_.computing_s() - beside_s_};
}

void Recorder::open_tables(const RecordMemory& memory) {
  std::map<std::string, std::vector<std::string>> headers = frame_taker_.tables();
  headers[series_csv] = series_header(simulation_.observer());
  if (!scenario_.divisions.empty()) headers[lineage_csv] = names_of(lineage_columns());
  for (const auto& [name, header] : headers) {
    const auto kept = memory.table_bytes.find(name);
    const std::uint64_t keep_bytes = kept == memory.table_bytes.end() ? 0 : kept->second;
    tables_.try_emplace(name, directory_ / name, begin_table(directory_ / name, header, keep_bytes));
  }
}

void Recorder::append(const std::string& table, const std::string& rows) {
  if (!rows.empty()) tables_.at(table).append(rows);
}

void Recorder::record_row() {
  rows_.push_back(simulation_.measures());
  append(series_csv, series_row(rows_.back(), simulation_.observer().columns()));
}

void Recorder::save_checkpoint() {
  if (!can_archive()) return;
  const WallTimes so_far = wall();
  const auto checkpoint = std::make_shared<Checkpoint>(blank_);
  checkpoint->run = simulation_.memory();
  RecordMemory& record = checkpoint->record;
  record.wall_s = so_far.total_s;
  record.solver_s = so_far.solver_s;
  writing_.add([this, checkpoint] { write(*checkpoint); });
}

void Recorder::begin(const std::string& input_toml) {
  open_tables({});
  write_file(directory_ / "scenario.input.toml", input_toml);
  write_file(directory_ / "scenario.toml", blank_.scenario);
  record_row();
  save_frame();
  save_checkpoint();
  writing_.finish();  // report write errors before the first step
}

void Recorder::go_on(const std::string& input_toml, RecordMemory memory) {
  frame_taker_.follow_division(simulation_.model().tissue);
  earlier_s_ = memory.wall_s;
  beside_s_ = simulation_.computing_s() - memory.solver_s;
  remove_half_written(directory_);
  open_tables(memory);
  write_file(directory_ / "scenario.input.toml", input_toml);
  write_file(directory_ / "scenario.toml", blank_.scenario);
  rows_ = read_series_rows(directory_ / series_csv, simulation_.observer());
  if (rows_.empty() || rows_.back().time_s() != simulation_.time_s())
    throw FileError((directory_ / series_csv).string() + ": does not end at the time of the checkpoint");
  for (const double time_s : memory.frame_times_s) frames_.emplace_back(time_s, frame_file(frames_.size()));
  if (!frames_.empty()) last_frame_s_ = frames_.back().first;
  list_frames();
  remove_what_came_after(directory_, frames_.size());
  if (!listeners_.empty() && !frames_.empty()) {
    const ReferenceRun run(directory_);
    for (std::size_t i = 0; i < frames_.size(); ++i) tell(run.frame(i), frames_[i].first);
  }
}

void Recorder::step_accepted(const AcceptedStep& step, const Observation& /*measures*/) {
  if (omp_get_num_procs() == 1) beside_s_ += writing_.processor_s() - written_s_;
  writing_.finish();
  record_row();
  if (step.frame_is_due) save_frame();
  if (simulation_.is_resumable()) save_checkpoint();
  written_s_ = writing_.processor_s();
}

void Recorder::write(Checkpoint& checkpoint) {
  RecordMemory& record = checkpoint.record;
  for (const auto& [time_s, file] : frames_) record.frame_times_s.push_back(time_s);
  const Sync sync = checkpoints_.sync_is_due() ? Sync::now : Sync::later;
  for (auto& [name, table] : tables_) {
    record.table_bytes[name] = table.size_bytes();
    if (sync == Sync::now) table.sync();
  }
  checkpoints_.write(checkpoint, sync);
}

void Recorder::cells_divided(const TissueChange& change) {
  frame_taker_.follow_division(simulation_.model().tissue);
  writing_.finish();
  for (const auto& daughters : change.daughters)
    for (const CellId daughter : daughters) {
      const Lineage& lineage = simulation_.model().tissue.cells[daughter.index()].lineage;
      std::vector<std::optional<double>> values;
      for (const LineageColumn& column : lineage_columns()) values.emplace_back(column.values(lineage));
      append(lineage_csv, csv_row(values));
    }
  if (!change.daughters.empty()) save_frame();
}

nlohmann::ordered_json Recorder::finish() {
  if (last_frame_s_ != simulation_.time_s()) save_frame();
  writing_.finish();
  list_frames();
  nlohmann::ordered_json summary = make_summary(scenario_, simulation_, rows_, wall());
  write_file(directory_ / "summary.json",
             summary.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
  for (RecordListener* listener : listeners_) listener->end();
  return summary;
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
  if (Clock::now() - listed_ >= between_lists) list_frames();
  if (!listeners_.empty()) tell(frame_of(frame.mesh(), frame.positions, arrays), frame.time_s);
  for (const auto& [table, columns] : frame.columns) append(table, csv_of_columns(columns));
}

void Recorder::list_frames() {
  write_collection(directory_ / "frames.pvd", frames_);
  listed_ = Clock::now();
}

void Recorder::tell(const Frame& frame, double time_s) {
  for (RecordListener* listener : listeners_) listener->add_frame(frame, time_s);
}

}  // namespace plica
