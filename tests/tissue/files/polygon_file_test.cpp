// Files of polygons, of points and of labelled faces.
#include "tissue/files/polygon_file.hpp"

#include <bit>

#include "core/errors.hpp"
#include "core/files.hpp"
#include "support/mesh_error.hpp"
#include "support/own_folder.hpp"
#include "tissue/files/points_file.hpp"
#include "tissue/hexahedral_mesh.hpp"

namespace {

const std::string mark = "\xef\xbb\xbf";  // byte-order mark

// A square pyramid without its base, with a triangle and a square.
void expect_two_faces(const PolygonFile& file) {
  ASSERT_EQ(file.surface.vertices.size(), 5U);
  EXPECT_EQ(file.surface.vertices[4], Vec3(0.5, 0.5, 2));
  ASSERT_EQ(file.surface.polygons.size(), 2U);
  EXPECT_EQ(file.surface.polygons[0], (std::vector<std::size_t>{0, 1, 4}));
  EXPECT_EQ(file.surface.polygons[1], (std::vector<std::size_t>{3, 2, 1, 0}));
}

TEST(PolygonFile, Obj) {
  expect_two_faces(
      polygons_in_obj("# pyramid\r\no one\nv 0 0 0\nv 1 0 0 0.5 0.5 0.5\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nv 0.5 0.5 +2e0\n"
                      "f 1/1/1 2//1 5\ns off\nf -2 -3 -4 -5 # back\n"));
}

TEST(PolygonFile, Off) {
  expect_two_faces(
      polygons_in_off("OFF\n# pyramid\n5 2 0\n0 0 0\n1 0 0\n\n1 1 0\n0 1 0\n.5 .5 2\n3 0 1 4 255 0 0\n4 3 2 1 0"));
  expect_two_faces(polygons_in_off("OFF 5 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n.5 .5 2\n3 0 1 4\n4 3 2 1 0\n"));
}

const std::string ply_header =
    "element vertex 5\nproperty float x\nproperty float y\nproperty uchar red\nproperty float z\nelement edge "
    "1\nproperty list uchar int two\nelement face 2\nproperty double height\nproperty list uchar int "
    "vertex_indices\nend_header\n";

TEST(PolygonFile, PlyAsText) {
  const PolygonFile file =
      polygons_in_ply("ply\r\nformat ascii 1.0\ncomment by hand\n" + ply_header +
                      "0 0 9 0\n1 0 9 0\n1 1 9 0\n0 1 9 0\n.5 .5 9 2\n2 0 1\n7.5 3 0 1 4\n8 4 3 2 1 0\n");
  expect_two_faces(file);
  EXPECT_EQ(file.arrays, (std::map<std::string, CellArray>{{"height", {7.5, 8}}}));
}

// Appends the bytes of a number, the most significant first where asked for.
template <class Number>
void append(Number value, bool big, std::string& bytes) {
  auto raw = std::bit_cast<std::array<char, sizeof(Number)>>(value);
  if (big == (std::endian::native == std::endian::little)) std::reverse(raw.begin(), raw.end());
  bytes.append(raw.data(), raw.size());
}

std::string binary_ply(bool big) {
  std::string bytes = "ply\nformat binary_" + std::string(big ? "big" : "little") + "_endian 1.0\n" + ply_header;
  const auto add = [&](auto value) { append(value, big, bytes); };
  for (const Vec3& p : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0), Vec3(0.5, 0.5, 2)}) {
    add(static_cast<float>(p.x()));
    add(static_cast<float>(p.y()));
    add(std::uint8_t{9});
    add(static_cast<float>(p.z()));
  }
  for (const int end : {0, 1}) {
    if (end == 0) add(std::uint8_t{2});
    add(std::int32_t{end});
  }
  const std::array<std::vector<std::int32_t>, 2> faces = {{{0, 1, 4}, {3, 2, 1, 0}}};
  for (int f = 0; f < 2; ++f) {
    add(f == 0 ? 7.5 : 8.0);
    add(static_cast<std::uint8_t>(faces[f].size()));
    for (const std::int32_t vertex : faces[f]) add(vertex);
  }
  return bytes;
}

