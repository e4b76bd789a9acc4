// Contacts that come and go in turns for ever when they change all at once.
#include <gtest/gtest.h>

#include "solver/step/newton_stepper.hpp"
#include "support/models.hpp"
#include "tissue/division.hpp"

namespace plica {
namespace {

using namespace support;

// Three nodes joined by linear springs, of which each moves along z: forces load - stiffness z.
const Mat3 stiffness = (Mat3() << 46, -21, 48, -21, 36, -41, 48, -41, 66).finished();  // nN/um, positive definite
const Vec3 load(-2, 8, -8);                                                            // nN

class Coupling final : public Law {
 public:
  explicit Coupling(std::array<NodeId, 3> nodes, Vectors rest) : nodes_(nodes), rest_(std::move(rest)) {}
  [[nodiscard]] std::string_view name() const override { return "coupling"; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<Coupling>(*this); }
  [[nodiscard]] double energy(const Step& step) const override {
    const Vec3 z = heights(step.positions);
    return 0.5 * z.dot(stiffness * z) - load.dot(z);
  }
  void add_forces(const Step& step, std::span<Vec3> forces) const override {
    const Vec3 f = load - stiffness * heights(step.positions);
    for (int k = 0; k < 3; ++k) forces[nodes_[k].index()].z() += f[k];
  }
  void add_tangent_product(const Step&, std::span<const Vec3> direction, std::span<Vec3> product) const override {
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < 3; ++l) product[nodes_[k].index()].z() += stiffness(k, l) * direction[nodes_[l].index()].z();
  }
  void add_tangent(const Step&, TangentSink& tangent) const override {
    for (int k = 0; k < 3; ++k)
      for (int l = k; l < 3; ++l)
        tangent.add_block(nodes_[k], nodes_[l], Vec3(0, 0, stiffness(k, l)).asDiagonal().toDenseMatrix());
  }
  [[nodiscard]] NodeGroups node_groups(std::span<const double>) const override {
    NodeGroups groups;
    groups.add(nodes_);
    return groups;
  }
  [[nodiscard]] std::unique_ptr<Law> after_division(const Tissue&, const Division&,
                                                    std::span<const Vec3>) const override {
    return clone();
  }

 private:
  [[nodiscard]] Vec3 heights(std::span<const Vec3> x) const {
    Vec3 z;
    for (int k = 0; k < 3; ++k) z[k] = x[nodes_[k].index()].z() - rest_[nodes_[k].index()].z();
    return z;
  }
  std::array<NodeId, 3> nodes_;
  Vectors rest_;
};

/// The three nodes stay above where they lie at rest.
class Floor final : public Obstacle {
 public:
  Floor(std::array<NodeId, 3> nodes, double height) : nodes_(nodes), height_(height) {}
  [[nodiscard]] std::string_view name() const override { return "floor"; }
  [[nodiscard]] std::unique_ptr<Obstacle> clone() const override { return std::make_unique<Floor>(*this); }
  [[nodiscard]] std::span<const NodeId> nodes() const override { return nodes_; }
  [[nodiscard]] Gap gap(const Vec3& x) const override { return {x.z() - height_, Vec3::UnitZ(), Mat3::Zero()}; }
  [[nodiscard]] std::unique_ptr<Obstacle> after_division(const Tissue&, const Division&) const override {
    return clone();
  }

 private:
  std::array<NodeId, 3> nodes_;
  double height_;
};

// Changing every contact at once, this goes (none) -> ... -> the same again, in a step of any length that matters.
TEST(ContactCycle, Ends) {
  Model model(build_block({.length_um = 20, .width_um = 20, .cell_height_um = 20, .cells = {1, 1, 1}}));
  model.volumes.hold(false);
  std::vector<NodeId> low;
  double floor = 1e9;
  for (const Vec3& x : model.tissue.rest_positions) floor = std::min(floor, x.z());
  for (std::size_t n = 0; n < model.tissue.node_count(); ++n)
    if (model.tissue.rest_positions[n].z() < floor + 1e-9) low.emplace_back(n);
  const std::array<NodeId, 3> nodes = {low[0], low[1], low[2]};
  for (auto& held : model.held) held = {true, true, true};
  for (const NodeId node : nodes) model.held[node.index()] = {true, true, false};
  model.laws.push_back(std::make_unique<Coupling>(nodes, model.tissue.rest_positions));
  model.obstacles.push_back(std::make_unique<Floor>(nodes, floor));

  NewtonStepper stepper(model);
  State end;
  const StepReport report = stepper.advance(rest_state(model), 1, true, end);
  ASSERT_TRUE(report.converged()) << report.reason();
  Vec3 z, force;
  for (int k = 0; k < 3; ++k) z[k] = end.positions[nodes[k].index()].z() - floor, force[k] = end.contact_forces[k];
  EXPECT_LE((stiffness * z - load - force).norm(), 1e-7);
  for (int k = 0; k < 3; ++k) {
    EXPECT_GE(z[k], -1e-8);
    EXPECT_GE(force[k], 0);
    EXPECT_LE(z[k] * force[k], 1e-7);
  }
}

}  // namespace
}  // namespace plica
