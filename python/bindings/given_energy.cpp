#include "given_energy.hpp"

#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "core/errors.hpp"
#include "mechanics/derivatives.hpp"

namespace plica::python {
namespace {

using Groups = nb::ndarray<const std::int32_t, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using Numbers = nb::ndarray<const double, nb::c_contig, nb::device::cpu>;
using Matrices = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;

class GivenEnergy final : public Law {
 public:
  GivenEnergy(const Groups& groups, const nb::callable& function)
      : nodes_(groups.shape(1)),
        groups_(groups.data(), groups.data() + groups.size()),
        // Laws are copied and deleted while other Python threads run.
        function_(new nb::callable(function), [](nb::callable* kept) {
          const nb::gil_scoped_acquire lock;
          delete kept;
        }) {}

  [[nodiscard]] std::string_view name() const override { return "energy"; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<GivenEnergy>(*this); }

  [[nodiscard]] double energy(const Step& step) const override {
    double sum = 0;
    for (const double one : values(step, 0)) sum += one;
    return sum;
  }
  void add_forces(const Step& step, std::span<Vec3> forces) const override {
    const std::vector<double>& gradients = values(step, 1);
    for (std::size_t i = 0; i < groups_.size(); ++i)
      forces[groups_[i]] -= Vec3(gradients[3 * i], gradients[3 * i + 1], gradients[3 * i + 2]);
  }
  void add_tangent_product(const Step& step, std::span<const Vec3> direction, std::span<Vec3> product) const override {
    Eigen::VectorXd along(variables());
    for_groups(step, [&](const auto* nodes, const Matrices& hessian) {
      for (std::size_t i = 0; i < nodes_; ++i) along.segment<3>(3 * i) = direction[nodes[i]];
      const Eigen::VectorXd result = hessian * along;
      for (std::size_t i = 0; i < nodes_; ++i) product[nodes[i]] += result.segment<3>(3 * i);
    });
  }
  void add_tangent(const Step& step, TangentSink& tangent) const override {
    for_groups(step, [&](const auto* nodes, const Matrices& hessian) {
      for (std::size_t i = 0; i < nodes_; ++i)
        for (std::size_t k = 0; k <= i; ++k)
          tangent.add_block(NodeId(nodes[i]), NodeId(nodes[k]), hessian.block<3, 3>(3 * i, 3 * k));
    });
  }
  [[nodiscard]] NodeGroups node_groups(std::span<const double> /*internal*/) const override {
    NodeGroups joined;
    std::vector<NodeId> group(nodes_);
    for (std::size_t i = 0; i < groups_.size(); i += nodes_) {
      std::transform(groups_.begin() + i, groups_.begin() + i + nodes_, group.begin(),
                     [](std::int32_t node) { return NodeId(node); });
      joined.add(group);
    }
    return joined;
  }
  [[nodiscard]] std::unique_ptr<Law> after_change(const Tissue& /*tissue*/, const TissueChange& /*change*/,
                                                  std::span<const Vec3> /*positions*/) const override {
    throw UsageError(label() + ": its groups are nodes of the whole tissue, not of a part of it");
  }
  [[nodiscard]] const LawDerivatives& derivatives() const override { return static_derivatives(); }
  [[nodiscard]] const std::vector<std::int32_t>& nodes() const { return groups_; }

 private:
  struct Kept {
    Vectors positions;
    bool semidefinite = false;
    std::vector<double> values;
  };

  [[nodiscard]] std::size_t variables() const { return 3 * nodes_; }

  // Energies, gradients or Hessians, by order; those of the last positions are kept.
  const std::vector<double>& values(const Step& step, std::size_t order) const {
    Kept& kept = kept_[order];
    const bool semidefinite = order == 2 && step.semidefinite_tangent;
    if (kept.semidefinite == semidefinite && std::ranges::equal(kept.positions, step.positions)) return kept.values;
    kept = {{step.positions.begin(), step.positions.end()}, semidefinite, computed(step, order)};
    if (semidefinite)
      for (std::size_t at = 0; at < kept.values.size(); at += variables() * variables()) {
        Eigen::Map<Eigen::MatrixXd> hessian(kept.values.data() + at, variables(), variables());
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(hessian);
        hessian =
            solver.eigenvectors() * solver.eigenvalues().cwiseMax(0).asDiagonal() * solver.eigenvectors().transpose();
      }
    return kept.values;
  }
  [[nodiscard]] std::vector<double> computed(const Step& step, std::size_t order) const {
    std::vector<double> places;
    places.reserve(3 * groups_.size());
    for (const std::int32_t node : groups_)
      places.insert(places.end(), step.positions[node].begin(), step.positions[node].end());
    const nb::gil_scoped_acquire lock;
    const nb::object result = (*function_)(array_of(std::move(places), variables()), order);
    const auto numbers = nb::cast<Numbers>(result);
    return {numbers.data(), numbers.data() + numbers.size()};
  }
  template <class Take>
  void for_groups(const Step& step, const Take& take) const {
    const std::vector<double>& hessians = values(step, 2);
    const std::size_t size = variables();
    for (std::size_t g = 0; g * nodes_ < groups_.size(); ++g)
      take(groups_.data() + g * nodes_, Matrices(hessians.data() + g * size * size, size, size));
  }

  std::size_t nodes_;
  std::vector<std::int32_t> groups_;
  std::shared_ptr<nb::callable> function_;
  mutable std::array<Kept, 3> kept_;  // by order; one thread at a time
};

void check_nodes_of(const std::string& name, const GivenEnergy& law, const Simulation::Parts& parts) {
  const auto refuse = [&](const std::string& why) { throw UsageError("energies: " + name + ": " + why); };
  if (parts.full_model) refuse("groups are nodes of a whole tissue; remove embryo.mirror");
  if (!parts.controls.divisions.empty() || parts.controls.exchange || !parts.controls.extrusions.empty())
    refuse("groups are nodes that stay; remove division, exchange and extrusion");
  const int count = static_cast<int>(parts.model->tissue.node_count());
  for (const std::int32_t node : law.nodes())
    if (node < 0 || node >= count)
      refuse("node " + std::to_string(node) + "; give nodes from 0 to " + std::to_string(count - 1));
}

}  // namespace

PartsAddition adding_energies(const nb::list& energies) {
  std::vector<std::pair<std::string, GivenEnergy>> laws;
  for (const nb::handle one : energies) {
    laws.emplace_back(nb::cast<std::string>(one[0]),
                      GivenEnergy(nb::cast<Groups>(one[1]), nb::cast<nb::callable>(one[2])));
    laws.back().second.set_label("energy." + laws.back().first);
  }
  return [laws = std::move(laws)](Simulation::Parts& parts) {
    for (const auto& [name, law] : laws) {
      check_nodes_of(name, law, parts);
      parts.model->laws.push_back(law.clone());
    }
  };
}

}  // namespace plica::python
