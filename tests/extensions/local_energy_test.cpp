// A law in thirty lines: apical faces that keep their area, as in vertex models.
#include "mechanics/local_energy.hpp"

#include "extensions/extension_checks.hpp"
#include "simulation/tape.hpp"
#include "tissue/faces.hpp"

namespace {

// k/2 (A - A0)^2 / A0, A the area of the two triangles on either side of a diagonal.
struct KeptAreas {
  double stiffness;  // nN/um

  static constexpr int nodes = 4, numbers = 1;
  static constexpr std::string_view name = "kept areas";

  [[nodiscard]] std::vector<LocalGroup<4, 1>> groups(const Tissue& tissue) const {
    std::vector<LocalGroup<4, 1>> groups;
    for (const Facet& facet : tissue.facets(CellSide::apical)) {
      const std::array<Vec3, 4> corners = gather(tissue.rest_positions, facet);
      groups.push_back({facet.nodes, {area(corners)}, facet.cell});
    }
    return groups;
  }
  template <class T>
  T operator()(const std::array<Eigen::Matrix<T, 3, 1>, 4>& x, const std::array<double, 1>& rest) const {
    const T change = area(x) - rest[0];
    return 0.5 * stiffness / rest[0] * change * change;
  }
  template <class T>
  static T area(const std::array<Eigen::Matrix<T, 3, 1>, 4>& x) {
    const Eigen::Matrix<T, 3, 1> diagonal = x[2] - x[0];
    return 0.5 * ((x[1] - x[0]).cross(diagonal).norm() + diagonal.cross(x[3] - x[0]).norm());
  }
};

const Extension kept_areas = [](Model& model) {
  model.laws.push_back(std::make_unique<LocalEnergy<KeptAreas>>(model.tissue, KeptAreas{2}));
};

TEST(LocalEnergy, DerivativesAgreeWithFiniteDifferences) {
  const Tissue tissue = distorted_block({.length_um = 40, .width_um = 20, .cells = {2, 1, 1}}, 2, 3);
  const LocalEnergy<KeptAreas> law(tissue, {3});
  check_derivatives(law, tissue, 2);
  check_semidefinite_tangent(law, tissue, 2, true);
  check_energy_flow(law, tissue);
  expect_no_resultant_and_no_torque(law, tissue, 2);
}

// A face stretched along one side by 1 + e: energy k e^2 A0 / 2, and each end of that side is pulled by k e w / 2.
TEST(LocalEnergy, ForceOfAStretchedFace) {
  const Tissue tissue = build_block({.length_um = 20, .width_um = 10, .cell_height_um = 20, .cells = {1, 1, 1}});
  const LocalEnergy<KeptAreas> law(tissue, {3});
  Vectors x = tissue.rest_positions;
  for (Vec3& place : x) place.x() *= 1.1;
  const Step step{x, x, Vectors(x.size(), Vec3::Zero()), 1, 1};
  EXPECT_NEAR(law.energy(step), 0.5 * 3 * 0.01 * 200, 1e-12);
  const Vectors forces = forces_of(law, step);
  for (const NodeId node : tissue.facets(CellSide::apical)[0].nodes) {
    const Vec3& rest = tissue.rest_positions[node.index()];
    EXPECT_NEAR(forces[node.index()].x(), -std::copysign(3 * 0.1 * 10 / 2, rest.x()), 1e-12);
    EXPECT_NEAR(forces[node.index()].y(), -std::copysign(3 * 0.1 * 22 / 2, rest.y()), 1e-12);
  }
}

TEST(LocalEnergy, FunctionsOfDuals) {
  using Number = Dual<2, true>;
  const auto formula = [](const auto& a, const auto& b) {
    using std::abs, std::cos, std::exp, std::log, std::pow, std::sin, std::sqrt;
    return sqrt(a) * exp(b) / log(a + 2) + pow(a * b, 3) - sin(a) * cos(b) + abs(b - a) + 2 * a - b / 3;
  };
  const double a = 1.3, b = 0.7, h = 1e-4;
  const Number dual = formula(Number::variable(a, 0), Number::variable(b, 1));
  EXPECT_EQ(dual.value, formula(a, b));
  EXPECT_NEAR(dual.gradient[0], (formula(a + h, b) - formula(a - h, b)) / (2 * h), 1e-7);
  EXPECT_NEAR(dual.gradient[1], (formula(a, b + h) - formula(a, b - h)) / (2 * h), 1e-7);
  EXPECT_NEAR(dual.hessian(0, 0), (formula(a + h, b) - 2 * formula(a, b) + formula(a - h, b)) / (h * h), 1e-6);
  EXPECT_NEAR(dual.hessian(1, 1), (formula(a, b + h) - 2 * formula(a, b) + formula(a, b - h)) / (h * h), 1e-6);
  const double mixed =
      (formula(a + h, b + h) - formula(a + h, b - h) - formula(a - h, b + h) + formula(a - h, b - h)) / (4 * h * h);
  EXPECT_NEAR(dual.hessian(0, 1), mixed, 1e-6);
  EXPECT_DOUBLE_EQ(dual.hessian(0, 1), dual.hessian(1, 0));
}

// By the area of apical faces of three cells, after ten seconds.
TEST(LocalEnergy, GradientsOfARunByItsNumbersAgreeWithDifferences) {
  const Scenario scenario = load_scenario({"block", "block.toml",
                                           "format = 1\n[embryo]\nshape = \"block\"\nlength_um = 60\nwidth_um = "
                                           "20\ncell_height_um = 20\ncells = [3, 1, 1]\n"
                                           "[cortex.top]\nregion = \"all\"\ntension_mN_per_m = 2\n[time]\nend_s = "
                                           "10\n[monitor.top]\nquantity = \"area\"\n"});
  const auto with = [&](double stiffness) {
    return Tape::Variant(scenario, [stiffness](Simulation::Parts& parts) {
      parts.model->laws.push_back(std::make_unique<LocalEnergy<KeptAreas>>(parts.model->tissue, KeptAreas{stiffness}));
    });
  };
  constexpr double stiffness = 3, change = 3e-4;
  const Tape tape = Tape(scenario, {.add = with(stiffness).add}).replayed(scenario, {});
  const std::size_t end = tape.steps();
  const auto area = [&](const Tape& of) { return of.outcome("top.area_um2", end); };
  const ModelPair pair = tape.parameter("stiffness", with(stiffness + change), with(stiffness - change), 2 * change);
  const auto gradient = tape.gradient({{end, area(tape).gradient}}, {.parameters = {&pair}, .tolerance = 1e-11});
  const double difference = (area(tape.replayed(with(stiffness + change), {})).value -
                             area(tape.replayed(with(stiffness - change), {})).value) /
                            (2 * change);
  EXPECT_GT(difference, 0.1);
  EXPECT_NEAR(gradient->by_parameter[0], difference, 1e-6 * difference);
}

TEST(LocalEnergy, WorksWithEveryLinearSolver) { expect_same_run_with_every_solver(kept_areas); }
TEST(LocalEnergy, ResumesToTheSameBitsThroughADivision) { expect_resumable_through_a_division(kept_areas); }

}  // namespace
