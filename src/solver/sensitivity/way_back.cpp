#include "solver/sensitivity/way_back.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <utility>

#include "core/parallel.hpp"

namespace plica {
namespace {

using Internals = std::vector<std::vector<double>>;

Internals zeros_like(const Internals& internals) {
  Internals zeros;
  for (const auto& internal : internals) zeros.emplace_back(internal.size(), 0.0);
  return zeros;
}

bool is_zero(std::span<const double> numbers) {
  return std::ranges::all_of(numbers, [](double number) { return number == 0; });
}

/// Solved adjoint problem of one step.
struct StepAdjoint {
  const Step& step;
  const Iterate& at;
  const ExactSolve::Solution& solution;  // mu and nu
  const Vectors& on_obstacles;           // forces that fixed directions bear; empty without contacts
  const Internals& internals;            // gradient by internal states at the end of the step
};

/// Return the outcome's dependence on a model, up to a constant: the part of its forces, targets, obstacles and
/// memories along the adjoint.
double along_adjoint(const Model& model, const StepAdjoint& adjoint) {
  const auto& [step, at, solution, on_obstacles, internals] = adjoint;
  double sum = 0;
  Vectors forces(at.positions.size(), Vec3::Zero());
  std::size_t l = 0;
  for_laws(model, step, [&](const Law& law, const Step& law_step) {
    law.add_forces(law_step, forces);
    const std::vector<double>& of_next = internals[l++];
    if (is_zero(of_next) || !law.derivatives().internal_has_parameters()) return;
    const std::vector<double> next = law.next_internal(law_step);
    for (std::size_t i = 0; i < next.size(); ++i) sum += of_next[i] * next[i];
  });
  for_held_constraints(model, [&](const Constraint& constraint, std::size_t first, std::size_t) {
    constraint.add_forces(at.positions, std::span(at.multipliers).subspan(first, constraint.count()), forces);
    std::vector<double> values(constraint.count());
    constraint.values(at.positions, values);
    for (std::size_t f = 0; f < values.size(); ++f)
      sum += solution.multipliers[first + f] * (values[f] - constraint.targets()[f]);
  });
  if (!on_obstacles.empty()) {
    const ObstacleContacts contacts(model);
    for (std::size_t place = 0; place < contacts.node_count(); ++place) {
      const auto of_node = contacts.at_node(place);
      const NodeObstacles touched = node_obstacles(model, contacts, of_node, at);
      if (touched.count == 0) continue;
      const std::size_t n = contacts.node(of_node.front()).index();
      // Touched obstacles push along their normals, and carry the node along with them.
      Eigen::MatrixXd normals(3, touched.count);
      Eigen::VectorXd gaps(touched.count);
      for (int k = 0; k < touched.count; ++k) {
        forces[n] += at.obstacle_forces[touched.contact[k]] * touched.inward[k];
        normals.col(k) = touched.free_normal[k];
        gaps[k] = contacts.gap(touched.contact[k], at.positions).value;
      }
      const Vec3 moved = -normals * (normals.transpose() * normals).ldlt().solve(gaps);
      sum += on_obstacles[n].dot(moved);
    }
  }
  return sum + parallel_dot(std::span<const Vec3>(solution.positions), std::span<const Vec3>(forces));
}

class WayBack {
 public:
  WayBack(const Model& model, const TapedRun& run, LinearMethod method, const OutcomeGradient& outcome,
          const GradientInput& input)
      : model_(model), run_(run), outcome_(outcome), input_(input), solver_(model, method) {
    gradient_.by_parameter.assign(input.parameters.size(), 0.0);
    if (input.law) gradient_.by_strength.assign(model.tissue.cells.size(), 0.0);
    internals_ = zeros_like(run.states.back().internals);
  }

  std::optional<RunGradient> go() {
    const std::size_t last = outcome_.empty() ? 0 : outcome_.rbegin()->first;
    internals_ = zeros_like(run_.states[last].internals);
    for (std::size_t n = last; n-- > 0;) {
      if (input_.stop_requested && input_.stop_requested()) return std::nullopt;
      back_through(n);
    }
    gradient_.linear_iterations = solver_.linear_iterations();
    gradient_.factorisations = solver_.factorisations();
    return std::move(gradient_);
  }

 private:
  /// Return the gradient by positions of a state, from the outcome and from later steps.
  Vectors& by_positions(std::size_t state) {
    const auto [place, is_new] = by_positions_.try_emplace(state);
    if (is_new) {
      const auto of_outcome = outcome_.find(state);
      place->second =
          of_outcome == outcome_.end() ? Vectors(model_.tissue.node_count(), Vec3::Zero()) : of_outcome->second;
    }
    return place->second;
  }

