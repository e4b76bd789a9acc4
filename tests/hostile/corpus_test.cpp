// Replays fuzzer seeds (fuzz/corpus), also with changed bytes, and past findings (fuzz/found). Seeds must be of current
// formats, and findings must stay fixed.
#include "core/files.hpp"
#include "record/archive.hpp"
#include "support/testing.hpp"
#include "targets.hpp"

namespace {

namespace fs = std::filesystem;

struct Counts {
  int seeds = 0, taken = 0, changed = 0, found = 0;
};

Counts replay(const std::string& target, bool (*feed)(std::string_view), int changes) {
  Counts counts;
  std::mt19937 random(1);
  for (const auto& entry : fs::directory_iterator(fs::path(PLICA_SOURCE_DIR) / "fuzz" / "corpus" / target)) {
    const std::string bytes = read_file(entry.path());
    ++counts.seeds;
    counts.taken += feed(bytes) ? 1 : 0;
    for (int i = 0; i < changes && !bytes.empty(); ++i, ++counts.changed) {
      std::string changed = bytes;
      for (int k = 0; k < 3; ++k) changed[random() % changed.size()] = static_cast<char>(random());
      if (i % 4 == 3) changed.resize(random() % changed.size());
      (void)feed(changed);
    }
  }
  const fs::path found = fs::path(PLICA_SOURCE_DIR) / "fuzz" / "found" / target;
  if (fs::exists(found))
    for (const auto& entry : fs::directory_iterator(found)) {
      (void)feed(read_file(entry.path()));
      ++counts.found;
    }
  std::printf("%s: %d inputs, %d of them taken, %d changed ones, %d found ones\n", target.c_str(), counts.seeds,
              counts.taken, counts.changed, counts.found);
  return counts;
}

TEST(FuzzCorpus, Scenarios) {
  const Counts counts = replay("scenario", fuzz_scenario, 100);
  EXPECT_GE(counts.seeds, 10);
  EXPECT_GE(counts.taken, 3);
}

TEST(FuzzCorpus, Studies) {
  const Counts counts = replay("study", fuzz_study, 300);
  EXPECT_GE(counts.taken, 4);
}

TEST(FuzzCorpus, Meshes) {
  const Counts counts = replay("mesh", fuzz_mesh, 1000);
  EXPECT_GE(counts.taken, 4);
}

TEST(FuzzCorpus, Polygons) {
  const Counts counts = replay("polygons", fuzz_polygons, 1000);
  EXPECT_GE(counts.taken, 4);
}

TEST(FuzzCorpus, Checkpoints) {
  if (!can_archive()) GTEST_SKIP() << "built without HDF5";
  const Counts counts = replay("checkpoint", fuzz_checkpoint, 50);
  EXPECT_GE(counts.taken, 4);
  EXPECT_GE(counts.found, 1);
}

}  // namespace