TEST(PolygonFile, PlyAsBytes) {
  for (const bool big : {false, true}) {
    const PolygonFile file = polygons_in_ply(binary_ply(big));
    expect_two_faces(file);
    EXPECT_EQ(file.arrays.at("height"), (CellArray{7.5, 8}));
  }
  const std::string whole = binary_ply(false);
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_THROW(polygons_in_ply(whole.substr(0, length)), MeshError) << length;
}

TEST(PolygonFile, ByteOrderMarksArePassedOver) {
  EXPECT_EQ(polygons_in_obj(mark + "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").surface.vertices.size(), 3U);
  EXPECT_EQ(polygons_in_off(mark + "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").surface.polygons.size(), 1U);
  expect_two_faces(polygons_in_ply(mark + binary_ply(false)));
  for (const char* utf16 : {"\xff\xfev", "\xfe\xffv"}) {
    expect_mesh_error([&] { polygons_in_obj(utf16); }, "is UTF-16 text; save it as UTF-8");
    expect_mesh_error([&] { polygons_in_ply(utf16); }, "is UTF-16 text; save it as UTF-8");
  }
}

TEST(PolygonFile, SaysWhatIsWrongAndWhere) {
  const auto obj = [](const char* text, const char* said) { expect_mesh_error([&] { polygons_in_obj(text); }, said); };
  obj("v 0 0\n", "line 1: a vertex must have three coordinates");
  obj("v 0 0 0\n\nv 0 one 0\n", "line 3: \"one\" is not a number");
  obj("v 0 0 0\nf 1 1.5 1\n", "line 2: \"1.5\" is not a whole number");
  obj("v 0 0 0\nf 0 1 1\n", "line 2: a face uses vertex 0; the first vertex is 1, the last -1");
  obj("v 0 0 0\nf -2 1 1\n", "line 2: a face uses vertex -2");
  obj("v 0 0 0\nf 1 1 7\n", "face 0 uses vertex 6; there are 1");
  const auto off = [](const char* text, const char* said) { expect_mesh_error([&] { polygons_in_off(text); }, said); };
  off("", "is empty");
  off("4OFF\n", "line 1: found \"4OFF\", expected OFF");
  off("OFF\n", "expected the numbers of vertices and faces");
  off("OFF\n2 1 0\n0 0 0\n", "the file ends after 1 of 2 vertices");
  off("OFF\n1 1 0\n0 0 0\n", "the file ends after 0 of 1 faces");
  off("OFF\n1 1 0\n0 0 0\n3 0 0\n", "line 4: a face has 2 corners; its line announces 3");
  off("OFF\n1 1 0\n0 0 0\n3 0 0 -1\n", "line 4: a face uses vertex -1");
  off("OFF\n1 1 0\n0 0 0\n3 0 0 4\n", "face 0 uses vertex 4; there are 1");
  const auto ply = [](const std::string& text, const char* said) {
    expect_mesh_error([&] { polygons_in_ply(text); }, said);
  };
  const std::string start = "ply\nformat ascii 1.0\n";
  ply("plx\n", "line 1: expected \"ply\"");
  ply("ply\nformat utf8 1.0\nend_header\n", "line 2: \"utf8\" is not a format; formats: ascii, binary_little_endian");
  ply("ply\nend_header\n", "the header has no format line");
  ply(start, "line 2: the file ends within the header");
  ply(start + "property float x\nend_header\n", "line 3: a property precedes the first element");
  ply(start + "element vertex many\nend_header\n", "line 3: \"many\" is not a number of elements");
  ply(start + "element vertex 1\nproperty half x\nend_header\n", "line 4: \"property half x\": unknown type");
  ply(start + "element face 1\nelement face 2\nend_header\n", "line 4: the header has two elements \"face\"");
  ply(start + "element face 1\nproperty int a\nproperty float a\nend_header\n",
      "line 5: element \"face\" has two properties \"a\"; rename one");
  ply(start + "element vertex 1\nproperty float x\nproperty float y\nend_header\n0 0\n",
      "vertices must have x, y and z");
  ply(start + "element face 1\nproperty int a\nend_header\n0\n",
      "faces must have one list vertex_indices or vertex_index");
  ply(start + "element vertex 999999999999\nproperty int x\nproperty int y\nproperty int z\nend_header\n0 0 0\n",
      "999999999999 elements \"vertex\" exceed the file");
  ply(start + "element face 1\nproperty list int int vertex_index\nend_header\n-3 1 2 3\n",
      "a list has the invalid length -3");
  ply(start + "element face 1\nproperty list int int vertex_index\nend_header\n3 1 2 3\n",
      "face 0 uses vertex 1; 0 precede it");
}

