#include <fmt/format.h>

#include <cstring>
#include <regex>

#include "core/errors.hpp"
#include "core/files.hpp"
#include "record/mesh_writer.hpp"
#include "support/own_folder.hpp"
#include "tissue/hexahedral_mesh.hpp"
#include "tissue/shapes/embryo.hpp"

namespace {

namespace fs = std::filesystem;

class MeshFileTest : public OwnFolder {
 protected:
  /// What reading complains of: one line that begins with the file's name, here left out. Nothing appears on stderr.
  template <class Error>
  [[nodiscard]] std::string error(const std::string& apical_array = "",
                                  const std::array<int, 3>& elements = {1, 1, 1}) const {
    testing::internal::CaptureStderr();
    const std::string text = error_of<Error>([&] { return read_mesh_file(file, apical_array, {elements}); });
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    const std::string start = file.string() + ": ";
    EXPECT_TRUE(text.starts_with(start)) << "no error, or without the file's name: " << text;
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 0) << text;
    return text.substr(std::min(start.size(), text.size()));
  }

  fs::path file = folder / "mesh.vtu";
};

/// A legacy file: points, cells (of any type) and lines of cell data.
std::string legacy(const std::vector<std::string>& points, const std::vector<std::vector<int>>& cells, int type = 12,
                   const std::string& arrays = "") {
  std::string text = fmt::format(
      "# vtk DataFile Version 3.0\ntest\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {} double\n", points.size());
  for (const std::string& point : points) text += point + "\n";
  std::size_t numbers = 0;
  for (const auto& cell : cells) numbers += cell.size() + 1;
  text += fmt::format("CELLS {} {}\n", cells.size(), numbers);
  for (const auto& cell : cells) text += fmt::format("{} {}\n", cell.size(), fmt::join(cell, " "));
  text += fmt::format("CELL_TYPES {}\n", cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) text += fmt::format("{}\n", type);
  if (!arrays.empty()) text += fmt::format("CELL_DATA {}\n{}", cells.size(), arrays);
  return text;
}

const std::vector<std::string> cube_points = {"0 0 0", "1 0 0", "1 1 0", "0 1 0", "0 0 1", "1 0 1", "1 1 1", "0 1 1"};
const std::vector<int> cube = {0, 1, 2, 3, 4, 5, 6, 7};

/// The cube as a binary legacy file (numbers big end first), where a coordinate may be NaN; node 6 is at (1, 1, z).
std::string binary_cube(double z) {
  std::string text = "# vtk DataFile Version 3.0\ntest\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 double\n";
  const auto add = [&](auto number) {
    std::string bytes(sizeof number, '\0');
    std::memcpy(bytes.data(), &number, sizeof number);
    text.append(bytes.rbegin(), bytes.rend());
  };
  for (int i = 0; i < 8; ++i)
    for (int axis = 0; axis < 3; ++axis)
      add(i == 6 && axis == 2 ? z : (hex_reference_nodes[static_cast<std::size_t>(i)][axis] + 1) / 2);
  text += "\nCELLS 1 9\n";
  add(8);
  for (const int node : cube) add(node);
  text += "\nCELL_TYPES 1\n";
  add(12);
  return text + "\n";
}

std::string apical_lines(const std::string& values) {
  return "SCALARS apical int 1\nLOOKUP_TABLE default\n" + values + "\n";
}

void expect_same_facets(const std::vector<Facet>& a, const std::vector<Facet>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].nodes, b[i].nodes) << i;
    EXPECT_EQ(a[i].cell, b[i].cell) << i;
  }
}

double total_volume(const Tissue& tissue) {
  double sum = 0;
  for (const Cell& cell : tissue.cells) sum += cell_volume(tissue, cell, tissue.rest_positions);
  return sum;
}

TEST_F(MeshFileTest, APillComesBackAsItWas) {
  const Tissue pill = build_shell({});
  write_mesh(file, pill, pill.rest_positions, {});
  const Tissue read = read_mesh_file(file, "", {1, 1, 1});
  EXPECT_EQ(read.rest_positions, pill.rest_positions);
  EXPECT_EQ(read.elements, pill.elements);
  expect_same_facets(read.apical_facets, pill.apical_facets);
  expect_same_facets(read.basal_facets, pill.basal_facets);
  ASSERT_EQ(read.cells.size(), pill.cells.size());
  for (std::size_t c = 0; c < pill.cells.size(); ++c) {
    EXPECT_EQ(read.cells[c].corners, pill.cells[c].corners);
    for (int e = 0; e < 12; ++e) EXPECT_EQ(read.cells[c].edges[e].direction, pill.cells[c].edges[e].direction);
  }
  EXPECT_EQ(read.regions.at("all"), CellSet(pill.cells.size(), true));
  EXPECT_FALSE(read.outer_shape);
  std::cout << read.cells.size() << " cells\n";
}

