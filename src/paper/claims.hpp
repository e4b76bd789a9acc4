// Table of measurable statements of the paper; verdicts follow from measured figures.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "paper/measures.hpp"

namespace plica {

/// Basis of a figure that meets its claim.
enum class Basis {
  fixed,      // no open parameter: mesh, law, invariant
  measured,   // outcome; its dependence on the reading shows in the scanned readings
  calibrated  // an open parameter was fitted to it
};

struct Claim {
  std::string section;               // of the paper, or note of our reading
  std::string text;                  // in our words
  std::string printed;               // value as printed
  std::string figure;                // name of our figure; prefixes "pill." and "sphere.": chosen reading
  double low = 0, high = 0;          // range in which the claim is met
  std::optional<double> value = {};  // printed number for the difference; empty: none
  std::string unit = {};
  Basis basis = Basis::measured;
  std::string cause = {};   // cause, if not met
  std::string remark = {};  // remark, if met
};

std::span<const Claim> claims();

enum class Verdict { reproduced, under_this_reading, not_reproduced };
const char* word_of(Verdict verdict);

/// Judge a claim. `ours`: figure in the chosen reading, empty if the event never happened. `scanned`: the figure in all
/// scanned readings. *reproduced*: within low and high in all of them; *under this reading*: only in the chosen one, or
/// after fitting.
Verdict verdict(const Claim& claim, std::optional<double> ours, std::span<const std::optional<double>> scanned);

}  // namespace plica
