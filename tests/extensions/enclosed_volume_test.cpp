// A door for new constraints, tried: a dense row, in one file. The volume inside the basal surface (the yolk's) is
// held; its multiplier is the pressure inside.
#include <cmath>

#include "extensions/extension_checks.hpp"
#include "measure/cells.hpp"
#include "support/constraint_law.hpp"
#include "tissue/division.hpp"

namespace plica {
namespace {

using namespace support;

using Corners = std::array<Vec3, 4>;

// Of the cone from the origin to a bilinear facet; basal facets look into the lumen.
double cone(const Corners& x) {
  const auto& [a, b, c, d] = x;
  return -(a.dot(b.cross(c)) + a.dot(c.cross(d)) + a.dot(b.cross(d)) + b.dot(c.cross(d))) / 12;
}

Corners cone_gradient(const Corners& x) {
  const auto& [a, b, c, d] = x;
  return {-(b.cross(c) + c.cross(d) + b.cross(d)) / 12, -(c.cross(a) + d.cross(a) + c.cross(d)) / 12,
          -(a.cross(b) + d.cross(a) + d.cross(b)) / 12, -(a.cross(c) + a.cross(b) + b.cross(c)) / 12};
}

// The block of d2/dx_i dx_j, i < j, is the cross product with a vector.
Vec3 cone_hessian(const Corners& x, int i, int j) {
  const auto& [a, b, c, d] = x;
  const Vec3 of_pairs[4][4] = {{{}, (c + d) / 12, (d - b) / 12, -(b + c) / 12},
                               {{}, {}, (a + d) / 12, (a - c) / 12},
                               {{}, {}, {}, (a + b) / 12},
                               {}};
  return of_pairs[i][j];
}

class EnclosedVolume final : public Constraint {
 public:
  explicit EnclosedVolume(const Tissue& tissue, std::optional<double> target = {}) {
    for (const Facet& facet : tissue.basal_facets) facets_.push_back(facet.nodes);
    std::vector<double> volume(1);
    values(tissue.rest_positions, volume);
    target_ = target.value_or(volume[0]);
    Vectors forces(tissue.node_count(), Vec3::Zero());
    add_forces(tissue.rest_positions, std::vector<double>{1.0}, forces);
    for (const Vec3& f : forces) gradient_scale_ += f.squaredNorm();
  }

  [[nodiscard]] std::string_view name() const override { return "enclosed volume"; }
  [[nodiscard]] std::unique_ptr<Constraint> clone() const override { return std::make_unique<EnclosedVolume>(*this); }
  [[nodiscard]] std::size_t count() const override { return 1; }
  [[nodiscard]] std::span<const double> targets() const override { return {&target_, 1}; }
  [[nodiscard]] bool is_dense() const override { return true; }

  void values(std::span<const Vec3> x, std::span<double> values) const override {
    values[0] = 0;
    for (const auto& nodes : facets_) values[0] += cone(corners(x, nodes));
  }
  [[nodiscard]] ConstraintParts parts() const override {
    ConstraintParts parts;
    for (const auto& nodes : facets_) {
      parts.nodes.add(nodes);
      parts.function.push_back(0);
    }
    return parts;
  }
  void gradients(std::span<const Vec3> x, std::span<Vec3> of_parts) const override {
    for (std::size_t f = 0; f < facets_.size(); ++f) {
      const Corners gradient = cone_gradient(corners(x, facets_[f]));
      std::copy(gradient.begin(), gradient.end(), of_parts.begin() + 4 * f);
    }
  }
  void for_parts(const std::function<void(std::size_t)>& body, bool) const override {
    for (std::size_t f = 0; f < facets_.size(); ++f) body(f);
  }
  void add_forces(std::span<const Vec3> x, std::span<const double> pressure, std::span<Vec3> forces) const override {
    for (const auto& nodes : facets_) {
      const Corners gradient = cone_gradient(corners(x, nodes));
      for (int i = 0; i < 4; ++i) forces[nodes[i].index()] += pressure[0] * gradient[i];
    }
  }
  void add_tangent_product(std::span<const Vec3> x, std::span<const double> pressure, std::span<const Vec3> direction,
                           std::span<Vec3> product) const override {
    for_blocks(x, pressure[0], [&](NodeId a, NodeId b, const Mat3& block) {
      product[a.index()] += block * direction[b.index()];
      product[b.index()] += block.transpose() * direction[a.index()];
    });
  }
  void add_tangent(std::span<const Vec3> x, std::span<const double> pressure, TangentSink& tangent) const override {
    for_blocks(x, pressure[0], [&](NodeId a, NodeId b, const Mat3& block) { tangent.add_block(a, b, block); });
  }
  [[nodiscard]] double gradient_scale(std::size_t) const override { return gradient_scale_; }
  [[nodiscard]] double rounding(const Tissue&, double position_rounding) const override {
    return std::sqrt(gradient_scale_) * position_rounding / target_;
  }
  [[nodiscard]] std::unique_ptr<Constraint> after_division(const Tissue& tissue, const Division&,
                                                           std::span<const Vec3>) const override {
    return std::make_unique<EnclosedVolume>(tissue, target_);
  }

