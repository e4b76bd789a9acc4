#include "solver/algebra/sparse_pattern.hpp"

#include <gtest/gtest.h>
#include <pthread.h>

#include <chrono>
#include <csignal>
#include <thread>
#include <vector>

namespace plica {
namespace {

/// Cube of rows, each joined to its neighbours along three axes: the part below the diagonal.
SparsePattern cube(int side) {
  SparsePattern lower;
  for (int i = 0; i < side * side * side; ++i) {
    if (i >= side * side) lower.columns.push_back(i - side * side);
    if (i / side % side > 0) lower.columns.push_back(i - side);
    if (i % side > 0) lower.columns.push_back(i - 1);
    lower.starts.push_back(static_cast<int>(lower.columns.size()));
  }
  return lower;
}

volatile std::sig_atomic_t caught = 0;

// METIS has a handler of its own while it works (elimination_order).
TEST(EliminationOrder, ASignalThatArrivesMeanwhileIsNotLost) {
  const SparsePattern pattern = cube(40);  // a quarter of a second
  const std::vector<int> undisturbed = elimination_order(pattern);
  const auto before = std::signal(SIGTERM, [](int) { caught = caught + 1; });
  std::thread sender([to = pthread_self()] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    pthread_kill(to, SIGTERM);
  });
  const std::vector<int> order = elimination_order(pattern);
  sender.join();
  std::signal(SIGTERM, before);
  EXPECT_EQ(caught, 1);
  EXPECT_EQ(order, undisturbed);
}

}  // namespace
}  // namespace plica
