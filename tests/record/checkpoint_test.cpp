// Checkpoints: the same bytes for the same run, and every damage is told from a good one.
#include "record/checkpoint.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>
#include <zlib.h>

#include "record/archive.hpp"
#include "scenario/print.hpp"
#include "simulation/simulation.hpp"
#include "support/checkpoint_fields.hpp"
#include "support/scenarios.hpp"

namespace {

namespace fs = std::filesystem;

constexpr std::size_t trailer_bytes = 64;
constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

// A block whose cells divided once, after some steps.
struct BlockRun {
  std::unique_ptr<Model> model;  // with the division behind it
  std::unique_ptr<Model> at_rest;
  std::vector<Checkpoint> checkpoints;  // after each step

  BlockRun() {
    const Scenario scenario = load_scenario(
        pulled_block("[division.all]\nregion = \"all\"\nat_s = 2\n[stop.never]\nmonitor = \"all\"\nbelow = 1\n"),
        {"time.integrator=bdf2"});
    at_rest = make_model(scenario);
    struct Keeper final : SimulationListener {
      Keeper(const Simulation& of, BlockRun& into) : simulation(of), run(into) {}
      void step_accepted(const AcceptedStep& step, const Observation& /*measures*/) override {
        now.record.table_bytes["series.csv"] += 100;
        now.record.frame_times_s.push_back(step.state.time_s);
        now.run = simulation.memory();
        run.checkpoints.push_back(now);
      }
      const Simulation& simulation;
      BlockRun& run;
      Checkpoint now;
    };
    Simulation simulation(scenario);
    Keeper keeper(simulation, *this);
    keeper.now = {"0.1.0", resolved_toml(scenario), fingerprint(at_rest->tissue), {}, {}};
    simulation.listen(keeper);
    simulation.run();
    model = std::make_unique<Model>(simulation.model());
  }
  [[nodiscard]] const Checkpoint& last() const { return checkpoints.back(); }
};

class CheckpointTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!can_archive()) GTEST_SKIP() << "built without HDF5";
  }
};

const BlockRun& block_run() {
  static const BlockRun run;
  return run;
}

// Whether the block at rest becomes such a model.
bool is_restored(const ModelMemory& changes) {
  try {
    (void)restored(*block_run().at_rest, changes, block_run().model->tissue.node_count());
    return true;
  } catch (const std::logic_error&) {
    return false;
  }
}

std::optional<Checkpoint> unless_refused(std::string_view bytes) {
  try {
    return read_checkpoint_bytes(bytes);
  } catch (const FileError&) {
    return std::nullopt;
  }
}

bool is_refused(std::string_view bytes) { return !unless_refused(bytes); }

// The same bytes with a checksum that fits them.
std::string made_right(std::string bytes) {
  const std::size_t size = bytes.size() - trailer_bytes;
  const auto sum = crc32(0, reinterpret_cast<const unsigned char*>(bytes.data()), static_cast<uInt>(size));
  std::string end = fmt::format("\nplica checkpoint {} bytes {} crc32 {:08x}", checkpoint_format, size, sum);
  end.resize(trailer_bytes - 1, ' ');
  return bytes.replace(size, trailer_bytes, end + "\n");
}

TEST_F(CheckpointTest, ComesBackAsItWas) {
  const Checkpoint before = block_run().last();
  ASSERT_TRUE(before.run.changes);
  const std::string bytes = checkpoint_bytes(before);
  const Checkpoint after = read_checkpoint_bytes(bytes);
  EXPECT_EQ(after.scenario, before.scenario);
  EXPECT_EQ(after.run.state.positions, before.run.state.positions);
  EXPECT_EQ(after.run.wanted_step_s, before.run.wanted_step_s);
  EXPECT_EQ(after.run.careful_steps, before.run.careful_steps);
  ASSERT_FALSE(before.run.state.trend.mean_velocities.empty()) << "second order";
  EXPECT_EQ(after.run.state.trend.mean_velocities, before.run.state.trend.mean_velocities);
  EXPECT_EQ(after.run.state.trend.earlier_s, before.run.state.trend.earlier_s);
  EXPECT_EQ(after.run.measures.values, before.run.measures.values);
  EXPECT_EQ(after.run.measures.monitors, before.run.measures.monitors);
  EXPECT_EQ(after.run.changes->rest_positions, before.run.changes->rest_positions);
  EXPECT_EQ(checkpoint_bytes(after), bytes) << "all that is in it comes back, and gives the same bytes";
  EXPECT_EQ(checkpoint_bytes(before), bytes);
  EXPECT_EQ(made_right(bytes), bytes) << "this test's own checksum";
}

