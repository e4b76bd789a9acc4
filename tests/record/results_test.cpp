#include "record/results.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <iostream>

#include "core/errors.hpp"

namespace plica {
namespace {

namespace fs = std::filesystem;

class ResultsTest : public testing::Test {
 protected:
  ResultsTest() : folder(fs::path(testing::TempDir()) / ("plica_results_" + std::to_string(::getpid()))) {
    fs::create_directories(folder);
  }
  ~ResultsTest() override { fs::remove_all(folder); }

  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder / name, std::ios::binary) << text;
    return folder / name;
  }

  fs::path folder;
};

TEST_F(ResultsTest, SeriesAtTimesOfRowsAndBetweenThem) {
  const Series series = read_series(write("series.csv", "time_s,a,b.c_um\n0,1,\n2,5,-1e-3\n4,,7\n"));
  EXPECT_EQ(series.columns, (std::vector<std::string>{"time_s", "a", "b.c_um"}));
  EXPECT_EQ(series.column("b.c_um"), 2U);
  EXPECT_FALSE(series.column("none"));
  EXPECT_EQ(series.at(1, 0), 1);
  EXPECT_EQ(series.at(1, 2 + 1e-9), 5);
  EXPECT_EQ(series.at(1, 0.5), 2);
  EXPECT_FALSE(series.at(1, 3)) << "nothing beside an empty field";
  EXPECT_FALSE(series.at(2, 1));
  EXPECT_DOUBLE_EQ(series.at(2, 3).value(), (7 - 1e-3) / 2);
  EXPECT_FALSE(series.at(1, -1));
  EXPECT_FALSE(series.at(2, 4.1));
}

TEST_F(ResultsTest, WhatIsNoSeriesNamesItsLine) {
  int cases = 0;
  for (const auto& [text, part] : std::vector<std::pair<std::string, std::string>>{
           {"", ":1: "},
           {"depth,time_s\n1,2\n", ":1: "},
           {"time_s,a\n0,1\n1\n", ":3: has 1 fields for 2 columns"},
           {"time_s,a\n0,x\n", ":2: \"x\" is not a number"},
           {"time_s,a\n0,nan\n", ":2: \"nan\" is not a number"},
           {"time_s,a\n1,0\n1,0\n", ":3: time missing"},
           {"time_s,a\n,0\n", ":2: time missing"},
       }) {
    const fs::path file = write("series.csv", text);
    try {
      (void)read_series(file);
      ADD_FAILURE() << text;
    } catch (const FileError& error) {
      EXPECT_NE(std::string(error.what()).find(file.string() + part), std::string::npos) << error.what();
    }
    ++cases;
  }
  std::cout << cases << " cases\n";
}

TEST_F(ResultsTest, SummaryOrNone) {
  EXPECT_TRUE(read_summary(folder).is_null());
  write("summary.json", "{\"b\": 1, \"a\": null}");
  EXPECT_EQ(read_summary(folder).at("b"), 1);
  for (const char* text : {"{", "[1]", ""}) {
    write("summary.json", text);
    EXPECT_THROW((void)read_summary(folder), FileError) << text;
  }
}

}  // namespace
}  // namespace plica
