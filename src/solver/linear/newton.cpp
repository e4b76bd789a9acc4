#include "solver/linear/newton.hpp"

#include "core/parallel.hpp"

namespace plica {

FactorMemory factor_memory(const Step& step, const Iterate& at) {
  const auto copy = [](std::span<const Vec3> vectors) { return Vectors(vectors.begin(), vectors.end()); };
  return {.at = at,
          .previous_positions = copy(step.previous_positions),
          .previous_velocities = copy(step.previous_velocities),
          .earlier_positions = copy(step.earlier_positions),
          .rate_s = step.rate_s,
          .end_time_s = step.end_time_s,
          .ahead = step.ahead,
          .changed_contacts = {},
          .has_left = {},
          .normals = {}};
}

Step step_of(const FactorMemory& memory) {
  return {.positions = memory.at.positions,
          .previous_positions = memory.previous_positions,
          .previous_velocities = memory.previous_velocities,
          .rate_s = memory.rate_s,
          .end_time_s = memory.end_time_s,
          .earlier_positions = memory.earlier_positions,
          .ahead = memory.ahead};
}

Vec3 without_held(const Model& model, std::size_t node, Vec3 direction) {
  for (int axis = 0; axis < 3; ++axis)
    if (model.held[node][axis]) direction[axis] = 0;
  return direction;
}

namespace {

// Frame of a free node: held axes first, then the shell's normal where it touches that, else nullptr.
NodeFrame node_frame(const Model& model, std::size_t node, const Vec3* inward) {
  NodeFrame frame;
  const auto add_fixed = [&](const Vec3& direction) { frame.axes.col(frame.fixed++) = direction.normalized(); };
  for (int axis = 0; axis < 3; ++axis)
    if (model.held[node][axis]) add_fixed(Vec3::Unit(axis));
  if (inward != nullptr) add_fixed(without_held(model, node, *inward));
  if (frame.fixed == 1) frame.axes.col(1) = frame.axes.col(0).unitOrthogonal();
  if (frame.fixed == 1 || frame.fixed == 2) frame.axes.col(2) = frame.axes.col(0).cross(frame.axes.col(1));
  return frame;
}

}  // namespace

std::vector<NodeFrame> node_frames(const Model& model, const Iterate& at) {
  std::vector<NodeFrame> frames(model.tissue.free_node_count());
  parallel_for(frames.size(), [&](std::size_t n) { frames[n] = node_frame(model, n, nullptr); });
  parallel_for(at.in_contact.size(), [&](std::size_t k) {
    if (!at.in_contact[k]) return;
    const std::size_t n = model.vitelline->nodes()[k].index();
    const Vec3 inward = model.vitelline->gap(at.positions[n]).inward;
    frames[n] = node_frame(model, n, &inward);
  });
  return frames;
}

void return_to_shell(const Model& model, Iterate& at) {
  parallel_for(at.in_contact.size(), [&](std::size_t k) {
    if (!at.in_contact[k]) return;
    const std::size_t n = model.vitelline->nodes()[k].index();
    // Where the way is not straight along the normal, because the node is partly held, it takes a few.
    for (int attempt = 0; attempt < 4; ++attempt) {
      const Vitelline::Gap gap = model.vitelline->gap(at.positions[n]);
      const Vec3 way = without_held(model, n, gap.inward);
      at.positions[n] -= gap.value / way.squaredNorm() * way;
      if (way == gap.inward) break;
    }
  });
  model.tissue.place_hanging(at.positions);
}

}  // namespace plica
