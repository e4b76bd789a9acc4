// From measured numbers to verdicts: of one run, and of an outcome over its draws, with the probability of a hit.
#pragma once

#include <optional>
#include <span>

#include "experiments/experiments.hpp"

namespace plica {

/// The number that an outcome asks for, of the run's own quantity and that of the other experiment: none where one of
/// them has none, or it would be a ratio to 0.
std::optional<double> compared(const Outcome& outcome, std::optional<double> own, std::optional<double> other);

/// Of the numbers of one run: a hit from `low` to `high`, undecided up to `margin` outside of these, else a miss.
/// Without a number of its own a miss, or a hit where the outcome says so; undecided where the other one has none.
Judgement judge(const Outcome& outcome, std::optional<double> own, std::optional<double> other = {});

/// From where to where.
struct Interval {
  double low = 0, high = 1;
};

/// What is known of the probability of a hit after `hits` of `draws`, when every value was as likely before: the middle
/// 90 % of Beta(1 + hits, 1 + draws - hits).
Interval probability_of_hit(std::size_t hits, std::size_t draws);

/// How an outcome came out over its draws.
struct Tally {
  std::size_t draws = 0, hits = 0, misses = 0, not_solved = 0;

  /// A hit where 80 % of the draws hit, a miss where 80 % miss, else undecided. So is an outcome without draws.
  [[nodiscard]] Judgement verdict() const;
};
Tally tally_of(std::span<const Judgement> draws);

}  // namespace plica
