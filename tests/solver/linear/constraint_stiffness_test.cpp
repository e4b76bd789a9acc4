// The stiffness of volumes in the matrix of a preconditioner: of whole cells, or of their elements.
#include "solver/linear/directions.hpp"
#include "solver/linear/system_matrix.hpp"
#include "support/law_checks.hpp"
#include "support/models.hpp"

namespace {

/// The matrix with the stiffness of the volumes alone, of 9 cells with random weights.
struct VolumeStiffness {
  explicit VolumeStiffness(const Model& model) : matrix(model), motion(random_motion(model.tissue, 2, 3)) {
    Random random(3);
    for (std::size_t c = 0; c < model.tissue.cells.size(); ++c) weights.push_back(1 + 0.5 * random.number());
    matrix.set_zero();
    matrix.take_gradients(model, motion.positions);
    matrix.add_constraint_stiffness(model, motion.positions, weights);
  }
  /// J^T W J times a direction.
  [[nodiscard]] Vectors exact_product(const Vectors& direction) const {
    std::vector<double> rates(weights.size());
    matrix.jacobian().rates(direction, rates);
    for (std::size_t c = 0; c < rates.size(); ++c) rates[c] *= weights[c];
    Vectors product(direction.size(), Vec3::Zero());
    matrix.jacobian().add_forces(rates, 1, product);
    return product;
  }

  SystemMatrix matrix;
  Motion motion;
  std::vector<double> weights;
};

TEST(ConstraintStiffness, IsThatOfWholeCells) {
  for (const std::array<int, 3>& elements : {std::array<int, 3>{1, 1, 1}, {2, 1, 1}, {1, 1, 3}, {2, 2, 2}, {3, 3, 2}}) {
    const Model model = dimpling_sheet(elements);
    const VolumeStiffness volumes(model);
    const Vectors direction = Random(7).vectors(model.tissue.node_count());
    const Vectors exact = volumes.exact_product(direction), assembled = product_of(volumes.matrix, direction);
    for (std::size_t n = 0; n < exact.size(); ++n)
      EXPECT_LE((assembled[n] - exact[n]).norm(), 1e-12 * largest(exact)) << elements[0] << elements[2];
  }
}

// Whose elements each resist: no direction is softer than with whole cells, and no further nodes are joined.
TEST(ConstraintStiffness, OfCellsOfVeryManyNodesHasThePatternOfTheirElements) {
  const Model model = dimpling_sheet({4, 4, 3});
  const VolumeStiffness volumes(model);
  for (std::size_t row = 0; row < 9; ++row) EXPECT_FALSE(volumes.matrix.jacobian().is_joined(row));
  for (unsigned seed = 1; seed < 6; ++seed) {
    const Vectors direction = Random(seed).vectors(model.tissue.node_count());
    EXPECT_GE(flat(direction).dot(flat(product_of(volumes.matrix, direction))),
              flat(direction).dot(flat(volumes.exact_product(direction))));
  }
  const BlockPattern& layout = volumes.matrix.layout();
  for (int node = 0; node < layout.nodes(); ++node) EXPECT_LE(layout.of(node).size(), 27u);
}

// The factor has the volume stiffness of whole cells, as the system has.
TEST(ConstraintStiffness, CellsOfSeveralElementsNeedHardlyMoreIterations) {
  const auto iterations = [](const std::array<int, 3>& elements) {
    const Model model = dimpling_sheet(elements);
    const State rest = rest_state(model);
    const Iterate at{rest.positions, rest.multipliers, rest.obstacle_forces, rest.on_obstacle};
    const Step step{rest.positions, rest.positions, rest.velocities, 5, 5};
    Random random(2);
    Residual residual;
    residual.forces = random.vectors(rest.positions.size());
    residual.deficits.assign(rest.multipliers.size(), 0.0);
    Direction direction;
    NewtonDirections::Cost cost;
    EXPECT_EQ(make_directions(model, LinearMethod::cholesky, {})->find(step, at, residual, {0, 1e-5}, direction, cost),
              NewtonDirections::Status::found);
    return cost.linear_solves;
  };
  const int of_one = iterations({1, 1, 1});
  for (const std::array<int, 3>& elements : {std::array<int, 3>{2, 1, 1}, {1, 1, 3}, {2, 2, 2}})
    EXPECT_LE(iterations(elements), of_one + 3) << elements[0] << elements[2];
}

}  // namespace
