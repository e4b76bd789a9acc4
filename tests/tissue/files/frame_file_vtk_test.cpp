// Snapshots and polygons in VTK's formats.
#include "core/errors.hpp"
#include "core/files.hpp"
#include "record/mesh_writer.hpp"
#include "support/mesh_error.hpp"
#include "support/own_folder.hpp"
#include "support/tissues.hpp"
#include "tissue/files/frame_file.hpp"
#include "tissue/files/polygon_file.hpp"

namespace {

namespace fs = std::filesystem;

class FrameFileTest : public OwnFolder {
 protected:
  /// What reading complains of, without anything on stderr.
  template <class Error, class Read>
  static std::string error(const Read& read, const fs::path& file) {
    testing::internal::CaptureStderr();
    const std::string text = error_of<Error>([&] { (void)read(file); });
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_TRUE(text.starts_with(file.string() + ": ")) << text;
    return text;
  }
};

TEST_F(FrameFileTest, ReadsWhatWasWritten) {
  const Tissue block = distorted_block({60, 20, 40, {3, 1, 1}, {2, 2, 1}}, 1, 7);
  const Vectors velocities = Random(1).vectors(block.node_count());
  write_mesh(folder / "a.vtu", block, block.rest_positions,
             {{{"velocity_um_per_s", velocities}}, {{"volume_um3", {1, -2.5, 3}}}, {{"cell_id", {0, 1, 2}}}}, 12.5);
  const Frame frame = read_frame(folder / "a.vtu");
  EXPECT_EQ(frame.positions, block.rest_positions);
  EXPECT_EQ(frame.elements, block.elements);
  EXPECT_EQ(frame.time_s, 12.5);
  EXPECT_EQ(frame.node_vectors.at("velocity_um_per_s"), velocities);
  EXPECT_EQ(frame.element_scalars.at("volume_um3"),
            (std::vector<double>{1, 1, 1, 1, -2.5, -2.5, -2.5, -2.5, 3, 3, 3, 3}));
  EXPECT_EQ(frame.element_scalars.at("cell_id")[4], 1);
  write_mesh(folder / "b.vtu", block, block.rest_positions, {});
  EXPECT_FALSE(read_frame(folder / "b.vtu").time_s);
}

TEST_F(FrameFileTest, ReadsCollections) {
  write_collection(folder / "frames.pvd", {{0, "frames/0.vtu"}, {0.1, "a&\"b\".vtu"}});
  const std::vector<std::pair<double, std::string>> expected = {{0, "frames/0.vtu"}, {0.1, "a&\"b\".vtu"}};
  EXPECT_EQ(read_collection(folder / "frames.pvd"), expected);
  write_collection(folder / "none.pvd", {});
  EXPECT_TRUE(read_collection(folder / "none.pvd").empty());
}

TEST_F(FrameFileTest, ReadsSurfacesInSeveralFormats) {
  const std::string off_plane = "0 0 0\n4 0 0\n4 4 0\n0 4 0\n";
  const std::vector<fs::path> files = {
      write("a.vtk", "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 4 double\n" + off_plane +
                         "POLYGONS 1 5\n4 0 1 2 3\n"),
      write(
          "a.stl",
          "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 4 0 0\nvertex 4 4 0\nendloop\nendfacet\nfacet "
          "normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 4 4 0\nvertex 0 4 0\nendloop\nendfacet\nendsolid s\n"),
      write("a.obj", "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nf 1 2 3 4\n"),
      write("a.ply",
            "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement "
            "face 1\nproperty list uchar int vertex_indices\nend_header\n" +
                off_plane + "4 0 1 2 3\n"),
  };
  for (const fs::path& file : files) {
    const TriangleSurface surface = read_surface(file);
    double area = 0;
    for (const auto& [a, b, c] : surface.triangles)
      area += (surface.points[b] - surface.points[a]).cross(surface.points[c] - surface.points[a]).norm() / 2;
    EXPECT_EQ(surface.triangles.size(), 2U) << file;
    EXPECT_NEAR(area, 16, 1e-5) << file;
  }
  // Of a volume mesh, its boundary: 14 faces of three cells in a row.
  const Tissue block = build_block({60, 20, 40, {3, 1, 1}, {1, 1, 1}});
  write_mesh(folder / "block.vtu", block, block.rest_positions, {});
  EXPECT_EQ(read_surface(folder / "block.vtu").triangles.size(), 28U);
}

TEST_F(FrameFileTest, WhatCannotBeReadSaysWhy) {
  const fs::path missing = folder / "missing.vtu", text = write("text.vtu", "hello"), empty = write("empty.pvd", "");
  const fs::path cut = write("cut.pvd", "<?xml version=\"1.0\"?>\n<VTKFile><Collection>\n");
  const fs::path untimed = write("untimed.pvd", "<VTKFile><Collection><DataSet file=\"a\"/></Collection></VTKFile>");
  const fs::path points =
      write("points.vtk", "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 1 float\n0 0 0\n");
  const Tissue block = build_block({60, 20, 40, {3, 1, 1}, {1, 1, 1}});
  write_mesh(folder / "whole.vtu", block, block.rest_positions, {});
  const std::string whole = read_file(folder / "whole.vtu");
  const fs::path torn = write("torn.vtu", whole.substr(0, whole.size() / 2));
  for (const fs::path& file : {missing, text, torn, folder}) {
    error<FileError>(read_frame, file);
    error<FileError>(read_surface, file);
  }
  for (const fs::path& file : {folder / "missing.pvd", empty, cut, untimed}) {
    error<FileError>(read_collection, file);
  }
  EXPECT_SAYS(error<FileError>(read_surface, points), "no face");
  const fs::path triangle = write("triangle.vtk",
                                  "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 3 float\n0 "
                                  "0 0 1 0 0 0 1 0\nCELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n5\n");
  EXPECT_SAYS(error<MeshError>(read_frame, triangle), "vtkTriangle");
}

class PolygonFileVtk : public OwnFolder {
 protected:
  PolygonFile read(const std::string& name, const std::string& text) { return read_polygon_file(write(name, text)); }
};

const std::string legacy_header = "# vtk DataFile Version 3.0\nby hand\nASCII\n";
const std::string points = "POINTS 5 double\n0 0 0  1 0 0  1 1 0  0 1 0  .5 .5 2\n";

void expect_faces_and_heights(const PolygonFile& file) {
  EXPECT_EQ(file.surface.vertices.at(4), Vec3(0.5, 0.5, 2));
  EXPECT_EQ(file.surface.polygons, (std::vector<std::vector<std::size_t>>{{0, 1, 4}, {3, 2, 1, 0}}));
  EXPECT_EQ(file.arrays.at("height"), (CellArray{7.5, 8}));
}

// A line before the faces has its own values, which are passed over.
TEST_F(PolygonFileVtk, LegacyPolydata) {
  expect_faces_and_heights(read("a.vtk", legacy_header + "DATASET POLYDATA\n" + points +
                                             "LINES 1 3\n2 0 1\nPOLYGONS 2 9\n3 0 1 4\n4 3 2 1 0\n" +
                                             "CELL_DATA 3\nSCALARS height double\nLOOKUP_TABLE default\n-1 7.5 8\n"));
}

TEST_F(PolygonFileVtk, LegacyGrid) {
  expect_faces_and_heights(
      read("a.vtk", legacy_header + "DATASET UNSTRUCTURED_GRID\n" + points +
                        "CELLS 2 9\n3 0 1 4\n4 3 2 1 0\nCELL_TYPES 2\n5 7\nCELL_DATA 2\nSCALARS height "
                        "double\nLOOKUP_TABLE default\n7.5 8\n"));
}

TEST_F(PolygonFileVtk, Vtp) {
  expect_faces_and_heights(
      read("a.vtp",
           "<?xml version=\"1.0\"?><VTKFile type=\"PolyData\" version=\"0.1\"><PolyData><Piece NumberOfPoints=\"5\" "
           "NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"2\"><Points><DataArray "
           "type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 1 1 0 0 1 0 .5 .5 "
           "2</DataArray></Points><CellData><DataArray type=\"Float64\" Name=\"height\" format=\"ascii\">7.5 "
           "8</DataArray></CellData><Polys><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 1 4 3 2 "
           "1 0</DataArray><DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">3 "
           "7</DataArray></Polys></Piece></PolyData></VTKFile>"));
}

TEST_F(PolygonFileVtk, SaysWhatIsWrong) {
  expect_mesh_error(
      [&] {
        read("a.vtk",
             legacy_header + "DATASET UNSTRUCTURED_GRID\n" + points + "CELLS 1 5\n4 0 1 2 4\nCELL_TYPES 1\n10\n");
      },
      "a.vtk: cell 0 is a vtkTetra (VTK type 10); a surface consists of polygons");
  EXPECT_THROW(read("a.vtp", "<VTKFile"), FileError);
  EXPECT_THROW(read("a.vtk", "nothing of VTK's"), FileError);
  EXPECT_THROW(read_polygon_file(folder / "nowhere.vtp"), FileError);
}

}  // namespace
