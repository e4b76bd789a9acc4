// Rigidity of a sheet of cells: with an elastic perimeter P_0 and area A, as 2D vertex models have it, the shear
// modulus of a disordered sheet vanishes above a shape index p_0 = P_0/sqrt(A) of 3.81 (Bi et al. 2015). Cells are
// solid prisms of fixed volume and height, so areas are fixed, and almost without stiffness of their own; the energy
//   K/2 sum over cells (P - P_0)^2,  half of it each for the apical and the basal perimeter,
// is that of lateral faces with the line tension K (P - P_0) of both cells. Periods of the sheet are sheared, then
// nodes reach equilibrium; the modulus is the second difference of the energy.
#include "mechanics/elasticity/corner_barrier.hpp"
#include "simulation/simulation.hpp"
#include "support/models.hpp"
#include "support/scenarios.hpp"
#include "tissue/exchange.hpp"

namespace {

class PerimeterElasticity final : public Law {
 public:
  PerimeterElasticity(const Tissue& tissue, double stiffness, double rest) : stiffness_(stiffness), rest_(rest) {
    for (const Cell& cell : tissue.cells)
      for (const auto corners : {cell.basal_corners(), cell.apical_corners()})
        rings_.emplace_back(corners.begin(), corners.end());
  }
  [[nodiscard]] std::string_view name() const override { return "perimeters"; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<PerimeterElasticity>(*this); }

  [[nodiscard]] double energy(const Step& step) const override {
    double sum = 0;
    for (const auto& ring : rings_) {
      const double excess = Perimeter(ring, step.positions).length - rest_;
      sum += 0.5 * stiffness_ * excess * excess;
    }
    return sum;
  }
  void add_forces(const Step& step, std::span<Vec3> forces) const override {
    for (const auto& ring : rings_) {
      const Perimeter perimeter(ring, step.positions);
      for (std::size_t i = 0; i < ring.size(); ++i)
        forces[ring[i].index()] -= stiffness_ * (perimeter.length - rest_) * perimeter.slope(i);
    }
  }
  void add_tangent_product(const Step& step, std::span<const Vec3> direction, std::span<Vec3> product) const override {
    for_blocks(step, [&](NodeId row, NodeId column, const Mat3& block) {
      product[row.index()] += block * direction[column.index()];
      if (row != column) product[column.index()] += block.transpose() * direction[row.index()];
    });
  }
  void add_tangent(const Step& step, TangentSink& tangent) const override {
    for_blocks(step, [&](NodeId row, NodeId column, const Mat3& block) { tangent.add_block(row, column, block); });
  }
  [[nodiscard]] NodeGroups node_groups(std::span<const double>) const override {
    NodeGroups groups;
    for (const auto& ring : rings_) groups.add(ring);
    return groups;
  }
  [[nodiscard]] std::unique_ptr<Law> after_change(const Tissue& tissue, const TissueChange&,
                                                  std::span<const Vec3>) const override {
    return std::make_unique<PerimeterElasticity>(tissue, stiffness_, rest_);
  }

 private:
  // Length of a ring, its edges, and their directions.
  struct Perimeter {
    Perimeter(const std::vector<NodeId>& ring, std::span<const Vec3> positions) {
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Vec3 edge = positions[ring[(i + 1) % ring.size()].index()] - positions[ring[i].index()];
        edges.push_back(std::sqrt(edge.squaredNorm() + blunt_um * blunt_um));
        directions.push_back(edge / edges.back());
        length += edges.back();
      }
    }
    [[nodiscard]] Vec3 slope(std::size_t corner) const {
      return directions[(corner + directions.size() - 1) % directions.size()] - directions[corner];
    }
    static constexpr double blunt_um = 0.02;
    std::vector<double> edges;
    std::vector<Vec3> directions;
    double length = 0;
  };

  template <class Take>
  void for_blocks(const Step& step, const Take& take) const {
    for (const auto& ring : rings_) {
      const Perimeter perimeter(ring, step.positions);
      const double tension = stiffness_ * (perimeter.length - rest_);
      for (std::size_t i = 0; i < ring.size(); ++i)
        for (std::size_t j = 0; j <= i; ++j)
          take(ring[i], ring[j], stiffness_ * perimeter.slope(i) * perimeter.slope(j).transpose());
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Vec3& along = perimeter.directions[i];
        const double turning = step.semidefinite_tangent ? std::max(0.0, tension) : tension;
        const Mat3 block = turning / perimeter.edges[i] * (Mat3::Identity() - along * along.transpose());
        const NodeId a = ring[i], b = ring[(i + 1) % ring.size()];
        take(a, a, block), take(b, b, block), take(a, b, -block);
      }
    }
  }

  std::vector<std::vector<NodeId>> rings_;
  double stiffness_, rest_;
};

