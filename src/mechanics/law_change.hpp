// What changes of the tissue (division, exchange, extrusion) and growth do to a law.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/ids.hpp"
#include "core/number_list.hpp"
#include "core/vector.hpp"

namespace plica {

class Law;
struct GrowthTensor;
struct Tissue;
struct TissueChange;

/// Positions of nodes at a change of the tissue, um; empty for a part of it.
struct ChangePositions {
  std::span<const Vec3> before, after;
};

class LawChange {
 public:
  /// Return the law for the tissue after a change (division, exchange, extrusion), with nodes at `positions`. Forces on
  /// existing nodes are unchanged by a division, except for effects of finer elements. Also called for a tissue of some
  /// cells only (CellsApart) and after extrusion, so previous cells and nodes may be missing.
  [[nodiscard]] virtual std::unique_ptr<Law> after_change(const Tissue& tissue, const TissueChange& change,
                                                          std::span<const Vec3> positions) const = 0;
  /// Return the internal state after a change of the tissue from the one before; called on the law before the change.
  [[nodiscard]] virtual std::vector<double> internal_after_change(std::span<const double> internal,
                                                                  const Tissue& /*tissue*/,
                                                                  const TissueChange& /*change*/,
                                                                  const ChangePositions& /*positions*/) const {
    return {internal.begin(), internal.end()};
  }

  /// Return the data that past divisions left in the law: numbers that the law of the initial tissue, the origins of
  /// cells and the present tissue do not determine.
  [[nodiscard]] virtual std::vector<double> past() const { return {}; }
  /// Return the law with this past for a tissue that divisions made of its own; `change` has no new nodes. Called on
  /// the law of the initial tissue, with reference positions. Throws InvalidNumbers for the past of another law or
  /// tissue.
  [[nodiscard]] virtual std::unique_ptr<Law> restored(const Tissue& tissue, const TissueChange& change,
                                                      std::span<const Vec3> positions,
                                                      std::span<const double> past) const;

  /// Return the law for the tissue after growth, in which these elements have other rest shapes, and cells other target
  /// volumes. `tensors`: growth of each cell since the last change of the tissue (`grow`); may be empty.
  [[nodiscard]] virtual std::unique_ptr<Law> grown(const Tissue& tissue, std::span<const ElementId> elements,
                                                   std::span<const GrowthTensor> tensors) const = 0;
  /// Multiply the growth of cells by that of this law, from the last change of the tissue to a time at or after that of
  /// the internal state. Laws without growth do nothing; without any, `tensors` stays empty.
  virtual void grow(std::span<const double> /*internal*/, double /*time_s*/,
                    std::vector<GrowthTensor>& /*tensors*/) const {}
  /// Whether any cell grows or shrinks just after a time.
  [[nodiscard]] virtual bool is_growing(std::span<const double> /*internal*/, double /*time_s*/) const { return false; }

 protected:
  ~LawChange() = default;
};

}  // namespace plica
