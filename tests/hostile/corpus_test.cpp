// The inputs of fuzz/corpus, through the same functions that the fuzzers feed: what a fuzzer found (found_*) stays
// mended, and the seeds are still of today's formats. Each seed also with some of its bytes changed.
#include <gtest/gtest.h>

#include <filesystem>
#include <random>

#include "core/files.hpp"
#include "output/archive.hpp"
#include "targets.hpp"

namespace plica {
namespace {

namespace fs = std::filesystem;

struct Counts {
  int seeds = 0, taken = 0, changed = 0;
};

Counts replay(const std::string& target, bool (*feed)(std::string_view), int changes) {
  Counts counts;
  std::mt19937 random(1);
  for (const auto& entry : fs::directory_iterator(fs::path(PLICA_SOURCE_DIR) / "fuzz" / "corpus" / target)) {
    const std::string bytes = read_file(entry.path());
    ++counts.seeds;
    counts.taken += feed(bytes) ? 1 : 0;
    if (entry.path().filename().string().starts_with("found_")) continue;
    for (int i = 0; i < changes && !bytes.empty(); ++i, ++counts.changed) {
      std::string changed = bytes;
      for (int k = 0; k < 3; ++k) changed[random() % changed.size()] = static_cast<char>(random());
      if (i % 4 == 3) changed.resize(random() % changed.size());
      (void)feed(changed);
    }
  }
  std::printf("%s: %d inputs, %d of them taken, %d changed ones\n", target.c_str(), counts.seeds, counts.taken,
              counts.changed);
  return counts;
}

TEST(FuzzCorpus, Scenarios) {
  const Counts counts = replay("scenario", fuzz_scenario, 100);
  EXPECT_GE(counts.seeds, 10);
  EXPECT_GE(counts.taken, 3);
}

TEST(FuzzCorpus, Meshes) {
  const Counts counts = replay("mesh", fuzz_mesh, 1000);
  EXPECT_GE(counts.taken, 4);
}

TEST(FuzzCorpus, Checkpoints) {
  if (!can_archive()) GTEST_SKIP() << "built without HDF5";
  const Counts counts = replay("checkpoint", fuzz_checkpoint, 200);
  EXPECT_GE(counts.taken, 4);
}

}  // namespace
}  // namespace plica
