#include "core/errors.hpp"
#include "core/files.hpp"
#include "record/mesh_writer.hpp"
#include "support/own_folder.hpp"
#include "tissue/hexahedral_mesh.hpp"
#include "tissue/shapes/embryo.hpp"

namespace {

namespace fs = std::filesystem;

class MeshWriterTest : public OwnFolder {
 protected:
  const Tissue block = build_block({60, 20, 40, {3, 1, 1}, {2, 2, 1}});
};

TEST_F(MeshWriterTest, WritesEachElementWithTheValuesOfItsCell) {
  const Vectors displacement(block.node_count(), Vec3(1, 2, 3));
  const MeshArrays arrays{
      {{"displacement_um", displacement}}, {{"pressure_Pa", {0, 1.5, 0}}}, {{"cell_id", {0, 1, 2}}}};
  write_mesh(folder / "a.vtu", block, block.rest_positions, arrays, 12.5);

  const std::string content = read_file(folder / "a.vtu");
  for (const char* name :
       {"Name=\"displacement_um\" NumberOfComponents=\"3\"", "Name=\"pressure_Pa\"", "Name=\"cell_id\"",
        "Name=\"TimeValue\"", "NumberOfCells=\"12\"", "vtkZLibDataCompressor", "format=\"binary\"", "type=\"Int32\""})
    EXPECT_SAYS(content, name);

  // Read back, each element is a cell; face 5 is the top one.
  write_mesh(folder / "b.vtu", block, block.rest_positions, {{}, {{"pressure_Pa", {0, 1.5, 0}}}, {{"top", {5, 5, 5}}}});
  const Tissue read = read_mesh_file(folder / "b.vtu", "top", {1, 1, 1});
  ASSERT_EQ(read.cells.size(), 12U);
  EXPECT_EQ(read.rest_positions, block.rest_positions);
  EXPECT_EQ(read.elements, block.elements);
  const CellArray expected = {0, 0, 0, 0, 1.5, 1.5, 1.5, 1.5, 0, 0, 0, 0};
  EXPECT_EQ(read.cell_arrays.at("pressure_Pa"), expected);
}

TEST_F(MeshWriterTest, WritesTheGivenPositionsAndTheSameBytesAgain) {
  Vectors moved = block.rest_positions;
  for (Vec3& position : moved) position += Vec3(0.1, 1e-9, 1.0 / 3);
  const MeshArrays arrays{{}, {}, {{"top", {5, 5, 5}}}};
  write_mesh(folder / "a.vtu", block, moved, arrays);
  write_mesh(folder / "b.vtu", block, moved, arrays);
  EXPECT_EQ(read_mesh_file(folder / "a.vtu", "top", {1, 1, 1}).rest_positions, moved);
  EXPECT_EQ(read_file(folder / "a.vtu"), read_file(folder / "b.vtu"));
  EXPECT_SAYS_NOT(read_file(folder / "a.vtu"), "TimeValue");
}

TEST_F(MeshWriterTest, NothingNonFiniteNorOfAnotherLengthReachesAFile) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  const Vectors& rest = block.rest_positions;
  Vectors bad = rest;
  bad.back().z() = nan;
  const Vectors short_of_one(rest.begin(), rest.end() - 1);
  const fs::path file = folder / "a.vtu";
  const auto refuses = [&](const Vectors& positions, const MeshArrays& arrays, std::optional<double> time = {}) {
    EXPECT_THROW(write_mesh(file, block, positions, arrays, time), std::logic_error);
    EXPECT_FALSE(fs::exists(file));
  };
  refuses(bad, {});
  refuses(short_of_one, {});
  refuses(rest, {{{"v", bad}}, {}, {}});
  refuses(rest, {{{"v", short_of_one}}, {}, {}});
  refuses(rest, {{}, {{"s", {1, infinite, 1}}}, {}});
  refuses(rest, {{}, {{"s", {1, 2}}}, {}});
  refuses(rest, {{}, {}, {{"i", {1, 2, 3, 4}}}});
  refuses(rest, {}, nan);
}

TEST_F(MeshWriterTest, AFullDiskIsAFileError) {
  EXPECT_THROW(write_mesh("/dev/full", block, block.rest_positions, {}), FileError);
  EXPECT_THROW(write_mesh(folder / "none" / "a.vtu", block, block.rest_positions, {}), FileError);
  const FileSizeLimit limit(1000);
  EXPECT_THROW(write_mesh(folder / "a.vtu", block, block.rest_positions, {}), FileError);
  EXPECT_TRUE(fs::is_empty(folder));
}

TEST_F(MeshWriterTest, CollectionListsTimesAndFiles) {
  write_collection(folder / "frames.pvd", {{0, "frames/0.vtu"}, {0.1, "a&\"b\".vtu"}});
  EXPECT_EQ(read_file(folder / "frames.pvd"),
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n  "
            "<Collection>\n    <DataSet timestep=\"0\" part=\"0\" file=\"frames/0.vtu\"/>\n    <DataSet "
            "timestep=\"0.1\" part=\"0\" file=\"a&amp;&quot;b&quot;.vtu\"/>\n  </Collection>\n</VTKFile>\n");
  EXPECT_THROW(write_collection(folder / "b.pvd", {{std::nan(""), "a.vtu"}}), std::logic_error);
  EXPECT_FALSE(fs::exists(folder / "b.pvd"));
}

}  // namespace
