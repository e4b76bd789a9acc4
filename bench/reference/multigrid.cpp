// A V-cycle over every second line of the mesh, in single precision: Chebyshev polynomials of the diagonal blocks
// smooth, a Cholesky factor solves the coarsest level. A mesh that is small or cannot be coarsened has one level, and
// the cycle is that factor.
#include <Eigen/Dense>
#include <cmath>
#include <stdexcept>

#include "level.hpp"
#include "preconditioner.hpp"

namespace plica::reference {
namespace {

constexpr std::size_t few_nodes =
    4000;                  // solved by the factor: a solve then takes less than a product of the fine mesh
constexpr int degree = 4;  // products a smoothing; 3 and 5 take as long
constexpr float smoothed_part =
    40;  // eigenvalues from the largest down to it over this are smoothed; 5: a third more iterations

using Blocks = std::vector<float>;

// x += inverse diagonal blocks times r, or x = scale x + weight D^-1 r.
void add_scaled(const Blocks& inverse, float scale, float weight, std::span<const float> r, std::span<float> x) {
  for (std::size_t n = 0; 3 * n < r.size(); ++n) {
    const float *D = &inverse[9 * n], *v = &r[3 * n];
    for (std::size_t c = 0; c < 3; ++c)
      x[3 * n + c] = scale * x[3 * n + c] + weight * (D[3 * c] * v[0] + D[3 * c + 1] * v[1] + D[3 * c + 2] * v[2]);
  }
}

class Smoother {
 public:
  explicit Smoother(const Level& level) : level_(&level), d_(3 * level.nodes()), Ad_(d_.size()) {
    unsigned state = 1;  // some vector with a part along the largest eigenvector
    for (float& value : largest_.emplace(3 * level.nodes())) {
      state = state * 1664525U + 1013904223U;
      value = static_cast<float>(state >> 8) / static_cast<float>(1 << 24) - 0.5F;
    }
  }

  void update() {
    const auto blocks = level_->diagonal();
    const bool first = inverse_.empty();
    inverse_.resize(blocks.size());
    for (std::size_t n = 0; n < level_->nodes(); ++n) {
      const Eigen::Matrix3d inverse = Eigen::Map<const Eigen::Matrix3d>(&blocks[9 * n]).inverse();
      for (int k = 0; k < 9; ++k) inverse_[9 * n + k] = static_cast<float>(inverse.data()[k]);
    }
    // Power iteration for the largest eigenvalue of D^-1 A; later from where it was.
    auto& v = *largest_;
    double size = 0;
    for (int k = 0; k < (first ? 15 : 2); ++k) {
      level_->multiply(v, Ad_);
      add_scaled(inverse_, 0, 1, Ad_, v);
      size = 0;
      for (const float value : v) size += double(value) * value;
      size = std::sqrt(size);
      for (float& value : v) value /= static_cast<float>(size);
    }
    largest_eigenvalue_ = 1.1F * static_cast<float>(size);
  }

  /// Improves x, r being b - A x before; r is used up unless `keep_residual`, and then it is b - A x after.
  void smooth(std::span<float> r, std::span<float> x, bool keep_residual) const {
    const float high = largest_eigenvalue_, low = high / smoothed_part;
    const float middle = (high + low) / 2, half = (high - low) / 2, sigma = middle / half;
    float rho = 1 / sigma;
    add_scaled(inverse_, 0, 1 / middle, r, d_);
    for (int k = 1;; ++k) {
      for (std::size_t n = 0; n < x.size(); ++n) x[n] += d_[n];
      if (k == degree && !keep_residual) return;
      level_->multiply(d_, Ad_);
      for (std::size_t n = 0; n < r.size(); ++n) r[n] -= Ad_[n];
      if (k == degree) return;
      const float next = 1 / (2 * sigma - rho);
      add_scaled(inverse_, next * rho, 2 * next / half, r, d_);
      rho = next;
    }
  }

 private:
  const Level* level_;
  Blocks inverse_;
  std::optional<std::vector<float>> largest_;
  float largest_eigenvalue_ = 0;
  mutable std::vector<float> d_, Ad_;
};

class Multigrid : public Preconditioner {
 public:
  explicit Multigrid(const Scene& scene) {
    levels_.push_back(std::make_unique<Level>(scene));
    while (levels_.back()->nodes() > few_nodes) {
      auto coarse = coarsen(static_cast<int>(levels_.back()->nodes()), levels_.back()->hexes());
      if (!coarse) break;
      levels_.push_back(std::make_unique<Level>(*levels_.back(), std::move(*coarse), scene.settings()));
    }
    for (std::size_t l = 0; l < levels_.size(); ++l) {
      if (l + 1 < levels_.size()) smoothers_.emplace_back(*levels_[l]);
      for (auto* vectors : {&x_, &r_, &b_}) vectors->emplace_back(3 * levels_[l]->nodes());
    }
    pattern_ = levels_.back()->pattern();
    factor_ = std::make_unique<BlockCholesky>(pattern_);
  }

  void update(const Scene& scene, std::span<const double> x) override {
    std::vector<double> positions(x.begin(), x.end());
    for (std::size_t l = 0; l < levels_.size(); ++l) {
      if (l > 0) positions = levels_[l]->kept(positions);
      levels_[l]->turn_to(positions, scene);
      if (l < smoothers_.size()) smoothers_[l].update();
    }
    levels_.back()->assemble(pattern_, values_);
    if (!factor_->factorise(values_)) throw std::runtime_error("the system is not positive definite");
  }

  void apply(std::span<const double> r, std::span<double> z) const override {
    std::copy(r.begin(), r.end(), r_[0].begin());
    cycle(0);
    std::copy(x_[0].begin(), x_[0].end(), z.begin());
  }

  [[nodiscard]] double update_cost() const override { return levels_.size() == 1 ? 20 : 2; }

 private:
  // x_[l] = about A^-1 r_[l]; uses r_[l] up.
  void cycle(std::size_t l) const {
    if (l == smoothers_.size()) {
      x_[l] = r_[l];
      factor_->solve(x_[l]);
      return;
    }
    std::fill(x_[l].begin(), x_[l].end(), 0.0F);
    smoothers_[l].smooth(r_[l], x_[l], true);
    levels_[l + 1]->restrict_to(r_[l], r_[l + 1]);
    cycle(l + 1);
    std::fill(b_[l].begin(), b_[l].end(), 0.0F);
    levels_[l + 1]->add_interpolated(x_[l + 1], b_[l]);
    for (std::size_t n = 0; n < x_[l].size(); ++n) x_[l][n] += b_[l][n];
    std::vector<float>& Ab = x_coarse_;
    Ab.resize(b_[l].size());
    levels_[l]->multiply(b_[l], Ab);
    for (std::size_t n = 0; n < Ab.size(); ++n) r_[l][n] -= Ab[n];
    smoothers_[l].smooth(r_[l], x_[l], false);
  }

  std::vector<std::unique_ptr<Level>> levels_;
  std::vector<Smoother> smoothers_;  // of all levels but the last
  BlockPattern pattern_;
  std::vector<float> values_;
  std::unique_ptr<BlockCholesky> factor_;
  mutable std::vector<std::vector<float>> x_, r_, b_;
  mutable std::vector<float> x_coarse_;
};

}  // namespace

std::unique_ptr<Preconditioner> make_multigrid(const Scene& scene) { return std::make_unique<Multigrid>(scene); }

}  // namespace plica::reference
