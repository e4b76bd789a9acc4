// Readers of polygons: what each format may hold, and what is wrong with a file, by line.
#include "tissue/files/polygon_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>

#include "core/errors.hpp"
#include "core/files.hpp"
#include "support/mesh_error.hpp"
#include "tissue/files/vertex_model.hpp"

namespace plica {
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
    "element vertex 5\nproperty float x\nproperty float y\nproperty uchar red\nproperty float z\nelement edge 1\n"
    "property list uchar int two\nelement face 2\nproperty double height\nproperty list uchar int vertex_indices\n"
    "end_header\n";

TEST(PolygonFile, PlyAsText) {
  const PolygonFile file = polygons_in_ply("ply\r\nformat ascii 1.0\ncomment by hand\n" + ply_header +
                                           "0 0 9 0\n1 0 9 0\n1 1 9 0\n0 1 9 0\n.5 .5 9 2\n2 0 1\n"
                                           "7.5 3 0 1 4\n8 4 3 2 1 0\n");
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
  ply(start, "line 3: the file ends within the header");
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

TEST(PolygonFile, IsReadByItsEnding) {
  const auto folder = std::filesystem::path(testing::TempDir()) / ("plica_polygons_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  write_file(folder / "a.OBJ", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
  EXPECT_EQ(read_polygon_file(folder / "a.OBJ").surface.polygons.size(), 1U);
  write_file(folder / "a.stl", "solid\n");
  expect_mesh_error([&] { read_polygon_file(folder / "a.stl"); },
                    "a.stl: \".stl\" is not the extension of a polygon file");
  write_file(folder / "b.ply",
             "ply\nformat ascii 1.0\nelement vertex 3\nproperty int x\nproperty int y\nproperty int z\nelement face 2\n"
             "property list int int vertex_indices\nproperty float a\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 nan\n"
             "3 0 1 2 -inf\n");
  const PolygonFile missing = read_polygon_file(folder / "b.ply");
  for (const double value : missing.arrays.at("a")) EXPECT_TRUE(std::isnan(value));
  EXPECT_THROW(read_polygon_file(folder / "nowhere.ply"), FileError);
  write_file(folder / "a.h5", "no HDF5");
  try {
    read_polygon_file(folder / "a.h5");
    ADD_FAILURE();
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("HDF5"), std::string::npos) << error.what();
  }
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace plica
