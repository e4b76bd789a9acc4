#include "mechanics/signals/signals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "mechanics/signals/signal_parts.hpp"

namespace plica {

std::vector<std::string> reaction_variables(const std::vector<std::string>& signals) {
  std::vector<std::string> names = signals;
  names.insert(names.end(), shape_measure_names.begin(), shape_measure_names.end());
  return names;
}

Signals::Signals(const Tissue& tissue, std::vector<SignalRule> rules)
    : rules_(std::move(rules)), faces_(faces_of(tissue, CellSide::lateral)) {
  std::erase_if(faces_, [](const Face& face) { return !face.beyond; });
}

Signals::Values Signals::initial() const {
  Values values;
  for (const SignalRule& rule : rules_) values.push_back(rule.initial);
  return values;
}

Signals Signals::after(const Tissue& tissue, const TissueChange& change) const {
  if (empty()) return {};
  std::vector<SignalRule> rules = rules_;
  follow(change, rules);
  return {tissue, std::move(rules)};
}

// A/d of each face, um.
std::vector<double> Signals::conductances(const Tissue& tissue, const Vectors& positions) const {
  Vectors centres;
  for (const Cell& cell : tissue.cells) centres.push_back(cell_centre(cell, positions));
  std::vector<double> result;
  for (const Face& face : faces_) {
    const Vec3 apart = between_centres(tissue, centres[face.cell.index()], centres[face.beyond->index()]);
    result.push_back(face.share * facet_area(gather(positions, face.nodes)) / apart.norm());
  }
  return result;
}

std::optional<SignalFailure> Signals::advance(const Tissue& tissue, const Geometry& geometry, double duration_s,
                                              Values& values) const {
  Parts parts;
  auto failure = take_parts(tissue, geometry, duration_s, values, parts);
  if (!failure) values = std::move(parts.values.back());
  return failure;
}

std::optional<SignalFailure> Signals::take_parts(const Tissue& tissue, const Geometry& geometry, double duration_s,
                                                 const Values& values, Parts& result) const {
  constexpr int most_parts = 1024;
  constexpr double most_change = 0.05;  // of a small change of concentrations, by reactions within a part
  const auto& [volumes_before, volumes, positions] = geometry;
  const std::size_t cells = volumes.size();

  // Amounts stay while cells change their volume.
  Values begin = values;
  for (CellArray& c : begin)
    for (std::size_t i = 0; i < cells; ++i) c[i] *= volumes_before[i] / volumes[i];

  const std::vector<double> g = conductances(tissue, positions);
  Chemistry chemistry(rules_, tissue, positions);
  const bool reacts = chemistry.any();
  Chemistry::Fastest fastest;
  for (int parts = 1; parts <= most_parts; parts *= 2) {
    const double part_s = duration_s / parts;
    result = {};
    result.values.push_back(begin);
    Values rates(size(), CellArray(cells, 0.0));
    bool is_short_enough = true;
    for (int part = 0; part < parts; ++part) {
      Values now = result.values.back();
      if (reacts) {
        if (auto failure = chemistry.take_rates(rules_, now, rates)) return failure;
        fastest = chemistry.fastest(now, rates);
        is_short_enough = part_s * fastest.rate <= most_change;
        if (!is_short_enough) break;
      }
      for (std::size_t s = 0; s < size(); ++s) {
        if (part == 0) result.diffusions.push_back(std::make_unique<Diffusion>(rules_[s], faces_, g, volumes, part_s));
        const Diffusion& diffusion = *result.diffusions[s];
        std::vector<double> amounts(cells);
        for (std::size_t i = 0; i < cells; ++i)
          amounts[i] = volumes[i] * (now[s][i] + diffusion.rate_s * (rules_[s].sources[i] + rates[s][i]));
        now[s] = diffusion.solve(amounts, volumes);
        const auto bad = std::ranges::find_if(now[s], [](double c) { return !std::isfinite(c); });
        if (bad != now[s].end())
          return SignalFailure{fmt::format("signal {} is not finite", rules_[s].name),
                               CellId(static_cast<std::size_t>(bad - now[s].begin())),
                               fmt::format("reduce its sources, or change signal.{}.reaction", rules_[s].name)};
      }
      result.values.push_back(std::move(now));
    }
    if (is_short_enough) return std::nullopt;
  }
  return SignalFailure{fmt::format("the reactions of signals are faster than {} parts of a step of {:g} s resolve",
                                   most_parts, duration_s),
                       fastest.cell, "reduce their rates, or time.max_step_s"};
}

Signals::Values inherited_signals(const TissueChange& change, std::span<const double> volumes_before,
                                  std::span<const double> volumes_after, const Signals::Values& values) {
  std::vector<double> after(volumes_before.size(), 0.0);  // volume of the descendants of each cell
  for (std::size_t c = 0; c < change.origin.size(); ++c) after[change.origin[c].index()] += volumes_after[c];
  Signals::Values result = values;
  follow(change, result);
  for (CellArray& array : result)
    for (std::size_t c = 0; c < array.size(); ++c) {
      const std::size_t origin = change.origin[c].index();
      array[c] *= volumes_before[origin] / after[origin];
    }
  return result;
}

bool are_at_rest(const Signals::Values& before, const Signals::Values& after, double duration_s) {
  for (std::size_t s = 0; s < after.size(); ++s) {
    const double most = 1e-3 * largest_magnitude(after[s]) * duration_s / 60;
    for (std::size_t c = 0; c < after[s].size(); ++c)
      if (std::abs(after[s][c] - before[s][c]) > most) return false;
  }
  return true;
}

}  // namespace plica
