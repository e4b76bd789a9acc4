#include "solver/sensitivity/step_terms.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <stdexcept>
#include <utility>

#include "mechanics/derivatives.hpp"
#include "solver/linear/node_frame.hpp"

namespace plica {
namespace {

/// Touched obstacles push along their normals, and carry nodes along with them.
void add_obstacles(const Model& model, const Iterate& at, StepTerms& terms) {
  terms.moved.assign(at.positions.size(), Vec3::Zero());
  const ObstacleContacts contacts(model);
  for (std::size_t place = 0; place < contacts.node_count(); ++place) {
    const auto of_node = contacts.at_node(place);
    const NodeObstacles touched = node_obstacles(model, contacts, of_node, at);
    if (touched.count == 0) continue;
    const std::size_t n = contacts.node(of_node.front()).index();
    Eigen::MatrixXd normals(3, touched.count);
    Eigen::VectorXd gaps(touched.count);
    for (int k = 0; k < touched.count; ++k) {
      terms.forces[n] += at.obstacle_forces[touched.contact[k]] * touched.inward[k];
      normals.col(k) = touched.free_normal[k];
      gaps[k] = contacts.gap(touched.contact[k], at.positions).value;
    }
    terms.moved[n] = -normals * (normals.transpose() * normals).ldlt().solve(gaps);
  }
}

}  // namespace

StepTerms step_terms(const Model& first_model, const TapedRun& run, std::size_t number, const TermsWanted& wanted) {
  const std::optional<Model> later = run.grown_in(number, first_model);
  const Model& model = later ? *later : first_model;
  const Step step = run.step(number);
  const Iterate at = run.at_end_of(number);
  const TapedState &begin = run.states[number], &end = run.states[number + 1];
  StepTerms terms;
  terms.forces.assign(at.positions.size(), Vec3::Zero());
  for_laws(model, step, [&](const Law& law, const Step& law_step) {
    law.add_forces(law_step, terms.forces);
    const std::size_t l = terms.internals.size();
    std::vector<double>& internal = terms.internals.emplace_back();
    if (!wanted.internals[l]) return;
    internal = law.with_signals(law.derivatives().next_internal_like(law, law_step, end.internals[l]), end.signals,
                                step.end_time_s);
  });
  terms.excess.assign(at.multipliers.size(), 0.0);
  for_held_constraints(model, [&](const Constraint& constraint, std::size_t first, std::size_t) {
    constraint.add_forces(at.positions, std::span(at.multipliers).subspan(first, constraint.count()), terms.forces);
    const std::span<double> excess = std::span(terms.excess).subspan(first, constraint.count());
    constraint.values(at.positions, excess);
    for (std::size_t f = 0; f < excess.size(); ++f) excess[f] -= constraint.targets()[f];
  });
  if (wanted.signals)
    terms.signals = signals_after(model, run, number, {begin.positions, end.positions, begin.signals});
  if (touches_obstacles(at)) add_obstacles(model, at, terms);
  return terms;
}

Signals::Values signals_after(const Model& model, const TapedRun& run, std::size_t number, const SignalInput& input) {
  State begin, end;
  begin.time_s = run.states[number].time_s, end.time_s = run.states[number + 1].time_s;
  begin.positions = input.begin, end.positions = input.end;
  begin.signals = input.before, end.internals = run.states[number + 1].internals;
  if (const auto failure = advance_signals(model, begin, end)) throw std::runtime_error(failure->problem);
  return std::move(end.signals);
}

bool touches_obstacles(const Iterate& at) {
  return std::ranges::count(at.on_obstacle, char{0}) != std::ssize(at.on_obstacle);
}

}  // namespace plica
