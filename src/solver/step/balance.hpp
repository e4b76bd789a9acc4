// Residual of an iterate of a step, and the contacts of nodes with obstacles.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/parallel.hpp"
#include "solver/linear/node_frame.hpp"
#include "solver/step/newton_stepper.hpp"
#include "solver/step/obstacle_changes.hpp"

namespace plica {

class Balance {
 public:
  Balance(const Model& model, const StepTolerances& tolerances)
      : model_(model),
        tolerances_(tolerances),
        contacts_(model),
        obstacle_changes_(model.tissue, contacts_),
        force_scale_(model.force_scale()),
        position_rounding_(model.position_rounding()),
        elastic_rounding_(model.elastic_rounding()) {
    for (std::size_t place = 0; place < model.constraint_count(); ++place)
      constraint_rounding_.push_back(model.constraint(place).rounding(model.tissue, position_rounding_));
  }

  /// Compute the residual and set the obstacle forces of the iterate: obstacles bear the forces that push nodes
  /// outward along their normals.
  [[nodiscard]] Residual residual(const Step& step, Iterate& at) const {
    Residual r;
    r.forces.assign(at.positions.size(), Vec3::Zero());
    Vectors of_one(at.positions.size(), Vec3::Zero());
    double balanced = 0;  // squared norm of the forces that have to balance
    double rounding = elastic_rounding_;
    const auto take = [&] {
      model_.tissue.carry_hanging(of_one);
      balanced += parallel_squared_norm(of_one);
      parallel_for(of_one.size(), [&](std::size_t n) {
        r.forces[n] += of_one[n];
        of_one[n].setZero();
      });
    };
    for_laws(model_, step, [&](const Law& law, const Step& law_step) {
      law.add_forces(law_step, of_one);
      take();
      rounding += law.rounding(law_step, position_rounding_);
    });
    r.deficits.assign(at.multipliers.size(), 0.0);
    const Model& model = at_end(model_, step);
    for_held_constraints(model, [&](const Constraint& constraint, std::size_t first, std::size_t place) {
      constraint.add_forces(at.positions, std::span(at.multipliers).subspan(first, constraint.count()), of_one);
      take();
      const std::span<double> deficits = std::span(r.deficits).subspan(first, constraint.count());
      constraint.values(at.positions, deficits);
      double worst = 0;
      for (std::size_t f = 0; f < deficits.size(); ++f) {
        deficits[f] = constraint.targets()[f] - deficits[f];
        worst = std::max(worst, std::abs(deficits[f] / constraint.targets()[f]));
      }
      r.constraint = std::max(r.constraint, worst);
      r.constraint_excess =
          std::max(r.constraint_excess, worst / std::max(tolerances_.constraint, constraint_rounding_[place]));
    });
    add_obstacle_forces(at, r.forces, of_one);
    take();

    Vectors& free = of_one;
    parallel_for(model_.tissue.free_node_count(),
                 [&](std::size_t n) { free[n] = without_held(model_, n, r.forces[n]); });
    take_out_normals(at, free);
    // Relative to the balancing forces, but at least to a floor, where these are negligible or at rounding level.
    const double floor = std::max(1e-4 * force_scale_, rounding / tolerances_.force);
    r.force = std::sqrt(parallel_squared_norm(free)) / (std::sqrt(balanced) + floor);
    return r;
  }

  [[nodiscard]] bool is_solved(const Residual& residual) const {
    return residual.force <= tolerances_.force && residual.constraint_excess <= 1;
  }

  /// Release nodes pulled inward, add nodes outside, and project all onto their obstacles. Returns whether any
  /// contact changed. `changes`: contacts; number of changes in this step, updated here.
  bool revise_contacts(Iterate& at, std::span<unsigned char> changes) const {
    std::vector<char> wanted(at.on_obstacle.begin(), at.on_obstacle.end());
    parallel_for(wanted.size(), [&](std::size_t k) {
      const Obstacle::Gap gap = contacts_.gap(k, at.positions);
      // A node that is held where an obstacle would push it needs no contact.
      if (without_held(model_, contacts_.node(k).index(), gap.inward).norm() < 1e-6) {
        at.on_obstacle[k] = wanted[k] = 0;
        at.obstacle_forces[k] = 0;
      } else if (at.on_obstacle[k]) {
        // Release nodes that are pulled inward by more than rounding.
        if (at.obstacle_forces[k] < -1e-12 * force_scale_) wanted[k] = 0;
        if (at.obstacle_forces[k] < 0) at.obstacle_forces[k] = 0;
      } else if (gap.value < -tolerances_.gap_um) {
        wanted[k] = 1;
      }
    });
    const bool changed = obstacle_changes_.make(wanted, changes, at.on_obstacle);
    return_to_obstacles(model_, contacts_, at);
    return changed;
  }

  [[nodiscard]] const ObstacleContacts& contacts() const { return contacts_; }

 private:
  // Free normals of the contacts of a node, normalised, as columns.
  static Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> normals_of(const NodeObstacles& touched) {
    Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> normals(3, touched.count);
    for (int k = 0; k < touched.count; ++k) normals.col(k) = touched.free_normal[k].normalized();
    return normals;
  }
  void add_obstacle_forces(Iterate& at, std::span<const Vec3> others, std::span<Vec3> forces) const {
    parallel_for(contacts_.node_count(), [&](std::size_t place) {
      const auto of_node = contacts_.at_node(place);
      const NodeObstacles touched = node_obstacles(model_, contacts_, of_node, at);
      if (touched.count == 0) return;
      const std::size_t n = contacts_.node(of_node.front()).index();
      if (touched.count == 1) {
        const Vec3 normal = touched.free_normal[0].normalized();
        double& force = at.obstacle_forces[touched.contact[0]];
        force = -normal.dot(others[n]) / normal.dot(touched.inward[0]);
        forces[n] = force * touched.inward[0];
        return;
      }
      const auto normals = normals_of(touched);
      Eigen::MatrixXd pushes(3, touched.count);
      for (int k = 0; k < touched.count; ++k) pushes.col(k) = touched.inward[k];
      const Eigen::VectorXd sizes =
          (normals.transpose() * pushes).partialPivLu().solve(-normals.transpose() * others[n]);
      for (const std::size_t k : of_node) at.obstacle_forces[k] = 0;  // redundant contacts bear none
      for (int k = 0; k < touched.count; ++k) at.obstacle_forces[touched.contact[k]] = sizes[k];
      forces[n] = pushes * sizes;
    });
  }
  void take_out_normals(const Iterate& at, std::span<Vec3> forces) const {
    parallel_for(contacts_.node_count(), [&](std::size_t place) {
      const auto of_node = contacts_.at_node(place);
      const NodeObstacles touched = node_obstacles(model_, contacts_, of_node, at);
      Vec3& force = forces[contacts_.node(of_node.front()).index()];
      if (touched.count == 1) {
        const Vec3 normal = touched.free_normal[0].normalized();
        force -= normal.dot(force) * normal;
      } else if (touched.count > 1) {
        const auto normals = normals_of(touched);
        force -= normals * (normals.transpose() * normals).ldlt().solve(normals.transpose() * force).eval();
      }
    });
  }

  const Model& model_;
  StepTolerances tolerances_;
  ObstacleContacts contacts_;
  ObstacleChanges obstacle_changes_;
  double force_scale_;                       // nN
  double position_rounding_;                 // um
  double elastic_rounding_;                  // nN: resulting error of elastic forces
  std::vector<double> constraint_rounding_;  // resulting error of relative values; constraints
};

}  // namespace plica
