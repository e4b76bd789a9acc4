// Forces that tests put on nodes.
#pragma once

#include "mechanics/law.hpp"
#include "tissue/tissue_change.hpp"

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
  [[nodiscard]] std::unique_ptr<Law> after_change(const Tissue& tissue, const TissueChange& change,
                                                  std::span<const Vec3>) const override {
    Vectors loads = loads_;
    loads.resize(change.kept_nodes());
    loads.resize(tissue.node_count(), Vec3::Zero());
    return std::make_unique<NodalForces>(std::move(loads));
  }

 private:
  Vectors loads_;
};

}  // namespace plica::support
