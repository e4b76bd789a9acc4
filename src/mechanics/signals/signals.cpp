#include "mechanics/signals/signals.hpp"

#include <fmt/format.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

namespace plica {
namespace {

double largest_magnitude(std::span<const double> values) {
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

// Vector from the centre of one cell to that of another, or to its nearest image in a periodic tissue.
Vec3 between_centres(const Tissue& tissue, const Vec3& from, const Vec3& to) {
  Vec3 apart = to - from;
  for (int axis = 0; axis < 3; ++axis)
    if (const double period = tissue.period[axis]; period > 0) apart[axis] -= period * std::round(apart[axis] / period);
  return apart;
}

}  // namespace

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

// Diffusion and decay of one signal over a time: its matrix, factorised.
struct Signals::Diffusion {
  double growth = 1, rate_s = 0;  // exp(k h); p h
  bool diffuses = false;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor;

  Diffusion(const SignalRule& rule, std::span<const Face> faces, std::span<const double> conductances,
            std::span<const double> volumes, double duration_s)
      : growth(std::exp(rule.decay * duration_s)),
        rate_s(rule.decay > 0 ? std::expm1(rule.decay * duration_s) / rule.decay : duration_s),
        diffuses(rule.diffusion > 0 && !faces.empty()) {
    if (!diffuses) return;
    std::vector<Eigen::Triplet<double>> entries;
    const auto cells = static_cast<int>(volumes.size());
    for (int c = 0; c < cells; ++c) entries.emplace_back(c, c, growth * volumes[static_cast<std::size_t>(c)]);
    for (std::size_t f = 0; f < faces.size(); ++f) {
      const double g = rate_s * rule.diffusion * conductances[f];
      const int a = faces[f].cell.number(), b = faces[f].beyond->number();
      entries.emplace_back(a, a, g);
      entries.emplace_back(b, b, g);
      entries.emplace_back(std::max(a, b), std::min(a, b), -g);  // the factor reads the lower half
    }
    Eigen::SparseMatrix<double> matrix(cells, cells);
    matrix.setFromTriplets(entries.begin(), entries.end());
    factor.compute(matrix);
  }

  // Solve for concentrations from the right-hand side, an amount per cell.
  [[nodiscard]] std::vector<double> solve(std::span<const double> amounts, std::span<const double> volumes) const {
    std::vector<double> c(amounts.begin(), amounts.end());
    if (!diffuses) {
      for (std::size_t i = 0; i < c.size(); ++i) c[i] /= growth * volumes[i];
      return c;
    }
    const auto n = static_cast<Eigen::Index>(c.size());
    Eigen::VectorXd::Map(c.data(), n) = factor.solve(Eigen::VectorXd::Map(amounts.data(), n)).eval();
    // Rounding of the solution, which fast diffusion enlarges, must not add up to amounts lost.
    double expected = 0, sum = 0;
    for (std::size_t i = 0; i < c.size(); ++i) expected += amounts[i], sum += growth * volumes[i] * c[i];
    if (std::abs(expected - sum) <= 1e-9 * std::abs(sum))
      for (double& value : c) value *= expected / sum;
    return c;
  }
};

// Reactions of all signals in all cells, per second.
struct Signals::Chemistry {
  std::vector<std::optional<Reaction>> reactions;  // signals
  std::vector<std::vector<double>> measures;       // cells, by measure; empty: no reaction reads it
  std::vector<double> variables;                   // of one cell

  Chemistry(const std::vector<SignalRule>& rules, const Tissue& tissue, const Vectors& positions) {
    std::vector<std::string> names;
    for (const SignalRule& rule : rules) names.push_back(rule.name);
    names = reaction_variables(names);
    for (const SignalRule& rule : rules) {
      auto& reaction = reactions.emplace_back();
      if (!rule.reaction.empty()) reaction.emplace(rule.reaction, names, rule.constants);
    }
    for (std::size_t m = 0; m < shape_measure_names.size(); ++m) {
      const std::string name(shape_measure_names[m]);
      const bool is_read = std::ranges::any_of(reactions, [&](const auto& one) { return one && one->reads(name); });
      const ShapeActivationRule rule{.kind = ShapeActivationRule::Kind::follows,
                                     .measure = static_cast<ShapeMeasure>(m)};
      measures.push_back(is_read ? ShapeActivation(tissue, rule).ratios(positions) : std::vector<double>());
    }
    variables.resize(names.size());
  }

