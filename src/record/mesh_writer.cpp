// Writer of the part of VTK's XML format that plica needs: one piece, hexahedra or polygons, a few number types, data
// in base64 within their arrays, compressed. VTK's own writer takes three times as long per snapshot. (Appended data
// are no shorter, and meshio mistakes their ends in some files.) Tests read the files back with VTK, ParaView and
// meshio.
#include "record/mesh_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "core/files.hpp"
#include "core/markup.hpp"

namespace plica {
namespace {

constexpr std::uint8_t vtk_hexahedron = 12;

void require(bool holds, const std::string& name, const char* problem) {
  if (!holds) throw std::logic_error(fmt::format("write_mesh: {} {}", name, problem));
}

template <class Number>
constexpr const char* type_name() {
  if constexpr (std::is_same_v<Number, double>) return "Float64";
  if constexpr (std::is_same_v<Number, std::int64_t>) return "Int64";
  if constexpr (std::is_same_v<Number, std::int32_t>) return "Int32";
  if constexpr (std::is_same_v<Number, std::uint8_t>) return "UInt8";
}

/// Growing file.
class VtkText {
 public:
  void line(int depth, std::string_view text) { xml_ += fmt::format("{:{}}{}\n", "", 2 * depth, text); }

  template <class Number>
  void array(int depth, const std::string& name, std::span<const Number> values, const std::string& shape = "") {
    xml_ += fmt::format(R"({:{}}<DataArray type="{}" Name="{}"{} format="binary">)", "", 2 * depth, type_name<Number>(),
                        xml_escaped(name), shape);
    append_compressed({reinterpret_cast<const char*>(values.data()), values.size_bytes()});
    xml_ += "</DataArray>\n";
  }

  void vectors(int depth, const std::string& name, std::span<const Vec3> values) {
    static_assert(sizeof(Vec3) == 3 * sizeof(double));
    array(depth, name, std::span(values.empty() ? nullptr : values.front().data(), 3 * values.size()),
          R"( NumberOfComponents="3")");
  }

  void time(std::optional<double> time_s) {
    if (time_s) array(3, "TimeValue", std::span<const double>(&*time_s, 1), R"( NumberOfTuples="1")");
  }

  [[nodiscard]] std::string text(const char* kind) const {
    constexpr bool little = std::endian::native == std::endian::little;
    return fmt::format(R"(<?xml version="1.0"?>
<VTKFile type="{}" version="1.0" byte_order="{}" header_type="UInt64" compressor="vtkZLibDataCompressor">
{}</VTKFile>
)",
                       kind, little ? "LittleEndian" : "BigEndian", xml_);
  }

 private:
  /// Append data: number of blocks, block size, size of a shorter last block, compressed sizes; then the blocks.
  void append_compressed(std::string_view bytes) {
    constexpr std::size_t block_bytes = std::size_t{1} << 20;
    std::vector<std::uint64_t> header = {(bytes.size() + block_bytes - 1) / block_bytes, block_bytes,
                                         bytes.size() % block_bytes};
    std::string blocks;
    for (std::size_t b = 0; b < header.front(); ++b)
      header.push_back(deflater_.append(bytes.substr(b * block_bytes, block_bytes), blocks));
    xml_ += base64({reinterpret_cast<const char*>(header.data()), header.size() * sizeof(std::uint64_t)});
    xml_ += base64(blocks);
  }

