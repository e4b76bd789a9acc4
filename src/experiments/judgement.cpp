#include <algorithm>
#include <array>
#include <boost/math/distributions/beta.hpp>

#include "experiments/experiments.hpp"

namespace plica {

std::optional<double> compared(const Outcome& outcome, std::optional<double> value,
                               std::optional<double> compared_value) {
  if (outcome.comparing == Comparing::nothing || !value) return value;
  if (!compared_value || (outcome.comparing == Comparing::ratio && *compared_value == 0)) return std::nullopt;
  return outcome.comparing == Comparing::ratio ? *value / *compared_value : *value - *compared_value;
}

Judgement judge(const Outcome& outcome, std::optional<double> value, std::optional<double> compared_value) {
  if (!value) return outcome.hit_if_none ? Judgement::hit : Judgement::miss;
  const std::optional<double> number = compared(outcome, value, compared_value);
  if (!number) return Judgement::undecided;
  if (*number >= outcome.low && *number <= outcome.high) return Judgement::hit;
  const bool is_near = *number >= outcome.low - outcome.margin && *number <= outcome.high + outcome.margin;
  return is_near ? Judgement::undecided : Judgement::miss;
}

Interval probability_of_hit(std::size_t hits, std::size_t draws) {
  // Not by way of long double, as is Boost's default: Valgrind has no numbers of 80 bits, and the tables for them
  // overflow there.
  using Policy = boost::math::policies::policy<boost::math::policies::promote_double<false>>;
  const boost::math::beta_distribution<double, Policy> known(1 + static_cast<double>(hits),
                                                             1 + static_cast<double>(draws - hits));
  return {boost::math::quantile(known, 0.05), boost::math::quantile(known, 0.95)};
}

Judgement Tally::verdict() const {
  constexpr double most = 0.8;
  const double needed = most * static_cast<double>(draws) - 1e-9;
  if (draws > 0 && static_cast<double>(hits) >= needed) return Judgement::hit;
  if (draws > 0 && static_cast<double>(misses) >= needed) return Judgement::miss;
  return Judgement::undecided;
}

const char* word_of(ClaimVerdict verdict) {
  constexpr std::array words = {"reproduced", "under this reading", "not reproduced", "not solved"};
  return words[static_cast<std::size_t>(verdict)];
}

ClaimVerdict verdict_of_claim(std::optional<Judgement> first, bool in_every_reading, Role role) {
  using enum ClaimVerdict;
  if (first == Judgement::not_solved) return not_solved;
  if (first != Judgement::hit) return not_reproduced;
  return in_every_reading && role != Role::fitted ? reproduced : under_this_reading;
}

Tally tally_of(std::span<const Judgement> draws) {
  const auto count = [&](Judgement which) { return static_cast<std::size_t>(std::ranges::count(draws, which)); };
  return {draws.size(), count(Judgement::hit), count(Judgement::miss), count(Judgement::not_solved)};
}

}  // namespace plica