TEST_F(MeshFileTest, RefinedCellsShareTheirNodesAndKeepTheirVolume) {
  const Tissue pill = build_shell({460, 280, 40, {6, 3, 4}, {1, 1, 1}});
  write_mesh(file, pill, pill.rest_positions, {});
  for (const auto& [n, m] : {std::pair{2, 2}, std::pair{3, 1}, std::pair{1, 3}, std::pair{2, 3}}) {
    const Tissue read = read_mesh_file(file, "", {n, n, m});
    // A closed surface of F squares has F + 2 vertices; n^2 F squares when refined.
    const std::size_t faces = pill.cells.size();
    EXPECT_EQ(read.node_count(), (faces * n * n + 2) * (m + 1));
    EXPECT_EQ(read.elements.size(), faces * n * n * m);
    EXPECT_EQ(read.apical_facets.size(), faces * n * n);
    EXPECT_EQ(read.basal_facets.size(), faces * n * n);
    EXPECT_NEAR(total_volume(read), total_volume(pill), 1e-12 * total_volume(pill));
    for (std::size_t c = 0; c < faces; ++c) {
      EXPECT_EQ(read.cells[c].corners, pill.cells[c].corners);
      EXPECT_EQ(read.cells[c].edges[0].nodes.size(), n + 1U);
      EXPECT_EQ(read.cells[c].edges[8].nodes.size(), m + 1U);
    }
  }
}

TEST_F(MeshFileTest, ACellIsTurnedForEachOfItsFaces) {
  for (int face = 0; face < 6; ++face) {
    write_file(file, legacy(cube_points, {cube}, 12, apical_lines(std::to_string(face))));
    const Tissue read = read_mesh_file(file, "apical", {2, 2, 1});
    ASSERT_EQ(read.cells.size(), 1U);
    std::array<int, 4> apical{};
    for (int i = 0; i < 4; ++i) apical[i] = read.cells[0].corners[4 + i].number();
    EXPECT_EQ(apical, hex_faces[face]);
    EXPECT_NEAR(hex_scaled_jacobian(hexahedron(read.cells[0].rest_shape)), 1, 1e-12);
    EXPECT_EQ(read.apical_facets.size(), 4U);
    EXPECT_EQ(read.basal_facets.size(), 4U);
    EXPECT_TRUE(read.cell_arrays.empty());
  }
  EXPECT_EQ(read_mesh_file(file, "apical", {1, 1, 1}).cells[0].corners[7], NodeId(7));
}

TEST_F(MeshFileTest, StackedCellsHaveFacetsOnTheSurfaceOnly) {
  const Tissue block = build_block({60, 20, 40, {3, 2, 2}, {1, 1, 1}});
  write_mesh(file, block, block.rest_positions, {{}, {}, {{"top", std::vector<int>(12, 5)}}});
  const Tissue read = read_mesh_file(file, "top", {1, 1, 1});
  expect_same_facets(read.apical_facets, block.apical_facets);
  expect_same_facets(read.basal_facets, block.basal_facets);
  EXPECT_EQ(read.apical_facets.size(), 6U);
}

TEST_F(MeshFileTest, ArraysOfOneComponentAreSetsOfCellsAndUnusedNodesGo) {
  std::vector<std::string> points = {"9 9 9", "1e200 0 0"};
  points.insert(points.end(), cube_points.begin(), cube_points.end());
  std::vector<int> cell;
  for (const int node : cube) cell.push_back(node + 2);
  const std::string arrays = apical_lines("5") +
                             "SCALARS furrow float 1\nLOOKUP_TABLE default\n0.5\nSCALARS rest int 1\nLOOKUP_TABLE "
                             "default\n0\nVECTORS push double\n1 2 3\n";
  write_file(file, legacy(points, {cell}, 12, arrays));
  const Tissue read = read_mesh_file(file, "apical", {1, 1, 1});
  EXPECT_EQ(read.node_count(), 8U);
  EXPECT_EQ(read.rest_positions[0], Vec3::Zero());
  EXPECT_EQ(read.cell_arrays, (std::map<std::string, CellArray>{{"furrow", {0.5}}, {"rest", {0}}}));
}