  Deflater deflater_{Deflater::Effort::fast};
  std::string xml_;
};

/// Repeat the value of each cell for its elements.
template <class Number, class Value>
std::vector<Number> of_elements(const MeshElements& mesh, const std::vector<Value>& of_cells) {
  std::vector<Number> values;
  values.reserve(mesh.elements.size());
  for (const CellId cell : mesh.element_cell) values.push_back(static_cast<Number>(of_cells[cell.index()]));
  return values;
}

bool is_finite(double value) { return std::isfinite(value); }
bool is_finite(const Vec3& value) { return value.allFinite(); }
bool is_finite(int) { return true; }

template <class Values>
void check_values(const std::string& name, const Values& values, std::size_t count, const char* of_each) {
  require(values.size() == count, name, of_each);
  require(std::ranges::all_of(values, [](const auto& value) { return is_finite(value); }), name, "is not finite");
}

void check(const MeshElements& mesh, std::span<const Vec3> positions, const MeshArrays& arrays,
           std::optional<double> time_s) {
  const auto of_nodes = [&](const auto& name, const auto& values) {
    check_values(name, values, mesh.nodes, "does not have one value per node");
  };
  const auto of_cells = [&](const auto& name, const auto& values) {
    check_values(name, values, mesh.cells, "does not have one value per cell");
  };
  of_nodes("positions", positions);
  for (const auto& [name, values] : arrays.node_vectors) of_nodes(name, values);
  for (const auto& [name, values] : arrays.node_scalars) of_nodes(name, values);
  for (const auto& [name, values] : arrays.cell_scalars) of_cells(name, values);
  for (const auto& [name, values] : arrays.cell_integers) of_cells(name, values);
  for (const auto& [name, values] : arrays.element_scalars)
    check_values(name, values, mesh.elements.size(), "does not have one value per element");
  require(!time_s || std::isfinite(*time_s), "the time", "is not finite");
}

void put_elements(const MeshElements& mesh, VtkText& vtu) {
  std::vector<std::int64_t> nodes, ends;
  nodes.reserve(8 * mesh.elements.size());
  for (const auto& element : mesh.elements) {
    for (const NodeId node : element) nodes.push_back(node.number());
    ends.push_back(static_cast<std::int64_t>(nodes.size()));
  }
  const std::vector<std::uint8_t> types(mesh.elements.size(), vtk_hexahedron);
  vtu.line(3, "<Cells>");
  vtu.array(4, "connectivity", std::span<const std::int64_t>(nodes));
  vtu.array(4, "offsets", std::span<const std::int64_t>(ends));
  vtu.array(4, "types", std::span<const std::uint8_t>(types));
  vtu.line(3, "</Cells>");
}

void put_field_data(const FramePolygons* polygons, const std::vector<std::pair<std::string, std::vector<int>>>& lists,
                    std::optional<double> time_s, VtkText& vtk) {
  if (!time_s && polygons == nullptr && lists.empty()) return;
  vtk.line(2, "<FieldData>");
  vtk.time(time_s);
  const auto put = [&](const std::string& name, const std::vector<int>& values) {
    vtk.array(3, name, std::span<const std::int32_t>(values), fmt::format(R"( NumberOfTuples="{}")", values.size()));
  };
  if (polygons != nullptr) {
    put("polygon_ends", polygons->ends);
    put("polygon_apical", polygons->apical);
    put("polygon_basal", polygons->basal);
    put("polygon_elements", polygons->elements);
  }
  for (const auto& [name, values] : lists) put(name, values);
  vtk.line(2, "</FieldData>");
}

void put_data(const MeshElements& mesh, const MeshArrays& arrays, VtkText& vtu) {
  vtu.line(3, "<PointData>");
  for (const auto& [name, values] : arrays.node_vectors) vtu.vectors(4, name, values);
  for (const auto& [name, values] : arrays.node_scalars) vtu.array(4, name, std::span<const double>(values));
  vtu.line(3, "</PointData>");
  vtu.line(3, "<CellData>");
  for (const auto& [name, values] : arrays.cell_scalars)
    vtu.array(4, name, std::span<const double>(of_elements<double>(mesh, values)));
  for (const auto& [name, values] : arrays.cell_integers)
    vtu.array(4, name, std::span<const std::int32_t>(of_elements<std::int32_t>(mesh, values)));
  for (const auto& [name, values] : arrays.element_scalars) vtu.array(4, name, std::span<const double>(values));
  vtu.line(3, "</CellData>");
}

}  // namespace

void write_mesh(const std::filesystem::path& file, const MeshElements& mesh, std::span<const Vec3> positions,
                const MeshArrays& arrays, std::optional<double> time_s) {
  check(mesh, positions, arrays, time_s);
  VtkText vtu;
  vtu.line(1, "<UnstructuredGrid>");
  put_field_data(arrays.polygons, arrays.lists, time_s, vtu);
  vtu.line(2, fmt::format(R"(<Piece NumberOfPoints="{}" NumberOfCells="{}">)", positions.size(), mesh.elements.size()));
  put_data(mesh, arrays, vtu);
  vtu.line(3, "<Points>");
  vtu.vectors(4, "positions", positions);
  vtu.line(3, "</Points>");
  put_elements(mesh, vtu);
  vtu.line(2, "</Piece>");
  vtu.line(1, "</UnstructuredGrid>");
  write_file(file, vtu.text("UnstructuredGrid"));
}

