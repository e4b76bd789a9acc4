// Simulations that go on from a moment of another, and whether they are where that one is, to the bit.
#pragma once

#include "core/threads.hpp"
#include "record/archive.hpp"
#include "record/checkpoint.hpp"
#include "simulation/simulation.hpp"
#include "support/tissues.hpp"

namespace plica::support {

inline void expect_same(const State& a, const State& b) {
  EXPECT_EQ(a.time_s, b.time_s);
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.velocities, b.velocities);
  EXPECT_EQ(a.multipliers, b.multipliers);
  EXPECT_EQ(a.obstacle_forces, b.obstacle_forces);
  EXPECT_EQ(a.on_obstacle, b.on_obstacle);
  EXPECT_EQ(a.divided_until_s, b.divided_until_s);
  EXPECT_EQ(as_numbers(a.exchanges), as_numbers(b.exchanges));
  EXPECT_EQ(a.trend.step_s, b.trend.step_s);
  EXPECT_EQ(a.trend.earlier_s, b.trend.earlier_s);
  EXPECT_EQ(a.trend.mean_velocities, b.trend.mean_velocities);
  EXPECT_EQ(a.trend.accelerations, b.trend.accelerations);
  EXPECT_EQ(a.trend.multiplier_rates, b.trend.multiplier_rates);
  EXPECT_EQ(a.internals, b.internals);
  EXPECT_EQ(a.signals, b.signals);
}

/// A fresh simulation goes on from a moment: by the bytes of a checkpoint, where this plica has them.
inline void go_on_by_bytes(Simulation& fresh, const RunMemory& memory) {
  Checkpoint checkpoint{"", "", "", memory, {}};
  if (can_archive()) checkpoint = read_checkpoint_bytes(checkpoint_bytes(checkpoint));
  fresh.go_on_from(std::move(checkpoint.run));
}

/// Runs that continue from every nth of these moments, from the one with number `first` on, with one to three threads
/// in turn, end where the whole run did.
inline void expect_to_end_alike(const Scenario& scenario, const Simulation& whole,
                                const std::vector<RunMemory>& moments, std::size_t first, std::size_t every) {
  int resumed = 0;
  for (std::size_t k = first; k < moments.size(); k += every, ++resumed) {
    const ThreadCount threads(1 + resumed % 3);
    Simulation rest(scenario);
    go_on_by_bytes(rest, moments[k]);
    while (rest.step()) (void)rest.memory();
    expect_same(rest.state(), whole.state());
    EXPECT_EQ(rest.steps(), whole.steps());
    ASSERT_FALSE(testing::Test::HasFailure()) << "from step " << k + 1;
  }
  EXPECT_GE(resumed, 4);
}

}  // namespace plica::support