TEST_F(MeshFileTest, WhatIsNoMeshIsAFileErrorInOneLine) {
  const Tissue block = build_block({});
  write_mesh(file, block, block.rest_positions, {{}, {}, {{"top", {5, 5, 5}}}});
  const std::string whole = read_file(file);
  const auto refused = [&](const std::string& content) {
    write_file(file, content);
    const std::string text = error<FileError>("top");
    EXPECT_TRUE(text.starts_with("cannot be read: ")) << text;
    EXPECT_SAYS_NOT(text, "0x");
    return text;
  };
  EXPECT_EQ(refused(""), "cannot be read: it is empty");
  EXPECT_EQ(refused("length_um = 460\n"),
            "cannot be read: neither a VTK XML file (.vtu) nor a legacy VTK file (.vtk); from Python, "
            "plica.Tissue.from_file reads Abaqus, Gmsh and others");
  for (const char* text :
       {"<html><body/></html>", "<VTKFile type=\"PolyData\"></VTKFile>", "<?xml version=\"1.0\"?>\n<VTKFile",
        "# vtk DataFile Version 3.0\n", "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\n"})
    refused(text);
  for (std::size_t part = 1; part < 20; ++part) refused(whole.substr(0, whole.size() * part / 20));
  fs::remove(file);
  EXPECT_EQ(error<FileError>(), "cannot be read: No such file or directory");
  fs::create_directory(file);
  EXPECT_EQ(error<FileError>(), "cannot be read: Is a directory");
}

TEST_F(MeshFileTest, ATruncatedLegacyFileIsAnError) {
  const std::string whole = legacy(cube_points, {cube}, 12, apical_lines("5"));
  // VTK takes some of these for a mesh without cells or arrays, and that is refused too.
  for (std::size_t length = 1; length < whole.find("LOOKUP_TABLE"); length += 3) {
    write_file(file, whole.substr(0, length));
    EXPECT_THROW((void)read_mesh_file(file, "apical", {1, 1, 1}), std::runtime_error) << whole.substr(0, length);
  }
}

TEST_F(MeshFileTest, DamagedBytesAreAnErrorOrAMesh) {
  const Tissue block = build_block({});
  write_mesh(file, block, block.rest_positions, {{}, {}, {{"top", {5, 5, 5}}}});
  const std::string whole = read_file(file);
  int refused = 0, read = 0;
  testing::internal::CaptureStderr();
  for (std::size_t at = 0; at < whole.size(); at += 7) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x15);
    write_file(file, damaged);
    try {
      (void)read_mesh_file(file, "top", {1, 1, 1});
      ++read;
    } catch (const FileError&) {
      ++refused;
    }
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_GT(refused, 0);
  std::cout << refused << " files refused, " << read << " read\n";
}

TEST_F(MeshFileTest, WhatIsWrongWithACellIsSaid) {
  const auto with = [](int node, const std::string& point) {
    auto points = cube_points;
    points[static_cast<std::size_t>(node)] = point;
    return points;
  };
  struct Case {
    std::string content;
    std::string message;
  };
  const std::vector<Case> cases = {
      {legacy(cube_points, {}), "the mesh has no cells"},
      {legacy(cube_points, {{0, 1, 3, 4}}, 10),
       "cell 0 is a vtkTetra (VTK type 10); every volume must be a vtkHexahedron (type 12): mesh one layer of "
       "hexahedra, in Gmsh for example, or set embryo.shape to \"surface\" and give apical polygons"},
      {legacy(cube_points, {{0, 1, 2, 3}}, 9),
       "none of its 1 cells is a hexahedron, cell 0 is a vtkQuad; for polygons, set embryo.shape to \"surface\""},
      {legacy(cube_points, {{0, 1, 2, 3, 4, 5, 6, 8}}), "cell 0 uses node 8; nodes are 0 to 7"},
      {legacy(cube_points, {{0, 1, 2, 3, 4, 5, 6, -1}}), "cell 0 uses node -1; nodes are 0 to 7"},
      {legacy(cube_points, {{0, 1, 2, 3, 4, 5, 6, 6}}),
       "cell 0 at (0.625, 0.5, 0.5) um uses node 6 twice; a hexahedron has eight"},
      {legacy(cube_points, {{0, 1, 2, 3, 4, 5, 6}}), "cell 0 is a hexahedron with 7 nodes; 8 are required"},
      {binary_cube(std::nan("")), "node 6 of cell 0 is at (1, 1, nan); coordinates must be finite, in um"},
      {legacy(with(6, "1 1 1e200"), {cube}),
       "node 6 of cell 0 is at (1, 1, 1e+200); coordinates must be finite, in um"},
      {legacy(cube_points, {{0, 1, 3, 2, 4, 5, 7, 6}}),
       "cell 0 at (0.5, 0.5, 0.5) um is inverted (det J <= 0 at a corner): its nodes are in the order of a VTK_VOXEL; "
       "order them around each face (VTK_HEXAHEDRON)"},
      {legacy(cube_points, {{4, 5, 6, 7, 0, 1, 2, 3}}),
       "cell 0 at (0.5, 0.5, 0.5) um is inverted (det J <= 0 at a corner): it is turned over; order nodes 0-3 "
       "counter-clockwise seen from nodes 4-7"},
      {legacy(with(6, "0 0 0.5"), {cube}),
       "cell 0 at (0.375, 0.375, 0.4375) um is inverted (det J <= 0 at a corner): a corner is flat or folded in, or "
       "the order of the nodes is not VTK's"},
      {legacy(cube_points, {cube, cube, cube}),
       "cells 0 and 1 share four nodes at (0.5, 0.5, 0) um but do not lie on the two sides of one face: one is "
       "twisted, or they overlap; turn or remove one"},
      {legacy(cube_points, {cube}),
       "the mesh has a single surface (a block or an open sheet), which leaves its apical faces undetermined; name the "
       "cell array that holds each cell's apical face (0-5) as apical_array"},
  };
  for (const Case& c : cases) {
    write_file(file, c.content);
    EXPECT_EQ(error<MeshError>(), c.message);
  }
  std::cout << cases.size() << " meshes\n";
}

