// Random exchanges, divisions and extrusions, mixed: the tissue stays sound.
#include <cstdlib>

#include "measure/self_intersections.hpp"
#include "simulation/division_rules.hpp"
#include "support/divided.hpp"
#include "support/prisms.hpp"
#include "support/turns.hpp"
#include "tissue/division.hpp"
#include "tissue/extrusion.hpp"
#include "tissue/shapes/polygon_embryo.hpp"

namespace {

// A sheet, a tube or an egg in which random walls turn and random cells divide and leave. `settle` moves nodes onto the
// shape: level 0 is the base.
class RandomEvents {
 public:
  using Settle = std::function<Vec3(const Vec3&, std::size_t level)>;

  RandomEvents(Tissue tissue, unsigned seed, Settle settle)
      : tissue_(std::move(tissue)),
        positions_(tissue_.rest_positions),
        random_(seed),
        settle_(std::move(settle)),
        first_count_(tissue_.cells.size()) {
    compare_volumes();
  }

  void run(int events) {
    for (int idle = 0; turns + divisions + extrusions < events && idle < 200; ++idle) {
      const int before = turns + divisions + extrusions;
      const double kind = random_.number();
      if (kind < 0.4)
        turn();
      else if (tissue_.cells.size() <= first_count_)
        divide_cells();
      else
        take_out_cells();
      if (turns + divisions + extrusions > before) idle = 0;
      check();
      relax();
    }
  }

  int turns = 0, divisions = 0, extrusions = 0, refused = 0;
  double gap = 0, lost = 0, least = 1;
  std::size_t crossings = 0;

 private:
  void turn() {
    std::vector<WallTurn> chosen = random_turns(tissue_, 1 + tissue_.cells.size() / 12, random_);
    turn(chosen);
  }

  void turn(std::vector<WallTurn>& chosen) {
    double length = 0;
    for (const WallTurn& one : chosen)
      length += 0.6 * wall_length(tissue_, one, positions_) / static_cast<double>(chosen.size());
    const std::size_t tried = chosen.size();
    turned(tissue_, chosen, length, positions_);
    compare_volumes();
    turns += static_cast<int>(chosen.size());
    refused += static_cast<int>(tried - chosen.size());
  }

  // Cuts whose daughters and their neighbours get good elements.
  void divide_cells() {
    for (int tried = 0; tried < 4; ++tried) {
      const CellId cell = any_cell();
      CutEnds taken;
      Tissue cut = tissue_;
      const std::vector<CellCut> its = {
          cut_by(random_.number() < 0 ? DivisionPlane::transverse : DivisionPlane::sagittal, tissue_, cell, positions_,
                 taken)};
      const TissueChange change = divide(cut, its, 0, positions_);
      const Vectors now = with_new_nodes(cut, change, positions_);
      if (!(worst_of(cut, now) > 0.02)) {
        ++refused;
        continue;
      }
      std::swap(tissue_, cut);
      positions_ = now;
      compare_volumes();
      ++divisions;
    }
  }

  void take_out_cells() {
    const CellId cell = any_cell();
    for (int tried = 0; tried < 8 && tissue_.cells[cell.index()].sides() > 3; ++tried) {
      std::vector<WallTurn> its = possible_turns(tissue_.sheet);
      std::erase_if(its, [&](const WallTurn& one) { return one.left != cell && one.right != cell; });
      if (its.empty()) return;
      its = {its[static_cast<std::size_t>(tried) % its.size()]};
      turn(its);
      check();
      relax();
    }
    if (!can_leave(tissue_.sheet, cell)) return;
    std::vector<CellId> leaving = {cell};
    take_out(tissue_, leaving, positions_, as_it_is);
    compare_volumes();
    extrusions += static_cast<int>(leaving.size());
    refused += leaving.empty() ? 1 : 0;
  }

  CellId any_cell() {
    const auto place =
        static_cast<std::size_t>(0.5 * (random_.number() + 1) * static_cast<double>(tissue_.cells.size()));
    return CellId(std::min(place, tissue_.cells.size() - 1));
  }

  static double worst_of(const Tissue& tissue, const Vectors& positions) {
    double worst = 1;
    for (std::size_t e = 0; e < tissue.elements.size(); ++e)
      worst = std::min({worst, hex_scaled_jacobian(gather(positions, tissue.elements[e])),
                        hex_scaled_jacobian(tissue.element_rest_shape[e])});
    return worst;
  }

  // Rest volumes of cells that live on are those before.
  void compare_volumes() {
    std::map<int, double> now;
    for (const Cell& cell : tissue_.cells) {
      const double volume = now[cell.lineage.id] = rest_volume(tissue_, cell);
      if (const auto known = volumes_.find(cell.lineage.id); known != volumes_.end())
        lost = std::max(lost, std::abs(volume / known->second - 1));
    }
    volumes_ = std::move(now);
  }