  [[nodiscard]] bool any() const {
    return std::ranges::any_of(reactions, [](const auto& one) { return one.has_value(); });
  }

  void go_to(std::size_t cell, const Values& values) {
    for (std::size_t s = 0; s < values.size(); ++s) variables[s] = values[s][cell];
    for (std::size_t m = 0; m < measures.size(); ++m)
      variables[values.size() + m] = measures[m].empty() ? 1 : measures[m][cell];
  }

  // Rate of one signal in the present cell, per second.
  [[nodiscard]] double rate(std::size_t signal) {
    return reactions[signal] ? reactions[signal]->at(variables) / 60 : 0;
  }

  // Rates of all signals in all cells.
  [[nodiscard]] std::optional<SignalFailure> take_rates(const std::vector<SignalRule>& rules, const Values& at,
                                                        Values& rates) {
    for (std::size_t i = 0; i < at.front().size(); ++i) {
      go_to(i, at);
      for (std::size_t s = 0; s < at.size(); ++s) {
        rates[s][i] = rate(s);
        if (!std::isfinite(rates[s][i]))
          return SignalFailure{fmt::format("the reaction of signal {} is not finite", rules[s].name), CellId(i),
                               fmt::format("change signal.{}.reaction", rules[s].name)};
      }
    }
    return std::nullopt;
  }

  // Bound of the rates at which small changes of signals grow or fade, per second, and its cell: the largest sum of a
  // row of the reactions' derivatives, as differences over a thousandth of the largest value of a signal.
  struct Fastest {
    double rate = 0;
    CellId cell;
  };
  [[nodiscard]] Fastest fastest(const Values& at, const Values& rates) {
    std::vector<double> changes;
    for (const CellArray& c : at) {
      const double largest = largest_magnitude(c);
      changes.push_back(1e-3 * (largest > 0 ? largest : 1));
    }
    Fastest result;
    for (std::size_t i = 0; i < at.front().size(); ++i) {
      go_to(i, at);
      for (std::size_t s = 0; s < at.size(); ++s) {
        double sum = 0;
        for (std::size_t j = 0; reactions[s] && j < at.size(); ++j) sum += derivative(s, rates[s][i], j, changes[j]);
        if (sum > result.rate) result = {sum, CellId(i)};
      }
    }
    return result;
  }

  // Magnitude of the derivative of a rate in the present cell by signal `by`; 0 where neither side of it has a value.
  [[nodiscard]] double derivative(std::size_t signal, double rate_here, std::size_t by, double change) {
    const double value = variables[by];
    double result = 0;
    for (const double changed : {value + change, value - change}) {
      variables[by] = changed;
      result = std::abs(rate(signal) - rate_here) / change;
      if (std::isfinite(result)) break;
      result = 0;
    }
    variables[by] = value;
    return result;
  }
};

std::optional<SignalFailure> Signals::advance(const Tissue& tissue, const Geometry& geometry, double duration_s,
                                              Values& values) const {
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
    std::vector<std::unique_ptr<Diffusion>> diffusions;
    Values now = begin, rates(size(), CellArray(cells, 0.0));
    bool is_short_enough = true;
    for (int part = 0; part < parts; ++part) {
      if (reacts) {
        if (auto failure = chemistry.take_rates(rules_, now, rates)) return failure;
        fastest = chemistry.fastest(now, rates);
        is_short_enough = part_s * fastest.rate <= most_change;
        if (!is_short_enough) break;
      }
      for (std::size_t s = 0; s < size(); ++s) {
        if (part == 0) diffusions.push_back(std::make_unique<Diffusion>(rules_[s], faces_, g, volumes, part_s));
        std::vector<double> amounts(cells);
        for (std::size_t i = 0; i < cells; ++i)
          amounts[i] = volumes[i] * (now[s][i] + diffusions[s]->rate_s * (rules_[s].sources[i] + rates[s][i]));
        now[s] = diffusions[s]->solve(amounts, volumes);
        const auto bad = std::ranges::find_if(now[s], [](double c) { return !std::isfinite(c); });
        if (bad != now[s].end())
          return SignalFailure{fmt::format("signal {} is not finite", rules_[s].name),
                               CellId(static_cast<std::size_t>(bad - now[s].begin())),
                               fmt::format("reduce its sources, or change signal.{}.reaction", rules_[s].name)};
      }
    }
    if (!is_short_enough) continue;
    values = std::move(now);
    return std::nullopt;
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