// Every member, each with a value that it does not have by itself: one that is forgotten comes back as it is by itself.
TEST_F(CheckpointTest, EveryMemberComesBack) {
  const Checkpoint before = marked(block_run().last());
  const auto written = fields_of(before), read = fields_of(read_checkpoint_bytes(checkpoint_bytes(before)));
  const auto unmarked = fields_of(Checkpoint{});
  for (const auto& [field, numbers] : written) {
    EXPECT_NE(numbers, unmarked.at(field)) << field << " has no value of its own here";
    EXPECT_EQ(numbers, read.at(field)) << field;
  }
  EXPECT_GT(written.size(), 45U);
}

// A state, not a history: the steps before it add a time of a snapshot each, nothing else.
TEST_F(CheckpointTest, DoesNotGrowWithTheRun) {
  const auto& checkpoints = block_run().checkpoints;
  const auto divided =
      std::ranges::find_if(checkpoints, [](const Checkpoint& checkpoint) { return checkpoint.run.changes != nullptr; });
  const auto first = divided + 2, last = checkpoints.end() - 1;
  ASSERT_GE(last - first, 3);
  // Times of frames are appended; HDF5 allots space in blocks.
  EXPECT_LE(checkpoint_bytes(*last).size(),
            checkpoint_bytes(*first).size() + static_cast<std::size_t>(last - first) * sizeof(double));
}

TEST_F(CheckpointTest, EveryDamageIsRefused) {
  const std::string whole = checkpoint_bytes(block_run().last());
  int cases = 0;
  const auto refused = [&](const std::string& bytes, const std::string& what) {
    ++cases;
    EXPECT_TRUE(is_refused(bytes)) << what;
  };
  constexpr std::size_t every = 97, ends = 512;
  for (std::size_t at = 0; at < whole.size(); at += at < ends || at + ends > whole.size() ? 1 : every) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ (1 << at % 8));
    refused(bytes, fmt::format("a bit flipped in byte {}", at));
  }
  for (std::size_t size = 0; size < whole.size(); size += size < ends || size + ends > whole.size() ? 1 : 10 * every)
    refused(whole.substr(0, size), fmt::format("cut off after {} bytes", size));
  for (std::size_t size = 1; size < whole.size(); size += 100 * every)
    refused(whole.substr(size), fmt::format("without its first {} bytes", size));
  refused(whole + "\n", "a byte more");
  refused(whole + whole, "twice");
  refused(std::string(whole.size(), '\0'), "nothing but zeros, as after a power cut");
  std::cout << cases << " damaged checkpoints refused\n";
  EXPECT_GT(cases, 1500);
}

// Which files HDF5 does not survive depends on its version, so here only that it is not let at any in this process
// first (reading_trial_test.cpp: what the trial does then): children that were waited for have touched pages.
TEST_F(CheckpointTest, IsReadOnTrialFirst) {
  const std::string bytes = checkpoint_bytes(block_run().last());
  const auto pages_of_children = [] {
    rusage usage{};
    ::getrusage(RUSAGE_CHILDREN, &usage);
    return usage.ru_minflt;
  };
  const long before = pages_of_children();
  (void)read_checkpoint_bytes(bytes);
  EXPECT_GT(pages_of_children(), before);
}