  void check() {
    expect_symmetric(tissue_);
    EXPECT_EQ(most_cells_at_a_vertex(tissue_.sheet), 3u);
    least = std::min(least, worst_of(tissue_, positions_));
    gap =
        std::max(gap, std::abs(volume_of_cells(tissue_, positions_) / volume_inside_boundary(tissue_, positions_) - 1));
    crossings += self_intersections(tissue_, positions_);
  }

  // Nodes move to even places on the shape, as far as no element becomes bad.
  void relax() {
    for (double part = 1; part > 0.01; part /= 2) {
      Vectors even = positions_;
      smooth(tissue_, even);
      for (const Vertex& vertex : tissue_.sheet.vertices)
        for (std::size_t level = 0; level < vertex.nodes.size() && !vertex.original.valid(); ++level) {
          const std::size_t n = vertex.nodes[level].index();
          even[n] = positions_[n] + part * (settle_(even[n], level) - positions_[n]);
        }
      tissue_.place_hanging_positions(even);
      if (worst_of(tissue_, even) < std::min(0.02, worst_of(tissue_, positions_))) continue;
      positions_ = std::move(even);
      break;
    }
  }

  Tissue tissue_;
  Vectors positions_;
  Random random_;
  Settle settle_;
  std::size_t first_count_;
  std::map<int, double> volumes_;  // by lineage
};

// A honeycomb of an even number of rows, rolled up about the x axis.
Tissue tube(int columns, int rows, double edge_um, double height_um) {
  PrismSheet sheet = honeycomb(columns, rows, edge_um, height_um);
  const double radius = 1.5 * edge_um * rows / (2 * std::numbers::pi);
  std::vector<std::size_t> same(sheet.apical.size());
  for (std::size_t v = 0; v < same.size(); ++v) {
    const double angle = sheet.apical[v].y() / radius;
    sheet.apical[v] = Vec3(sheet.apical[v].x(), radius * std::sin(angle), radius * std::cos(angle));
    sheet.basal[v] =
        Vec3(sheet.apical[v].x(), (radius - height_um) * std::sin(angle), (radius - height_um) * std::cos(angle));
    same[v] = v;
    for (std::size_t other = 0; other < v; ++other)
      if ((sheet.apical[other] - sheet.apical[v]).norm() < 1e-6) same[v] = other;
  }
  PrismSheet joined;
  std::map<std::size_t, std::size_t> numbers;
  for (const auto& cell : sheet.cells) {
    auto& its = joined.cells.emplace_back();
    for (const std::size_t vertex : cell) {
      const auto [number, is_new] = numbers.emplace(same[vertex], joined.apical.size());
      if (is_new) {
        joined.apical.push_back(sheet.apical[same[vertex]]);
        joined.basal.push_back(sheet.basal[same[vertex]]);
      }
      its.push_back(number->second);
    }
  }
  return tissue_from_prisms(joined, PolygonSplit::diagonals, 1);
}

// PLICA_RANDOM_EVENTS: their number, over three shapes and five seeds.
TEST(RandomEvents, LeaveASoundTissue) {
  const char* given = std::getenv("PLICA_RANDOM_EVENTS");
  const int each = (given ? std::atoi(given) : 450) / 15 + 1;
  const Vec3 half_axes(230, 90, 90);
  const double radius = 1.5 * 4 * 16 / (2 * std::numbers::pi);
  int events = 0;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const auto check = [&](const char* what, RandomEvents run) {
      run.run(each);
      const int sum = run.turns + run.divisions + run.extrusions;
      events += sum;
      std::cout << what << ", seed " << seed << ": " << run.turns << " turns, " << run.divisions << " divisions, "
                << run.extrusions << " extrusions, " << run.refused << " refused; gap " << run.gap
                << ", rest volumes off by " << run.lost << ", worst scaled Jacobian " << run.least << ", "
                << run.crossings << " crossings\n";
      EXPECT_GE(sum, each) << what;
      EXPECT_LE(run.gap, 1e-9) << what;
      EXPECT_LE(run.lost, 1e-9) << what;
      EXPECT_GT(run.least, 0) << what;
      EXPECT_EQ(run.crossings, 0u) << what;
    };
    check("sheet", {tissue_from_prisms(irregular_polygons(12, 12, 4, 10, 0.1, seed), PolygonSplit::diagonals, 1), seed,
                    [](const Vec3& x, std::size_t level) { return Vec3(x.x(), x.y(), level == 0 ? -10 : 0); }});
    check("tube", {tube(12, 16, 4, 6), seed, [&](const Vec3& x, std::size_t level) {
                     const double factor = (radius - (level == 0 ? 6 : 0)) / std::hypot(x.y(), x.z());
                     return Vec3(x.x(), factor * x.y(), factor * x.z());
                   }});
    check("egg", {build_egg({460, 180, 180, {}, {}}, 200, seed, {.height_um = 25}), seed,
                  [&](const Vec3& x, std::size_t level) {
                    const Vec3 axes = half_axes - Vec3::Constant(level == 0 ? 25 : 0);
                    return Vec3(x / x.cwiseQuotient(axes).norm());
                  }});
  }
  std::cout << events << " events\n";
}

}  // namespace
