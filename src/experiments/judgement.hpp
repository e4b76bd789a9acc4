// Judgement of measured numbers: one run, and an outcome over its draws with the probability of a hit.
#pragma once

#include <optional>
#include <span>

#include "experiments/experiments.hpp"

namespace plica {

/// Number to judge, from the run's own value and that of the other experiment; empty if a value is missing or a ratio
/// has denominator 0.
std::optional<double> compared(const Outcome& outcome, std::optional<double> own, std::optional<double> other);

/// Judge one run: hit from `low` to `high`, undecided up to `margin` outside, else miss. A missing own number is a
/// miss, or a hit with `hit_if_none`; a missing other number is undecided.
Judgement judge(const Outcome& outcome, std::optional<double> own, std::optional<double> other = {});

/// Closed interval.
struct Interval {
  double low = 0, high = 1;
};

/// Credible interval (90 %) of the probability of a hit after `hits` of `draws` with a uniform prior: central interval
/// of Beta(1 + hits, 1 + draws - hits).
Interval probability_of_hit(std::size_t hits, std::size_t draws);

/// Counts of an outcome over its draws.
struct Tally {
  std::size_t draws = 0, hits = 0, misses = 0, not_solved = 0;

  /// Hit if 80 % of the draws hit, miss if 80 % miss, else undecided (also without draws).
  [[nodiscard]] Judgement verdict() const;
};
Tally tally_of(std::span<const Judgement> draws);

/// Verdict of a claim: reproduced if it is a hit in every reading of an open text (draw); under this reading if in the
/// first but not in all, or fitted; else not reproduced.
enum class ClaimVerdict { reproduced, under_this_reading, not_reproduced, not_solved };
const char* word_of(ClaimVerdict verdict);
ClaimVerdict verdict_of_claim(std::optional<Judgement> first, bool in_every_reading, Role role);

}  // namespace plica
