// What VTK says of a bad file goes to a window of our own while it reads: its messages take several lines, name sources
// of VTK and appear on stderr, also from objects inside its readers. Any error counts, since VTK hands out what it has got of
// a broken file as if it were whole.
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
#include <exception>
#include <fstream>
#include <system_error>

#include "core/errors.hpp"
#include "tissue/mesh_file.hpp"

namespace plica {
namespace {

/// Keeps the first error and prints nothing.
class SilentWindow : public vtkOutputWindow {
 public:
  static SilentWindow* New();
  vtkTypeMacro(SilentWindow, vtkOutputWindow);

  void DisplayText(const char*) override {}
  void DisplayErrorText(const char* text) override {
    if (first_error_.empty()) first_error_ = text;
  }
  void DisplayWarningText(const char*) override {}
  void DisplayGenericWarningText(const char*) override {}
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
vtkStandardNewMacro(SilentWindow);

/// VTK's output goes to `window` as long as this lives.
class RedirectedOutput {
 public:
  explicit RedirectedOutput(SilentWindow& window) : former_(vtkOutputWindow::GetInstance()) {
    vtkOutputWindow::SetInstance(&window);
  }
  RedirectedOutput(const RedirectedOutput&) = delete;
  RedirectedOutput& operator=(const RedirectedOutput&) = delete;
  ~RedirectedOutput() { vtkOutputWindow::SetInstance(former_); }

 private:
  vtkSmartPointer<vtkOutputWindow> former_;
};

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
vtkSmartPointer<vtkUnstructuredGrid> grid_of(const std::filesystem::path& file) {
  vtkNew<SilentWindow> window;
  const RedirectedOutput redirected(*window);
  vtkNew<Reader> reader;
  reader->SetFileName(file.c_str());
  try {
    reader->Update();
  } catch (const std::exception&) {  // out of memory, when a broken file asks for any number of nodes
    throw_unread(file, "it is not a mesh that VTK can read");
  }
  if (window->has_error()) throw_unread(file, fmt::format("VTK says: {}", window->first_error()));
  vtkSmartPointer<vtkUnstructuredGrid> grid = reader->GetOutput();
  if (grid == nullptr) throw_unread(file, "it holds no unstructured grid");
  return grid;
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

/// Arrays of one number a cell: as sets where it is not 0, or as the faces that are apical.
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
    CellSet set(mesh.cells.size());
    for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell) {
      const double value = array->GetComponent(static_cast<vtkIdType>(cell), 0);
      set[cell] = value != 0 && !std::isnan(value);
      if (name != apical_array) continue;
      if (!(value >= 0 && value <= 5 && value == std::floor(value)))
        throw MeshError(fmt::format("the apical face of cell {} is {} in \"{}\"; faces are 0 to 5", cell, value, name));
      mesh.apical_faces.push_back(static_cast<int>(value));
    }
    if (name != apical_array) mesh.arrays[name] = std::move(set);
  }
  if (!apical_array.empty() && mesh.apical_faces.empty())
    throw MeshError(fmt::format("there is no cell array \"{}\" of one number a cell; there {}", apical_array,
                                names.empty() ? "is none at all" : "are: " + names));
}

}  // namespace

Tissue read_mesh_file(const std::filesystem::path& file, const std::string& apical_array,
                      const std::array<int, 3>& elements_per_cell) {
  const auto grid = is_xml(file) ? grid_of<vtkXMLUnstructuredGridReader>(file) : grid_of<vtkUnstructuredGridReader>(file);
  try {
    HexahedralMesh mesh;
    check_hexahedra(*grid);
    copy_geometry(*grid, mesh);
    if (!mesh.cells.empty()) copy_arrays(*grid, apical_array, mesh);
    return tissue_from_mesh(mesh, elements_per_cell);
  } catch (const MeshError& error) {
    throw MeshError(fmt::format("{}: {}", file.string(), error.what()));
  }
}

}  // namespace plica