// As by one who means it: what reads HDF5 then stands alone. Harmless: what is read has nothing but numbers in it, and
// whether it fits the embryo can be told.
TEST_F(CheckpointTest, DamageUnderARightChecksumIsRefusedOrHarmless) {
  const std::string whole = checkpoint_bytes(block_run().last());
  int refused = 0, read = 0, restored = 0;
  for (std::size_t at = 0; at < whole.size() - trailer_bytes; at += at < 2048 ? 3 : 251) {
    for (const int flip : {0x01, 0x80, 0xff}) {
      std::string bytes = whole;
      bytes[at] = static_cast<char>(bytes[at] ^ flip);
      const std::optional<Checkpoint> checkpoint = unless_refused(made_right(bytes));
      (checkpoint ? read : refused) += 1;
      if (!checkpoint) continue;
      for (const auto& [field, numbers] : fields_of(*checkpoint))
        EXPECT_TRUE(std::ranges::all_of(numbers, [](double number) { return std::isfinite(number); })) << field << at;
      EXPECT_TRUE(fits_columns(checkpoint->run.measures));
      (void)why_unfit(checkpoint->run, *block_run().model);
      if (checkpoint->run.changes) restored += is_restored(*checkpoint->run.changes);
    }
  }
  std::cout << refused << " refused, " << read << " read, " << restored << " of them restored\n";
  EXPECT_GT(refused, 100);
  EXPECT_GT(read, 100);
  EXPECT_GT(restored, 20);
}

TEST_F(CheckpointTest, AnotherFormatIsNamed) {
  std::string bytes = checkpoint_bytes(block_run().last());
  const std::string mark = fmt::format("\nplica checkpoint {} ", checkpoint_format);
  for (const char* format : {"9  ", "1  ", "12 ", "99 ", "121", "0  "}) {
    std::string other = bytes;
    other.replace(bytes.size() - trailer_bytes + mark.size() - 3, 3, format);
    EXPECT_SAYS(error_of<FileError>([&] { return read_checkpoint_bytes(other); }), "format");
  }
}

TEST_F(CheckpointTest, MeasuresOfOtherColumnsAreNamed) {
  std::string bytes = checkpoint_bytes(block_run().last());
  const std::size_t at = bytes.find("furrow_depth_um ");
  ASSERT_NE(at, std::string::npos);
  bytes.replace(at, 15, "furrow_width_um");
  EXPECT_SAYS(error_of<FileError>([&] { return read_checkpoint_bytes(made_right(bytes)); }), "other columns");
}

// Before its items each list has its length.
TEST_F(CheckpointTest, ListsThatDoNotAddUpAreRefused) {
  const std::string bytes = checkpoint_bytes(marked(block_run().last()));
  using Internals = std::array<double, 7>;  // three lists: {1, 2}, {}, {3}
  const auto as_bytes = [](const Internals& of) {
    return std::string(reinterpret_cast<const char*>(of.data()), sizeof(of));
  };
  const std::size_t at = bytes.find(as_bytes({3, 2, 1, 2, 0, 1, 3}));
  ASSERT_NE(at, std::string::npos);
  const auto with = [&](const Internals& of) {
    std::string changed = bytes;
    return made_right(changed.replace(at, sizeof(of), as_bytes(of)));
  };
  EXPECT_FALSE(is_refused(with({3, 1, 1, 1, 2, 1, 3})));
  for (const Internals& of : {Internals{3, 2, 1, 2, 0, 0, 3},
                              {3, 2, 1, 2, 0, 2, 3},
                              {3, 2, 1, 2, -1, 1, 3},
                              {3, 2, 1, 2, 0.5, 1, 3},
                              {3, 1e9, 1, 2, 0, 1, 3}})
    EXPECT_TRUE(is_refused(with(of))) << of[1] << of[4] << of[5];
}

TEST_F(CheckpointTest, WhatIsNoNumberIsRefused) {
  const Checkpoint& good = block_run().last();
  int cases = 0;
  const auto refused = [&](const auto& harm) {
    Checkpoint bad = good;
    harm(bad);
    EXPECT_TRUE(is_refused(checkpoint_bytes(bad))) << "case " << cases;
    ++cases;
  };
  refused([](Checkpoint& c) { c.run.state.positions[5].y() = no_number; });
  refused([](Checkpoint& c) { c.run.state.velocities[0].x() = std::numeric_limits<double>::infinity(); });
  refused([](Checkpoint& c) { c.run.state.multipliers[2] = no_number; });
  refused([](Checkpoint& c) { c.run.state.time_s = no_number; });
  refused([](Checkpoint& c) { c.run.equilibrium_time_s = no_number; });
  refused([](Checkpoint& c) { c.run.wanted_step_s = -std::numeric_limits<double>::infinity(); });
  refused([](Checkpoint& c) { c.record.frame_times_s[1] = no_number; });
  refused([](Checkpoint& c) { c.run.measures.values[column_index("max_volume_error")] = no_number; });
  refused([](Checkpoint& c) { c.run.measures.monitors[0] = no_number; });
  refused([](Checkpoint& c) { c.run.measures.values.pop_back(); });
  refused([](Checkpoint& c) { c.run.measures.values[column_index("cells")] = 0.5; });
  EXPECT_EQ(cases, 11);
}