  void back_through(std::size_t n) {
    const Step step = run_.step(n);
    const Iterate at = run_.at_end_of(n);
    Internals before = zeros_like(run_.states[n].internals);
    Vectors& by_end = by_positions(n + 1);
    Vectors& by_previous = by_positions(n);
    Vectors none;
    Vectors& by_earlier = step.ahead > 0 ? by_positions(n - 1) : none;
    const auto for_gradients = [&](const auto& body) {
      std::size_t l = 0;
      for_laws(model_, step, [&](const Law& law, const Step& law_step) {
        body(law.derivatives(), law_step, l, BeginningGradient{step.ahead, by_previous, by_earlier, before[l]});
        ++l;
      });
    };

    // What internal states at the end say about positions there, and about earlier ones.
    for_gradients([&](const LawDerivatives& law, const Step& law_step, std::size_t l, const BeginningGradient& to) {
      if (!is_zero(internals_[l]))
        law.add_internal_gradient(law_step, run_.states[n + 1].internals[l], internals_[l], by_end, to);
    });
    // The forces' part, by the step's own system.
    model_.tissue.carry_hanging(by_end);
    if (parallel_squared_norm(by_end) > 0) {
      const ExactSolve::Solution solution = solver_.solve(step, at, by_end, input_.tolerance);
      add_parameters({step, at, solution, on_obstacles(step, at, by_end), internals_});
      for_gradients([&](const LawDerivatives& law, const Step& law_step, std::size_t l, const BeginningGradient& to) {
        law.add_force_gradient(law_step, solution.positions, to);
        if (input_.law != l) return;
        const LawDerivatives& of_strengths = input_.unscaled_law ? input_.unscaled_law->derivatives() : law;
        of_strengths.add_strength_gradient(law_step, solution.positions, gradient_.by_strength);
      });
    }
    internals_ = std::move(before);
    by_positions_.erase(n + 1);
  }

  [[nodiscard]] Vectors on_obstacles(const Step& step, const Iterate& at, const Vectors& by_end) const {
    if (input_.parameters.empty() || std::ranges::count(at.on_obstacle, char{0}) == std::ssize(at.on_obstacle))
      return {};
    return solver_.unbalanced(step, at, by_end);
  }
  void add_parameters(const StepAdjoint& adjoint) {
    for (std::size_t p = 0; p < input_.parameters.size(); ++p) {
      const ModelPair& pair = *input_.parameters[p];
      gradient_.by_parameter[p] +=
          (along_adjoint(*pair.more, adjoint) - along_adjoint(*pair.less, adjoint)) / pair.difference;
    }
  }

  const Model& model_;
  const TapedRun& run_;
  const OutcomeGradient& outcome_;
  const GradientInput& input_;
  ExactSolve solver_;
  RunGradient gradient_;
  std::map<std::size_t, Vectors> by_positions_;  // states
  Internals internals_;                          // gradient by those at the end of the present step
};

}  // namespace

void require_derivatives(const Model& model) {
  for (const auto& law : model.laws) (void)law->derivatives();
}

ModelPair model_pair(const Model& model, std::string name, std::unique_ptr<const Model> more,
                     std::unique_ptr<const Model> less, double difference) {
  for (const Model* side : {more.get(), less.get()}) {
    bool same = side->tissue.rest_positions == model.tissue.rest_positions &&
                side->tissue.elements == model.tissue.elements && side->held == model.held &&
                side->laws.size() == model.laws.size() && side->multiplier_count() == model.multiplier_count() &&
                ObstacleContacts(*side).size() == ObstacleContacts(model).size();
    for (std::size_t l = 0; same && l < model.laws.size(); ++l)
      same = side->laws[l]->label() == model.laws[l]->label() &&
             side->laws[l]->first_internal(side->tissue) == model.laws[l]->first_internal(model.tissue);
    if (!same)
      throw NoGradient(name +
                       ": has no gradient, since it changes the tissue, which laws act, or the state before the "
                       "first step; choose another key");
  }
  return {std::move(name), std::move(more), std::move(less), difference};
}

std::optional<RunGradient> way_back(const Model& model, const TapedRun& run, LinearMethod method,
                                    const OutcomeGradient& outcome, const GradientInput& input) {
  require_derivatives(model);
  if (input.law) (void)with_strengths(*model.laws[*input.law], std::vector<double>(model.tissue.cells.size(), 1.0));
  return WayBack(model, run, method, outcome, input).go();
}

}  // namespace plica
