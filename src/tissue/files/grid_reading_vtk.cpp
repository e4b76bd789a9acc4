#include <fmt/format.h>
#include <fmt/ranges.h>
#include <vtkCellArray.h>
#include <vtkCellTypes.h>
#include <vtkDataArray.h>
#include <vtkDataReader.h>
#include <vtkDataSet.h>
#include <vtkDataSetAttributes.h>
#include <vtkDataSetSurfaceFilter.h>
#include <vtkGenericCell.h>
#include <vtkGenericDataObjectReader.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkOBJReader.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkPLYReader.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSTLReader.h>
#include <vtkSmartPointer.h>
#include <vtkTriangleFilter.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridReader.h>
#include <vtkXMLGenericDataObjectReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <sstream>
#include <system_error>

#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/one_thread_vtk.hpp"
#include "tissue/files/grid_reading.hpp"
#include "tissue/files/text_lines.hpp"
#include "tissue/hexahedral_mesh.hpp"

namespace plica {
namespace {

template <class Output>
constexpr const char* what_is = "surface";
template <>
constexpr const char* what_is<vtkUnstructuredGrid> = "unstructured grid";

class ErrorWindow : public vtkOutputWindow {
 public:
  static ErrorWindow* New();

  void DisplayText(const char*) override {}
  void DisplayErrorText(const char* text) override {
    if (first_error_.empty()) first_error_ = text;
  }
  [[nodiscard]] bool has_error() const { return !first_error_.empty(); }

  /// One line, without the place in VTK's sources and the address of VTK's object.
  [[nodiscard]] std::string first_error() const {
    std::string text = first_error_;
    if (text.starts_with("ERROR: In")) text.erase(0, text.find('\n') + 1);
    const std::size_t address = text.find(" (0x"), end = text.find("): ");
    if (address != std::string::npos && end != std::string::npos && address < end) text.erase(0, end + 3);
    std::string line;
    std::istringstream words(text);
    for (std::string word; words >> word;) line += line.empty() ? word : " " + word;
    while (line.ends_with(' ') || line.ends_with('.')) line.pop_back();
    return line;
  }

 private:
  std::string first_error_;
};
vtkStandardNewMacro(ErrorWindow)

