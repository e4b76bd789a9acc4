#include <stdexcept>

#include "preconditioner.hpp"
#include "solver/block_cholesky.hpp"

namespace plica::reference {
namespace {

std::vector<int> element_groups(const Mesh& mesh) {
  std::vector<int> groups;
  for (const auto& hex : mesh.hexes) groups.insert(groups.end(), hex.begin(), hex.end());
  return groups;  // springs join nodes of one hexahedron
}

class Factor : public Preconditioner {
 public:
  explicit Factor(const Scene& scene)
      : pattern_(pattern_of_groups(static_cast<int>(scene.mesh().nodes.size() / 3), element_groups(scene.mesh()), 8)),
        cholesky_(pattern_) {
    for (const auto& hex : scene.mesh().hexes)
      for (int a = 0; a < 8; ++a)
        for (int b = 0; b <= a; ++b) place(hex[a], hex[b]);
  }

  void update(const Scene& scene, std::span<const double> /*x*/) override {
    std::vector<float> values(9 * pattern_.columns.size());
    for (int n = 0; n < pattern_.nodes(); ++n) add_scaled_identity(scene.settings().mass, n, values);
    scene.elements().write_blocks(scene.settings().stiffness_factor(), blocks_);
    for (std::size_t pair = 0; pair < places_.size(); ++pair) add(&blocks_[9 * pair], places_[pair], values);
    for (const auto& [i, j, block] : scene.springs()) {
      double minus[9];
      for (int k = 0; k < 9; ++k) minus[k] = -block[k];
      add(block, {pattern_.find(i / 3, i / 3), false}, values);
      add(block, {pattern_.find(j / 3, j / 3), false}, values);
      add(minus, {pattern_.find(std::max(i, j) / 3, std::min(i, j) / 3), false}, values);
    }
    if (!cholesky_.factorise(values)) throw std::runtime_error("the system is not positive definite");
  }

  void apply(std::span<const double> r, std::span<double> z) const override {
    single_.assign(r.begin(), r.end());
    cholesky_.solve(single_);
    std::copy(single_.begin(), single_.end(), z.begin());
  }

  [[nodiscard]] double update_cost() const override { return 20; }

 private:
  struct Place {
    int block;
    bool turned;
  };

  void place(int a, int b) { places_.push_back({pattern_.find(std::max(a, b), std::min(a, b)), a < b}); }

  template <class Real>
  static void add(const Real* block, Place place, std::vector<float>& values) {
    float* value = &values[9 * static_cast<std::size_t>(place.block)];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) value[3 * i + j] += static_cast<float>(block[place.turned ? 3 * j + i : 3 * i + j]);
  }

  void add_scaled_identity(double factor, int node, std::vector<float>& values) const {
    const int block = pattern_.starts[node + 1] - 1;
    for (int i = 0; i < 3; ++i) values[9 * static_cast<std::size_t>(block) + 4 * i] += static_cast<float>(factor);
  }

  BlockPattern pattern_;
  BlockCholesky cholesky_;
  std::vector<Place> places_;  // of each element's 36 pairs
  std::vector<double> blocks_;
  mutable std::vector<float> single_;
};

}  // namespace

std::unique_ptr<Preconditioner> make_factor(const Scene& scene) { return std::make_unique<Factor>(scene); }

}  // namespace plica::reference
