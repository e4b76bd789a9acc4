// A constraint with given multipliers as a law of energy -sum m_k c_k, so that the checks of laws apply to it.
#pragma once

#include "mechanics/constraint.hpp"
#include "mechanics/law.hpp"

namespace plica::support {

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
  [[nodiscard]] std::unique_ptr<Law> after_change(const Tissue&, const TissueChange&,
                                                  std::span<const Vec3>) const override {
    return nullptr;  // not divided in tests
  }

 private:
  std::unique_ptr<Constraint> constraint_;
  std::vector<double> multipliers_;
};

}  // namespace plica::support