    /// Tells the two kinds of file by how they begin.
    bool is_xml(const std::filesystem::path& file) {
  std::string start(64, '\0');
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  stream.read(start.data(), static_cast<std::streamsize>(start.size()));
  if (stream.bad() || (stream.gcount() == 0 && errno != 0))
    throw_unread(file, std::generic_category().message(errno != 0 ? errno : EIO));
  start.resize(static_cast<std::size_t>(stream.gcount()));
  if (start.empty()) throw_unread(file, "it is empty");
  start = plain_text(start);
  if (start.starts_with("# vtk DataFile")) return false;
  const std::size_t first = start.find_first_not_of(" \t\r\n");
  if (first == std::string::npos || start[first] != '<')
    throw_unread(file,
                 "neither a VTK XML file (.vtu) nor a legacy VTK file (.vtk); from Python, plica.Tissue.from_file "
                 "reads Abaqus, Gmsh and others");
  return true;
}

/// Lets a reader of legacy files read all arrays, not only the first, and pass over a byte-order mark. It reads the
/// result, if that is not empty.
std::string prepare_legacy(const std::filesystem::path& file, vtkDataReader& reader) {
  reader.ReadAllScalarsOn();
  reader.ReadAllFieldsOn();
  std::string text;
  std::string start(3, '\0');
  std::ifstream(file, std::ios::binary).read(start.data(), 3);
  if (!without_byte_order_mark(start).empty()) return text;
  text = read_file(file).substr(3);
  reader.ReadFromInputStringOn();
  reader.SetBinaryInputString(text.data(), static_cast<int>(text.size()));
  return text;
}

/// Output of `last`, a reader or a filter behind it.
template <class Output, class Reader, class Last>
vtkSmartPointer<Output> output_of(const std::filesystem::path& file, Reader& reader, Last& last) {
  vtkNew<ErrorWindow> window;
  vtkOutputWindow::SetInstance(window);
  reader.SetFileName(file.c_str());
  last.Update();
  if (window->has_error()) throw_unread(file, fmt::format("VTK reports: {}", window->first_error()));
  vtkSmartPointer<Output> output = Output::SafeDownCast(last.GetOutputDataObject(0));
  if (output == nullptr) throw_unread(file, fmt::format("it has no {}", what_is<Output>));
  return output;
}

/// The triangles of whatever surface the reader finds.
template <class Reader>
vtkSmartPointer<vtkPolyData> triangles_of(const std::filesystem::path& file, Reader& reader) {
  vtkNew<vtkDataSetSurfaceFilter> surface;
  surface->SetInputConnection(reader.GetOutputPort());
  vtkNew<vtkTriangleFilter> triangles;
  triangles->PassVertsOff();
  triangles->PassLinesOff();
  triangles->SetInputConnection(surface->GetOutputPort());
  return output_of<vtkPolyData>(file, reader, *triangles);
}

/// Whether the first eight nodes are the corners of a hexahedron, and others may follow.
bool is_quadratic(int type) {
  return type == VTK_QUADRATIC_HEXAHEDRON || type == VTK_TRIQUADRATIC_HEXAHEDRON ||
         type == VTK_BIQUADRATIC_QUADRATIC_HEXAHEDRON || type == VTK_LAGRANGE_HEXAHEDRON;
}

/// Whether cells of this type are volumes, or unknown.
bool is_volume(int type) {
  const auto cell = vtkSmartPointer<vtkCell>::Take(vtkGenericCell::InstantiateCell(type));
  return cell == nullptr || cell->GetCellDimension() > 2;
}

/// Numbers of the hexahedra among the cells.
std::vector<long long> hexahedra_among(vtkUnstructuredGrid& grid) {
  const vtkIdType count = grid.GetNumberOfCells();
  if (count > largest_mesh_elements)
    throw MeshError("the mesh has {} cells; at most {} are allowed", count, largest_mesh_elements);
  if (count == 0) return {};
  vtkCellArray* cells = grid.GetCells();
  const vtkUnsignedCharArray* types = grid.GetCellTypesArray();
  if (cells == nullptr || types == nullptr || !cells->IsValid() || types->GetNumberOfTuples() != count)
    throw MeshError("the lists of cells, nodes and types have inconsistent lengths");
  std::vector<long long> hexahedra;
  for (vtkIdType cell = 0; cell < count; ++cell) {
    const int type = grid.GetCellType(cell);
    if (type == VTK_HEXAHEDRON || is_quadratic(type)) {
      if (cells->GetCellSize(cell) < 8 || (type == VTK_HEXAHEDRON && cells->GetCellSize(cell) != 8))
        throw MeshError("cell {} is a hexahedron with {} nodes; 8 are required", cell, cells->GetCellSize(cell));
      hexahedra.push_back(cell);
    } else if (is_volume(type)) {
      throw MeshError(
          "cell {} is a {} (VTK type {}); every volume must be a vtkHexahedron (type {}): mesh one layer of hexahedra, "
          "in Gmsh for example, or set embryo.shape to \"surface\" and give apical polygons",
          cell, vtkCellTypes::GetClassNameFromTypeId(type), type, int{VTK_HEXAHEDRON});
    }
  }
  if (hexahedra.empty())
    throw MeshError(
        "none of its {} cells is a hexahedron, cell 0 is a {}; for polygons, set embryo.shape to \"surface\"", count,
        vtkCellTypes::GetClassNameFromTypeId(grid.GetCellType(0)));
  return hexahedra;
}

std::string remark_on(vtkUnstructuredGrid& grid, const std::vector<long long>& hexahedra) {
  const auto quadratic =
      std::ranges::count_if(hexahedra, [&](long long cell) { return is_quadratic(grid.GetCellType(cell)); });
  const auto others = grid.GetNumberOfCells() - static_cast<vtkIdType>(hexahedra.size());
  std::vector<std::string> parts;
  if (others > 0)
    parts.push_back(fmt::format("{} faces, lines and vertices beside the hexahedra were omitted", others));
  if (quadratic > 0)
    parts.push_back(fmt::format("{} hexahedra have nodes between corners: only their corners are used", quadratic));
  return fmt::format("{}", fmt::join(parts, "; "));
}

}  // namespace

vtkSmartPointer<vtkUnstructuredGrid> read_grid(const std::filesystem::path& file) {
  if (is_xml(file)) {
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    return output_of<vtkUnstructuredGrid>(file, *reader, *reader);
  }
  vtkNew<vtkUnstructuredGridReader> reader;
  const std::string text = prepare_legacy(file, *reader);
  return output_of<vtkUnstructuredGrid>(file, *reader, *reader);
}

vtkSmartPointer<vtkDataSet> read_data_set(const std::filesystem::path& file) {
  if (is_xml(file)) {
    vtkNew<vtkXMLGenericDataObjectReader> reader;
    return output_of<vtkDataSet>(file, *reader, *reader);
  }
  vtkNew<vtkGenericDataObjectReader> reader;
  const std::string text = prepare_legacy(file, *reader);
  return output_of<vtkDataSet>(file, *reader, *reader);
}

vtkSmartPointer<vtkPolyData> read_triangles(const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  if (ending == ".stl" || ending == ".STL") return triangles_of(file, *vtkNew<vtkSTLReader>());
  if (ending == ".ply" || ending == ".PLY") return triangles_of(file, *vtkNew<vtkPLYReader>());
  if (ending == ".obj" || ending == ".OBJ") return triangles_of(file, *vtkNew<vtkOBJReader>());
  if (is_xml(file)) return triangles_of(file, *vtkNew<vtkXMLGenericDataObjectReader>());
  return triangles_of(file, *vtkNew<vtkGenericDataObjectReader>());
}

Vectors points_of(vtkDataSet& data) {
  Vectors points(static_cast<std::size_t>(data.GetNumberOfPoints()));
  for (std::size_t i = 0; i < points.size(); ++i) data.GetPoint(static_cast<vtkIdType>(i), points[i].data());
  return points;
}

void for_arrays(vtkDataSetAttributes& data, int components,
                const std::function<void(const std::string& name, vtkDataArray&)>& take) {
  for (int a = 0; a < data.GetNumberOfArrays(); ++a)
    if (vtkDataArray* array = data.GetArray(a);
        array != nullptr && array->GetName() != nullptr && array->GetNumberOfComponents() == components)
      take(array->GetName(), *array);
}

GridHexahedra hexahedra_of(vtkUnstructuredGrid& grid) {
  GridHexahedra found;
  found.cells = hexahedra_among(grid);
  found.remark = remark_on(grid, found.cells);
  const vtkIdType point_count = grid.GetNumberOfPoints();
  if (point_count > 8 * largest_mesh_elements)
    throw MeshError("the mesh has {} nodes; at most {} are allowed", point_count, 8 * largest_mesh_elements);
  found.points = points_of(grid);
  vtkNew<vtkIdList> nodes;
  for (const vtkIdType cell : found.cells) {
    grid.GetCells()->GetCellAtId(cell, nodes);
    auto& hexahedron = found.hexahedra.emplace_back();
    for (int i = 0; i < 8; ++i) {
      // Before VTK's number is made shorter.
      const vtkIdType node = nodes->GetId(i);
      if (node < 0 || node >= point_count)
        throw MeshError("cell {} uses node {}; nodes are 0 to {}", cell, node, point_count - 1);
      hexahedron[i] = NodeId(static_cast<std::size_t>(node));
    }
  }
  return found;
}

}  // namespace plica