constexpr double stiffness = 1;  // nN/um, of both perimeters of a cell

const std::string periodic_sheet = R"([embryo]
shape = "sheet"
length_um = 48
width_um = 48
cell_count = 64
cell_height_um = 6
periodic = ["x", "y"]
[elasticity]
young_modulus_Pa = 0.01
poisson_ratio = 0
corner_barrier_Pa = 0.01
[dynamics]
surface_drag_Pa_s_per_um = 1
)";

// Shear the periods: images, a period away along y, move along x.
void shear(Tissue& tissue, Vectors& positions, double by) {
  for (std::size_t n = 0; n < tissue.free_node_count(); ++n) positions[n].x() += by * positions[n].y();
  for (Vec3& shift : tissue.hanging_shifts) shift.x() += by * shift.y();
  tissue.place_hanging_positions(positions);
}

struct Relaxed {
  double energy = 0;  // of perimeters, over K A
  Vectors positions;
  bool is_at_rest = false;
};

// Equilibrium of the tissue, from these positions.
Relaxed relaxed(const Tissue& tissue, const Vectors& positions, double shape_index) {
  const Model usual = *make_model(scenario_of(periodic_sheet));
  Model model(tissue);
  for (const auto& law : usual.laws) model.laws.push_back(law->clone());
  const double area = 48.0 * 48.0 / static_cast<double>(tissue.cells.size());
  model.laws.push_back(std::make_unique<PerimeterElasticity>(tissue, 0.5 * stiffness, shape_index * std::sqrt(area)));
  for (auto& held : model.held) held[2] = true;
  model.stiffness_scale = stiffness / 6;
  Simulation simulation({std::make_unique<Model>(std::move(model)),
                         {.max_step_s = 1e5,
                          .position_tolerance_um = 0.3,
                          .end_s = 1e7,
                          .equilibrium_speed_um_per_s = 1e-9,
                          .frame_every_s = 0}});
  RunMemory memory = simulation.memory();
  memory.state.positions = positions;
  simulation.go_on_from(memory);
  const RunStatus status = simulation.run();
  const Law& law = *simulation.model().laws.back();
  Step step;
  step.positions = simulation.state().positions;
  return {law.energy(step) / (stiffness * 48 * 48), simulation.state().positions, status == RunStatus::equilibrium};
}

// Second difference of the energy between sheared periods, over K: a shear modulus.
double shear_modulus(const Tissue& tissue, double shape_index) {
  const Relaxed rest = relaxed(tissue, tissue.rest_positions, shape_index);
  EXPECT_TRUE(rest.is_at_rest);
  constexpr double by = 0.02;
  double sum = -2 * rest.energy;
  for (const double way : {by, -by}) {
    Tissue sheared = tissue;
    Vectors positions = rest.positions;
    shear(sheared, positions, way);
    const Relaxed one = relaxed(sheared, positions, shape_index);
    EXPECT_TRUE(one.is_at_rest);
    sum += one.energy;
  }
  return sum / (by * by);
}

TEST(SheetRigidity, ShearModulusVanishesAtThePublishedShapeIndex) {
  const Tissue tissue = make_model(scenario_of(periodic_sheet))->tissue;
  std::map<double, double> moduli;
  for (const double shape_index : {3.5, 3.7, 3.75, 3.8, 3.85}) {
    moduli[shape_index] = shear_modulus(tissue, shape_index);
    std::cout << "shape index " << shape_index << ": shear modulus " << moduli[shape_index] << " K\n";
  }
  EXPECT_NEAR(moduli[3.5], 0.93 * (3.722 - 3.5), 0.06);  // that of a honeycomb: P_6/4 (P_6 - P_0)
  EXPECT_GT(moduli[3.8], 1e-3);
  EXPECT_LT(std::abs(moduli[3.85]), 1e-4);
}

}  // namespace
