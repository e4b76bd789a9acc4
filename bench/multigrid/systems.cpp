#include "systems.hpp"

#include <algorithm>

#include "scenario/load.hpp"
#include "scenario/setup.hpp"
#include "solver/linear/system_matrix.hpp"

namespace plica::multigrid_bench {
namespace {

std::unique_ptr<const Model> drosophila(const SystemSettings& s) {
  const auto n = [&](int axis) { return std::to_string(s.elements_per_cell[axis]); };
  const auto times = [&](int count) { return std::to_string(count * s.scale); };
  return make_model(load_scenario(
      find_scenario("drosophila"),
      {"embryo.elements_per_cell=[" + n(0) + "," + n(1) + "," + n(2) + "]", "embryo.length_um=" + times(460),
       "embryo.diameter_um=" + times(280), "embryo.cells=[" + times(18) + "," + times(9) + "," + times(8) + "]",
       "region.furrow.cells_along=" + times(14), "region.furrow.cells_across=" + times(5)}));
}

class Blocks final : public TangentSink {
 public:
  explicit Blocks(const BlockPattern& pattern) : pattern_(pattern), blocks_(pattern.columns.size(), Mat3::Zero()) {}
  void add_block(NodeId row, NodeId column, const Mat3& block) override {
    if (column <= row)
      blocks_[pattern_.find(row.number(), column.number())] += block;
    else
      blocks_[pattern_.find(column.number(), row.number())] += block.transpose();
  }
  std::vector<Mat3>& all() { return blocks_; }

 private:
  const BlockPattern& pattern_;
  std::vector<Mat3> blocks_;
};

void add_volumes(const Model& model, double bulk_modulus, Blocks& blocks) {
  const auto& elements = model.tissue.elements;
  Vectors gradients(8 * elements.size());
  model.volumes.gradients(model.tissue.rest_positions, gradients);
  for (std::size_t e = 0; e < elements.size(); ++e) {
    double volume = 0;  // a third of sum x . dV/dx: V is cubic
    for (int a = 0; a < 8; ++a)
      volume += model.tissue.rest_positions[elements[e][a].index()].dot(gradients[8 * e + a]) / 3;
    for (int a = 0; a < 8; ++a)
      for (int b = 0; b <= a; ++b)
        blocks.add_block(elements[e][a], elements[e][b],
                         bulk_modulus / volume * gradients[8 * e + a] * gradients[8 * e + b].transpose());
  }
}

// Normals of the nodes that touch the shell; zero of the others.
Vectors fixed_normals(const Model& model, int free_of) {
  Vectors normals(model.tissue.free_node_count(), Vec3::Zero());
  const Obstacle& shell = *model.obstacles.front();
  const auto nodes = shell.nodes();
  for (std::size_t k = 0; k < nodes.size(); ++k)
    if (free_of == 0 || k % free_of != 0)
      normals[nodes[k].index()] = shell.gap(model.tissue.rest_positions[nodes[k].index()]).inward;
  return normals;
}

std::vector<float> rigid_motions(const Vectors& positions, const Vectors& normals) {
  Vec3 middle = Vec3::Zero();
  for (std::size_t n = 0; n < normals.size(); ++n) middle += positions[n] / static_cast<double>(normals.size());
  double squares = 0;
  for (std::size_t n = 0; n < normals.size(); ++n) squares += (positions[n] - middle).squaredNorm();
  const double radius = std::sqrt(squares / static_cast<double>(normals.size()));
  std::vector<float> motions;
  for (std::size_t n = 0; n < normals.size(); ++n) {
    Eigen::Matrix<double, 3, 6> motion;
    motion << Mat3::Identity(), cross_matrix((positions[n] - middle) / radius).transpose();
    motion = (Mat3::Identity() - normals[n] * normals[n].transpose()) * motion.eval();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 6; ++j) motions.push_back(static_cast<float>(motion(i, j)));
  }
  return motions;
}

}  // namespace

System make_system(const SystemSettings& settings) {
  const auto model = drosophila(settings);
  const State state = rest_state(*model);
  Step step{state.positions, state.positions, state.velocities, settings.step_s, settings.step_s};
  step.semidefinite_tangent = true;
  System system{.pattern = SystemMatrix(*model, {}, false).layout(),
                .values = {},
                .near_kernel = {},
                .elements = model->tissue.elements.size()};
  Blocks blocks(system.pattern);
  for (const auto& law : model->laws) law->add_tangent(step, blocks);
  add_volumes(*model, settings.bulk_modulus, blocks);

  const Vectors normals = fixed_normals(*model, settings.free_of);
  for (int row = 0; row < system.pattern.nodes(); ++row)
    for (int at = system.pattern.starts[row]; at < system.pattern.starts[row + 1]; ++at) {
      const int column = system.pattern.columns[at];
      const Vec3 &n = normals[row], &m = normals[column];
      const Mat3& whole = blocks.all()[at];
      Mat3 block = (Mat3::Identity() - n * n.transpose()) * whole * (Mat3::Identity() - m * m.transpose());
      if (row == column) block += n.dot(whole * n) * n * n.transpose();
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) system.values.push_back(static_cast<float>(block(i, j)));
    }
  system.near_kernel = rigid_motions(state.positions, normals);
  return system;
}

}  // namespace plica::multigrid_bench
