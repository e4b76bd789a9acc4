// Volume enclosed by the basal surface of a closed sheet (the yolk): held or compressible
// (docs/theory/enclosed_volume.md).
#pragma once

#include <array>
#include <vector>

#include "mechanics/constraint.hpp"
#include "tissue/tissue.hpp"

namespace plica {

class EnclosedVolume;

/// Fluid in an enclosed volume, as measures and outcomes see it.
class EnclosedFluid {
 public:
  virtual ~EnclosedFluid() = default;
  [[nodiscard]] virtual const EnclosedVolume& volume() const = 0;
  /// Return the inner pressure, kPa; `multiplier`: of the constraint that holds the volume, else 0.
  [[nodiscard]] virtual double pressure(std::span<const Vec3> positions, double multiplier) const = 0;
};

/// Constraint that holds the enclosed volume at its reference value; the multiplier is the inner pressure, kPa. The
/// sheet must be closed, or a slice closed by planes across x or by mirror planes, in which its nodes must stay.
class EnclosedVolume final : public Constraint, public EnclosedFluid {
 public:
  explicit EnclosedVolume(const Tissue& tissue);
  /// Make the constraint with another target volume, um^3.
  EnclosedVolume(const Tissue& tissue, double target);

  [[nodiscard]] std::string_view name() const override { return "enclosed volume"; }
  [[nodiscard]] std::unique_ptr<Constraint> clone() const override { return std::make_unique<EnclosedVolume>(*this); }
  [[nodiscard]] std::size_t count() const override { return 1; }
  [[nodiscard]] std::span<const double> targets() const override { return {&target_, 1}; }
  [[nodiscard]] bool is_dense() const override { return true; }
  void values(std::span<const Vec3> positions, std::span<double> values) const override;
  [[nodiscard]] ConstraintParts parts() const override;
  void gradients(std::span<const Vec3> positions, std::span<Vec3> of_parts) const override;
  void for_parts(const std::function<void(std::size_t)>& body, bool shared) const override;
  void add_forces(std::span<const Vec3> positions, std::span<const double> multipliers,
                  std::span<Vec3> forces) const override;
  void add_tangent_product(std::span<const Vec3> positions, std::span<const double> multipliers,
                           std::span<const Vec3> direction, std::span<Vec3> product) const override;
  void add_tangent(std::span<const Vec3> positions, std::span<const double> multipliers,
                   TangentSink& tangent) const override;
  [[nodiscard]] double gradient_scale(std::size_t /*function*/) const override { return gradient_scale_; }
  [[nodiscard]] double rounding(const Tissue& tissue, double position_rounding) const override;
  [[nodiscard]] std::unique_ptr<Constraint> after_change(const Tissue& tissue, const TissueChange& change,
                                                         std::span<const Vec3> positions) const override;

  /// Return the volume, um^3, and V/V_0, over the target.
  [[nodiscard]] double volume(std::span<const Vec3> positions) const;
  [[nodiscard]] double ratio(std::span<const Vec3> positions) const { return volume(positions) / target_; }

  [[nodiscard]] const EnclosedFluid* enclosed_fluid() const override { return this; }
  [[nodiscard]] const EnclosedVolume& volume() const override { return *this; }
  [[nodiscard]] double pressure(std::span<const Vec3> /*positions*/, double multiplier) const override {
    return multiplier;
  }

  [[nodiscard]] std::size_t facet_count() const { return facets_.size(); }

  /// Whether the basal surface of a tissue is closed, or that of a slice or one side of such.
  [[nodiscard]] static bool is_closed(const Tissue& tissue);

 private:
  template <class Take>
  void for_blocks(std::span<const Vec3> positions, double pressure, const Take& take) const;

  /// Edge at the end of a slice, oriented as in its facet; forms a triangle of the end with a place in its plane.
  struct RimEdge {
    NodeId from, to;
    Vec3 place;
  };
  [[nodiscard]] static std::vector<RimEdge> open_rim(const Tissue& tissue);

  std::vector<std::array<NodeId, 4>> facets_;
  std::vector<RimEdge> rim_;
  double target_ = 0;
  double gradient_scale_ = 0;  // reference |dV/dx|^2, um^4
};

/// Compressible enclosed volume: energy K V_0/2 (V/V_0 - 1)^2, inner pressure K (1 - V/V_0). The assembled tangent
/// omits the pressure term, which joins all nodes; the semidefinite tangent is zero otherwise.
class ElasticVolume final : public Law, public EnclosedFluid {
 public:
  /// Make the law with `bulk_modulus` K, kPa, and `rest_volume` V_0, um^3.
  ElasticVolume(const Tissue& tissue, double bulk_modulus) : volume_(tissue), bulk_modulus_(bulk_modulus) {}
  ElasticVolume(const Tissue& tissue, double bulk_modulus, double rest_volume)
      : volume_(tissue, rest_volume), bulk_modulus_(bulk_modulus) {}

  [[nodiscard]] std::string_view name() const override { return "enclosed volume"; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<ElasticVolume>(*this); }
  [[nodiscard]] double energy(const Step& step) const override {
    const double strain = volume_.ratio(step.positions) - 1;
    return 0.5 * bulk_modulus_ * volume_.targets()[0] * strain * strain;
  }
  void add_forces(const Step& step, std::span<Vec3> forces) const override {
    volume_.add_forces(step.positions, std::array{pressure(step.positions)}, forces);
  }
  void add_tangent_product(const Step& step, std::span<const Vec3> direction, std::span<Vec3> product) const override {
    Vectors gradient(step.positions.size(), Vec3::Zero());
    volume_.add_forces(step.positions, std::array{1.0}, gradient);
    double change = 0;
    for (std::size_t n = 0; n < gradient.size(); ++n) change += gradient[n].dot(direction[n]);
    const double stiffness = bulk_modulus_ / volume_.targets()[0] * change;
    for (std::size_t n = 0; n < gradient.size(); ++n) product[n] += stiffness * gradient[n];
    if (!step.semidefinite_tangent)
      volume_.add_tangent_product(step.positions, std::array{pressure(step.positions)}, direction, product);
  }
  void add_tangent(const Step& step, TangentSink& tangent) const override {
    if (!step.semidefinite_tangent) volume_.add_tangent(step.positions, std::array{pressure(step.positions)}, tangent);
  }
  [[nodiscard]] const LawDerivatives& derivatives() const override { return static_derivatives(); }
  [[nodiscard]] NodeGroups node_groups(std::span<const double> /*internal*/) const override {
    return volume_.parts().nodes;
  }
  /// Return a law without force for a part of the tissue, which encloses nothing.
  [[nodiscard]] std::unique_ptr<Law> after_change(const Tissue& tissue, const TissueChange& /*change*/,
                                                  std::span<const Vec3> /*positions*/) const override {
    // Cutting cells makes more facets; fewer are left where only some cells are kept.
    const bool is_part = tissue.basal_facets.size() < volume_.facet_count();
    return std::make_unique<ElasticVolume>(tissue, is_part ? 0 : bulk_modulus_, volume_.targets()[0]);
  }

  [[nodiscard]] const EnclosedFluid* enclosed_fluid() const override { return this; }
  [[nodiscard]] const EnclosedVolume& volume() const override { return volume_; }
  [[nodiscard]] double pressure(std::span<const Vec3> positions, double /*multiplier*/ = 0) const override {
    return bulk_modulus_ * (1 - volume_.ratio(positions));
  }

 private:
  EnclosedVolume volume_;
  double bulk_modulus_;
};

}  // namespace plica
