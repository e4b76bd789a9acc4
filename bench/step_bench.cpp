// Time profile of a step: pill of 756 cells, first step of the Drosophila contraction.
#include <benchmark/benchmark.h>

#include "mechanics/elasticity/corotational.hpp"
#include "scenario/load.hpp"
#include "scenario/setup.hpp"
#include "solver/linear/system_matrix.hpp"
#include "solver/step/newton_stepper.hpp"

namespace plica {
namespace {

// Cells stay as they are; `refinement` elements a cell in each direction.
std::unique_ptr<const Model> drosophila(int refinement) {
  const std::string n = std::to_string(refinement);
  return make_model(
      load_scenario(find_scenario("drosophila"), {"embryo.elements_per_cell=[" + n + "," + n + "," + n + "]"}));
}

struct Setting {
  explicit Setting(int refinement)
      : model(drosophila(refinement)),
        state(rest_state(*model)),
        step{state.positions, state.positions, state.velocities, 0.05, 0.05} {}
  std::unique_ptr<const Model> model;
  State state;
  Step step;
};

void element_forces(benchmark::State& bench) {
  const Setting setting(static_cast<int>(bench.range(0)));
  Vectors forces(setting.state.positions.size(), Vec3::Zero());
  for (auto _ : bench) setting.model->laws.front()->add_forces(setting.step, forces);
  bench.counters["elements"] = static_cast<double>(setting.model->tissue.elements.size());
}
BENCHMARK(element_forces)->Arg(1)->Arg(2)->Unit(benchmark::kMicrosecond);

void tangent_product(benchmark::State& bench) {
  const Setting setting(static_cast<int>(bench.range(0)));
  Vectors product(setting.state.positions.size(), Vec3::Zero());
  for (auto _ : bench) setting.model->laws.front()->add_tangent_product(setting.step, setting.state.positions, product);
}
BENCHMARK(tangent_product)->Arg(1)->Arg(2)->Unit(benchmark::kMicrosecond);

void assembly(benchmark::State& bench) {
  const Setting setting(static_cast<int>(bench.range(0)));
  SystemMatrix matrix(*setting.model);
  for (auto _ : bench) {
    matrix.set_zero();
    for (const auto& law : setting.model->laws) law->add_tangent(setting.step, matrix);
  }
}
BENCHMARK(assembly)->Arg(1)->Arg(2)->Unit(benchmark::kMicrosecond);

void factorisation(benchmark::State& bench) {
  const Setting setting(static_cast<int>(bench.range(0)));
  SystemMatrix matrix(*setting.model, {}, false);
  matrix.set_zero();
  for (const auto& law : setting.model->laws) law->add_tangent(setting.step, matrix);
  matrix.take_gradients(*setting.model, setting.state.positions);
  std::vector<double> values;
  matrix.write_values(std::vector<NodeFrame>(setting.state.positions.size()), values);
  const auto solver = make_direct_solver();
  solver->analyse(matrix.pattern());
  for (auto _ : bench) benchmark::DoNotOptimize(solver->factorise(values));
}
BENCHMARK(factorisation)->Arg(1)->Arg(2)->Unit(benchmark::kMicrosecond);

// The factor that most steps of a small embryo use: A, and volumes as a stiffness.
struct FactorSetting : Setting {
  explicit FactorSetting(int refinement) : Setting(refinement), matrix(*model), factor(matrix.layout()) {
    matrix.set_zero();
    for (const auto& law : model->laws) law->add_tangent(step, matrix);
    const std::vector<double> weights(model->tissue.cells.size(), 10.0 / 16'000);  // 10 kPa over a cell's volume
    matrix.take_gradients(*model, state.positions);
    matrix.add_constraint_stiffness(*model, state.positions, weights);
    matrix.write_projected_blocks(std::vector<NodeFrame>(state.positions.size()), values);
  }
  SystemMatrix matrix;
  BlockCholesky factor;
  UninitialisedVector<float> values;
};

void block_factor(benchmark::State& bench) {
  FactorSetting setting(static_cast<int>(bench.range(0)));
  for (auto _ : bench)
    if (!setting.factor.factorise(setting.values)) bench.SkipWithError("not positive definite");
  bench.counters["numbers"] = static_cast<double>(setting.factor.factor_size());
  bench.counters["blocks"] = static_cast<double>(setting.matrix.layout().columns.size());
}
BENCHMARK(block_factor)->Arg(1)->Arg(2)->Unit(benchmark::kMicrosecond);

void block_solve(benchmark::State& bench) {
  FactorSetting setting(static_cast<int>(bench.range(0)));
  if (!setting.factor.factorise(setting.values)) bench.SkipWithError("not positive definite");
  const std::vector<float> right(3 * setting.matrix.layout().nodes(), 1.0F);
  std::vector<float> x;
  for (auto _ : bench) {
    x = right;
    setting.factor.solve(x);
  }
  bench.counters["numbers"] = static_cast<double>(setting.factor.factor_size());
}
BENCHMARK(block_solve)->Arg(1)->Arg(2)->Unit(benchmark::kMicrosecond);

void first_step(benchmark::State& bench) {
  const Setting setting(static_cast<int>(bench.range(0)));
  NewtonStepper solver(*setting.model);
  State next;
  for (auto _ : bench) {
    solver.forget_factor();
    benchmark::DoNotOptimize(solver.advance(setting.state, 0.05, true, next));
  }
}
BENCHMARK(first_step)->Arg(1)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace plica
