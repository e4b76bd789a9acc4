#include "paper/readings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace plica {
namespace {

const std::string across = "contraction.apical.across_ratio=";
const std::string stiffness = "contraction.apical.stiffness_nN_per_um=";
const std::string preload = "contraction.apical.preload_nN=";
const std::string rows = "region.furrow.cells_across=";
const std::string drag = "dynamics.surface_drag_Pa_s_per_um=";

// Springs of the chosen reading: 60 nN to 4.82 nN/um.
const double preload_per_stiffness_um = 60 / 4.82;

// Add springs of stiffness k (nN/um) with a proportional preload to `keys`.
std::vector<std::string> with_springs(double k, std::vector<std::string> keys) {
  keys.push_back(fmt::format("{}{}", stiffness, k));
  keys.push_back(fmt::format("{}{:.4g}", preload, preload_per_stiffness_um * k));
  return keys;
}

std::vector<std::string> ramp(int end_s) {
  return {fmt::format("contraction.apical.program.time_s=[0,{}]", end_s), "contraction.apical.program.activity=[0,1]"};
}

std::vector<std::string> the_papers_algorithm(double step_s) {
  return {"volume.method=projection", "time.scheme=linearly-implicit", "time.integrator=backward-euler",
          fmt::format("time.step_s={}", step_s)};
}

// Stiffness values k are fitted to a depth of 28.89 um at equilibrium with the keys of their row, by
//   plica calibrate drosophila --set KEY=VALUE --set contraction.apical.preload_nN=60/4.82*k
//     --vary contraction.apical.stiffness_nN_per_um=2:10 --target furrow_depth_um=28.89
// Rows marked "springs as chosen" keep 4.82 and 60.
const std::vector<PaperReading> table = {
    {"chosen",
     "chosen",
     "5 rows, across/along 0.35, k = 4.82, preload 60, drag 131, step on",
     {},
     {.scanned = true, .quick = true}},
    {"across-0.2", "across/along", "0.2 (k = 6.86)", with_springs(6.86, {across + "0.2"}), {.scanned = true}},
    {"across-0.3", "across/along", "0.3 (k = 5.34)", with_springs(5.34, {across + "0.3"}), {.scanned = true}},
    {"across-0.4", "across/along", "0.4 (k = 4.395)", with_springs(4.395, {across + "0.4"}), {.scanned = true}},
    {"across-0.6", "across/along", "0.6 (k = 3.295)", with_springs(3.295, {across + "0.6"}), {.scanned = true}},
    {"across-1",
     "across/along",
     "1, equal springs (k = 2.17)",
     with_springs(2.17, {across + "1"}),
     {.scanned = true, .quick = true}},
    {"axial-2", "across/along", "0, axial springs only (k = 9.64)", with_springs(9.64, {across + "0"})},
    {"axial-3", "across/along", "0, axial springs only (k = 14.46)", with_springs(14.46, {across + "0"})},
    {"preload-none", "preload", "none (k = 7.99)", {stiffness + "7.99", preload + "0"}},
    {"preload-only", "preload", "nothing else: constant forces of 152.5 nN", {stiffness + "0", preload + "152.5"}},
    {"rows-3", "rows", "3 rows (k = 7.635)", with_springs(7.635, {rows + "3"}), {.scanned = true}},
    {"rows-7", "rows", "7 rows (k = 4.31)", with_springs(4.31, {rows + "7"}), {.scanned = true}},
    {"rows-3-equal", "rows", "3 rows, equal springs, k as chosen", {rows + "3", across + "1"}},
    {"ramp-10", "activation", "ramp of 10 s", ramp(10)},
    {"ramp-30", "activation", "ramp of 30 s", ramp(30)},
    {"ramp-60", "activation", "ramp of 60 s", ramp(60)},
    {"clock-equal", "clock", "drag 2870: equal speeds at 15 min", {drag + "2870", "time.end_min=900"}},
    {"clock-equal-rest",
     "clock",
     "the same, to rest by a stop slower in proportion, 0.0091 um/min",
     {drag + "2870", "time.end_min=900", "stop.equilibrium_speed_um_per_min=0.0091"}},
    {"vce-1", "VCE", "the last cell of the rows", {}, {.vce = 1, .same_runs_as = "chosen"}},
    {"vce-3", "VCE", "the third-last cell", {}, {.vce = 3, .same_runs_as = "chosen"}},
    {"depth-lips",
     "depth",
     "from the lips down, springs as chosen",
     {},
     {.depth_below_lips = true, .same_runs_as = "chosen"}},
    {"depth-lips-deep",
     "depth",
     "from the lips down, graded contraction over 7 rows and shortening cells (`drosophila-deep`)",
     {},
     {.base = "drosophila-deep", .depth_below_lips = true}},
    {"no-shell", "shell", "none, springs as chosen", {"vitelline.enabled=false"}},
    {"no-shell-28.89", "shell", "none (k = 3.33)", with_springs(3.33, {"vitelline.enabled=false"})},
    {"diagonals", "diagonals", "also the two diagonals of each facet (k = 2.07)",
     with_springs(2.07, {"contraction.apical.diagonals=true"})},
    {"volume-none", "volume", "not held, Poisson's ratio 0.45 (k = 4.61)", with_springs(4.61, {"volume.method=none"})},
    {"paper-20", "algorithm", "the paper's: linear solve, then projection; step 20 s", the_papers_algorithm(20)},
    {"paper-5", "algorithm", "the same, step 5 s", the_papers_algorithm(5)},
    {"shape-memory", "elasticity", "discrete shape memory (k = 5.53)",
     with_springs(5.53, {"elasticity.model=shape-memory"})},
    {"poisson-0.3", "Poisson's ratio", "0.3 (k = 4.45)", with_springs(4.45, {"elasticity.poisson_ratio=0.3"})},
    {"poisson-0.49", "Poisson's ratio", "0.49 (k = 5.06)", with_springs(5.06, {"elasticity.poisson_ratio=0.49"})},
};

// Section 3.1, 3.2, 2.3 and 4. A range printed is met within it; a number within what issue and text allow.
const std::vector<PrintedNumber> numbers = {
    {"pill.depth_um", "pill's depth 28.89 um within 5 %", 28.89, 0.05 * 28.89},
    {"sphere.depth_um", "sphere's depth 27.44 um within 5 %", 27.44, 0.05 * 27.44},
    {"pill.vml_area_loss_percent", "area loss of VML 30 % within 5 points", 30, 5},
    {"pill.peak_ratio", "pill's speed ratio 3.65 within 15 %", 3.65, 0.15 * 3.65},
    {"sphere.peak_ratio", "sphere's speed ratio 1.23 within 15 %", 1.23, 0.15 * 1.23},
    {"pill.vml_at_equal_um", "VML displaced by 7-10 um at equal speeds", 8.5, 1.5},
    {"pill.vce_at_equal_um", "VCE displaced by 13-17 um at equal speeds", 15, 2},
    {"pill.rest_min", "pill at rest at 15 min within 5 %", 15, 0.75},
    {"pill.equal_speeds_s", "pill's speeds equal at 15 min within 5 %", 900, 45},
    {"pill.peak_ratio_time_s", "pill's largest difference at 30 s within 15 s", 30, 15},
    {"sphere.peak_ratio_time_s", "sphere's largest difference at 30 s within 15 s", 30, 15},
};

}  // namespace

