// Symmetry checks for `embryo.mirror`.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "scenario/acting.hpp"
#include "tissue/mirror.hpp"

namespace plica {

/// Collects errors of input that mirror planes do not allow.
class SymmetryCheck {
 public:
  SymmetryCheck(const Scenario& scenario, const Tissue& whole, const Mirror& mirror)
      : scenario_(scenario), whole_(whole), mirror_(mirror) {}

  /// Return whether a region that `table` uses is symmetric.
  bool check_region(const std::string& table, const std::string& region);
  void check_acting(const Acting& acting);
  void check_nodes(const std::string& table, const std::vector<bool>& held);
  void finish() const;  // throws ScenarioError if there are errors

  [[nodiscard]] const Tissue& whole() const { return whole_; }

 private:
  // Returns the first cell of the whole that differs from its mirror image on the side.
  [[nodiscard]] std::optional<CellId> first_cell(const std::function<bool(std::size_t, std::size_t)>& differ) const;
  void refuse(const std::string& key, std::string problem, std::string remedy);

  const Scenario& scenario_;
  const Tissue& whole_;
  const Mirror& mirror_;
  std::vector<Diagnostic> errors_;
};

/// Returns the solved side of the scenario's mirror planes (at least one). Throws ScenarioError if the tissue, or input
/// on its cells and nodes, is not symmetric.
MirroredSide mirrored_side(const Scenario& scenario, const Tissue& whole);

}  // namespace plica
