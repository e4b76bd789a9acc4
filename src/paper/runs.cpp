#include "paper/runs.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/errors.hpp"
#include "measure/reference_run.hpp"
#include "paper/mechanism.hpp"
#include "record/results.hpp"
#include "scenario/load.hpp"

namespace plica {
namespace fs = std::filesystem;
namespace {

const std::vector<std::string> no_frames = {"output.frame_every_s=0", "output.cells_csv=false"};

std::vector<std::string> operator+(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

std::string tolerance(double um) { return fmt::format("time.tolerance_um={}", um); }

// Add a run, or the reason to skip it. [expect] of a built-in scenario does not apply to its variants.
void add(Plan& plan, const std::string& id, const std::string& base, const std::vector<std::string>& overrides,
         int watch_along = 0, bool without_divisions = false) {
  try {
    // Verdicts do not depend on a default; readings by the paper's algorithm name the first order.
    Scenario scenario =
        load_scenario(find_scenario(base), std::vector<std::string>{"time.integrator=bdf2"} + overrides);
    scenario.expect.clear();
    if (without_divisions) scenario.divisions.clear();
    if (watch_along > 0) watch_ends(scenario, watch_along);
    plan.runs.push_back({id, std::move(scenario)});
  } catch (const ScenarioError& error) {
    plan.skipped[id] = error.diagnostics().front().key + ": " + error.diagnostics().front().problem;
  } catch (const UsageError& error) {
    plan.skipped[id] = error.what();
  }
}

void plan_refined(Plan& plan, const std::vector<std::string>& coarse) {
  const std::vector<std::string> space =
      no_frames + coarse + std::vector<std::string>{"embryo.elements_per_cell=[2,2,2]"};
  add(plan, "fine-space-pill", "drosophila", space);
  add(plan, "fine-space-sphere", "xenopus", space);
}

void plan_divisions(Plan& plan) {
  const std::vector<std::string> frames = {"output.frame_every_s=300"};
  add(plan, "division-twice", "drosophila-division-twice", frames);
  add(plan, "division", "drosophila-division", frames);
  add(plan, "division-without", "drosophila-division", frames, 0, true);
}

// Chosen reading to 20 min, as in Fig. 10, and its start with frequent snapshots.
void plan_chosen(Plan& plan, bool quick) {
  const std::vector<std::string> to_the_end = {"time.end_min=20", "stop.at_equilibrium=false",
                                               "output.frame_every_s=60", "output.cells_csv=false",
                                               tolerance(quick ? 0.2 : 0.02)};
  add(plan, "main-pill", "drosophila", to_the_end, pill_along);
  add(plan, "main-sphere", "xenopus", to_the_end, sphere_along);
  const std::vector<std::string> early = {"output.cells_csv=false", "stop.at_equilibrium=false",
                                          tolerance(quick ? 0.2 : 0.02)};
  add(plan, "onset-pill", "drosophila",
      early + std::vector<std::string>{"time.end_s=60", quick ? "output.frame_every_s=4" : "output.frame_every_s=1"});
  add(plan, "onset-sphere", "xenopus",
      early +
          std::vector<std::string>{"time.end_s=20", quick ? "output.frame_every_s=2" : "output.frame_every_s=0.25"});
  add(plan, "switched-off", "drosophila",
      no_frames + std::vector<std::string>{
                      "contraction.apical.program.time_s=[0,60,61]", "contraction.apical.program.activity=[1,1,0]",
                      "dynamics.surface_drag_Pa_s_per_um=0.1", "time.end_s=120", "stop.at_equilibrium=false"});
  add(plan, "division-demo", "division-demo", {});
}

// Figures of a finished run, or none.
std::optional<Figures> finished(const Results& results, const std::string& id) {
  if (!results.has(id)) return std::nullopt;
  return figures_of_run(results.folder(id));
}

std::optional<double> summary_number(const Results& results, const std::string& id, const char* key) {
  return results.has(id) ? number_of(read_summary(results.folder(id)), key) : std::nullopt;
}

void add_ratio(Figures& figures, const std::string& name, std::optional<double> a, std::optional<double> b) {
  if (a && b && *b != 0) figures[name] = *a / *b;
}

// Daughters of the middle cell of division-demo compared with their mother.
void measure_demo(Figures& figures, const Results& results) {
  if (!results.has("division-demo")) return;
  const Series cells = read_table(results.folder("division-demo") / "cells.csv");
  const auto column = [&](const char* name) { return cells.column(name).value(); };
  const std::size_t mother = column("mother_id"), volume = column("volume_um3"), area = column("apical_area_um2"),
                    height = column("height_um"), id = column("cell_id");
  std::vector<const std::vector<std::optional<double>>*> daughters;
  for (const auto& row : cells.rows)
    if (row[mother]) daughters.push_back(&row);
  if (daughters.size() < 4) return;
  const auto& mother_row =
      *std::ranges::find_if(cells.rows, [&](const auto& row) { return *row[id] == *(*daughters.front())[mother]; });
  figures["demo.cut_ratio"] = *(*daughters[0])[volume] / *(*daughters[1])[volume];
  const auto& last = *daughters.back();
  figures["demo.volume_ratio"] = *last[volume] / *mother_row[volume];
  figures["demo.area_ratio"] = *last[area] / *mother_row[area];
  figures["demo.height_ratio"] = *last[height] / *mother_row[height];
  if (const auto count = summary_number(results, "division-demo", "cells")) figures["demo.cells"] = *count;
}

void measure_divisions(Figures& figures, const Results& results) {
  const auto lips = [&](const char* id) { return summary_number(results, id, "lip_distance_um"); };
  const auto highest = [&](const char* id) { return summary_number(results, id, "highest_points_distance_um"); };
  add_ratio(figures, "division.lips_ratio", lips("division"), lips("division-without"));
  add_ratio(figures, "division.highest_ratio", highest("division"), highest("division-without"));
  add_ratio(figures, "twice.lips_ratio", lips("division-twice"), lips("division"));
  for (const char* id : {"division", "division-without", "division-twice"}) {
    if (lips(id)) figures[fmt::format("{}.lips_um", id)] = *lips(id);
    if (highest(id)) figures[fmt::format("{}.highest_um", id)] = *highest(id);
  }
  if (const auto push = summary_number(results, "division", "push.force_nN")) figures["division.push_nN"] = *push;
  if (!lips("division-without")) return;
  const Series series = read_series(results.folder("division-without") / "series.csv");
  add_ratio(figures, "division.open_ratio", lips("division-without"),
            series.at(series.column("lip_distance_um").value(), 0));
}

// Mean inward (dorsal) displacement of the apical nodes adjacent to the lip cells from outside, um.
std::optional<double> neighbours_inward_um(const Frame& frame) {
  const std::vector<double>& furrow = frame.element_scalars.at("region_furrow");
  const Vectors& displacement = frame.node_vectors.at("displacement_um");
  std::vector<char> of_furrow(frame.positions.size(), 0);
  for (std::size_t e = 0; e < frame.elements.size(); ++e)
    if (furrow[e] != 0)
      for (const NodeId node : frame.elements[e]) of_furrow[node.index()] = 1;
  double sum = 0;
  int count = 0;
  for (std::size_t e = 0; e < frame.elements.size(); ++e) {
    const auto& nodes = frame.elements[e];
    const bool beside =
        furrow[e] == 0 && std::ranges::any_of(nodes, [&](NodeId n) { return of_furrow[n.index()] != 0; });
    if (!beside) continue;
    for (int i = 4; i < 8; ++i)
      if (!of_furrow[nodes[i].index()]) sum += displacement[nodes[i].index()].z(), ++count;
  }
  return count > 0 ? std::optional(sum / count) : std::nullopt;
}

// Largest displacement after removal of the best-fitting rigid motion: only drag resists rotation about the pill's
// axis.
double change_of_shape_um(const Vectors& positions, const Vectors& displacements) {
  Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();
  const auto motions = [&](std::size_t n) {
    Eigen::Matrix<double, 3, 6> motion;
    motion << Mat3::Identity(), -cross_matrix(positions[n]);
    return motion;
  };
  for (std::size_t n = 0; n < positions.size(); ++n) {
    normal += motions(n).transpose() * motions(n);
    right += motions(n).transpose() * displacements[n];
  }
  const Eigen::Matrix<double, 6, 1> rigid = normal.ldlt().solve(right);
  double largest = 0;
  for (std::size_t n = 0; n < positions.size(); ++n)
    largest = std::max(largest, (displacements[n] - motions(n) * rigid).norm());
  return largest;
}

void measure_frames(Figures& figures, const Results& results) {
  try {
    if (results.has("main-pill"))
      if (const auto inward = neighbours_inward_um(ReferenceRun(results.folder("main-pill")).last_frame()))
        figures["pill.neighbours_inward_um"] = *inward;
    if (results.has("switched-off")) {
      const Frame end = ReferenceRun(results.folder("switched-off")).last_frame();
      figures["off.left_um"] = change_of_shape_um(end.positions, end.node_vectors.at("displacement_um"));
    }
  } catch (const FileError&) {  // built without VTK: rows that need snapshots are left out
  }
}

void measure_onsets(Measured& measured, const Results& results) {
  Figures& figures = measured.figures;
  const auto take = [&](const std::string& embryo, int along) {
    if (!results.has("onset-" + embryo) || !results.has("main-" + embryo)) return Onsets{};
    Onsets found = onsets(results.folder("onset-" + embryo), results.folder("main-" + embryo), along);
    add_prefixed(figures, "onset_" + embryo + ".", figures_of_onsets(found));
    return found;
  };
  measured.pill_onsets = take("pill", pill_along);
  measured.sphere_onsets = take("sphere", sphere_along);
  const auto figure = [&](const char* name) { return figure_named(figures, name); };
  add_ratio(figures, "onset_pill.middle_over_ends", figure("onset_pill.middle_s"), figure("onset_pill.ends_s"));
  add_ratio(figures, "onset_sphere.spread_over_equal", figure("onset_sphere.spread_s"),
            figure("sphere.equal_speeds_s"));
  add_ratio(figures, "onset_sphere.spread_over_pill_equal", figure("onset_sphere.spread_s"),
            figure("pill.equal_speeds_s"));
  add_ratio(figures, "onset_sphere.spread_over_pill", figure("onset_sphere.spread_s"), figure("onset_pill.spread_s"));
  add_ratio(figures, "both.ratio_of_ratios", figure("pill.peak_ratio"), figure("sphere.peak_ratio"));
}

// Figures in more readable units.
void add_minutes(Figures& figures) {
  if (figures.contains("pill.equal_speeds_s")) figures["pill.equal_speeds_min"] = figures["pill.equal_speeds_s"] / 60;
}

}  // namespace

Results::Results(fs::path directory, const Plan& plan) : directory_(std::move(directory)) {
  for (const BatchRun& run : plan.runs) {
    const nlohmann::ordered_json summary = read_summary(folder(run.id));
    if (summary.is_object() && (summary.at("status") == "equilibrium" || summary.at("status") == "end_time"))
      finished_.insert(run.id);
  }
}

Plan make_plan(bool quick) {
  Plan plan;
  const std::vector<std::string> coarse = {tolerance(quick ? 0.3 : matrix_tolerance_um)};
  if (!quick) {
    plan_refined(plan, coarse);
    plan_divisions(plan);
    for (const auto& [id, base] : {std::pair{"fine-time-pill", "drosophila"}, {"fine-time-sphere", "xenopus"}})
      add(plan, id, base, no_frames + std::vector<std::string>{tolerance(fine_tolerance_um)});
  }
  plan_chosen(plan, quick);
  for (const PaperReading& reading : readings()) {
    const ReadingOptions& options = reading.options;
    if (!options.same_runs_as.empty() || (quick && !options.quick)) continue;
    const std::vector<std::string> overrides = no_frames + coarse + reading.overrides;
    add(plan, reading.id + "-pill", options.base, overrides, pill_along);
    add(plan, reading.id + "-sphere", options.base, overrides + sphere_overrides(reading), sphere_along);
  }
  return plan;
}

Measured measure(const Results& results) {
  Measured measured;
  Figures& figures = measured.figures;
  figures = mesh_figures();
  figures.merge(mechanism().figures);
  for (const char* id : {"pill", "sphere"})
    for (const char* which : {"main-", "fine-space-", "fine-time-", "chosen-"})
      if (const auto found = finished(results, std::string(which) + id))
        add_prefixed(figures, std::string(which) == "main-" ? fmt::format("{}.", id) : fmt::format("{}{}.", which, id),
                     *found);
  for (const PaperReading& reading : readings()) {
    const std::string& same = reading.options.same_runs_as;
    const std::string runs = same.empty() ? reading.id : same;
    for (const char* id : {"pill", "sphere"})
      if (const auto found = finished(results, runs + "-" + id))
        add_prefixed(measured.readings[reading.id], fmt::format("{}.", id), *found);
  }
  for (auto& [id, of_reading] : measured.readings) add_minutes(of_reading);
  add_minutes(figures);
  measure_demo(figures, results);
  measure_divisions(figures, results);
  measure_frames(figures, results);
  measure_onsets(measured, results);
  return measured;
}

}  // namespace plica
