// Polygons in VTK's files.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "core/errors.hpp"
#include "core/files.hpp"
#include "support/mesh_error.hpp"
#include "tissue/files/polygon_file.hpp"

#ifdef PLICA_WITH_VTK

namespace plica {
namespace {

class PolygonFileVtk : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  PolygonFile read(const std::string& name, const std::string& text) {
    write_file(folder_ / name, text);
    return read_polygon_file(folder_ / name);
  }

  std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) / ("plica_polygons_vtk_" + std::to_string(::getpid()));
};

const std::string legacy = "# vtk DataFile Version 3.0\nby hand\nASCII\n";
const std::string points = "POINTS 5 double\n0 0 0  1 0 0  1 1 0  0 1 0  .5 .5 2\n";

void expect_two_faces(const PolygonFile& file) {
  EXPECT_EQ(file.surface.vertices.at(4), Vec3(0.5, 0.5, 2));
  EXPECT_EQ(file.surface.polygons, (std::vector<std::vector<std::size_t>>{{0, 1, 4}, {3, 2, 1, 0}}));
  EXPECT_EQ(file.arrays.at("height"), (CellArray{7.5, 8}));
}

// A line before the faces has its own values, which are passed over.
TEST_F(PolygonFileVtk, LegacyPolydata) {
  expect_two_faces(read("a.vtk", legacy + "DATASET POLYDATA\n" + points +
                                     "LINES 1 3\n2 0 1\nPOLYGONS 2 9\n3 0 1 4\n4 3 2 1 0\n" +
                                     "CELL_DATA 3\nSCALARS height double\nLOOKUP_TABLE default\n-1 7.5 8\n"));
}

TEST_F(PolygonFileVtk, LegacyGrid) {
  expect_two_faces(read("a.vtk", legacy + "DATASET UNSTRUCTURED_GRID\n" + points +
                                     "CELLS 2 9\n3 0 1 4\n4 3 2 1 0\nCELL_TYPES 2\n5 7\n"
                                     "CELL_DATA 2\nSCALARS height double\nLOOKUP_TABLE default\n7.5 8\n"));
}

TEST_F(PolygonFileVtk, Vtp) {
  expect_two_faces(read(
      "a.vtp",
      "<?xml version=\"1.0\"?><VTKFile type=\"PolyData\" version=\"0.1\"><PolyData><Piece NumberOfPoints=\"5\" "
      "NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"2\"><Points><DataArray "
      "type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 1 1 0 0 1 0 .5 .5 2</DataArray></Points>"
      "<CellData><DataArray type=\"Float64\" Name=\"height\" format=\"ascii\">7.5 8</DataArray></CellData><Polys>"
      "<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 1 4 3 2 1 0</DataArray><DataArray "
      "type=\"Int64\" Name=\"offsets\" format=\"ascii\">3 7</DataArray></Polys></Piece></PolyData></VTKFile>"));
}

TEST_F(PolygonFileVtk, SaysWhatIsWrong) {
  expect_mesh_error(
      [&] {
        read("a.vtk", legacy + "DATASET UNSTRUCTURED_GRID\n" + points + "CELLS 1 5\n4 0 1 2 4\nCELL_TYPES 1\n10\n");
      },
      "a.vtk: cell 0 is a vtkTetra (VTK type 10); a surface consists of polygons");
  EXPECT_THROW(read("a.vtp", "<VTKFile"), FileError);
  EXPECT_THROW(read("a.vtk", "nothing of VTK's"), FileError);
  EXPECT_THROW(read_polygon_file(folder_ / "nowhere.vtp"), FileError);
}

}  // namespace
}  // namespace plica

#endif
