#include "study/design.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/random/sobol.hpp>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <sstream>

#include "core/files.hpp"
#include "core/numbers.hpp"
#include "scenario/print.hpp"
#include "scenario/toml_reader.hpp"
#include "study/csv_fields.hpp"

namespace plica {
namespace {

constexpr std::size_t most_runs = 10'000'000;

// Random numbers in [0, 1), identical with every C++ library.
class Uniform {
 public:
  explicit Uniform(std::uint64_t seed) : engine_(seed) {}
  double operator()() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  std::size_t below(std::size_t count) { return static_cast<std::size_t>((*this)() * static_cast<double>(count)); }

 private:
  std::mt19937_64 engine_;
};

using Places = std::vector<std::vector<double>>;  // points, each with a coordinate from 0 to 1 for each dimension

// Sobol's sequence with a digital shift: bits of each dimension are flipped by those of a random number. The points
// stay evenly spread and differ between seeds.
Places sobol(std::size_t count, std::size_t dimensions, std::uint64_t seed) {
  boost::random::sobol sequence(dimensions);
  std::mt19937_64 random(seed);
  std::vector<std::uint64_t> shift(dimensions);
  for (std::uint64_t& bits : shift) bits = random();
  Places places(count, std::vector<double>(dimensions));
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t d = 0; d < dimensions; ++d) {
      const std::uint64_t bits = i == 0 ? 0 : sequence();  // Boost omits the first, which is 0
      places[i][d] = static_cast<double>((bits ^ shift[d]) >> 11) * 0x1p-53;
    }
  return places;
}

// Latin hypercube: each dimension has one point in each of `count` slices.
Places latin_hypercube(std::size_t count, std::size_t dimensions, std::uint64_t seed) {
  Uniform uniform(seed);
  Places places(count, std::vector<double>(dimensions));
  std::vector<std::size_t> slices(count);
  for (std::size_t d = 0; d < dimensions; ++d) {
    std::iota(slices.begin(), slices.end(), 0);
    for (std::size_t i = count; i-- > 1;) std::swap(slices[i], slices[uniform.below(i + 1)]);
    for (std::size_t i = 0; i < count; ++i)
      places[i][d] = (static_cast<double>(slices[i]) + uniform()) / static_cast<double>(count);
  }
  return places;
}

// Saltelli's design: for each of `count` pairs A and B the points A, A with one coordinate of B (each in turn), and B.
Places for_sobol_indices(std::size_t count, std::size_t dimensions, std::uint64_t seed) {
  Places places;
  for (const auto& pair : sobol(count, 2 * dimensions, seed)) {
    const std::vector<double> a(pair.begin(), pair.begin() + static_cast<long>(dimensions));
    const std::vector<double> b(pair.begin() + static_cast<long>(dimensions), pair.end());
    places.push_back(a);
    for (std::size_t d = 0; d < dimensions; ++d) {
      places.push_back(a);
      places.back()[d] = b[d];
    }
    places.push_back(b);
  }
  return places;
}

// Write a value of an integer key as an integer where it is one up to rounding.
std::string number_of(const StudyKey& key, double value) {
  const double whole = std::round(value);
  const bool is_whole = key.is_whole && std::abs(value - whole) <= 1e-9 * std::max(1.0, std::abs(value));
  return is_whole ? fmt::format("{:.0f}", whole) : float_in_toml(value);
}

// Values of a key with integer bounds and step are written without a decimal point.
std::string in_steps(const StudyKey& key, double step) {
  const double value = key.low + *key.step * step;
  const auto is_whole = [](double number) { return number == std::floor(number); };
  if (is_whole(*key.step) && is_whole(key.low)) return fmt::format("{:.0f}", value);
  return float_in_toml(value);
}

double steps_of(const StudyKey& key) { return std::floor((key.high - key.low) / *key.step * (1 + 1e-12)); }

std::string value_at(const StudyKey& key, double place) {
  if (!key.values.empty()) {
    const auto count = static_cast<double>(key.values.size());
    return key.values[static_cast<std::size_t>(std::min(place * count, count - 1))];
  }
  if (key.mean) {
    using Policy = boost::math::policies::policy<boost::math::policies::promote_double<false>>;  // as in judgement.cpp
    const boost::math::normal_distribution<double, Policy> normal(*key.mean, *key.sd);
    const double from = std::isfinite(key.low) ? boost::math::cdf(normal, key.low) : 0;
    const double to = std::isfinite(key.high) ? boost::math::cdf(normal, key.high) : 1;
    const double part = std::clamp(from + place * (to - from), 1e-12, 1 - 1e-12);
    return float_in_toml(std::clamp(boost::math::quantile(normal, part), key.low, key.high));
  }
  if (key.step) return in_steps(key, std::min(std::floor(place * (steps_of(key) + 1)), steps_of(key)));
  const double value = key.is_log ? key.low * std::pow(key.high / key.low, place) : std::lerp(key.low, key.high, place);
  return number_of(key, std::clamp(value, key.low, key.high));
}

std::vector<std::string> values_of(const StudyKey& key) {
  if (!key.values.empty()) return key.values;
  const double steps = key.step ? steps_of(key) : *key.count - 1;
  std::vector<std::string> values;
  for (double i = 0; i <= steps; ++i)
    values.push_back(key.step ? in_steps(key, i) : value_at(key, steps > 0 ? i / steps : 0));
  return values;
}

using Values = std::vector<std::vector<std::string>>;  // points, each with a value for each key

void refuse_too_many(const StudyInput& study, double runs) {
  if (runs > static_cast<double>(most_runs))
    throw ScenarioError({{study.file, 0, "design", fmt::format("has {:.0f} runs", runs),
                          fmt::format("give fewer points, values or replicates, for at most {} runs", most_runs)}});
}

// Cartesian product; the last key changes fastest.
Values grid(const StudyInput& study) {
  Values points = {{}};
  for (const StudyKey& key : study.keys) {
    const std::vector<std::string> values = values_of(key);
    refuse_too_many(study, static_cast<double>(points.size()) * static_cast<double>(values.size()));
    Values more;
    for (const auto& point : points)
      for (const std::string& value : values) {
        more.push_back(point);
        more.back().push_back(value);
      }
    points = std::move(more);
  }
  return points;
}

Values list(const StudyInput& study) {
  Values points(study.keys.front().values.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    for (const StudyKey& key : study.keys) points[i].push_back(key.values[i]);
  return points;
}

// Value of a key in the scenario. Throws ScenarioError if it has none.
std::string own_value(const StudyInput& study, const toml::table& resolved, const StudyKey& key) {
  const toml::node_view<const toml::node> node = toml::at_path(resolved, key.key);
  if (node.is_value()) return value_in_toml(*node.node());
  throw ScenarioError({{study.file, key.line, "vary." + key.key, "has no single value in the scenario to vary about",
                        "give one in [set], or choose another kind of design"}});
}

// The scenario itself, then each key in turn through its values, the others as in the scenario.
Values one_at_a_time(const StudyInput& study) {
  const toml::table resolved = toml::parse(resolved_toml(load_scenario(study.scenario, study.overrides)));
  std::vector<std::string> own;
  for (const StudyKey& key : study.keys) own.push_back(own_value(study, resolved, key));
  Values points = {own};
  for (std::size_t k = 0; k < study.keys.size(); ++k)
    for (const std::string& value : values_of(study.keys[k])) {
      points.push_back(own);
      points.back()[k] = value;
    }
  return points;
}

Values drawn(const StudyInput& study) {
  const std::size_t count = static_cast<std::size_t>(study.points), dimensions = study.keys.size();
  refuse_too_many(study, static_cast<double>(count) *
                             (study.kind == DesignKind::sobol_indices ? static_cast<double>(dimensions) + 2 : 1));
  const Places places = study.kind == DesignKind::sobol             ? sobol(count, dimensions, study.seed)
                        : study.kind == DesignKind::latin_hypercube ? latin_hypercube(count, dimensions, study.seed)
                                                                    : for_sobol_indices(count, dimensions, study.seed);
  Values points;
  for (const auto& place : places) {
    points.emplace_back();
    for (std::size_t k = 0; k < dimensions; ++k) points.back().push_back(value_at(study.keys[k], place[k]));
  }
  return points;
}

// Number of points without randomness (every spread is 0): their replicates are one run.
std::size_t points_without_spread(const StudyDesign& design, std::map<std::string, double> spreads) {
  return static_cast<std::size_t>(std::ranges::count_if(design.runs, [&](const StudyPoint& point) {
    for (std::size_t k = 0; k < design.keys.size(); ++k)
      if (design.keys[k].ends_with(".variation.spread"))
        spreads[design.keys[k]] = number_in(point.values[k]).value_or(0);
    return std::ranges::none_of(spreads, [](const auto& spread) { return spread.second > 0; });
  }));
}

// Keys of all seeds in the scenario with their values.
std::vector<std::pair<std::string, std::int64_t>> seeds_of(const StudyInput& study, StudyDesign& design) {
  std::vector<std::pair<std::string, std::int64_t>> seeds;
  std::map<std::string, double> spreads;
  bool varies = std::ranges::any_of(design.keys, [](const auto& key) { return key.ends_with("variation.spread"); });
  const toml::table resolved = toml::parse(resolved_toml(load_scenario(study.scenario, study.overrides)));
  for (const char* group : {"contraction", "cortex"})
    if (const toml::table* laws = resolved[group].as_table())
      for (const auto& [name, law] : *laws) {
        const auto variation = toml::node_view(law)["variation"];
        const auto seed = variation["seed"].value<std::int64_t>();
        if (!seed) continue;
        varies = varies || variation["spread"].value_or(0.0) > 0;
        seeds.emplace_back(fmt::format("{}.{}.variation.seed", group, name.str()), *seed);
        spreads[fmt::format("{}.{}.variation.spread", group, name.str())] = variation["spread"].value_or(0.0);
      }
  if (!varies)
    throw ScenarioError({{study.file, 0, "design.replicates", "would all be identical: nothing is random",
                          "give a contraction or cortex a variation.spread, or remove replicates"}});
  if (const std::size_t alike = points_without_spread(design, std::move(spreads)); alike > 0)
    design.notes.push_back({study.file, 0, "design.replicates",
                            fmt::format("{} of {} points have a spread of 0, so their {} replicates are identical",
                                        alike, design.runs.size(), study.replicates),
                            "to save these runs, make them a separate study without replicates"});
  return seeds;
}

}  // namespace

StudyDesign design_of_points(const std::string& file, const std::string& text) {
  const std::vector<std::vector<std::string>> rows = csv_fields(text);
  if (rows.size() < 2 || rows.front().empty())
    throw ScenarioError({{file, 0, "", "no points", "give a row of keys, and one row of values per point"}});
  StudyDesign design{rows.front(), {}};
  for (std::size_t r = 1; r < rows.size(); ++r) {
    if (rows[r].size() != design.keys.size())
      throw ScenarioError({{file, static_cast<int>(r) + 1, "", fmt::format("has {} values", rows[r].size()),
                            fmt::format("give {}, one per key of the first line", design.keys.size())}});
    StudyPoint point{static_cast<int>(r), 1, {}, {}};
    for (const std::string& field : rows[r]) point.values.push_back(word_in_toml(field));
    design.runs.push_back(std::move(point));
  }
  return design;
}

StudyDesign design_of(const StudyInput& study) {
  StudyDesign design;
  if (study.kind == DesignKind::file) {
    design = design_of_points(study.points_file, read_file(study.points_file));
  } else {
    for (const StudyKey& key : study.keys) design.keys.push_back(key.key);
    for (auto& values : study.kind == DesignKind::grid            ? grid(study)
                        : study.kind == DesignKind::list          ? list(study)
                        : study.kind == DesignKind::one_at_a_time ? one_at_a_time(study)
                                                                  : drawn(study))
      design.runs.push_back({0, 1, std::move(values), {}});
  }
  refuse_too_many(study, static_cast<double>(design.runs.size()) * study.replicates);
  const auto seeds = study.replicates > 1 ? seeds_of(study, design) : decltype(seeds_of(study, design)){};
  std::vector<StudyPoint> runs;
  for (std::size_t p = 0; p < design.runs.size(); ++p)
    for (int r = 1; r <= study.replicates; ++r) {
      runs.push_back({static_cast<int>(p) + 1, r, design.runs[p].values, {}});
      for (const auto& [key, seed] : seeds) runs.back().seeds.push_back(fmt::format("{}={}", key, seed + r - 1));
    }
  design.runs = std::move(runs);
  return design;
}

std::vector<std::string> overrides_of(const StudyInput& study, const StudyDesign& design, const StudyPoint& run) {
  std::vector<std::string> overrides = study.overrides;
  overrides.insert(overrides.end(), run.seeds.begin(), run.seeds.end());
  for (std::size_t k = 0; k < design.keys.size(); ++k) overrides.push_back(design.keys[k] + "=" + run.values[k]);
  return overrides;
}

std::string name_of_run(const StudyPoint& run, bool has_replicates) {
  return has_replicates ? fmt::format("{:06}_{}", run.point, run.replicate) : fmt::format("{:06}", run.point);
}

std::string points_csv(const StudyDesign& design) {
  const std::vector<std::string>& keys = design.keys;
  const std::vector<StudyPoint>& runs = design.runs;
  std::string text = "run,point,replicate";
  for (const std::string& key : keys) text += ',' + csv_field(key);
  text += ",seeds\n";
  for (std::size_t r = 0; r < runs.size(); ++r) {
    text += fmt::format("{},{},{}", r, runs[r].point, runs[r].replicate);
    for (const std::string& value : runs[r].values) text += ',' + csv_field(value);
    text += ',' + csv_field(fmt::format("{}", fmt::join(runs[r].seeds, " "))) + '\n';
  }
  return text;
}

StudyDesign points_of_csv(const std::string& text) {
  const auto rows = csv_fields(text);
  const auto refuse = [] { throw FileError("points.csv: not a list of points; restart the study"); };
  if (rows.empty() || rows.front().size() < 4) refuse();
  const auto whole_number = [&](const std::string& field) {
    const double number = number_in(field).value_or(0);
    if (!(number >= 1 && number <= static_cast<double>(most_runs) && number == std::floor(number))) refuse();
    return static_cast<int>(number);
  };
  StudyDesign design;
  design.keys.assign(rows.front().begin() + 3, rows.front().end() - 1);
  for (std::size_t r = 1; r < rows.size(); ++r) {
    const auto& row = rows[r];
    if (row.size() != rows.front().size()) refuse();
    StudyPoint point;
    point.point = whole_number(row[1]);
    point.replicate = whole_number(row[2]);
    point.values.assign(row.begin() + 3, row.end() - 1);
    std::istringstream seeds(row.back());
    for (std::string seed; seeds >> seed;) point.seeds.push_back(seed);
    design.runs.push_back(std::move(point));
  }
  return design;
}

}  // namespace plica
