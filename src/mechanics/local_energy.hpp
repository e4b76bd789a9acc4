// Laws that are written as one energy of a few nodes; forces, tangents and derivatives follow by automatic
// differentiation. tests/extensions/local_energy_test.cpp has an example.
#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/dual.hpp"
#include "mechanics/derivatives.hpp"
#include "tissue/tissue_change.hpp"

namespace plica {

/// Nodes that an energy joins, the numbers that it reads (rest lengths, say), and the cell whose strength scales it, if
/// any.
template <int nodes, int numbers>
struct LocalGroup {
  std::array<NodeId, nodes> at;
  std::array<double, numbers> given = {};
  CellId cell = {};
};

/// Law whose energy (nN um) is a sum over groups of nodes of a function that is twice differentiable. `Energy` has
///   static constexpr int nodes, numbers;
///   static constexpr std::string_view name;
///   std::vector<LocalGroup<nodes, numbers>> groups(const Tissue&) const;   // also of a tissue that has changed
///   template <class T>
///   T operator()(const std::array<Eigen::Matrix<T, 3, 1>, nodes>& x, const std::array<double, numbers>& given) const;
/// with T double or Dual; functions as sqrt are called without namespace, after `using std::sqrt`. It stores its
/// energy: programs and memory need a law of their own. It takes about as many times longer than derivatives by hand as
/// it has variables, once an iterate.
template <class Energy>
class LocalEnergy final : public Law, public LawDerivatives {
 public:
  static constexpr int nodes = Energy::nodes, variables = 3 * nodes;
  using Group = LocalGroup<nodes, Energy::numbers>;

  LocalEnergy(const Tissue& tissue, Energy energy)
      : LocalEnergy(tissue, std::move(energy), std::vector<double>(tissue.cells.size(), 1)) {}

  [[nodiscard]] std::string_view name() const override { return Energy::name; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<LocalEnergy>(*this); }

  [[nodiscard]] double energy(const Step& step) const override {
    double sum = 0;
    for (const Group& group : groups_) sum += strength(group) * energy_(places<double>(step, group), group.given);
    return sum;
  }
  void add_forces(const Step& step, std::span<Vec3> forces) const override {
    for (const Group& group : groups_) {
      const Values<1> gradient = strength(group) * at<false>(step, group).gradient;
      for (int i = 0; i < nodes; ++i) forces[group.at[i].index()] -= gradient.template segment<3>(3 * i);
    }
  }
  void add_tangent_product(const Step& step, std::span<const Vec3> direction, std::span<Vec3> product) const override {
    const std::vector<Values<variables>>& matrices = stiffnesses(step);
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      Values<1> along;
      for (int i = 0; i < nodes; ++i) along.template segment<3>(3 * i) = direction[groups_[g].at[i].index()];
      const Values<1> result = matrices[g] * along;
      for (int i = 0; i < nodes; ++i) product[groups_[g].at[i].index()] += result.template segment<3>(3 * i);
    }
  }
  void add_tangent(const Step& step, TangentSink& tangent) const override {
    const std::vector<Values<variables>>& matrices = stiffnesses(step);
    for (std::size_t g = 0; g < groups_.size(); ++g)
      for (int i = 0; i < nodes; ++i)
        for (int k = 0; k <= i; ++k)
          tangent.add_block(groups_[g].at[i], groups_[g].at[k], matrices[g].template block<3, 3>(3 * i, 3 * k));
  }
  [[nodiscard]] NodeGroups node_groups(std::span<const double> /*internal*/) const override {
    NodeGroups joined;
    for (const Group& group : groups_) joined.add(group.at);
    return joined;
  }

  /// Strengths go from cells to their daughters.
  [[nodiscard]] std::unique_ptr<Law> after_change(const Tissue& tissue, const TissueChange& change,
                                                  std::span<const Vec3> /*positions*/) const override {
    return std::unique_ptr<Law>(new LocalEnergy(tissue, energy_, inherited(change, strengths_)));
  }

  [[nodiscard]] const LawDerivatives& derivatives() const override { return *this; }
  void add_strength_gradient(const Step& step, std::span<const Vec3> adjoint,
                             std::span<double> of_cells) const override {
    for (const Group& group : groups_) {
      if (!group.cell.valid()) continue;
      const Values<1> gradient = strength(group) * at<false>(step, group).gradient;
      for (int i = 0; i < nodes; ++i)
        of_cells[group.cell.index()] -= adjoint[group.at[i].index()].dot(gradient.template segment<3>(3 * i));
    }
  }
  [[nodiscard]] std::unique_ptr<Law> with_strengths(std::span<const double> factors) const override {
    auto law = std::make_unique<LocalEnergy>(*this);
    for (std::size_t c = 0; c < factors.size(); ++c) law->strengths_[c] *= factors[c];
    law->kept_ = {};
    return law;
  }

 private:
  template <int columns>
  using Values = Eigen::Matrix<double, variables, columns>;

  LocalEnergy(const Tissue& tissue, Energy energy, std::vector<double> strengths)
      : energy_(std::move(energy)), groups_(energy_.groups(tissue)), strengths_(std::move(strengths)) {}

  [[nodiscard]] double strength(const Group& group) const {
    return group.cell.valid() ? strengths_[group.cell.index()] : 1;
  }
  template <class T>
  static std::array<Eigen::Matrix<T, 3, 1>, nodes> places(const Step& step, const Group& group) {
    std::array<Eigen::Matrix<T, 3, 1>, nodes> x;
    for (int v = 0; v < variables; ++v) {
      const double coordinate = step.positions[group.at[v / 3].index()][v % 3];
      if constexpr (std::is_same_v<T, double>)
        x[v / 3][v % 3] = coordinate;
      else
        x[v / 3][v % 3] = T::variable(coordinate, v);
    }
    return x;
  }
  template <bool with_hessian>
  [[nodiscard]] Dual<variables, with_hessian> at(const Step& step, const Group& group) const {
    return energy_(places<Dual<variables, with_hessian>>(step, group), group.given);
  }
  /// Its Hessian; for a semidefinite tangent, the part of non-negative eigenvalues.
  [[nodiscard]] Values<variables> stiffness(const Step& step, const Group& group) const {
    const Values<variables> hessian = strength(group) * at<true>(step, group).hessian;
    if (!step.semidefinite_tangent) return hessian;
    const Eigen::SelfAdjointEigenSolver<Values<variables>> solver(hessian);
    return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0).asDiagonal() * solver.eigenvectors().transpose();
  }
  [[nodiscard]] const std::vector<Values<variables>>& stiffnesses(const Step& step) const {
    if (kept_.semidefinite != step.semidefinite_tangent || !std::ranges::equal(kept_.positions, step.positions)) {
      kept_ = {{step.positions.begin(), step.positions.end()}, step.semidefinite_tangent, {}};
      for (const Group& group : groups_) kept_.matrices.push_back(stiffness(step, group));
    }
    return kept_.matrices;
  }

  Energy energy_;
  std::vector<Group> groups_;
  std::vector<double> strengths_;  // cells
  struct {
    Vectors positions;
    bool semidefinite = false;
    std::vector<Values<variables>> matrices;  // groups
  } mutable kept_;                            // of the last iterate, for all products of its linear system
};

}  // namespace plica
