// VTK's readers trust the numbers in a file: a few damaged bytes make them divide by zero or write beyond their memory.
// So a child process reads the file and hands over what it found as bytes, and plica lives on whatever VTK does. There
// a window of our own takes what VTK has to say, also from objects within its readers. Any error counts, since VTK
// hands out what it has got of a broken file as if it were whole.
#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellTypes.h>
#include <vtkDataArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <cerrno>
#include <cmath>
#include <fstream>
#include <system_error>

#include "core/child_process.hpp"
#include "core/errors.hpp"
#include "tissue/mesh_bytes.hpp"
#include "tissue/mesh_file.hpp"

namespace plica {
namespace {

/// Keeps the first error.
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
    for (const char c : text) {
      const bool space = std::isspace(static_cast<unsigned char>(c)) != 0;
      if (!space) line += c;
      if (space && !line.empty() && line.back() != ' ') line += ' ';
    }
    while (line.ends_with(' ') || line.ends_with('.')) line.pop_back();
    return line;
  }

 private:
  std::string first_error_;
};
vtkStandardNewMacro(ErrorWindow)

    [[noreturn]] void throw_unread(const std::filesystem::path& file, const std::string& why) {
  throw FileError(fmt::format("{}: cannot be read: {}", file.string(), why));
}

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
  if (start.starts_with("# vtk DataFile")) return false;
  if (start.starts_with("\xEF\xBB\xBF")) start.erase(0, 3);
  const std::size_t first = start.find_first_not_of(" \t\r\n");
  if (first == std::string::npos || start[first] != '<')
    throw_unread(file, "it is neither a VTK XML file (.vtu) nor a legacy VTK file (.vtk)");
  return true;
}

template <class Reader>
vtkSmartPointer<vtkUnstructuredGrid> grid_of(const std::filesystem::path& file, Reader& reader) {
  vtkNew<ErrorWindow> window;
  vtkOutputWindow::SetInstance(window);
  reader.SetFileName(file.c_str());
  reader.Update();
  if (window->has_error()) throw_unread(file, fmt::format("VTK says: {}", window->first_error()));
  vtkSmartPointer<vtkUnstructuredGrid> grid = reader.GetOutput();
  if (grid == nullptr) throw_unread(file, "it holds no unstructured grid");
  return grid;
}

vtkSmartPointer<vtkUnstructuredGrid> read_grid(const std::filesystem::path& file) {
  if (is_xml(file)) {
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    return grid_of(file, *reader);
  }
  vtkNew<vtkUnstructuredGridReader> reader;
  reader->ReadAllScalarsOn();  // by default, the first array only
  reader->ReadAllFieldsOn();
  return grid_of(file, *reader);
}

void check_hexahedra(vtkUnstructuredGrid& grid) {
  const vtkIdType count = grid.GetNumberOfCells();
  if (count > largest_mesh_elements)
    throw MeshError(fmt::format("the mesh has {} cells; at most {} are allowed", count, largest_mesh_elements));
  if (count == 0) return;
  vtkCellArray* cells = grid.GetCells();
  const vtkUnsignedCharArray* types = grid.GetCellTypesArray();
  if (cells == nullptr || types == nullptr || !cells->IsValid() || types->GetNumberOfTuples() != count)
    throw MeshError("the lists of the cells' nodes and types do not fit together");
  for (vtkIdType cell = 0; cell < count; ++cell) {
    const int type = grid.GetCellType(cell);
    if (type != VTK_HEXAHEDRON)
      throw MeshError(fmt::format("cell {} is a {} (VTK type {}); every cell must be a vtkHexahedron (type {})", cell,
                                  vtkCellTypes::GetClassNameFromTypeId(type), type, int{VTK_HEXAHEDRON}));
    if (cells->GetCellSize(cell) != 8)
      throw MeshError(fmt::format("cell {} is a hexahedron with {} nodes", cell, cells->GetCellSize(cell)));
  }
}

