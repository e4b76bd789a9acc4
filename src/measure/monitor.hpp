// [monitor.NAME]: one number a step about a region, as the paper's monitoring language has them. Pure functions of
// Model and State; docs/reference/measures.md says what each quantity means.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "measure/reference_run.hpp"
#include "measure/surface_distance.hpp"
#include "mechanics/model.hpp"

namespace plica {

enum class Quantity {
  position,
  displacement,
  speed,
  velocity,
  deviation,
  relative_energy_norm,
  surface_distance,
  force,
  volume,
  area,
  area_ratio,
  apical_elongation,
  pressure,
  kinetic_energy,
  time,
  wall
};

/// What is known of a quantity, whatever it is monitored on.
struct QuantityInfo {
  enum class Of { node, cell, region };           // what has a value of its own; `over` makes one number of them
  enum class Axis { none, may_have, must_have };  // a component instead of the norm
  enum class Reference { none, run, surface };    // what it is measured against
  Quantity quantity;
  std::string_view name;
  std::string_view unit;  // as in a column's name; empty for a ratio
  Of of;
  std::string_view meaning;  // for docs/reference/measures.md, in Markdown
  Axis axis = Axis::none;
  Reference reference = Reference::none;

  /// Nodes, or the area, of one side of the cells.
  [[nodiscard]] bool has_face() const { return of == Of::node || quantity == Quantity::area; }
};

std::span<const QuantityInfo> quantities();
const QuantityInfo& info_of(Quantity quantity);
const QuantityInfo* quantity_named(std::string_view name);  // null where there is none

enum class Over { mean, max, min, sum, rms };

/// One monitor. The region is looked up at every use, because division makes a new tissue.
struct Monitor {
  enum class Face { any, apical, basal };
  enum class ReferenceAt { same_time, end };

  std::string name;
  Quantity quantity = Quantity::displacement;
  std::string region = "all";
  Face face = Face::any;    // only nodes of this side; of the area, its side (any: apical)
  std::optional<int> axis;  // 0 1 2: that component; empty: the norm
  std::string from;         // of a force: only what the cells of this region exert
  Over over = Over::mean;
  std::optional<double> at_s;  // when the value is taken that a summary has; empty: the last
  double poisson_ratio = 0;    // of the energy norm
  std::shared_ptr<const ReferenceRun> reference_run;
  std::optional<Frame> reference_frame;  // the run's last one, where it is measured against its end
  std::shared_ptr<const SurfaceDistance> reference_surface;

  /// NAME.quantity_unit: its column in series.csv and its key in summary.json.
  [[nodiscard]] std::string column() const;
};

/// A moment of a run.
struct Moment {
  const Model& model;
  const State& state;
  double wall_s = 0;  // computing time of all steps so far
};

/// A monitor at a moment, in the unit of its column: a value for each node or cell of its region (or one for all of
/// it), and the number they make. No values: the monitor has none at this moment.
struct Reading {
  std::vector<double> values;
  std::optional<double> number;
};

/// What cells exert on nodes while the body stands still, nN: elasticity, contraction, applied pressures and the
/// pressures that hold their volumes. The rest of the body exerts the opposite, but for drag and the shell.
Vectors forces_of_cells(const Model& model, const State& state, const CellSet& cells);

Reading read_monitor(const Monitor& monitor, const Moment& moment);

/// The nodes that a monitor of nodes reads, in their order.
std::vector<NodeId> monitored_nodes(const Monitor& monitor, const Tissue& tissue);

/// The cells that a monitor of cells reads: those of its region, of the area only those that have that side.
std::vector<CellId> monitored_cells(const Monitor& monitor, const Tissue& tissue);

/// One number of many; nothing of none.
std::optional<double> combined(Over over, std::span<const double> values);

}  // namespace plica
