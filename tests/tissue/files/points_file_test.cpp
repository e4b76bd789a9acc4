#include "tissue/files/points_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "core/errors.hpp"
#include "core/files.hpp"
#include "tissue/hexahedral_mesh.hpp"

namespace plica {
namespace {

TEST(PointsFile, HasItsColumnsByName) {
  const PointTable table =
      points_in_csv("\xef\xbb\xbf# measured\ncell,\"z_um\",x_um, y_um ,sna\r\n7,3,1,2,0.5\r\n\n8,-3,-1,-2e0,0");
  ASSERT_EQ(table.points.size(), 2U);
  EXPECT_EQ(table.points[0], Vec3(1, 2, 3));
  EXPECT_EQ(table.points[1], Vec3(-1, -2, -3));
  EXPECT_EQ(table.arrays, (std::map<std::string, std::vector<double>>{{"cell", {7, 8}}, {"sna", {0.5, 0}}}));
}

TEST(PointsFile, MissingValuesAndTextAreNoNumbers) {
  const PointTable table = points_in_csv(
      "x_um,y_um,z_um,gene,kind,is_in\n1,2,3,,apical,True\n1,2,3,0.5,basal,false\n1,2,3,NaN,,true\n1,2,3,N/A,-,0\n"
      "1,2,3,-inf,null,1\n");
  EXPECT_EQ(table.arrays.size(), 2U);
  EXPECT_EQ(table.arrays.at("is_in"), (std::vector<double>{1, 0, 1, 0, 1}));
  const std::vector<double>& gene = table.arrays.at("gene");
  for (std::size_t i = 0; i < gene.size(); ++i) EXPECT_EQ(std::isnan(gene[i]), i != 1) << i;
  EXPECT_EQ(table.remarks, (std::vector<std::string>{"column kind contains text and is not an array"}));
}

TEST(PointsFile, SaysInWhichLineWhatIsWrong) {
  const auto expect = [](const char* text, const char* said) {
    try {
      points_in_csv(text);
      FAIL() << text;
    } catch (const MeshError& error) {
      EXPECT_NE(std::string(error.what()).find(said), std::string::npos) << error.what();
    }
  };
  expect("", "is empty; the first line must name the columns, including x_um, y_um and z_um");
  expect("x,y,z\n1,2,3\n", "line 1: must name the columns, including x_um, y_um and z_um once each; it names x, y, z");
  expect("x_um,y_um,z_um,z_um\n", "line 1: must name");
  expect("x_um,y_um,z_um\n1,2,3\n1,2\n", "line 3: has 2 fields; the first line has 3");
  expect("x_um,y_um,z_um\n1,2,three\n", "line 2: \"three\" of column z_um is not a number");
  expect("x_um,y_um,z_um,a\n1,2,3,4\n1,2,3,4.5.6\n", "line 3: \"4.5.6\" of column a is not a number");
  expect("\xff\xfex_um", "is UTF-16 text; save it as UTF-8");
  expect("x_um,y_um,z_um\n1,nan,3\n", "line 2: \"nan\" of column y_um is not a number");
  EXPECT_THROW(read_points_file("/nowhere/points.csv"), FileError);
}

TEST(CellTable, HasAnArrayPerColumn) {
  const std::string file = testing::TempDir() + "plica_cell_table_" + std::to_string(::getpid()) + ".csv";
  write_file(file, "myosin, calcium\n1,2\n0.5,-1e-3\n");
  EXPECT_EQ(read_cell_table(file),
            (std::map<std::string, std::vector<double>>{{"calcium", {2, -1e-3}}, {"myosin", {1, 0.5}}}));
  write_file(file, "myosin,myosin\n1,2\n");
  EXPECT_THROW((void)read_cell_table(file), MeshError);
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace plica
