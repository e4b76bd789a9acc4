// What a scenario says, printed; differences of two; words of its keys; names that are near.
#include "scenario/print.hpp"

#include "scenario/builtin.hpp"
#include "scenario/load.hpp"
#include "scenario/schema.hpp"
#include "scenario/suggest.hpp"
#include "scenario/toml_reader.hpp"
#include "scenario/words.hpp"
#include "support/testing.hpp"

namespace {

/// Compares two scenarios field by field; returns the number of fields.
int expect_same(Scenario a, Scenario b) {
  int count = 0;
  for (const ScenarioTable& info : scenario_tables()) {
    const std::vector<std::string> names = info.named() ? info.names(a) : std::vector<std::string>{""};
    if (info.named()) {
      EXPECT_EQ(names, info.names(b));
    }
    for (const std::string& name : names) {
      for (const KeyRow& row : info.rows) {
        const Slot left = row.field(a, name), right = row.field(b, name);
        std::visit(
            [&](auto field) {
              if constexpr (!std::is_same_v<decltype(field), std::monostate>) {
                EXPECT_EQ(*field, *std::get<decltype(field)>(right)) << row.table << " " << name << " " << row.key;
              }
            },
            left);
        ++count;
      }
    }
  }
  return count;
}

TEST(ResolvedToml, LoadsBackToTheSameScenario) {
  std::vector<ScenarioSource> sources;
  for (const BuiltinScenario& builtin : builtin_scenarios()) {
    sources.push_back(find_scenario(std::string(builtin.name)));
  }
  sources.push_back({"sphere", "sphere.toml", "[embryo]\nshape = \"sphere\"\ndiameter_um = 301.7\n"});
  sources.push_back({"file", "file.toml", "[embryo]\nshape = \"file\"\nfile = \"a \\\\ b.vtu\"\n"});
  sources.push_back({"rich", "rich.toml", R"(
title = "quote \" backslash \\ newline \n µ"
[embryo]
shape = "block"
width_um = 0.1
[region.a]
ids = [0, 7]
y_um = [-1e-7, 0.30000000000000004]
[region.b]
union = ["a", "all"]
[contraction.c]
region = "b"
program = { time_min = [0, 0.1, 7], activity = [0, 0.3333333333333333, 1] }
profile = { shape = "linear", half_width_um = 33.3 }
delay = { speed_um_per_s = 0.7, from = "ends" }
variation = { spread = 0.2, seed = 5 }
[contraction.f]
region = "a"
profile = { shape = "gaussian", axis = "along", sigma_um = 30 }
[signal.u]
reaction = "k * u"
constants = { k = 0.5, b = -1 }
source = { region = "a", per_min = 2 }
[hold.d]
region = "a"
directions = ["y"]
[pressure.e]
region = "all"
pressure_Pa = 1e22
[time]
step_s = 0.1
[output]
cells_csv = true
[expect]
max_volume_error = { value = 0, within = 1e-9 }
nodes = { value = 100, within_percent = 1 }
)"});
  int fields = 0;
  for (const ScenarioSource& source : sources) {
    const Scenario scenario = load_scenario(source);
    const std::string text = resolved_toml(scenario);
    const Scenario again = load_scenario({source.name, "resolved.toml", text});
    fields += expect_same(scenario, again);
    EXPECT_EQ(resolved_toml(again), text);
  }
  std::cout << sources.size() << " scenarios, " << fields << " fields\n";
}

TEST(ResolvedToml, FillsInDefaultsAndLeavesOutWhatHasNoValue) {
  const std::string text = resolved_toml(load_scenario({"test", "test.toml", "[region.a]\nface = \"left\"\n"}));
  EXPECT_SAYS(text, "\n[region.a]\nface = \"left\"\n\n");
  EXPECT_SAYS(text, "\nstep_s = \"adaptive\"\n");
  EXPECT_SAYS(text, "\nend_s = 3600\n");
  EXPECT_SAYS_NOT(text, "cells_csv");
  EXPECT_SAYS_NOT(text, "width_um");
}

// The section below a heading, without the heading.
std::string section_of(const std::string& page, const std::string& heading) {
  const std::size_t begin = page.find("\n## " + heading + "\n");
  EXPECT_NE(begin, std::string::npos) << heading;
  return begin == std::string::npos ? "" : page.substr(begin + 1, page.find("\n## ", begin + 1) - begin - 1);
}

const InnerTables* inner_of(std::string_view key) {
  for (const InnerTables& inner : inner_tables())
    if (std::ranges::find(inner.keys, key.substr(0, key.find('.'))) != inner.keys.end()) return &inner;
  return nullptr;
}

std::string heading_of(const ScenarioTable& info) {
  return info.path.empty() ? "Top level" : "`[" + std::string(info.stem()) + (info.named() ? ".NAME]`" : "]`");
}

TEST(Reference, HasEveryRowOfTheTable) {
  const std::string page = reference_markdown();
  int count = 0, inner_count = 0;
  for (const ScenarioTable& info : scenario_tables()) {
    const std::string section = section_of(page, heading_of(info));
    for (const KeyRow& row : info.rows) {
      const InnerTables* inner = inner_of(row.key);
      const std::string& there = inner == nullptr ? section : section_of(page, std::string(inner->title));
      std::string key(row.key);
      if (key.starts_with("stiffness_program.")) key.erase(0, std::string_view("stiffness_").size());
      EXPECT_SAYS(there, "\n| `" + key + "` | " + row.type() + " | ") << info.path << " " << key;
      EXPECT_SAYS(there, row.meaning) << info.path << " " << key;
      if (inner != nullptr) {
        EXPECT_SAYS(section, "([" + std::string(inner->title) + "](#") << info.path << " " << key;
        ++inner_count;
      }
      ++count;
    }
  }
  EXPECT_GT(count, 250);
  EXPECT_GT(inner_count, 100);
  std::cout << count << " rows, " << inner_count << " of inner tables\n";
}

TEST(Reference, TablesThatShareInnerTablesHaveTheSameKeysInThem) {
  std::map<std::string, std::map<std::string, std::string>> meanings;  // by key of the inner table, and table
  for (const ScenarioTable& info : scenario_tables())
    for (const KeyRow& row : info.rows) {
      if (inner_of(row.key) == nullptr) continue;
      if (row.key == "follow.measure") {  // the one key that only one table has
        EXPECT_SAYS(std::string(row.meaning), "`[cortex.NAME]` only");
        continue;
      }
      const std::size_t dot = row.key.find('.');
      std::string key(row.key.substr(0, dot)), table(row.table);
      if (key == "stiffness_program") key = "program", table += " stiffness";
      meanings[key][table] += std::string(row.key.substr(dot)) + row.type() + row.expected() + std::string(row.meaning);
    }
  for (const auto& [key, tables] : meanings)
    for (const auto& [table, text] : tables) EXPECT_EQ(text, tables.begin()->second) << table << " " << key;
}

TEST(Reference, LinksToEverySection) {
  const std::string page = reference_markdown();
  for (const auto& [label, anchor] : {std::pair("top level", "top-level"),
                                      {"embryo", "embryo"},
                                      {"stop", "stop"},
                                      {"stop.NAME", "stopname"},
                                      {"self_contact", "self_contact"},
                                      {"division.NAME", "divisionname"},
                                      {"Profile", "profile"},
                                      {"Activity time course", "activity-time-course"}})
    EXPECT_SAYS(page, "[" + std::string(label) + "](#" + anchor + ")") << label;
  std::size_t links = 0, headings = 0;
  for (std::size_t at = 0; (at = page.find("](#", at)) != std::string::npos && at < page.find("\n## "); ++at) ++links;
  for (std::size_t at = 0; (at = page.find("\n## ", at)) != std::string::npos; ++at) ++headings;
  EXPECT_EQ(links, headings);
}

TEST(ScenarioDifferences, AreKeysInDottedFormWithBothValues) {
  const auto keys = scenario_differences(
      "a = 1\n[embryo]\nshape = \"pill\"\ncells = [18, 9, 8]\n[time]\nend_s = 60.0\n[stop]\nat_equilibrium = true\n",
      "a = 1\n[embryo]\nshape = \"pill\"\ncells = [18, 9, 9]\n[time]\nend_s = 90.0\n[furrow]\nregion = \"belly\"\n");
  ASSERT_EQ(keys.size(), 4u);
  EXPECT_EQ(keys[0].key, "embryo.cells");
  EXPECT_EQ(keys[0].a, "[ 18, 9, 8 ]");
  EXPECT_EQ(keys[0].b, "[ 18, 9, 9 ]");
  EXPECT_EQ(keys[1].key, "furrow.region");
  EXPECT_EQ(keys[1].a, "");
  EXPECT_EQ(keys[2].key, "stop.at_equilibrium");
  EXPECT_EQ(keys[2].a, "true");
  EXPECT_EQ(keys[2].b, "");
  EXPECT_EQ(keys[3].key, "time.end_s");
}

TEST(ScenarioDifferences, AreNoneOfTheSameAndAllOfWhatIsNoToml) {
  EXPECT_TRUE(scenario_differences("a = 1", "a = 1").empty());
  ASSERT_EQ(scenario_differences("a = 1", "no toml").size(), 1u);
  EXPECT_EQ(scenario_differences("a = 1", "no toml")[0].a, "1");
}

int tables = 0;  // that were looked at

// Returns the words that a table allows for a key.
std::vector<std::string_view> allowed(std::string_view table, std::string_view key) {
  for (const KeyRow& row : rows_of(table))
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
  for (const char* table :
       {"contraction.*", "cortex.*", "pressure.*", "foundation.*", "matrix.*", "growth.*", "elasticity.*"}) {
    expect_words(table, "profile.shape", words::profile_shapes);
    expect_words(table, "profile.axis", words::profile_axes);
    expect_words(table, "variation.by", words::variation_bys);
  }
  for (const char* table : {"contraction.*", "cortex.*"}) {
    expect_words(table, "pulse.phase", words::pulse_phases);
    expect_words(table, "delay.axis", words::delay_axes);
    expect_words(table, "delay.from", words::delay_starts);
  }
  expect_words("cortex.*", "trigger.measure", words::cell_measures);
  expect_words("cortex.*", "follow.measure", words::cell_measures);
  expect_words("cortex.*", "trigger.of", words::read_cells);
  for (const char* table : {"contraction.*", "cortex.*", "pressure.*", "growth.*", "foundation.*", "matrix.*"})
    expect_words(table, "follow.of", words::read_cells);
  expect_words("cortex.*", "direction.axis", words::fibre_axes);
  expect_words("enclosed.*", "volume", words::enclosed_states);
  expect_words("self_contact", "surface", words::contact_surfaces);
  expect_words("hold.*", "directions", words::axes);
  expect_words("pressure.*", "face", words::surfaces);
  expect_words("foundation.*", "faces", words::surfaces);
  expect_words("matrix.*", "faces", words::surfaces);
  expect_words("growth.*", "axis", words::delay_axes);
  expect_words("ablation.*", "faces", words::edges);
  expect_words("division.*", "when", words::division_triggers);
  expect_words("division.*", "plane", words::division_planes);
  expect_words("time", "scheme", words::schemes);
  expect_words("time", "integrator", words::integrators);
  expect_words("time", "linear_solver", words::linear_solvers);
  expect_words("stop", "combine", words::combinations);
  expect_words("stop.*", "over", words::criterion_overs);
  expect_words("monitor.*", "face", words::surfaces);
  expect_words("monitor.*", "axis", words::axes);
  expect_words("monitor.*", "over", words::overs);
  expect_words("monitor.*", "reference_at", words::reference_times);

  // The rest of the keys that take words: names of quantities and of measure sets have tables of their own, these three
  // are no enums, of enclosed surfaces there is one, and resistances are known to foundations only.
  int with_words = 0;
  for (const ScenarioTable& info : scenario_tables())
    for (const KeyRow& row : info.rows) with_words += row.allowed.words.empty() ? 0 : 1;
  EXPECT_EQ(tables + 7, with_words) << "embryo.shape, elasticity.model, volume.method, monitor.*.quantity, "
                                       "enclosed.*.surface, measure.sets, foundation.*.resists";
}

TEST(Suggest, TheNearestOfSeveralThatAreNear) {
  using Names = std::vector<std::string>;
  for (const auto& [given, known, nearest] : std::vector<std::tuple<const char*, Names, const char*>>{
           {"stifness", {"stiffness", "stillness"}, "stiffness"},  // in any order
           {"stifness", {"stillness", "stiffness"}, "stiffness"},
           {"gpa", {"gab", "gap"}, "gap"},  // a swap of two letters is one edit; a deletion and an insertion are two
           {"yolk_gpa", {"yolk_gal", "yolk_gap"}, "yolk_gap"},
           {"lengt_um", {"length_um", "height_um"}, "length_um"},
           {"lengt_um", {"height_um", "length_um"}, "length_um"},
           {"YOUNG_MODULUS_PA", {"poisson_ratio", "young_modulus_Pa"}, "young_modulus_Pa"},  // case does not count
           {"Xenopus", {"drosophila", "xenopus"}, "xenopus"},
           {"young", {"poisson_ratio", "young_modulus_Pa"}, "young_modulus_Pa"},  // the beginning is enough
           {"you", {"poisson_ratio", "young_modulus_Pa"}, ""},                    // but too short to say anything
           {"colour", {"length_um", "cells"}, ""},
           {"at", {"x", "is"}, ""},  // no letter is the same
           {"cells", {}, ""}})
    EXPECT_EQ(nearest_name(given, known).value_or(""), nearest) << given;
}

TEST(Suggest, AUnitIsWhatFollowsAName) {
  for (const char* name : {"young_modulus_Pa", "young_modulus_kPa", "young_modulus", "Young_Modulus_nN_per_um2"})
    EXPECT_EQ(without_unit(name), "young_modulus") << name;
  EXPECT_EQ(without_unit("um"), "um");
}

TEST(Suggest, WhereNothingIsNearAllThatIsKnownIsNamed) {
  EXPECT_EQ(did_you_mean("drosofila", {"xenopus", "drosophila"}), "use \"drosophila\" (nearest match)");
  EXPECT_EQ(did_you_mean("mouse", {"xenopus", "drosophila"}), "use one of: xenopus, drosophila");
  EXPECT_EQ(did_you_mean("mouse", {}), "none is defined");
}

TEST(Nesting, AKeyWithTooManyPartsIsFoundWhereverItStands) {
  std::string deep = "a";
  for (int part = 1; part <= most_key_parts; ++part) deep += part % 3 == 0 ? " . \"b.c\"" : ".'d'";
  for (const std::string& text : {deep + " = 1", "[" + deep + "]", "[[" + deep + "]]", "x = {y = 1, " + deep + " = 1}",
                                  "x = [{" + deep + " = 1}]", "# \"\nx = '''''\\'''''\n\"\\\"\" = 1\n" + deep + " = 1"})
    EXPECT_EQ(line_of_too_deep_key("\n" + text), text.starts_with('#') ? 5 : 2) << text;
}

TEST(Nesting, DotsInTextsNumbersAndCommentsAreNone) {
  const std::string dots(100, '.');
  for (const std::string& text :
       {"x = \"" + dots + "\"", "x = '" + dots + "'", "x = \"\"\"\n\"" + dots + "\"\"\"\"\"", "# " + dots,
        "x = \"\\\"" + dots + "\"",
        std::string("x = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]"),
        std::string("a.b.c.d = 1\ne.f.g.h = 2\n[a.b.c.d]\n[a.b.c.e]\n[i.b.c.e]\n")})
    EXPECT_EQ(line_of_too_deep_key(text), 0) << text;
}

}  // namespace
