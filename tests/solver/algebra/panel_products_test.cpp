#include "solver/algebra/panel_products.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>
#include <vector>

#include "support/tissues.hpp"

namespace plica {
namespace {

// As a supernode keeps it: [lower triangle; any numbers], padded with zeros to whole chunks.
struct Example {
  Example(int width, int rows) : dense(Eigen::MatrixXf::Zero(rows, width)), chunks(width * chunks_for(rows)) {
    support::Random random(11);
    for (int j = 0; j < width; ++j)
      for (int i = j; i < rows; ++i) {
        dense(i, j) = static_cast<float>(random.number());
        chunks[j * chunks_for(rows)].numbers[i] = dense(i, j);
      }
  }
  [[nodiscard]] Panel panel() const {
    return {chunks.data(), chunks_for(dense.rows()), static_cast<int>(dense.cols())};
  }

  Eigen::MatrixXf dense;
  std::vector<PanelChunk> chunks;
};

// Widths on both sides of six columns at once, heights on both sides of a chunk and of several.
constexpr int shapes[][2] = {{3, 3}, {3, 40}, {6, 16}, {6, 17}, {9, 9}, {12, 100}, {15, 48}, {21, 31}, {33, 210}};

TEST(PanelProducts, AreThoseOfTheDenseMatrixForAnyKernels) {
  int cases = 0;
  for (const Kernels kernels : available_kernels())
    for (const auto& [width, rows] : shapes) {
      const Example example(width, rows);
      const auto& [multiply, multiply_transposed] = panel_products(kernels);
      const std::size_t height = chunks_for(rows), size = PanelChunk::size * height;
      const Eigen::VectorXf x = Eigen::VectorXf::LinSpaced(width, -1, 2);

      constexpr float none = std::numeric_limits<float>::quiet_NaN();  // what is not written shows
      std::vector<PanelChunk> y(height);
      std::fill_n(y.front().numbers, size, none);
      multiply(example.panel(), x.data(), y.data());
      Eigen::Map<Eigen::VectorXf> numbers(y.front().numbers, static_cast<Eigen::Index>(size));
      EXPECT_LT((numbers.head(rows) - example.dense * x).cwiseAbs().maxCoeff(), 1e-5F) << name(kernels);
      EXPECT_TRUE((numbers.tail(numbers.size() - rows).array() == 0).all()) << name(kernels);

      numbers.head(rows).setLinSpaced(-2, 3);
      Eigen::VectorXf back = Eigen::VectorXf::Constant(width, none);
      multiply_transposed(example.panel(), y.data(), back.data());
      EXPECT_LT((back - example.dense.transpose() * numbers.head(rows)).cwiseAbs().maxCoeff(), 1e-4F) << name(kernels);
      ++cases;
    }
  EXPECT_EQ(cases, 9 * available_kernels().size());
}

}  // namespace
}  // namespace plica