FramePolygons polygons_of(const Tissue& tissue) {
  FramePolygons polygons;
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) {
    const std::vector<Stop>& ring = tissue.sheet.cells[c].ring;
    const auto beyond = [&](const Stop& stop) { return tissue.sheet.walls[stop.wall.index()].beyond(CellId(c)); };
    for (std::size_t i = 0; i < ring.size(); ++i) {
      // After divisions three cells also meet at stops within a side.
      if (ring[i].at != 0 && beyond(ring[i]) == beyond(ring[i - 1])) continue;
      const std::vector<NodeId>& nodes = tissue.sheet.vertices[ring[i].vertex.index()].nodes;
      polygons.basal.push_back(nodes.front().number());
      polygons.apical.push_back(nodes.back().number());
    }
    polygons.ends.push_back(static_cast<int>(polygons.apical.size()));
    polygons.elements.push_back(tissue.cells[c].first_element.number());
  }
  return polygons;
}

void write_polygons(const std::filesystem::path& file, const SurfaceMesh& surface) {
  check_values("points", surface.points, surface.points.size(), "");
  for (const auto& [name, values] : surface.vectors)
    check_values(name, values, surface.points.size(), "does not have one value per point");
  for (const auto& [name, values] : surface.scalars)
    check_values(name, values, surface.ends.size(), "does not have one value per polygon");
  VtkText vtp;
  vtp.line(1, "<PolyData>");
  put_field_data(nullptr, {}, surface.time_s, vtp);
  vtp.line(
      2, fmt::format(R"(<Piece NumberOfPoints="{}" NumberOfPolys="{}">)", surface.points.size(), surface.ends.size()));
  vtp.line(3, "<PointData>");
  for (const auto& [name, values] : surface.vectors) vtp.vectors(4, name, values);
  vtp.line(3, "</PointData>");
  vtp.line(3, "<CellData>");
  for (const auto& [name, values] : surface.scalars) vtp.array(4, name, std::span<const double>(values));
  vtp.line(3, "</CellData>");
  vtp.line(3, "<Points>");
  vtp.vectors(4, "positions", surface.points);
  vtp.line(3, "</Points>");
  const std::vector<std::int64_t> corners(surface.corners.begin(), surface.corners.end()),
      ends(surface.ends.begin(), surface.ends.end());
  vtp.line(3, "<Polys>");
  vtp.array(4, "connectivity", std::span<const std::int64_t>(corners));
  vtp.array(4, "offsets", std::span<const std::int64_t>(ends));
  vtp.line(3, "</Polys>");
  vtp.line(2, "</Piece>");
  vtp.line(1, "</PolyData>");
  write_file(file, vtp.text("PolyData"));
}

Frame frame_of(const MeshElements& mesh, std::span<const Vec3> positions, const MeshArrays& arrays) {
  Frame frame;
  frame.positions.assign(positions.begin(), positions.end());
  frame.elements.assign(mesh.elements.begin(), mesh.elements.end());
  for (const auto& [name, vectors] : arrays.node_vectors)
    frame.node_vectors[name].assign(vectors.begin(), vectors.end());
  for (const auto& [name, values] : arrays.cell_scalars)
    frame.element_scalars[name] = of_elements<double>(mesh, values);
  for (const auto& [name, values] : arrays.cell_integers)
    frame.element_scalars[name] = of_elements<double>(mesh, values);
  for (const auto& [name, values] : arrays.element_scalars) frame.element_scalars[name] = values;
  if (arrays.polygons != nullptr) frame.polygons = *arrays.polygons;
  return frame;
}

void write_collection(const std::filesystem::path& pvd,
                      const std::vector<std::pair<double, std::string>>& time_and_file) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n  "
      "<Collection>\n";
  for (const auto& [time_s, file] : time_and_file) {
    if (!std::isfinite(time_s)) throw std::logic_error("write_collection: a time is not finite");
    text += fmt::format("    <DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", time_s, xml_escaped(file));
  }
  text += "  </Collection>\n</VTKFile>\n";
  write_file(pvd, text);
}

}  // namespace plica