TEST_F(CheckpointTest, WhatDoesNotFitTheEmbryoIsNamed) {
  const BlockRun& run = block_run();
  EXPECT_FALSE(why_unfit(run.last().run, *run.model));
  EXPECT_TRUE(why_unfit(run.last().run, *run.at_rest)) << "its cells have not divided";
  int cases = 0;
  const auto unfit = [&](const auto& harm) {
    Checkpoint bad = run.last();
    harm(bad.run);
    EXPECT_TRUE(why_unfit(read_checkpoint_bytes(checkpoint_bytes(bad)).run, *run.model)) << "case " << cases;
    ++cases;
  };
  unfit([](RunMemory& m) { m.state.positions.pop_back(); });
  unfit([](RunMemory& m) { m.state.velocities.clear(); });
  unfit([](RunMemory& m) { m.state.multipliers.push_back(0); });
  unfit([](RunMemory& m) { m.state.obstacle_forces.push_back(0); });
  unfit([](RunMemory& m) { m.state.on_obstacle.push_back(0); });
  unfit([](RunMemory& m) { m.state.trend.earlier_s = -1; });
  unfit([](RunMemory& m) { m.state.trend.step_s = 1e308; });
  unfit([](RunMemory& m) { m.state.trend.mean_velocities.resize(1, Vec3::Zero()); });
  unfit([](RunMemory& m) { m.state.trend.accelerations.resize(1, Vec3::Zero()); });
  unfit([](RunMemory& m) { m.state.trend.multiplier_rates.resize(1); });
  unfit([](RunMemory& m) { m.state.time_s = -1; });
  unfit([](RunMemory& m) { m.steps = -1; });
  unfit([](RunMemory& m) { m.wanted_step_s = -1; });
  unfit([](RunMemory& m) { m.careful_steps = -1; });
  unfit([](RunMemory& m) { m.pace.since_s = m.state.time_s + 1; });
  unfit([](RunMemory& m) { m.pace.steps = -1; });
  unfit([](RunMemory& m) { m.state.internals.pop_back(); });
  unfit([](RunMemory& m) { m.state.signals.emplace_back(); });
  EXPECT_EQ(cases, 18);
}

// A law whose memory has another length in this version would read past its end.
TEST_F(CheckpointTest, MemoryOfAnotherLengthIsNamed) {
  Simulation simulation(
      load_scenario(pulled_block("[cortex.skin]\nregion = \"all\"\nstiffness_mN_per_m = 1\nrelaxation_s = 9\n"
                                 "[self_contact]\nsurface = \"apical\"\n"),
                    {"elasticity.model=neo-hookean", "elasticity.relaxation_s=9"}));
  simulation.run_until(1);
  const Model& model = simulation.model();
  const RunMemory good = simulation.memory();
  EXPECT_FALSE(why_unfit(good, model));
  int with_memory = 0;
  for (std::size_t l = 0; l < model.laws.size(); ++l) {
    RunMemory longer = good;
    longer.state.internals[l].push_back(1);
    with_memory += longer.state.internals[l].size() > 1;
    EXPECT_SAYS(why_unfit(longer, model).value_or(""), model.laws[l]->label());
    EXPECT_THROW(simulation.go_on_from(longer), UnfitMemory);
  }
  EXPECT_GE(with_memory, 2);
  RunMemory given = good;
  for (std::size_t l = 0; l < model.laws.size(); ++l)
    if (model.laws[l]->is_active()) given.state.internals[l].resize(model.tissue.cells.size(), 1);
  EXPECT_FALSE(why_unfit(given, model)) << "an activity a cell";
}