 private:
  static Corners corners(std::span<const Vec3> x, const std::array<NodeId, 4>& nodes) {
    return {x[nodes[0].index()], x[nodes[1].index()], x[nodes[2].index()], x[nodes[3].index()]};
  }
  template <class Take>
  void for_blocks(std::span<const Vec3> x, double pressure, const Take& take) const {
    for (const auto& nodes : facets_)
      for (int i = 0; i < 4; ++i)
        for (int j = i + 1; j < 4; ++j)
          take(nodes[i], nodes[j], -pressure * cross_matrix(cone_hessian(corners(x, nodes), i, j)));
  }

  std::vector<std::array<NodeId, 4>> facets_;
  double target_ = 0, gradient_scale_ = 0;
};

const Extension yolk = [](Model& model) {
  model.constraints.push_back(std::make_unique<EnclosedVolume>(model.tissue));
};

TEST(EnclosedVolume, IsTheLumens) {
  const Tissue tissue = build_shell({200, 100, 20, {6, 4, 4}, {1, 1, 1}});
  const EnclosedVolume volume(tissue);
  EXPECT_NEAR(volume.targets()[0] / lumen_volume(tissue, tissue.rest_positions).value(), 1, 1e-14);
}

TEST(EnclosedVolume, DerivativesAgreeWithFiniteDifferences) {
  const Tissue tissue = build_block({.length_um = 40, .width_um = 20, .cells = {2, 1, 1}});
  check_derivatives(ConstraintLaw(EnclosedVolume(tissue), {0.7}), tissue, 4);
}

TEST(EnclosedVolume, IsHeldAsCellsAreAndThePressureIsNotNothing) {
  const auto at_end = [](const Extension& extension) {
    Simulation simulation(extended(extension, {"time.end_s=20"}));
    EXPECT_EQ(simulation.run(), RunStatus::end_time) << simulation.failure();
    return simulation;
  };
  const Simulation held = at_end(yolk), free = at_end({});
  const auto ratio = [](const Simulation& simulation) { return simulation.measures()["lumen_volume_ratio"].value(); };
  EXPECT_NEAR(ratio(held), 1, 1e-9);
  EXPECT_GT(std::abs(ratio(free) - 1), 1e-3);
  EXPECT_GT(std::abs(held.state().multipliers.back()), 1e-6);
  EXPECT_LE(*held.measures()["max_volume_error"], 1e-9);
}

// What a dense row costs: one more solve each time, and no blocks. The shell is a little away, since with the lumen
// held in a sheet that lies on it nothing can move at first, and the constraints are nearly one.
TEST(EnclosedVolume, CostsFewIterationsMore) {
  for (const char* method : {"cholesky", "multigrid"}) {
    const auto iterations_a_direction = [&](const Extension& extension) {
      Simulation simulation(
          extended(extension, {"time.end_s=10", "vitelline.gap_um=0.5", std::string("time.linear_solver=") + method}));
      double linear = 0, newton = 0;
      while (simulation.step()) {
        linear += *simulation.measures()["linear_iterations"];
        newton += *simulation.measures()["newton_iterations"];
      }
      std::printf("%s: %d steps, %.0f Newton and %.0f linear iterations\n", method, simulation.steps(), newton, linear);
      return linear / newton;
    };
    EXPECT_LE(iterations_a_direction(yolk), 1.1 * iterations_a_direction({}));
  }
}

TEST(EnclosedVolume, WorksWithEveryLinearSolver) { expect_same_run_with_every_solver(yolk); }
TEST(EnclosedVolume, ResumesToTheSameBitsThroughADivision) {
  expect_resumable_through_a_division(yolk, "division.floor.daughter_volume_ratio=0.5");  // there is no room to grow
}
TEST(EnclosedVolume, IsRefusedByThePapersAlgorithm) {
  EXPECT_THROW(expect_runs_with_the_papers_algorithm(yolk), std::logic_error);
}

}  // namespace
}  // namespace plica
