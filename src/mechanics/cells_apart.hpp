// Some cells of a model without the others, with laws of their own.
#pragma once

#include <cstdint>

#include "mechanics/model.hpp"
#include "tissue/tissue_change.hpp"

namespace plica {

/// Cells that keep their elements and faces; nodes keep their numbers, used or not.
class CellsApart {
 public:
  CellsApart(const Model& model, const Vectors& positions, const CellSet& cells);
  [[nodiscard]] bool are_of(const Model& model) const { return model.revision == revision_; }

  /// Return these cells as a model: laws, volumes and other constraints. Contact and compressible enclosed volumes
  /// exert no force in a part.
  [[nodiscard]] const Model& model() const { return part_; }
  /// Return the number of a cell among these; invalid: it is not one.
  [[nodiscard]] CellId number_of(CellId cell) const;
  /// Return their state in a state of the whole model: without contacts, signals and recent rates.
  [[nodiscard]] State state(const Model& whole, const State& state) const;

  /// Return their static force on nodes, nN; nodes, in a state of that model: elasticity, contraction, applied and cell
  /// pressures. The other cells exert the opposite, except for drag and the shell.
  [[nodiscard]] Vectors forces(const Model& whole, const State& state) const;

 private:
  std::uint64_t revision_;  // of the whole model
  TissueChange kept_;       // of its tissue
  Model part_;
};

}  // namespace plica
