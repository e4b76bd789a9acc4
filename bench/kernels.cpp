// Times the kernels of the element laws, each in yardsticks (reference/yardstick.hpp) and as a share of the nearer
// ceiling of the machine (ceilings.hpp), all measured in turns in one run. Prints JSON.
//
// The nearer ceiling is the longer of two times: that of the kernel's operations at the machine's rate of
// multiply-adds, and that of its bytes at the rate at which an array of as many bytes is read. Operations are counted
// by running the kernel with numbers that count (counted_kernels.hpp). Bytes are those of its arrays, each read or
// written once, what is added to both.
#include <omp.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>

#include "ceilings.hpp"
#include "counted_kernels.hpp"
#include "mechanics/constraints/cell_volume.hpp"
#include "mechanics/elasticity/corotational.hpp"
#include "reference/yardstick.hpp"
#include "tissue/shapes/embryo.hpp"

namespace plica::bench {
namespace {

// The pill of 756 cells, each cut into n x n x m elements, a little deformed everywhere.
struct Scene {
  explicit Scene(std::array<int, 3> elements_per_cell)
      : tissue(build_shell({.elements_per_cell = elements_per_cell})), positions(tissue.rest_positions) {
    std::mt19937 engine(1);
    std::uniform_real_distribution<double> number(-1, 1);
    const double size_um = 0.05 * std::min(20.0 / elements_per_cell[0], 40.0 / elements_per_cell[2]);
    for (Vec3& x : positions) x += size_um * Vec3(number(engine), number(engine), number(engine));
    for (std::size_t n = 0; n < positions.size(); ++n)
      direction.emplace_back(number(engine), number(engine), number(engine));
    for (const Vec3& x : positions) mesh.nodes.insert(mesh.nodes.end(), x.begin(), x.end());
    for (const auto& nodes : tissue.elements) {
      auto& hex = mesh.hexes.emplace_back();
      for (int i = 0; i < 8; ++i) hex[i] = nodes[i].number();
    }
  }

  Tissue tissue;
  Vectors positions, direction;
  reference::Mesh mesh;
};

struct Kernel {
  std::string name;
  std::function<void()> run;
  std::function<void(std::size_t)> count;  // runs the counted kernel on the first batches
  double element_bytes, node_bytes;        // what it touches of each
  std::vector<double> times_s = {}, read_rates = {};
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

// Takes no blocks: what is timed is their making.
class NoTangent final : public TangentSink {
 public:
  void add_block(NodeId, NodeId, const Mat3&) override {}
  [[nodiscard]] bool accepts_concurrent_blocks() const override { return true; }
};

struct Measured {
  const Scene& scene;
  Kernels kernels;
  int threads;

  Corotational elasticity{scene.tissue, std::vector(scene.tissue.elements.size(), ElasticModuli::from_young(1, 0.45)),
                          0, kernels};
  CellVolumes volumes{scene.tissue, kernels};
  Step step{scene.positions, scene.tissue.rest_positions, {}, 0.05, 0.05};
  Step warped{scene.positions, scene.tissue.rest_positions, {}, 0.05, 0.05, true};
  Vectors result = Vectors(scene.positions.size(), Vec3::Zero());
  std::vector<double> pressures = std::vector<double>(scene.tissue.cells.size(), 0.1);
  std::vector<double> of_cells = std::vector<double>(scene.tissue.cells.size());
  Vectors gradients = Vectors(8 * scene.tissue.elements.size());
  NoTangent sink = {};

