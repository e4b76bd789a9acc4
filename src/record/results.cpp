#include "record/results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/errors.hpp"
#include "core/numbers.hpp"
#include "mechanics/obstacles/vitelline.hpp"
#include "scenario/load.hpp"
#include "scenario/words.hpp"

namespace plica {
namespace {

std::vector<std::string> fields(std::string line) {
  std::erase(line, '\r');
  std::vector<std::string> result;
  for (std::size_t at = 0, end = 0; end != std::string::npos; at = end + 1) {
    end = line.find(',', at);
    result.push_back(line.substr(at, end - at));
  }
  return result;
}

}  // namespace

std::optional<std::size_t> Series::column(const std::string& name) const {
  const auto found = std::ranges::find(columns, name);
  if (found == columns.end()) return std::nullopt;
  return static_cast<std::size_t>(found - columns.begin());
}

std::optional<double> Series::at(std::size_t column, double time_s) const {
  constexpr double same_time_s = 1e-6;
  const auto after =
      std::ranges::lower_bound(rows, time_s - same_time_s, {}, [](const auto& row) { return *row.front(); });
  if (after == rows.end()) return std::nullopt;
  if (std::abs(*after->front() - time_s) <= same_time_s) return (*after)[column];
  if (after == rows.begin()) return std::nullopt;
  const auto before = after - 1;
  const std::optional<double> low = (*before)[column], high = (*after)[column];
  if (!low || !high) return std::nullopt;
  const double part = (time_s - *before->front()) / (*after->front() - *before->front());
  return *low + part * (*high - *low);
}

Series read_series(const std::filesystem::path& file, std::uintmax_t most_bytes) {
  std::istringstream text(read_file(file, most_bytes));
  const auto refuse = [&](int line, const std::string& problem) {
    throw FileError(fmt::format("{}:{}: {}", file.string(), line, problem));
  };
  Series series;
  int number = 1;
  std::string line;
  std::getline(text, line);
  series.columns = fields(line);
  if (series.columns.front() != "time_s") refuse(1, "not a time series: the first column is not time_s");
  while (std::getline(text, line)) {
    ++number;
    const std::vector<std::string> texts = fields(line);
    if (texts.size() != series.columns.size())
      refuse(number, fmt::format("has {} fields for {} columns", texts.size(), series.columns.size()));
    std::vector<std::optional<double>> row;
    for (const std::string& field : texts) {
      row.push_back(number_in(field));
      if (!row.back() && !field.empty()) refuse(number, fmt::format("\"{}\" is not a number", field));
    }
    const bool too_early = !series.rows.empty() && row.front() && *row.front() <= *series.rows.back().front();
    if (!row.front() || too_early) refuse(number, "time missing or not after the previous one");
    series.rows.push_back(std::move(row));
  }
  return series;
}

nlohmann::ordered_json read_summary(const std::filesystem::path& directory) {
  const std::filesystem::path file = directory / "summary.json";
  if (!is_there(file)) return nullptr;
  try {
    nlohmann::ordered_json summary = nlohmann::ordered_json::parse(read_file(file));
    if (!summary.is_object()) throw FileError(file.string() + ": is not the summary of a run");
    return summary;
  } catch (const nlohmann::json::exception& problem) {
    throw FileError(fmt::format("{}: is damaged: {}", file.string(), problem.what()));
  }
}

std::optional<double> number_of(const nlohmann::ordered_json& summary, const std::string& key) {
  if (!summary.is_object() || !summary.contains(key) || !summary.at(key).is_number()) return std::nullopt;
  return summary.at(key).get<double>();
}

std::optional<Scenario> scenario_of_run(const std::filesystem::path& directory) {
  const std::filesystem::path file = directory / "scenario.toml";
  if (!is_there(file)) return {};
  try {
    return load_scenario({"scenario", file.string(), read_file(file)});
  } catch (const ScenarioError&) {
    return {};
  }
}

Scenario as_begun(Scenario scenario, const std::filesystem::path& directory) {
  const std::optional<Scenario> before = scenario_of_run(directory);
  if (!before) return scenario;
  if (!scenario.given_at.contains("elasticity.corner_barrier_Pa"))
    scenario.elasticity.corner_barrier_Pa = before->elasticity.corner_barrier_Pa;
  if (!scenario.given_at.contains("time.integrator")) scenario.time.integrator = before->time.integrator;
  return scenario;
}

std::optional<Capsule> shell_of_run(const Scenario& scenario, const Vectors& rest_positions) {
  const EmbryoInput& embryo = scenario.embryo;
  const EmbryoShape shape = shape_of(embryo);
  if (!scenario.vitelline.enabled || is_patch(shape)) return {};
  if (!is_of_grid(shape) && shape != EmbryoShape::file) return {};  // the shell touches the apical surface
  const double radius = embryo.diameter_um / 2,
               half_axis = shape_of(embryo) == EmbryoShape::pill    ? embryo.length_um / 2 - radius
                           : shape_of(embryo) == EmbryoShape::slice ? embryo.length_um / 2
                                                                    : 0;
  Capsule shell =
      shape_of(embryo) == EmbryoShape::file ? enclosing_capsule(rest_positions) : Capsule{half_axis, radius};
  shell.radius_um += scenario.vitelline.gap_um;
  return shell;
}

}  // namespace plica