// Sizes and indices, each of which the model would be made with.
TEST_F(CheckpointTest, ChangesThatDoNotFitTheEmbryoAreRefused) {
  const ModelMemory& good = *block_run().last().run.changes;
  ASSERT_TRUE(is_restored(good));
  int cases = 0;
  const auto refused = [&](const auto& harm) {
    ModelMemory bad = good;
    harm(bad);
    EXPECT_FALSE(is_restored(bad)) << "case " << cases;
    ++cases;
  };
  refused([](ModelMemory& m) { m.origin.pop_back(); });
  refused([](ModelMemory& m) { m.origin.back() = CellId(1000000); });
  refused([](ModelMemory& m) { m.origin.back() = CellId(); });
  refused([](ModelMemory& m) { m.origin.front() = CellId(1); });
  refused([](ModelMemory& m) { m.cells.pop_back(); });
  refused([](ModelMemory& m) { m.origin.clear(), m.cells.clear(); });
  refused([](ModelMemory& m) { m.rest_positions.clear(); });
  refused([](ModelMemory& m) { m.rest_positions.push_back(Vec3::Zero()); });
  refused([](ModelMemory& m) { m.held.pop_back(); });
  refused([](ModelMemory& m) { m.laws.pop_back(); });
  refused([](ModelMemory& m) { m.laws.back().push_back(1); });
  refused([](ModelMemory& m) { m.growths.push_back({.cell = CellId(1000000), .rest_from = {}, .rest_to = {}}); });
  refused([](ModelMemory& m) { m.growths.push_back({.cell = CellId(0), .rest_from = {}, .rest_to = {}}); });
  refused([](ModelMemory& m) { m.cells.front().rest_shape.pop_back(); });
  refused([](ModelMemory& m) { m.sheet.cells.pop_back(); });
  refused([](ModelMemory& m) { m.sheet.vertices.pop_back(); });
  const auto refused_vertex = [&](const auto& harm) {
    refused([&](ModelMemory& m) { harm(m.sheet.vertices.front()); });
  };
  refused_vertex([](Vertex& vertex) { vertex.nodes.clear(); });
  refused_vertex([](Vertex& vertex) { vertex.nodes.pop_back(); });
  refused_vertex([](Vertex& vertex) { vertex.nodes.front() = NodeId(1000000); });
  refused_vertex([](Vertex& vertex) { vertex.nodes.back() = NodeId(); });
  refused_vertex([](Vertex& vertex) { vertex.original = VertexId(1); });
  const auto refused_polygon = [&](const auto& harm) { refused([&](ModelMemory& m) { harm(m.sheet.cells.front()); }); };
  refused_polygon([](Polygon& polygon) { polygon.ring.clear(); });
  refused_polygon([](Polygon& polygon) { polygon.ring.pop_back(); });
  refused_polygon([](Polygon& polygon) { polygon.ring.back().at = 1.5; });
  refused_polygon([](Polygon& polygon) { polygon.ring.front().at = 0.5; });
  refused_polygon([](Polygon& polygon) { polygon.ring.insert(polygon.ring.begin(), polygon.ring.front()); });
  refused_polygon([](Polygon& polygon) { polygon.ring[1].vertex = VertexId(1000000); });
  refused_polygon([](Polygon& polygon) { polygon.ring[1].vertex = VertexId(); });
  refused_polygon([](Polygon& polygon) { polygon.inner.emplace_back(1000000); });
  refused_polygon([](Polygon& polygon) { polygon.quadrilaterals.clear(); });
  refused_polygon([](Polygon& polygon) { polygon.quadrilaterals.resize(1000, polygon.quadrilaterals.front()); });
  refused_polygon([](Polygon& polygon) { polygon.quadrilaterals.front()[2].wall = 4; });
  refused_polygon([](Polygon& polygon) { polygon.quadrilaterals.front()[2].at = -0.5; });
  refused_polygon([](Polygon& polygon) { polygon.quadrilaterals.front()[2] = {-1, 0, 0}; });
  EXPECT_EQ(cases, 34);
}