  // The elements' batches; positions, and what is added to (read and written); directions.
  std::vector<Kernel> kernels_to_time() {
    constexpr double corotational = sizeof(CorotationalBatch) / 8.0, volume = sizeof(VolumeBatch) / 8.0,
                     vec = sizeof(Vec3);
    double* out = components(std::span(result));
    const double* d = components(scene.direction);
    const CorotationalArrays e = elasticity.kernel_arrays(step), w = elasticity.kernel_arrays(warped);
    const VolumeArrays v = volumes.kernel_arrays(scene.positions, pressures);
    return {
        {"element forces", [this] { elasticity.add_forces(step, result); },
         [=](std::size_t n) { counted::corotational().add_forces(e, 0, n, out); }, corotational, 3 * vec},
        {"tangent product", [this] { elasticity.add_tangent_product(step, scene.direction, result); },
         [=](std::size_t n) { counted::corotational().add_product(e, 0, n, d, out); }, corotational, 4 * vec},
        {"semidefinite tangent product", [this] { elasticity.add_tangent_product(warped, scene.direction, result); },
         [=](std::size_t n) { counted::corotational().add_product(w, 0, n, d, out); }, corotational, 4 * vec},
        {"tangent blocks", [this] { elasticity.add_tangent(step, sink); },
         [=](std::size_t n) {
           const auto blocks = std::make_unique<HexahedronBlocks>();
           for (std::size_t b = 0; b < n; ++b) counted::corotational().write_blocks(e, b, *blocks);
         },
         corotational, vec},
        {"volumes", [this] { volumes.values(scene.positions, of_cells); },
         [=, this](std::size_t n) { counted::volumes().add_volumes(v, 0, n, of_cells.data()); }, volume, vec},
        {"volume gradients", [this] { volumes.gradients(scene.positions, gradients); },
         [=, this](std::size_t n) {
           counted::volumes().write_gradients(v, 0, n, reinterpret_cast<double*>(gradients.data()));
         },
         volume + 8 * vec, vec},
        {"volume forces", [this] { volumes.add_forces(scene.positions, pressures, result); },
         [=](std::size_t n) { counted::volumes().add_forces(v, 0, n, out); }, volume, 3 * vec},
        {"volume tangent product",
         [this] { volumes.add_tangent_product(scene.positions, pressures, scene.direction, result); },
         [=](std::size_t n) { counted::volumes().add_product(v, 0, n, d, out); }, volume, 4 * vec}};
  }
};

nlohmann::ordered_json measure(const Scene& scene, Kernels kernels, int threads, int rounds, const std::string& only) {
  const auto elements = scene.tissue.elements.size();
  Measured measured{scene, kernels, threads};
  std::vector<Kernel> all = measured.kernels_to_time();
  std::erase_if(all, [&](const Kernel& kernel) { return !only.empty() && kernel.name != only; });
  reference::Yardstick yardstick(scene.mesh);
  // A few milliseconds each.
  const std::size_t repeats = std::max<std::size_t>(1, 30'000 / elements);
  std::vector<double> yardsticks, rates;
  std::vector<Reading> readings;
  for (const Kernel& kernel : all)
    readings.emplace_back(kernels,
                          static_cast<std::size_t>(kernel.element_bytes * static_cast<double>(elements) +
                                                   kernel.node_bytes * static_cast<double>(scene.positions.size())),
                          threads);
  const auto time = [&](int clock_threads, const auto& run) {
    run();
    return seconds(clock_threads,
                   [&] {
                     for (std::size_t k = 0; k < repeats; ++k) run();
                   }) /
           static_cast<double>(repeats);
  };
  for (int round = 0; round < rounds; ++round) {
    yardsticks.push_back(time(1, [&] { yardstick.product(); }));
    for (std::size_t k = 0; k < all.size(); ++k) {
      rates.push_back(multiply_add_rate(kernels, threads));
      all[k].times_s.push_back(time(threads, all[k].run));
      all[k].read_rates.push_back(readings[k].rate());
    }
  }

  nlohmann::ordered_json out;
  const double yardstick_s = median(yardsticks), rate = median(rates), count = static_cast<double>(elements);
  out["elements"] = elements;
  out["instructions"] = name(kernels);
  out["threads"] = threads;
  out["yardstick_us"] = 1e6 * yardstick_s;
  out["multiply_add_rate"] = rate;
  std::vector<double> read_rates;
  for (const Kernel& kernel : all) {
    const std::size_t counted_batches = std::min<std::size_t>(elements / 8, 64);
    counted::take_count();
    kernel.count(counted_batches);
    const double operations = static_cast<double>(counted::take_count()) / static_cast<double>(8 * counted_batches);
    const double bytes = kernel.element_bytes + kernel.node_bytes * static_cast<double>(scene.positions.size()) / count;
    const double time_s = median(kernel.times_s), read_rate = read_rates.emplace_back(median(kernel.read_rates));
    const double by_arithmetic = operations * count / rate, by_memory = bytes * count / read_rate;
    out["kernels"].push_back({{"kernel", kernel.name},
                              {"ns_per_element", 1e9 * time_s / count},
                              {"yardsticks", time_s / yardstick_s},
                              {"operations_per_element", operations},
                              {"bytes_per_element", bytes},
                              {"reading_rate", read_rate},
                              {"ceiling", by_arithmetic > by_memory ? "multiply-adds" : "reading"},
                              {"share", std::max(by_arithmetic, by_memory) / time_s}});
  }
  out["reading_rate"] = median(read_rates);
  return out;
}

int run(int argc, const char* const* argv) {
  CLI::App app("Times of the element laws' kernels, and the machine's ceilings. Prints JSON.");
  std::vector<int> elements_per_cell = {1, 1};
  int threads = 1, rounds = 9;
  app.add_option("--elements-per-cell", elements_per_cell, "N M: along and across a cell, basal to apical")
      ->expected(2);
  app.add_option("--threads", threads, "Of the kernels and ceilings")->check(CLI::PositiveNumber);
  app.add_option("--rounds", rounds, "Medians are taken over these")->check(CLI::PositiveNumber);
  std::string only;
  app.add_option("--kernel", only, "Time no other than this, as \"tangent product\"");
  app.footer("Example: kernels --elements-per-cell 8 4 --threads 2");
  CLI11_PARSE(app, argc, argv);
  omp_set_num_threads(threads);
  const Scene scene({elements_per_cell[0], elements_per_cell[0], elements_per_cell[1]});
  std::printf("%s\n", measure(scene, chosen_kernels(), threads, rounds, only).dump(2).c_str());
  return 0;
}

}  // namespace
}  // namespace plica::bench

int main(int argc, char** argv) { return plica::bench::run(argc, argv); }
