// Every figure and claim of the paper that asserts something measurable, as a table; verdicts follow from the figures.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "paper/measures.hpp"

namespace plica {

/// What stands behind a figure that meets its claim.
enum class Basis {
  fixed,      // nothing in it is open: mesh, law, invariant
  measured,   // an outcome; whether it hangs on the reading shows in the readings that are scanned
  calibrated  // an open parameter was chosen to meet it
};

struct Claim {
  std::string section;               // of the paper, or the note of our reading
  std::string text;                  // in our words
  std::string printed;               // value, as printed
  std::string figure;                // name of our figure; "pill." and "sphere." ones are of the chosen reading
  double low = 0, high = 0;          // met within
  std::optional<double> value = {};  // printed number that the difference is to; without it, none is given
  std::string unit = {};
  Basis basis = Basis::measured;
  std::string cause = {};   // why, where it is not met
  std::string remark = {};  // where it is met
};

std::span<const Claim> claims();

enum class Verdict { reproduced, under_this_reading, not_reproduced };
const char* word_of(Verdict verdict);

/// `ours`: the figure in the chosen reading, empty where what it measures never happened. `scanned`: the same figure in
/// each reading that a claim must hold in to need no choice. *reproduced*: within low and high, whatever is chosen;
/// *under this reading*: within, but by a choice.
Verdict verdict(const Claim& claim, std::optional<double> ours, std::span<const std::optional<double>> scanned);

}  // namespace plica