void copy_geometry(vtkUnstructuredGrid& grid, HexahedralMesh& mesh) {
  const vtkIdType point_count = grid.GetNumberOfPoints(), cell_count = grid.GetNumberOfCells();
  if (point_count > 8 * largest_mesh_elements) throw MeshError(fmt::format("the mesh has {} nodes", point_count));
  mesh.points.resize(static_cast<std::size_t>(point_count));
  for (vtkIdType i = 0; i < point_count; ++i) grid.GetPoints()->GetPoint(i, mesh.points[i].data());
  mesh.cells.resize(static_cast<std::size_t>(cell_count));
  vtkNew<vtkIdList> nodes;
  for (vtkIdType cell = 0; cell < cell_count; ++cell) {
    grid.GetCells()->GetCellAtId(cell, nodes);
    for (int i = 0; i < 8; ++i) {
      // Before VTK's number is made shorter.
      const vtkIdType node = nodes->GetId(i);
      if (node < 0 || node >= point_count)
        throw MeshError(fmt::format("cell {} uses node {}, and the nodes are 0 to {}", cell, node, point_count - 1));
      mesh.cells[cell][i] = NodeId(static_cast<std::size_t>(node));
    }
  }
}

std::vector<int> apical_faces(vtkDataArray& array) {
  std::vector<int> faces;
  for (vtkIdType cell = 0; cell < array.GetNumberOfTuples(); ++cell) {
    const double value = array.GetComponent(cell, 0);
    if (!(value >= 0 && value <= 5 && value == std::floor(value)))
      throw MeshError(
          fmt::format("the apical face of cell {} is {} in \"{}\"; faces are 0 to 5", cell, value, array.GetName()));
    faces.push_back(static_cast<int>(value));
  }
  return faces;
}

/// Arrays of one number a cell: as sets where it is neither 0 nor NaN, or as the faces that are apical.
void copy_arrays(vtkUnstructuredGrid& grid, const std::string& apical_array, HexahedralMesh& mesh) {
  std::string names;
  for (int a = 0; a < grid.GetCellData()->GetNumberOfArrays(); ++a) {
    vtkDataArray* array = grid.GetCellData()->GetArray(a);
    if (array == nullptr || array->GetName() == nullptr || array->GetNumberOfComponents() != 1) continue;
    const std::string name = array->GetName();
    if (array->GetNumberOfTuples() != grid.GetNumberOfCells())
      throw MeshError(fmt::format("the cell array \"{}\" has {} values for {} cells", name, array->GetNumberOfTuples(),
                                  grid.GetNumberOfCells()));
    names += names.empty() ? name : ", " + name;
    if (name == apical_array) {
      mesh.apical_faces = apical_faces(*array);
      continue;
    }
    CellSet& set = mesh.arrays[name];
    set.resize(mesh.cells.size());
    for (std::size_t cell = 0; cell < set.size(); ++cell) {
      const double value = array->GetComponent(static_cast<vtkIdType>(cell), 0);
      set[cell] = value != 0 && !std::isnan(value);
    }
  }
  if (!apical_array.empty() && mesh.apical_faces.empty())
    throw MeshError(fmt::format("there is no cell array \"{}\" of one number a cell; there {}", apical_array,
                                names.empty() ? "is none at all" : "are: " + names));
}

/// What the child process says: a letter for the kind of answer, then the mesh or the error.
std::string answer(const std::filesystem::path& file, const std::string& apical_array) {
  try {
    HexahedralMesh mesh;
    const vtkSmartPointer<vtkUnstructuredGrid> grid = read_grid(file);
    check_hexahedra(*grid);
    copy_geometry(*grid, mesh);
    if (!mesh.cells.empty()) copy_arrays(*grid, apical_array, mesh);
    return 'm' + mesh_to_bytes(mesh);
  } catch (const FileError& error) {
    return std::string("f") + error.what();
  } catch (const MeshError& error) {
    return std::string("c") + error.what();
  }
}

}  // namespace

Tissue read_mesh_file(const std::filesystem::path& file, const std::string& apical_array,
                      const std::array<int, 3>& elements_per_cell) {
  const std::optional<std::string> bytes = output_of_child([&] { return answer(file, apical_array); });
  if (!bytes || bytes->empty()) throw_unread(file, "it is damaged: VTK breaks off at it");
  const std::string_view content = std::string_view(*bytes).substr(1);
  if (bytes->front() == 'f') throw FileError(std::string(content));
  try {
    if (bytes->front() == 'c') throw MeshError(std::string(content));
    return tissue_from_mesh(mesh_from_bytes(content), elements_per_cell);
  } catch (const MeshError& error) {
    throw MeshError(fmt::format("{}: {}", file.string(), error.what()));
  }
}

}  // namespace plica
