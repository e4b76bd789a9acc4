// A law whose pattern changes between steps, and one that bounds a step before it is tried: what contact will need.
#include <array>

#include "extensions/extension_checks.hpp"

namespace plica {
namespace {

using namespace support;

/// A spring between two nodes at opposite ends of the embryo, which takes hold of others after every few steps. Its
/// internal state: how many steps there have been.
class WanderingSpring final : public Law {
 public:
  [[nodiscard]] std::string_view name() const override { return "wandering spring"; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<WanderingSpring>(*this); }
  [[nodiscard]] double energy(const Step& step) const override { return 0.5 * stiffness * stretch(step).squaredNorm(); }
  void add_forces(const Step& step, std::span<Vec3> forces) const override {
    const auto [a, b] = nodes(step.internal);
    forces[a.index()] += stiffness * stretch(step);
    forces[b.index()] -= stiffness * stretch(step);
  }
  void add_tangent_product(const Step& step, std::span<const Vec3> direction, std::span<Vec3> product) const override {
    const auto [a, b] = nodes(step.internal);
    const Vec3 change = stiffness * (direction[b.index()] - direction[a.index()]);
    product[a.index()] -= change;
    product[b.index()] += change;
  }
  void add_tangent(const Step& step, TangentSink& tangent) const override {
    const auto [a, b] = nodes(step.internal);
    const Mat3 block = stiffness * Mat3::Identity();
    tangent.add_block(a, a, block);
    tangent.add_block(b, b, block);
    tangent.add_block(b, a, -block);
  }
  [[nodiscard]] NodeGroups node_groups(std::span<const double> internal) const override {
    NodeGroups groups;
    groups.add(nodes(internal));
    return groups;
  }
  [[nodiscard]] int pattern_revision(std::span<const double> internal) const override {
    return static_cast<int>(internal[0]) / 4;
  }
  [[nodiscard]] std::vector<double> first_internal(const Tissue&) const override { return {0}; }
  [[nodiscard]] std::vector<double> next_internal(const Step& step) const override { return {step.internal[0] + 1}; }
  [[nodiscard]] std::unique_ptr<Law> after_division(const Tissue&, const Division&,
                                                    std::span<const Vec3>) const override {
    return clone();
  }

 private:
  static constexpr double stiffness = 0.04;  // nN/um
  [[nodiscard]] std::array<NodeId, 2> nodes(std::span<const double> internal) const {
    const auto n = static_cast<std::size_t>(7 * pattern_revision(internal));
    return {NodeId(n), NodeId(800 + n)};
  }
  [[nodiscard]] Vec3 stretch(const Step& step) const {
    const auto [a, b] = nodes(step.internal);
    return step.positions[b.index()] - step.positions[a.index()];
  }
};

const Extension wandering = [](Model& model) { model.laws.push_back(std::make_unique<WanderingSpring>()); };

TEST(ChangingPattern, WorksWithEveryLinearSolver) { expect_same_run_with_every_solver(wandering); }
TEST(ChangingPattern, ResumesToTheSameBitsThroughADivision) { expect_resumable_through_a_division(wandering); }

/// Lets nodes move a half of what Newton's method wants, and counts how often it was asked.
class Hesitant final : public Law {
 public:
  explicit Hesitant(int& asked) : asked_(asked) {}
  [[nodiscard]] std::string_view name() const override { return "hesitant"; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<Hesitant>(*this); }
  [[nodiscard]] double energy(const Step&) const override { return 0; }
  void add_forces(const Step&, std::span<Vec3>) const override {}
  void add_tangent_product(const Step&, std::span<const Vec3>, std::span<Vec3>) const override {}
  void add_tangent(const Step&, TangentSink&) const override {}
  [[nodiscard]] double max_fraction(const Step&, std::span<const Vec3>) const override {
    ++asked_;
    return 0.5;
  }
  [[nodiscard]] std::unique_ptr<Law> after_division(const Tissue&, const Division&,
                                                    std::span<const Vec3>) const override {
    return clone();
  }

 private:
  int& asked_;
};

TEST(MaxFraction, BoundsEveryDirectionBeforeItIsTried) {
  const auto newton_iterations = [](const Extension& extension) {
    Simulation simulation(extended(extension, {"time.step_s=2", "time.end_s=4", "output.frame_every_s=0"}));
    double sum = 0;
    while (simulation.step()) sum += *simulation.measures()["newton_iterations"];
    EXPECT_EQ(simulation.status(), RunStatus::end_time) << simulation.failure();
    return sum;
  };
  int asked = 0;
  const double free = newton_iterations({});
  const double bound =
      newton_iterations([&](Model& model) { model.laws.push_back(std::make_unique<Hesitant>(asked)); });
  EXPECT_EQ(asked, bound);
  EXPECT_GT(bound, 3 * free) << "by halves it takes more";
}

}  // namespace
}  // namespace plica