// Two triangles that share the edge from 10 to 30; the rows of faces are numbered 5 and 6, and 7 has no edges.
VertexModelTables two_triangles() {
  return {{{10, 20, 30, 40}, {{"x", {0, 1, 1, 0}}, {"y", {0, 0, 1, 1}}}},
          {{0, 1, 2, 3, 4, 5},
           {{"srce", {10, 20, 30, 30, 10, 40}}, {"trgt", {20, 30, 10, 40, 30, 10}}, {"face", {6, 6, 6, 5, 5, 5}}}},
          {{7, 5, 6}, {{"area", {0, 0.25, 0.75}}}}};
}

TEST(VertexModel, FacesAreRingsOfEdges) {
  const PolygonFile file = polygons_of(two_triangles());
  EXPECT_EQ(file.surface.polygons, (std::vector<std::vector<std::size_t>>{{0, 2, 3}, {0, 1, 2}}));
  EXPECT_EQ(file.surface.vertices[2], Vec3(1, 1, 0));
  EXPECT_EQ(file.arrays, (std::map<std::string, CellArray>{{"area", {0.25, 0.75}}}));
}

TEST(VertexModel, CellsThatHaveGoneAreLeftOut) {
  VertexModelTables tables = two_triangles();
  tables.faces.columns["is_alive"] = {1, 1, 0};
  tables.edges.columns["trgt"][1] = 40;  // what is left of the ring of face 6
  const PolygonFile file = polygons_of(tables);
  EXPECT_EQ(file.surface.polygons, (std::vector<std::vector<std::size_t>>{{0, 2, 3}}));
  EXPECT_EQ(file.arrays.at("area"), CellArray{0.25});
}

TEST(VertexModel, HalfEdgesThatRunBackwardsAreReversed) {
  VertexModelTables tables = two_triangles();
  EXPECT_TRUE(polygons_of(tables).remarks.empty());
  std::swap(tables.edges.columns["srce"][1], tables.edges.columns["trgt"][1]);
  std::swap(tables.edges.columns["srce"][5], tables.edges.columns["trgt"][5]);
  const PolygonFile file = polygons_of(tables);
  EXPECT_EQ(file.surface.polygons.size(), 2U);
  for (const auto& polygon : file.surface.polygons) EXPECT_GT(area_vector(file.surface.vertices, polygon).z(), 0);
  EXPECT_EQ(file.remarks, (std::vector<std::string>{"2 half-edges that ran backwards were reversed"}));
}

