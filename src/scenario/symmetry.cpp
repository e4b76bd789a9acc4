#include "scenario/symmetry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "scenario/acting.hpp"
#include "scenario/regions.hpp"
#include "scenario/schema.hpp"
#include "scenario/words.hpp"

namespace plica {
namespace {

MirroredSide side_of(const Scenario& scenario, const Tissue& whole) {
  std::array<bool, 3> axes = {false, false, false};
  for (const std::string& axis : scenario.embryo.mirror) axes[meaning_of(words::mirror_planes, axis)] = true;
  try {
    return plica::side_of(whole, axes);
  } catch (const NotSymmetric& error) {
    throw ScenarioError({diagnostic_at(scenario, "embryo.mirror", error.what(), error.remedy)});
  }
}

class SymmetryCheck {
 public:
  SymmetryCheck(const Scenario& scenario, const Tissue& whole, const Mirror& mirror)
      : scenario_(scenario), whole_(whole), mirror_(mirror) {}

  void check_acting(const Acting& acting) {
    if (!check_region(acting.table, acting.input.region)) return;
    const CellPattern pattern = make_pattern(acting.input, whole_);
    for (const auto& [of_cells, what] :
         {std::pair(&pattern.strengths,
                    "is not symmetric: the factor is {:.4g} in cell {} and {:.4g} in its mirror image, cell {}"),
          {&pattern.delays_s,
           "is not symmetric: the delay is {:.4g} s in cell {} and {:.4g} s in its mirror image, cell {}"},
          {&pattern.pulse_phases,
           "is not symmetric: the pulse phase is {:.4g} in cell {} and {:.4g} in its mirror image, cell {}"},
          {&pattern.pulse_periods_s,
           "is not symmetric: the pulse period is {:.4g} s in cell {} and {:.4g} s in its mirror image, cell {}"}}) {
      const std::vector<double>& numbers = *of_cells;
      if (numbers.empty()) continue;
      const double largest = std::abs(*std::ranges::max_element(numbers, {}, [](double a) { return std::abs(a); }));
      const auto differ = [&](std::size_t a, std::size_t b) {
        return std::abs(numbers[a] - numbers[b]) > 1e-9 * largest;
      };
      if (const auto cell = first_cell(differ))
        return refuse(acting.table,
                      fmt::format(fmt::runtime(what), numbers[cell->index()], cell->number(),
                                  numbers[mirror_.own(*cell).index()], mirror_.own(*cell).number()),
                      "make variation, delay, pulse and profile symmetric, or remove embryo.mirror");
    }
  }

  bool check_region(const std::string& table, const std::string& region) {
    const CellSet& cells = whole_.regions.at(region);
    const auto cell = first_cell([&](std::size_t a, std::size_t b) { return cells[a] != cells[b]; });
    if (!cell) return true;
    const CellId own = mirror_.own(*cell);
    const bool has_own = cells[own.index()];
    refuse(table + ".region",
           fmt::format("region \"{}\" is not symmetric: it contains cell {} but not its mirror image, cell {}", region,
                       (has_own ? own : *cell).number(), (has_own ? *cell : own).number()),
           "use a symmetric region, or remove embryo.mirror");
    return false;
  }

  void check_nodes(const std::string& table, const std::vector<bool>& held) {
    std::vector<NodeId> own(held.size());  // node of the whole, by node of the side
    for (std::size_t n = held.size(); n-- > 0;)
      if (const auto [node, signs] = mirror_.nodes[n]; signs == Vec3::Ones()) own[node.index()] = NodeId(n);
    for (std::size_t n = 0; n < held.size(); ++n) {
      if (held[n] == held[own[mirror_.nodes[n].node.index()].index()]) continue;
      const Vec3& x = whole_.rest_positions[n];
      return refuse(
          table,
          fmt::format(
              "is not symmetric: only one of the node at {:.6g}, {:.6g}, {:.6g} um and its mirror image is fixed",
              x.x(), x.y(), x.z()),
          "use a symmetric region and ranges, or remove embryo.mirror");
    }
  }

  void finish() const {
    if (!errors_.empty()) throw ScenarioError(errors_);
  }

 private:
  // Returns the first cell of the whole that differs from its mirror image on the side.
  template <class Differ>
  [[nodiscard]] std::optional<CellId> first_cell(const Differ& differ) const {
    for (std::size_t c = 0; c < whole_.cells.size(); ++c)
      if (differ(c, mirror_.own(CellId(c)).index())) return CellId(c);
    return std::nullopt;
  }
  void refuse(const std::string& key, std::string problem, std::string remedy) {
    errors_.push_back(diagnostic_at(scenario_, key, std::move(problem), std::move(remedy)));
  }

  const Scenario& scenario_;
  const Tissue& whole_;
  const Mirror& mirror_;
  std::vector<Diagnostic> errors_;
};

}  // namespace

MirroredSide mirrored_side(const Scenario& scenario, const Tissue& whole) {
  MirroredSide side = side_of(scenario, whole);
  SymmetryCheck check(scenario, whole, side.mirror);
  for (const Acting& acting : acting_tables(scenario)) check.check_acting(acting);
  for (const ScenarioTable& table : scenario_tables()) {
    if (table.mirrored_regions)
      table.regions(scenario, [&](const std::string& address, const std::string& region) {
        check.check_region(address.substr(0, address.rfind('.')), region);
      });
    if (table.held_nodes) table.held_nodes(scenario, whole, std::bind_front(&SymmetryCheck::check_nodes, &check));
  }
  check.finish();
  return side;
}

}  // namespace plica
