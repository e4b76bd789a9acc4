// A door for new laws, tried: a law with an internal state, in one file. Maxwell springs along apical edges, whose rest
// lengths flow after the lengths.
//
// Tension k (l - L), dL/dt = (l - L)/tau, with the rate at the end of the step as in every law (law.hpp):
//   L = (L_before + (rate_s/tau) l) / (1 + rate_s/tau),   tension = k (l - L_before) / (1 + rate_s/tau).
// The internal state: L at the step's beginning, then L at the beginning of the step before, for steps of second order.
// Springs keep numbers of nodes, so they follow divisions only: a table for them must refuse [exchange].
#include "extensions/extension_checks.hpp"
#include "mechanics/energy.hpp"

namespace {

class MaxwellSprings final : public Law {
 public:
  struct Spring {
    NodeId a, b;
    double stiffness, rest_length;  // nN/um, um: where it began

    static auto parts(auto& spring) { return std::tie(spring.a, spring.b, spring.stiffness, spring.rest_length); }
  };

  MaxwellSprings(std::vector<Spring> springs, double relaxation_s)
      : springs_(std::move(springs)), relaxation_s_(relaxation_s) {}
  /// `rest_ratio`: rest lengths over lengths at the beginning; below 1 they pull.
  MaxwellSprings(const Tissue& tissue, double stiffness, double relaxation_s, double rest_ratio = 0.5)
      : relaxation_s_(relaxation_s) {
    for (const Cell& cell : tissue.cells)
      for (const CellEdge& edge : cell.edges)
        if (edge.side == CellSide::apical) {
          const NodeId a = edge.nodes.front(), b = edge.nodes.back();
          springs_.push_back({a, b, stiffness, rest_ratio * length(tissue.rest_positions, a, b)});
        }
  }

  [[nodiscard]] std::string_view name() const override { return "maxwell springs"; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<MaxwellSprings>(*this); }

  [[nodiscard]] double energy(const Step& step) const override {
    double sum = 0;
    for_springs(step, [&](const Pulled& p) { sum += 0.5 * p.slope * p.stretch * p.stretch; });
    return sum;
  }
  void add_forces(const Step& step, std::span<Vec3> forces) const override {
    for_springs(step, [&](const Pulled& p) {
      forces[p.a] += p.slope * p.stretch * p.direction;
      forces[p.b] -= p.slope * p.stretch * p.direction;
    });
  }
  void add_tangent_product(const Step& step, std::span<const Vec3> direction, std::span<Vec3> product) const override {
    for_springs(step, [&](const Pulled& p) {
      const Vec3 change = p.stiffness(step) * (direction[p.b] - direction[p.a]);
      product[p.a] -= change;
      product[p.b] += change;
    });
  }
  void add_tangent(const Step& step, TangentSink& tangent) const override {
    for_springs(step, [&](const Pulled& p) {
      const Mat3 block = p.stiffness(step);
      tangent.add_block(NodeId(p.a), NodeId(p.a), block);
      tangent.add_block(NodeId(p.b), NodeId(p.b), block);
      tangent.add_block(NodeId(p.a), NodeId(p.b), -block);
    });
  }
  [[nodiscard]] EnergyFlow energy_flow(const CompletedStep& completed) const override {
    return relaxing_energy_flow(*this, completed);
  }
  [[nodiscard]] NodeGroups node_groups(std::span<const double>) const override {
    NodeGroups groups;
    for (const Spring& spring : springs_) groups.add(std::array{spring.a, spring.b});
    return groups;
  }

  [[nodiscard]] std::vector<double> first_internal(const Tissue&) const override {
    std::vector<double> lengths;
    for (const Spring& spring : springs_) lengths.push_back(spring.rest_length);
    const std::vector<double> earlier = lengths;
    lengths.insert(lengths.end(), earlier.begin(), earlier.end());
    return lengths;
  }
  [[nodiscard]] std::vector<double> next_internal(const Step& step) const override {
    std::vector<double> lengths;
    const double r = step.rate_s / relaxation_s_;
    for_springs(step, [&](const Pulled& p) { lengths.push_back((p.length - p.stretch + r * p.length) / (1 + r)); });
    lengths.insert(lengths.end(), step.internal.begin(), step.internal.begin() + springs_.size());
    return lengths;
  }

  // A spring whose edge is cut becomes two in series.
  [[nodiscard]] std::unique_ptr<Law> after_change(const Tissue&, const TissueChange& change,
                                                  std::span<const Vec3>) const override {
    std::vector<Spring> springs;
    for_parts(change, [&](const Spring& part, std::size_t, double) { springs.push_back(part); });
    return std::make_unique<MaxwellSprings>(std::move(springs), relaxation_s_);
  }
  [[nodiscard]] std::vector<double> internal_after_change(std::span<const double> internal, const Tissue&,
                                                          const TissueChange& change,
                                                          const ChangePositions&) const override {
    std::vector<double> lengths;
    for (const std::size_t first : {std::size_t{0}, springs_.size()})
      for_parts(change, [&](const Spring&, std::size_t whole, double share) {
        lengths.push_back(share * internal[first + whole]);
      });
    return lengths;
  }
  // Which edges were cut, the tissue alone does not tell.
  [[nodiscard]] std::vector<double> past() const override { return as_numbers(springs_); }
  [[nodiscard]] std::unique_ptr<Law> restored(const Tissue& tissue, const TissueChange&, std::span<const Vec3>,
                                              std::span<const double> past) const override {
    std::vector<Spring> springs;
    take_numbers({past.begin(), past.end()}, springs);
    for (const Spring& spring : springs)
      if (!spring.a.is_among(tissue.node_count()) || !spring.b.is_among(tissue.node_count())) throw InvalidNumbers();
    return std::make_unique<MaxwellSprings>(std::move(springs), relaxation_s_);
  }

