// [hold.NAME]: fixed nodes.
#include <algorithm>

#include "scenario/setup.hpp"
#include "scenario/tables/table.hpp"

namespace plica {
namespace of_hold {

// One entry per node.
std::vector<bool> held_nodes(const HoldInput& input, const Tissue& tissue) {
  const auto inside = [](const std::optional<Range>& range, double value) {
    // The tolerance includes nodes on a plane given as [a, a] despite rounding.
    return !range || (value >= (*range)[0] - 1e-9 && value <= (*range)[1] + 1e-9);
  };
  const CellSet& cells = tissue.regions.at(input.region);
  std::vector<bool> held(tissue.node_count(), false);
  for (std::size_t e = 0; e < tissue.elements.size(); ++e) {
    if (!cells[tissue.element_cell[e].index()]) continue;
    for (const NodeId node : tissue.elements[e]) {
      const Vec3& x = tissue.rest_positions[node.index()];
      if (inside(input.x_um, x.x()) && inside(input.y_um, x.y()) && inside(input.z_um, x.z()))
        held[node.index()] = true;
    }
  }
  return held;
}

void take_nodes(const Scenario& scenario, const Tissue& tissue, const TakeNodes& take) {
  for (const auto& [name, input] : scenario.holds) take("hold." + name, held_nodes(input, tissue));
}

void check_holds(const Scenario& scenario, const Tissue& tissue, Errors& errors) {
  take_nodes(scenario, tissue, [&](const std::string& table, const std::vector<bool>& nodes) {
    if (std::ranges::find(nodes, true) == nodes.end())
      errors.push_back(diagnostic_at(scenario, table, "no node of the region lies in these ranges",
                                     "widen x_um, y_um or z_um; `plica mesh` writes the positions of nodes"));
  });
}

void build(const Scenario& scenario, const Origin&, Model& model) {
  for (const auto& [name, input] : scenario.holds) {
    const std::vector<bool> nodes = held_nodes(input, model.tissue);
    for (std::size_t n = 0; n < nodes.size(); ++n)
      for (const std::string& direction : input.directions)
        if (nodes[n]) hold_node(NodeId(n), meaning_of(words::axes, direction), model);
  }
}

}  // namespace of_hold

ScenarioTable hold_table() {
  using namespace of_hold;
  using H = HoldInput;
  ScenarioTable info{"hold.*", "Fixed nodes (Dirichlet condition).", "Surroundings"};
  const auto row = key_rows(info, &Scenario::holds);
  info.rows = {
      row("region", &H::region, anything, "Cells whose nodes are fixed.", {.required = true}),
      row("directions", &H::directions, one_of(words::axes), "Fixed directions."),
      row("x_um", &H::x_um, anything, "Only nodes with x in this range at t = 0 (µm)."),
      row("y_um", &H::y_um, anything, "Likewise in y (µm)."),
      row("z_um", &H::z_um, anything, "Likewise in z (µm)."),
  };
  info.check = check_holds;
  info.build = build;
  info.held_nodes = take_nodes;
  return info;
}

}  // namespace plica
