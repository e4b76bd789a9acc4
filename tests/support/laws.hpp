// Laws of tests: forces put on nodes, and a constraint with given multipliers, of energy -sum m_k c_k, so that the
// checks of laws apply to it.
#pragma once

#include "mechanics/constraint.hpp"
#include "mechanics/law.hpp"
#include "tissue/division.hpp"

namespace plica::support {

/// Constant forces on nodes (dead loads), nN.
class NodalForces final : public Law {
 public:
  explicit NodalForces(Vectors loads) : loads_(std::move(loads)) {}
  [[nodiscard]] std::string_view name() const override { return "nodal forces"; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<NodalForces>(*this); }
  [[nodiscard]] double energy(const Step& step) const override {
    double work = 0;
    for (std::size_t n = 0; n < loads_.size(); ++n) work += loads_[n].dot(step.positions[n]);
    return -work;
  }
  void add_forces(const Step&, std::span<Vec3> forces) const override {
    for (std::size_t n = 0; n < loads_.size(); ++n) forces[n] += loads_[n];
  }
  void add_tangent_product(const Step&, std::span<const Vec3>, std::span<Vec3>) const override {}
  void add_tangent(const Step&, TangentSink&) const override {}
  [[nodiscard]] std::unique_ptr<Law> after_division(const Tissue& tissue, const Division& division,
                                                    std::span<const Vec3>) const override {
    Vectors loads = loads_;
    loads.resize(division.free_nodes_before);
    loads.resize(tissue.node_count(), Vec3::Zero());
    return std::make_unique<NodalForces>(std::move(loads));
  }

 private:
  Vectors loads_;
};

class ConstraintLaw final : public Law {
 public:
  ConstraintLaw(const Constraint& constraint, std::vector<double> multipliers)
      : constraint_(constraint.clone()), multipliers_(std::move(multipliers)) {}
  [[nodiscard]] std::string_view name() const override { return constraint_->name(); }
  [[nodiscard]] std::unique_ptr<Law> clone() const override {
    return std::make_unique<ConstraintLaw>(*constraint_, multipliers_);
  }
  [[nodiscard]] double energy(const Step& step) const override {
    std::vector<double> values(constraint_->count());
    constraint_->values(step.positions, values);
    double sum = 0;
    for (std::size_t k = 0; k < values.size(); ++k) sum -= multipliers_[k] * values[k];
    return sum;
  }
  void add_forces(const Step& step, std::span<Vec3> forces) const override {
    constraint_->add_forces(step.positions, multipliers_, forces);
  }
  void add_tangent_product(const Step& step, std::span<const Vec3> direction, std::span<Vec3> product) const override {
    constraint_->add_tangent_product(step.positions, multipliers_, direction, product);
  }
  void add_tangent(const Step& step, TangentSink& tangent) const override {
    constraint_->add_tangent(step.positions, multipliers_, tangent);
  }
  [[nodiscard]] std::unique_ptr<Law> after_division(const Tissue&, const Division&,
                                                    std::span<const Vec3>) const override {
    return nullptr;  // not divided in tests
  }

 private:
  std::unique_ptr<Constraint> constraint_;
  std::vector<double> multipliers_;
};

}  // namespace plica::support