std::span<const PaperReading> readings() { return table; }

std::vector<std::string> sphere_overrides(const PaperReading& reading) {
  std::vector<std::string> keys = {"embryo.shape=sphere", "embryo.cells=[9,9,8]", "region.furrow.cells_along=7"};
  if (reading.options.base == "drosophila-deep") keys.emplace_back("region.floor.cells_along=7");
  return keys;
}

std::span<const PrintedNumber> printed_numbers() { return numbers; }

std::optional<double> figure_named(const Figures& figures, const std::string& name) {
  const auto found = figures.find(name);
  return found == figures.end() ? std::nullopt : std::optional(found->second);
}

std::optional<double> figure_in(const PaperReading& reading, const std::string& name, const Figures& figures) {
  std::string key = name;
  if (reading.options.depth_below_lips && name.ends_with(".depth_um"))
    key = name.substr(0, name.size() - 8) + "depth_below_lips_um";
  if (reading.options.vce != 2 &&
      (name.find("peak_ratio") != std::string::npos || name.find("equal") != std::string::npos))
    key += fmt::format("_{}", reading.options.vce);
  return figure_named(figures, key);
}

std::optional<Score> score(const PaperReading& reading, const Figures& figures) {
  if (!figures.contains("pill.depth_um") || !figures.contains("sphere.depth_um")) return std::nullopt;
  Score result;
  for (const PrintedNumber& number : numbers) {
    const auto value = figure_in(reading, number.name, figures);
    const double miss = value ? std::min(largest_miss, std::abs(*value - number.centre) / number.half) : largest_miss;
    result.rms += miss * miss / static_cast<double>(numbers.size());
    result.met += miss <= 1 ? 1 : 0;
  }
  result.rms = std::sqrt(result.rms);
  return result;
}

}  // namespace plica