TEST_F(CheckpointTest, ScenariosThatMayChange) {
  const std::string before =
      "format = 1\n[embryo]\na = 1\n[time]\nend_s = 1\n[stop]\nb = 1\n[stop.x]\nc = 1\n[output]\nd = 1\n";
  const auto with = [&](const std::string& old_line, const std::string& new_line) {
    std::string now = before;
    return now.replace(now.find(old_line), old_line.size(), new_line);
  };
  EXPECT_FALSE(other_scenario(before, before));
  EXPECT_FALSE(other_scenario(before, with("end_s = 1", "end_s = 2")));
  EXPECT_FALSE(other_scenario(before, with("d = 1", "")));
  EXPECT_FALSE(other_scenario(before, with("[stop.x]\nc = 1\n", "[stop.y]\n")));
  EXPECT_TRUE(other_stop(before, with("b = 1", "b = 2")));
  EXPECT_TRUE(other_stop(before, with("c = 1", "c = 2")));
  EXPECT_FALSE(other_stop(before, with("end_s = 1", "end_s = 2")));
  EXPECT_EQ(other_scenario(before, with("a = 1", "a = 2")), "embryo.a was 1 and is now 2");
  EXPECT_EQ(other_scenario(before, with("a = 1\n", "")), "embryo.a was 1 and is now missing");
  EXPECT_TRUE(other_scenario(before, before + "[stopped]\na = 1\n"));
  EXPECT_TRUE(other_scenario(before, with("format = 1", "format = 2")));
}

// The last two of a directory.
class CheckpointFilesTest : public CheckpointTest {
 protected:
  CheckpointFilesTest() : folder(fs::path(testing::TempDir()) / fmt::format("plica_checkpoints_{}", ::getpid())) {
    fs::create_directories(folder);
  }
  ~CheckpointFilesTest() override { fs::remove_all(folder); }

  // The time of the checkpoint that is read; -1: none.
  double time_read() {
    const std::optional<Checkpoint> checkpoint = read_checkpoint(folder, complaint);
    return checkpoint ? checkpoint->run.state.time_s : -1;
  }
  const fs::path folder;
  const fs::path newest = folder / "checkpoint.h5", previous = folder / "checkpoint.previous.h5";
  const std::vector<Checkpoint>& steps = block_run().checkpoints;
  std::string complaint;
};

TEST_F(CheckpointFilesTest, TheOneBeforeIsTakenWhenTheNewestIsDamaged) {
  EXPECT_EQ(time_read(), -1);
  CheckpointFiles files(folder);
  for (const int step : {0, 1, 2}) {
    files.write(steps[step], Sync::now);
    EXPECT_EQ(time_read(), steps[step].run.state.time_s);
    EXPECT_EQ(complaint, "");
  }
  write_file(newest, read_file(newest).substr(1));
  EXPECT_EQ(time_read(), steps[1].run.state.time_s);
  EXPECT_SAYS(complaint, newest.string());
  fs::remove(newest);
  EXPECT_EQ(time_read(), steps[1].run.state.time_s) << "as after a kill between two renames";
  EXPECT_EQ(complaint, "");
  write_file(previous, "");
  EXPECT_THROW(time_read(), FileError);
  remove_checkpoints(folder);
  EXPECT_EQ(time_read(), -1);
}

// What is not on the disk never takes the place of what is.
TEST_F(CheckpointFilesTest, OneOfTheTwoIsOnTheDisk) {
  const auto previous_time = [&] { return read_checkpoint_bytes(read_file(previous)).run.state.time_s; };
  CheckpointFiles files(folder);
  files.write(steps[0], Sync::now);
  for (const int step : {1, 2, 3}) {
    files.write(steps[step], Sync::later);
    EXPECT_EQ(previous_time(), steps[0].run.state.time_s);
    EXPECT_EQ(time_read(), steps[step].run.state.time_s);
  }
  files.write(steps[4], Sync::now);
  EXPECT_EQ(previous_time(), steps[0].run.state.time_s) << "the one before was not on the disk";
  files.write(steps[5], Sync::later);
  EXPECT_EQ(previous_time(), steps[4].run.state.time_s);
}

TEST_F(CheckpointFilesTest, AfterADamagedOneTheGoodOneStays) {
  {
    CheckpointFiles files(folder);
    files.write(steps[0], Sync::now);
    files.write(steps[1], Sync::now);
  }
  write_file(newest, "damaged");
  CheckpointFiles files(folder);
  files.write(steps[1], Sync::now);
  EXPECT_EQ(read_checkpoint_bytes(read_file(previous)).run.state.time_s, steps[0].run.state.time_s);
  EXPECT_EQ(time_read(), steps[1].run.state.time_s);
}

}  // namespace
