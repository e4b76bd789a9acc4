// Times the kernels of the element laws, each in yardsticks (bench/reference/yardstick.hpp) and as a share of the
// nearer ceiling of the machine (ceilings.hpp), all measured in turns in one run. Prints JSON.
//
// A kernel's ceiling is the time that its operations take at the machine's rate of multiply-adds, or its bytes at the
// rate at which an array of as many bytes is read, whichever is longer. Operations are counted by running the kernel
// with numbers that count (counted_kernels.hpp); bytes are those of all arrays it touches, read or written once, and of
// what it adds to once more.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <random>

#include "ceilings.hpp"
#include "counted_kernels.hpp"
#include "mechanics/cell_volume.hpp"
#include "mechanics/corotational.hpp"
#include "reference/yardstick.hpp"
#include "tissue/embryo.hpp"

namespace plica::bench {
namespace {

// The pill of 756 cells, its cells cut into n x n x m elements, at some deformation.
struct Scene {
  Scene(int across, int layers)
      : tissue(build_shell({.elements_per_cell = {across, across, layers}})), positions(tissue.rest_positions) {
    std::mt19937 engine(1);
    std::uniform_real_distribution<double> number(-1, 1);
    const double size_um = 0.05 * std::min(20.0 / across, 40.0 / layers);
    for (Vec3& x : positions) x += size_um * Vec3(number(engine), number(engine), number(engine));
    for (std::size_t n = 0; n < positions.size(); ++n)
      direction.emplace_back(number(engine), number(engine), number(engine));
    result.assign(positions.size(), Vec3::Zero());
    pressures.assign(tissue.cells.size(), 0.1);
  }

  [[nodiscard]] Step step() const { return {positions, tissue.rest_positions, {}, 0.05, 0.05, false}; }
  [[nodiscard]] std::size_t elements() const { return tissue.elements.size(); }
  [[nodiscard]] double yardstick_s(int rounds) const {
    reference::Mesh mesh;
    for (const Vec3& x : positions) mesh.nodes.insert(mesh.nodes.end(), x.begin(), x.end());
    for (const auto& nodes : tissue.elements) {
      auto& hex = mesh.hexes.emplace_back();
      for (int i = 0; i < 8; ++i) hex[i] = nodes[i].number();
    }
    return 1e-6 * reference::yardstick_us(mesh, rounds);
  }

  Tissue tissue;
  Vectors positions, direction, result;
  std::vector<double> pressures;
};

struct Kernel {
  std::string name;
  std::function<void()> run;
  double operations = 0;  // of all elements
  double bytes = 0;
  std::vector<double> times_s = {};
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace
}  // namespace plica::bench