TEST(VertexModel, SaysWhatIsWrong) {
  const auto expect = [](const auto& spoil, const char* said) {
    VertexModelTables tables = two_triangles();
    spoil(tables);
    expect_mesh_error([&] { polygons_of(tables); }, said);
  };
  expect([](auto& t) { t.vertices.columns.erase("y"); }, "the table of vertices has no numeric column \"y\"; it has x");
  expect([](auto& t) { t.edges.columns.erase("srce"); }, "the table of edges has no numeric column \"srce\"");
  expect([](auto& t) { t.vertices.index[1] = 10; }, "the table of vertices has two rows 10");
  expect([](auto& t) { t.edges.columns["trgt"][1] = 99; }, "an edge names row 99 of vertices, which does not exist");
  expect([](auto& t) { t.edges.columns["face"][1] = 99; }, "an edge names row 99 of faces, which does not exist");
  expect([](auto& t) { t.edges.columns["trgt"][1] = 40; }, "the 3 edges of face 6 do not form one ring");
  expect([](auto& t) { t.edges.columns["trgt"][2] = 20; }, "the 3 edges of face 6 do not form one ring");
  expect([](auto& t) { t.edges.columns["srce"][1] = 10; }, "the 3 edges of face 6 do not form one ring");
}

using TissueFiles = OwnFolder;

TEST_F(TissueFiles, AreReadByTheirEnding) {
  write_file(folder / "a.OBJ", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
  EXPECT_EQ(read_polygon_file(folder / "a.OBJ").surface.polygons.size(), 1U);
  write_file(folder / "a.stl", "solid\n");
  expect_mesh_error([&] { read_polygon_file(folder / "a.stl"); },
                    "a.stl: \".stl\" is not the extension of a polygon file");
  write_file(folder / "a.TIF", "II");
  expect_mesh_error([&] { read_polygon_file(folder / "a.TIF"); },
                    "a.TIF: is an image; make cells of its labels: of a volume by `plica labels FILE");
  write_file(folder / "b.ply",
             "ply\nformat ascii 1.0\nelement vertex 3\nproperty int x\nproperty int y\nproperty int z\nelement face "
             "2\nproperty list int int vertex_indices\nproperty float a\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 "
             "nan\n3 0 1 2 -inf\n");
  const PolygonFile missing = read_polygon_file(folder / "b.ply");
  for (const double value : missing.arrays.at("a")) EXPECT_TRUE(std::isnan(value));
  EXPECT_THROW(read_polygon_file(folder / "nowhere.ply"), FileError);
  write_file(folder / "a.h5", "no HDF5");
  EXPECT_SAYS(error_of<FileError>([&] { return read_polygon_file(folder / "a.h5"); }), "HDF5");
}

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
      "x_um,y_um,z_um,gene,kind,is_in\n1,2,3,,apical,True\n1,2,3,0.5,basal,false\n1,2,3,NaN,,true\n1,2,3,N/"
      "A,-,0\n1,2,3,-inf,null,1\n");
  EXPECT_EQ(table.arrays.size(), 2U);
  EXPECT_EQ(table.arrays.at("is_in"), (std::vector<double>{1, 0, 1, 0, 1}));
  const std::vector<double>& gene = table.arrays.at("gene");
  for (std::size_t i = 0; i < gene.size(); ++i) EXPECT_EQ(std::isnan(gene[i]), i != 1) << i;
  EXPECT_EQ(table.remarks, (std::vector<std::string>{"column kind contains text and is not an array"}));
}

