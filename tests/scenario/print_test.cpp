#include "scenario/print.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <map>

#include "scenario/builtin.hpp"
#include "scenario/load.hpp"
#include "scenario/schema.hpp"

namespace plica {
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
      for (const Row& row : info.rows) {
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
  EXPECT_NE(text.find("\n[region.a]\nface = \"left\"\n\n"), std::string::npos) << text;
  EXPECT_NE(text.find("\nstep_s = \"adaptive\"\n"), std::string::npos) << text;
  EXPECT_NE(text.find("\nend_s = 3600\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("cells_csv"), std::string::npos) << text;
  EXPECT_EQ(text.find("width_um"), std::string::npos) << text;
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
    for (const Row& row : info.rows) {
      const InnerTables* inner = inner_of(row.key);
      const std::string& there = inner == nullptr ? section : section_of(page, std::string(inner->title));
      std::string key(row.key);
      if (key.starts_with("stiffness_program.")) key.erase(0, std::string_view("stiffness_").size());
      EXPECT_NE(there.find("\n| `" + key + "` | " + row.type() + " | "), std::string::npos) << info.path << " " << key;
      EXPECT_NE(there.find(row.meaning), std::string::npos) << info.path << " " << key;
      if (inner != nullptr) {
        EXPECT_NE(section.find("([" + std::string(inner->title) + "](#"), std::string::npos) << info.path << " " << key;
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
    for (const Row& row : info.rows) {
      if (inner_of(row.key) == nullptr) continue;
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
    EXPECT_NE(page.find("[" + std::string(label) + "](#" + anchor + ")"), std::string::npos) << label;
  std::size_t links = 0, headings = 0;
  for (std::size_t at = 0; (at = page.find("](#", at)) != std::string::npos && at < page.find("\n## "); ++at) ++links;
  for (std::size_t at = 0; (at = page.find("\n## ", at)) != std::string::npos; ++at) ++headings;
  EXPECT_EQ(links, headings);
}

TEST(Reference, SaysTypeDefaultAndRange) {
  const std::string page = reference_markdown();
  int count = 0;
  for (const std::string line : {
           "| `poisson_ratio` | number | `0.45` | > -1 and < 0.5 |",
           "| `shape` | word | `\"pill\"` | pill \\| sphere \\| slice \\| block \\| egg \\| points \\| sheet \\| "
           "surface \\| file |",
           "| `step_s` | number | `\"adaptive\"` | >= 1e-06 or \"adaptive\" |",
           "| `cells` | 3 integers | `[18, 9, 8]` | 1 to 100000; with shape pill, sphere, slice, block |",
           "| `end_min` | number | see `end_s` | > 0; not with `end_s` |",
           "| `region` | text | required | any |",
       }) {
    EXPECT_NE(page.find(line), std::string::npos) << line;
    ++count;
  }
  std::cout << count << " lines\n";
}

}  // namespace
}  // namespace plica
