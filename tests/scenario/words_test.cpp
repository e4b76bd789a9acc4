#include "scenario/words.hpp"

#include <gtest/gtest.h>

#include <set>

#include "scenario/schema.hpp"

namespace plica {
namespace {

int tables = 0;  // that were looked at

// Returns the words that a table allows for a key.
std::vector<std::string_view> allowed(std::string_view table, std::string_view key) {
  for (const Row& row : rows_of(table))
    if (row.key == key) return row.allowed.words;
  ADD_FAILURE() << "no key " << table << "." << key;
  return {};
}

// Every allowed word has a meaning of its own.
template <class Words>
void expect_words(std::string_view table, std::string_view key, const Words& words) {
  ++tables;
  SCOPED_TRACE(testing::Message() << table << "." << key);
  using Meaning = std::decay_t<decltype(words.front().meaning)>;
  std::set<Meaning> meanings;
  const std::vector<std::string_view> given = allowed(table, key);
  EXPECT_FALSE(given.empty());
  for (const std::string_view word : given) {
    EXPECT_NO_THROW(meanings.insert(meaning_of(words, word))) << word;
    EXPECT_EQ(meaning_of(words, word, words.front().meaning), meaning_of(words, word));
  }
  EXPECT_EQ(meanings.size(), given.size());
  EXPECT_EQ(words.size(), given.size());
  EXPECT_EQ(meaning_of(words, "", words.back().meaning), words.back().meaning) << "not given";
  EXPECT_THROW((void)meaning_of(words, "no such word"), std::logic_error);
}

TEST(Words, EachThatIsAllowedHasAMeaningOfItsOwn) {
  expect_words("embryo", "keep", words::keeps);
  expect_words("embryo", "mirror", words::mirror_planes);
  expect_words("embryo", "elements", words::polygon_splits);
  expect_words("embryo", "rim", words::rims);
  expect_words("embryo", "periodic", words::periods);
  expect_words("region.*", "face", words::sides);
  expect_words("volume", "projection_surface", words::projection_surfaces);
  expect_words("volume", "projection_weights", words::projection_weights);
  expect_words("contraction.*", "edges", words::edges);
  expect_words("cortex.*", "faces", words::edges);
  for (const char* table : {"contraction.*", "cortex.*", "pressure.*", "elasticity.*"}) {
    expect_words(table, "profile.shape", words::profile_shapes);
    expect_words(table, "profile.axis", words::profile_axes);
    expect_words(table, "variation.by", words::variation_bys);
  }
  for (const char* table : {"contraction.*", "cortex.*"}) {
    expect_words(table, "pulse.phase", words::pulse_phases);
    expect_words(table, "delay.axis", words::delay_axes);
    expect_words(table, "delay.from", words::delay_starts);
  }
  expect_words("cortex.*", "trigger.measure", words::own_measures);
  expect_words("cortex.*", "follow.measure", words::own_measures);
  expect_words("enclosed.*", "volume", words::enclosed_states);
  expect_words("self_contact", "surface", words::contact_surfaces);
  expect_words("hold.*", "directions", words::axes);
  expect_words("pressure.*", "face", words::pressure_faces);
  expect_words("ablation.*", "faces", words::edges);
  expect_words("division.*", "when", words::division_triggers);
  expect_words("division.*", "plane", words::division_planes);
  expect_words("time", "scheme", words::schemes);
  expect_words("time", "integrator", words::integrators);
  expect_words("time", "linear_solver", words::linear_solvers);
  expect_words("stop", "combine", words::combinations);
  expect_words("stop.*", "over", words::criterion_overs);
  expect_words("monitor.*", "face", words::monitor_faces);
  expect_words("monitor.*", "axis", words::axes);
  expect_words("monitor.*", "over", words::overs);
  expect_words("monitor.*", "reference_at", words::reference_times);

  // The rest of the keys that take words: names of quantities and of measure sets have tables of their own, these three
  // are no enums, and of enclosed surfaces there is one.
  int with_words = 0;
  for (const ScenarioTable& info : scenario_tables())
    for (const Row& row : info.rows) with_words += row.allowed.words.empty() ? 0 : 1;
  EXPECT_EQ(tables + 6, with_words)
      << "embryo.shape, elasticity.model, volume.method, monitor.*.quantity, enclosed.*.surface, measure.sets";
}

TEST(Words, MeanWhatTheySay) {
  EXPECT_EQ(meaning_of(words::edges, "basal"), CellSide::basal);
  EXPECT_EQ(meaning_of(words::integrators, "bdf2"), TimeOrder::second);
  EXPECT_EQ(meaning_of(words::delay_starts, "ends"), StartDelay::From::ends);
  EXPECT_EQ(meaning_of(words::division_planes, "longest-axis"), DivisionPlane::longest_axis);
  EXPECT_EQ(meaning_of(words::overs, "rms"), Over::rms);
}

}  // namespace
}  // namespace plica