  [[nodiscard]] const std::vector<Spring>& springs() const { return springs_; }

 private:
  struct Pulled {
    std::size_t a, b;
    Vec3 direction;
    double length, stretch, slope;
    [[nodiscard]] Mat3 stiffness(const Step& step) const {
      const double turning = slope * stretch / length;
      const Mat3 along = direction * direction.transpose();
      return slope * along +
             (step.semidefinite_tangent ? std::max(0.0, turning) : turning) * (Mat3::Identity() - along);
    }
  };
  static double length(std::span<const Vec3> x, NodeId a, NodeId b) { return (x[b.index()] - x[a.index()]).norm(); }

  template <class Take>
  void for_springs(const Step& step, const Take& take) const {
    for (std::size_t k = 0; k < springs_.size(); ++k) {
      const Spring& spring = springs_[k];
      const double before = (1 + step.ahead) * step.internal[k] - step.ahead * step.internal[springs_.size() + k];
      const Vec3 d = step.positions[spring.b.index()] - step.positions[spring.a.index()];
      const double l = d.norm();
      take(Pulled{spring.a.index(), spring.b.index(), d / l, l, l - before,
                  spring.stiffness / (1 + step.rate_s / relaxation_s_)});
    }
  }

  // Each spring of the tissue after the division: itself, of which it is a part, and which share of its length.
  template <class Take>
  void for_parts(const TissueChange& change, const Take& take) const {
    for (std::size_t k = 0; k < springs_.size(); ++k) {
      const auto& [a, b, stiffness, rest_length] = springs_[k];
      const auto midway = change.node_midway.find(std::minmax(a, b));
      if (midway == change.node_midway.end()) {
        take(springs_[k], k, 1.0);
        continue;
      }
      take(Spring{a, midway->second, 2 * stiffness, rest_length / 2}, k, 0.5);
      take(Spring{midway->second, b, 2 * stiffness, rest_length / 2}, k, 0.5);
    }
  }

  std::vector<Spring> springs_;
  double relaxation_s_;
};

const Extension maxwell = [](Model& model) {
  model.laws.push_back(std::make_unique<MaxwellSprings>(model.tissue, 2.0, 20.0));
};

TEST(MaxwellSprings, DerivativesAgreeWithFiniteDifferences) {
  const Tissue tissue = distorted_block({.length_um = 40, .width_um = 20, .cells = {2, 1, 1}}, 2, 3);
  const MaxwellSprings law(tissue, 3, 0.5);
  check_derivatives(law, tissue, 2);
  check_semidefinite_tangent(MaxwellSprings(tissue, 3, 0.5, 1.5), tissue, 2, true);
}

TEST(MaxwellSprings, EnergyFlowIsTheWorkOfTheForces) {
  const Tissue tissue = distorted_block(two_cells, 2, 3);
  check_energy_flow(MaxwellSprings(tissue, 3, 2), tissue);
}

// One spring between two nodes that are held: tension decays as exp(-t/tau).
TEST(MaxwellSprings, TensionDecaysAtConstantLength) {
  Model model(build_block({.length_um = 20, .width_um = 20, .cell_height_um = 20, .cells = {1, 1, 1}}));
  model.laws.push_back(std::make_unique<MaxwellSprings>(model.tissue, 3, 10));
  for (auto& held : model.held) held = {true, true, true};
  RunControls controls{
      .scheme = {.order = TimeOrder::second}, .fixed_step_s = 0.05, .end_s = 10, .stop_at_equilibrium = false};
  Simulation simulation({std::make_unique<Model>(std::move(model)), controls});
  ASSERT_EQ(simulation.run(), RunStatus::end_time) << simulation.failure();
  const std::vector<double>& rest_lengths = simulation.state().internals.at(0);
  EXPECT_NEAR((20 - rest_lengths[0]) / 10, std::exp(-1.0), 1e-3);
}

TEST(MaxwellSprings, ForcesAreTheSameThroughADivision) {
  Model model(distorted_block({.length_um = 60, .width_um = 40, .cell_height_um = 40, .cells = {3, 2, 1}}, 2, 5));
  maxwell(model);
  State state = rest_state(model);
  Random random(2);
  for (double& length : state.internals[0]) length *= 1 + 0.3 * random.number();
  const auto forces = [&] {
    Step still{state.positions, state.positions, state.velocities, 0.7, 1};
    still.internal = state.internals[0];
    return forces_of(*model.laws[0], still);
  };
  const Vectors before = forces();
  const TissueChange division =
      divide_cells(model, state, std::vector<PlannedDivision>{{{CellId(1), 0}}, {{CellId(3), 1}}});
  const Vectors after = forces();
  ASSERT_GT(state.internals[0].size(), before.size());
  for (std::size_t n = 0; n < division.kept_nodes(); ++n) EXPECT_LE((after[n] - before[n]).norm(), 1e-11) << n;
}

TEST(MaxwellSprings, WorkWithEveryLinearSolver) { expect_same_run_with_every_solver(maxwell); }
TEST(MaxwellSprings, ResumeToTheSameBitsThroughADivision) { expect_resumable_through_a_division(maxwell); }
TEST(MaxwellSprings, WorkWithThePapersAlgorithm) { expect_runs_with_the_papers_algorithm(maxwell); }

}  // namespace
