// What a step of signals is made of (signals.cpp): diffusion and decay, reactions, and the parts of a step.
#pragma once

#include <fmt/format.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <memory>

#include "mechanics/active/shape_activation.hpp"
#include "mechanics/signals/signals.hpp"

namespace plica {

inline double largest_magnitude(std::span<const double> values) {
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

/// Return a rule that reads a measure of cells, by its number.
inline ShapeActivationRule measured(std::size_t measure) {
  return {.kind = ShapeActivationRule::Kind::follows, .measure = static_cast<ShapeMeasure>(measure)};
}

/// Return the vector from the centre of one cell to that of another, or to its nearest image in a periodic tissue.
inline Vec3 between_centres(const Tissue& tissue, const Vec3& from, const Vec3& to) {
  Vec3 apart = to - from;
  for (int axis = 0; axis < 3; ++axis)
    if (const double period = tissue.period[axis]; period > 0) apart[axis] -= period * std::round(apart[axis] / period);
  return apart;
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

  // Solve the system of its matrix; right side: one number per cell.
  [[nodiscard]] std::vector<double> solution(std::span<const double> right, std::span<const double> volumes) const {
    std::vector<double> c(right.begin(), right.end());
    if (!diffuses) {
      for (std::size_t i = 0; i < c.size(); ++i) c[i] /= growth * volumes[i];
      return c;
    }
    const auto n = static_cast<Eigen::Index>(c.size());
    Eigen::VectorXd::Map(c.data(), n) = factor.solve(Eigen::VectorXd::Map(right.data(), n)).eval();
    return c;
  }

  // Return concentrations from the right side, an amount per cell.
  [[nodiscard]] std::vector<double> solve(std::span<const double> amounts, std::span<const double> volumes) const {
    std::vector<double> c = solution(amounts, volumes);
    if (!diffuses) return c;
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
      measures.push_back(is_read ? ShapeActivation(tissue, measured(m)).ratios(positions) : std::vector<double>());
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

  // Return `part` of the largest value of each signal, or of 1.
  [[nodiscard]] static std::vector<double> small_changes(const Values& at, double part) {
    std::vector<double> changes;
    for (const CellArray& c : at) {
      const double largest = largest_magnitude(c);
      changes.push_back(part * (largest > 0 ? largest : 1));
    }
    return changes;
  }

  // Bound of the rates at which small changes of signals grow or fade, per second, and its cell: the largest sum of a
  // row of the reactions' derivatives, as differences over a thousandth of the largest value of a signal.
  struct Fastest {
    double rate = 0;
    CellId cell;
  };
  [[nodiscard]] Fastest fastest(const Values& at, const Values& rates) {
    const std::vector<double> changes = small_changes(at, 1e-3);
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

  // Derivative of a rate in the present cell by a variable, as a difference over twice `change`; of one side where the
  // other has no value.
  [[nodiscard]] double slope(std::size_t signal, std::size_t by, double change) {
    const double value = variables[by], here = rate(signal);
    const auto at = [&](double other) {
      variables[by] = other;
      const double result = rate(signal);
      variables[by] = value;
      return result;
    };
    const double more = at(value + change), less = at(value - change);
    if (std::isfinite(more) && std::isfinite(less)) return (more - less) / (2 * change);
    return std::isfinite(more) ? (more - here) / change : std::isfinite(less) ? (here - less) / change : 0;
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

/// Step of signals: concentrations at its beginning and after each of its equal parts, and what each signal does in
/// one.
struct Signals::Parts {
  std::vector<Values> values;                          // parts + 1
  std::vector<std::unique_ptr<Diffusion>> diffusions;  // signals
};

}  // namespace plica