TEST_F(MeshFileTest, TheApicalArrayMustBeThereAndFit) {
  write_file(file, legacy(cube_points, {cube}, 12, apical_lines("6")));
  EXPECT_EQ(error<MeshError>("apical"), "the apical face of cell 0 is 6 in \"apical\"; faces are 0 to 5");
  EXPECT_EQ(error<MeshError>("up"), "no cell array \"up\" with one number per cell; there are: apical");
  write_file(file, legacy(cube_points, {cube}));
  EXPECT_EQ(error<MeshError>("up"), "no cell array \"up\" with one number per cell; there are none");

  const Tissue block = build_block({});
  write_mesh(file, block, block.rest_positions, {{}, {}, {{"top", {5, 4, 5}}}});
  EXPECT_EQ(error<MeshError>("top"),
            "the apical faces of cell 0 at (-20, 0, 0) um and its neighbour, cell 1, do not meet in an edge; correct "
            "the array that names them");
  write_mesh(file, block, block.rest_positions, {{}, {}, {{"top", {5, 5, 0}}}});
  EXPECT_EQ(error<MeshError>("top"),
            "the apical faces of cell 1 at (0, 0, 0) um and its neighbour, cell 2, do not meet in an edge; correct the "
            "array that names them");
}

TEST_F(MeshFileTest, RefinementMustBePossible) {
  write_file(file, legacy(cube_points, {cube}, 12, apical_lines("5")));
  EXPECT_SAYS(error<MeshError>("apical", {1, 2, 1}), "make the first two equal");
  EXPECT_SAYS(error<MeshError>("apical", {0, 0, 1}), "at least 1");
  EXPECT_EQ(error<MeshError>("apical", {300, 300, 300}),
            "the mesh would have 27000000 elements; at most 20000000 are allowed");
  EXPECT_NE(error<MeshError>("apical", {2'000'000'000, 2'000'000'000, 2'000'000'000}).find("at most"),
            std::string::npos);
}

TEST_F(MeshFileTest, CoincidentNodesAreMerged) {
  auto points = cube_points;
  for (const char* point : {"1 0 0", "2 0 0", "2 1 0", "1 1 0", "1 0 1", "2 0 1", "2 1 1", "1 1 1"})
    points.emplace_back(point);
  write_file(file, legacy(points, {cube, {8, 9, 10, 11, 12, 13, 14, 15}}, 12, apical_lines("5\n5")));
  const Tissue tissue = read_mesh_file(file, "apical", {});
  EXPECT_EQ(tissue.node_count(), 12);
  EXPECT_EQ(tissue.remarks, std::vector<std::string>{"4 coincident nodes were merged"});
}

TEST_F(MeshFileTest, WhatIsNoClosedLayerNeedsTheArray) {
  const Tissue shell = build_shell({460, 280, 40, {4, 3, 3}, {1, 1, 2}});
  write_mesh(file, shell, shell.rest_positions, {});
  EXPECT_TRUE(std::regex_match(
      error<MeshError>(),
      std::regex(
          R"(cell 0 at \(.*, .*, .*\) um has no face on the outer surface; the layer must be one cell thick, or .*)")))
      << error<MeshError>();

  auto points = cube_points;
  for (const char* point : {"5 0 0", "6 0 0", "6 1 0", "5 1 0", "5 0 1", "6 0 1", "6 1 1", "5 1 1"})
    points.emplace_back(point);
  write_file(file, legacy(points, {cube, {8, 9, 10, 11, 12, 13, 14, 15}}));
  EXPECT_EQ(error<MeshError>(),
            "the mesh is not one closed layer but 2 pieces of 1 and 1 cells: set embryo.keep = \"largest\"");
}

TEST_F(MeshFileTest, TheLargestPieceIsKept) {
  HexahedralMesh mesh;
  const Tissue block = build_block({60, 20, 40, {3, 1, 1}, {1, 1, 1}});
  mesh.points = block.rest_positions;
  mesh.cells = block.elements;
  const std::size_t far = mesh.points.size();
  for (int i = 0; i < 8; ++i)
    mesh.points.push_back(block.rest_positions[block.elements[0][i].index()] + Vec3(0, 99, 0));
  mesh.cells.insert(mesh.cells.begin(), std::array<NodeId, 8>{});
  for (std::size_t i = 0; i < 8; ++i) mesh.cells[0][i] = NodeId(far + i);
  mesh.apical_faces = {5, 5, 5, 5};
  mesh.arrays["gene"] = {9, 1, 2, 3};
  EXPECT_EQ(tissue_from_mesh(mesh, {}).remarks,
            (std::vector<std::string>{"the mesh has 2 pieces of 3 and 1 cells that share no face; embryo.keep = "
                                      "\"largest\" omits all but the largest"}));
  const Tissue kept = tissue_from_mesh(mesh, {.keep_largest = true});
  EXPECT_EQ(kept.cell_arrays.at("gene"), (CellArray{1, 2, 3}));
  EXPECT_EQ(kept.rest_positions, block.rest_positions);
  EXPECT_EQ(kept.remarks, (std::vector<std::string>{"the largest of 2 pieces of 3 and 1 cells was kept"}));
}

// A cube with a quadrilateral before it, in a file of types one by one.
TEST_F(MeshFileTest, FacesBesideHexahedraAreOmittedAndArraysKeepTheirCells) {
  std::string text =
      legacy(cube_points, {{0, 1, 2, 3}, cube}, 12,
             "SCALARS apical int 1\nLOOKUP_TABLE default\n9\n5\nSCALARS gene float 1\nLOOKUP_TABLE default\n7\n2\n");
  text.replace(text.find("CELL_TYPES 2\n12"), 15, "CELL_TYPES 2\n9");
  for (const std::string& content : {text, "\xef\xbb\xbf" + text}) {
    write_file(file, content);
    const Tissue read = read_mesh_file(file, "apical", {1, 1, 1});
    ASSERT_EQ(read.cells.size(), 1U);
    EXPECT_EQ(read.cell_arrays.at("gene"), CellArray{2});
    EXPECT_EQ(read.remarks,
              (std::vector<std::string>{"1 faces, lines and vertices beside the hexahedra were omitted"}));
  }
  write_file(file, binary_cube(1).insert(0, "\xef\xbb\xbf"));
  EXPECT_SAYS(error<MeshError>(), "the mesh has a single surface");
}

TEST_F(MeshFileTest, OfQuadraticHexahedraTheCornersAreKept) {
  for (const auto& [type, nodes] : {std::pair(25, 20), {29, 27}, {33, 24}}) {
    auto points = cube_points;
    std::vector<int> cell = cube;
    for (int node = 8; node < nodes; ++node) {
      points.emplace_back("0.5 0.5 0.5");
      cell.push_back(node);
    }
    write_file(file, legacy(points, {cell}, type, apical_lines("5")));
    const Tissue read = read_mesh_file(file, "apical", {1, 1, 1});
    EXPECT_EQ(read.node_count(), 8U);
    EXPECT_NEAR(total_volume(read), 1, 1e-12);
    EXPECT_EQ(read.remarks,
              (std::vector<std::string>{"1 hexahedra have nodes between corners: only their corners are used"}));
  }
}

}  // namespace
