// Monitors ([monitor.NAME]): user-defined output variables, one number per step for a region. Pure functions of Model
// and State; quantities are defined in docs/reference/measures.md.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "measure/reference_run.hpp"
#include "measure/surface_distance.hpp"
#include "mechanics/cells_apart.hpp"

namespace plica {

struct Monitor;
struct Moment;

struct Quantity {
  enum class Of { node, cell, side, region };     // items with one value each, reduced by `over`; side: of a cell
  enum class Axis { none, may_have, must_have };  // a component instead of the norm
  enum class Reference { none, run, surface };    // reference it is compared with
  std::string_view name;
  std::string_view unit;  // as in column names; empty for a ratio
  Of of;
  std::vector<double> (*values)(const Monitor&, const Moment&);  // empty without a value at this time
  std::string_view meaning;                                      // for docs/reference/measures.md, in Markdown
  Axis axis = Axis::none;
  Reference reference = Reference::none;

  /// Whether `face` selects one side of the cells.
  [[nodiscard]] bool has_face() const { return of == Of::node || name == "area" || name == "curvature"; }
};

std::span<const Quantity> quantities();
const Quantity* quantity_named(std::string_view name);  // null if unknown

enum class Over { mean, max, min, sum, rms };

/// Monitor. The region is looked up at each use, since divisions replace the tissue.
struct Monitor {
  enum class ReferenceAt { same_time, end };

  std::string name;
  const Quantity* quantity = nullptr;
  std::string region = "all";
  std::optional<CellSide> face;                     // only nodes of this side; empty: all; for areas: apical
  std::optional<int> axis;                          // component 0, 1 or 2; empty: norm
  std::string from;                                 // for forces: region of the cells that exert them; empty: all
  mutable std::shared_ptr<const CellsApart> apart;  // these, for the last model
  Over over = Over::mean;
  std::optional<double> at_s;  // time of the value in the summary; empty: the last
  double poisson_ratio = 0;    // for the energy norm
  std::shared_ptr<const ReferenceRun> reference_run;
  std::optional<Frame> reference_frame;  // last snapshot, for comparison with the end
  std::shared_ptr<const SurfaceDistance> reference_surface;

  /// Column in series.csv and key in summary.json: NAME.quantity_unit.
  [[nodiscard]] std::string column() const;
};

struct Moment {
  const Model& model;
  const State& state;
  double wall_s = 0;  // computing time of all steps so far
};

/// Reading of a monitor in the unit of its column: one value per node or cell of its region (or one in all), and their
/// reduction. Empty without a value at this time.
struct Reading {
  std::vector<double> values;
  std::optional<double> number;
};

Reading read_monitor(const Monitor& monitor, const Moment& moment);

/// Nodes read by a monitor, in order.
std::vector<NodeId> monitored_nodes(const Monitor& monitor, const Tissue& tissue);

/// Cells read by a monitor: those of its region; for areas only those with that side.
std::vector<CellId> monitored_cells(const Monitor& monitor, const Tissue& tissue);

/// Reduce values to one number; empty without values.
std::optional<double> combined(Over over, std::span<const double> values);

}  // namespace plica