TEST(PointsFile, SaysInWhichLineWhatIsWrong) {
  const auto expect = [](const char* text, const char* said) { expect_mesh_error([&] { points_in_csv(text); }, said); };
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

TEST_F(TissueFiles, OfCellsHaveAnArrayPerColumn) {
  const std::string file = (folder / "cells.csv").string();
  write_file(file, "myosin, calcium\n1,2\n0.5,-1e-3\n");
  EXPECT_EQ(read_cell_table(file),
            (std::map<std::string, std::vector<double>>{{"calcium", {2, -1e-3}}, {"myosin", {1, 0.5}}}));
  write_file(file, "myosin,myosin\n1,2\n");
  EXPECT_THROW((void)read_cell_table(file), MeshError);
  std::filesystem::remove(file);
}

// A grid of squares of two triangles each, with labels row by row.
PolygonFile triangles(const std::vector<std::vector<int>>& labels) {
  PolygonFile file;
  const std::size_t n = labels.size();
  for (std::size_t r = 0; r <= n; ++r)
    for (std::size_t c = 0; c <= n; ++c)
      file.surface.vertices.emplace_back(static_cast<double>(c), static_cast<double>(r), 0);
  for (std::size_t r = 0; r < n; ++r)
    for (std::size_t c = 0; c < n; ++c) {
      const std::size_t v = c + r * (n + 1);
      file.surface.polygons.push_back({v, v + 1, v + n + 2});
      file.surface.polygons.push_back({v, v + n + 2, v + n + 1});
      for (int i = 0; i < 2; ++i) {
        file.arrays["label"].push_back(labels[r][c]);
        file.arrays["gene"].push_back(labels[r][c] + i);
      }
    }
  return file;
}

TEST(LabelledFaces, FacesOfALabelAreACellWhoseCornersAreWhereThreeMeet) {
  // Bricks: the middle one, 5, has six neighbours.
  const PolygonFile file = triangles({{1, 1, 1, 2, 2, 2},
                                      {1, 1, 1, 2, 2, 2},
                                      {3, 5, 5, 5, 5, 4},
                                      {3, 5, 5, 5, 5, 4},
                                      {6, 6, 6, 7, 7, 7},
                                      {6, 6, 6, 7, 7, 7}});
  const PolygonFile cells = cells_of_labels(file, "label");
  ASSERT_EQ(cells.arrays.at("label"), (CellArray{1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(cells.arrays.at("gene").at(4), 5.5);
  const auto& middle = cells.surface.polygons[4];
  ASSERT_EQ(middle.size(), 6U);
  for (const std::size_t corner : middle) {
    const Vec3& p = cells.surface.vertices[corner];
    EXPECT_TRUE((p.y() == 2 || p.y() == 4) && (p.x() == 1 || p.x() == 3 || p.x() == 5)) << p.transpose();
  }
  EXPECT_GT(area_vector(cells.surface.vertices, middle).z(), 0);
  EXPECT_EQ(cells.surface.polygons[0].size(), 4U);  // three within, one at the rim
  EXPECT_EQ(label_advice(cells), "");
  EXPECT_SAYS(label_advice(file), "its 72 faces are triangles with 7 values of \"label\"");
}

TEST(LabelledFaces, WhatIsNoCellIsRefusedOrLeftOut) {
  expect_mesh_error(
      [] {
        cells_of_labels(triangles({{1, 2}, {2, 1}}), "label");
      },
      "the faces with label 1 are in pieces, or enclose others; correct the labels near (0, 0, 0) um");
  expect_mesh_error(
      [] {
        cells_of_labels(triangles({{1, 1, 1}, {1, 2, 1}, {1, 1, 1}}), "label");
      },
      "the faces with label 1 are in pieces, or enclose others");
  expect_mesh_error(
      [] {
        cells_of_labels(triangles({{1, 1}, {2, 2}}), "label");
      },
      "no label of \"label\" has faces with three corners where three cells meet");
  PolygonFile holed = triangles({{0, 1, 1, 2, 2, 0},
                                 {0, 1, 1, 2, 2, 0},
                                 {0, 3, 3, 3, 3, 0},
                                 {0, 3, 3, 3, 3, 0},
                                 {0, 0, 0, 0, 0, 0},
                                 {9, 0, 0, 0, 0, 0}});
  for (double& label : holed.arrays["label"])
    if (label == 0) label = std::nan("");
  const PolygonFile cells = cells_of_labels(holed, "label");
  EXPECT_EQ(cells.arrays.at("label"), (CellArray{1, 2, 3}));
  ASSERT_EQ(cells.remarks.size(), 1U);
  EXPECT_EQ(cells.remarks[0], "1 cells with fewer than three corners were omitted");
}

}  // namespace
