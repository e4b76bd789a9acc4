// VTK builds the file in memory and write_file puts it on the disk: VTK's own file writers notice a full disk only now
// and then (never when it shows at close), write_file always does. The price is the compressed file in memory.
#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/errors.hpp"
#include "core/files.hpp"
#include "output/mesh_writer.hpp"

namespace plica {
namespace {

void require(bool holds, const std::string& name, const char* problem) {
  if (!holds) throw std::logic_error(fmt::format("write_mesh: {} {}", name, problem));
}

vtkNew<vtkDoubleArray> vector_array(const std::string& name, std::span<const Vec3> values, const Tissue& tissue) {
  require(values.size() == tissue.node_count(), name, "has not one value a node");
  require(std::all_of(values.begin(), values.end(), [](const Vec3& value) { return value.allFinite(); }), name,
          "is not finite");
  vtkNew<vtkDoubleArray> array;
  array->SetName(name.c_str());
  array->SetNumberOfComponents(3);
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i) array->SetTuple(static_cast<vtkIdType>(i), values[i].data());
  return array;
}

vtkNew<vtkDoubleArray> scalar_array(const std::string& name, const std::vector<double>& values, const Tissue& tissue) {
  require(values.size() == tissue.node_count(), name, "has not one value a node");
  require(std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); }), name,
          "is not finite");
  vtkNew<vtkDoubleArray> array;
  array->SetName(name.c_str());
  for (const double value : values) array->InsertNextValue(value);
  return array;
}

/// Each cell's value, repeated for its elements.
template <class Array, class Value>
vtkNew<Array> element_array(const std::string& name, const std::vector<Value>& values, const Tissue& tissue) {
  require(values.size() == tissue.cells.size(), name, "has not one value a cell");
  require(std::all_of(values.begin(), values.end(), [](Value value) { return std::isfinite(double(value)); }), name,
          "is not finite");
  vtkNew<Array> array;
  array->SetName(name.c_str());
  array->SetNumberOfTuples(static_cast<vtkIdType>(tissue.elements.size()));
  for (std::size_t e = 0; e < tissue.elements.size(); ++e)
    array->SetValue(static_cast<vtkIdType>(e), values[tissue.element_cell[e].index()]);
  return array;
}

void add_elements(const Tissue& tissue, std::span<const Vec3> positions, vtkUnstructuredGrid& grid) {
  vtkNew<vtkPoints> points;
  points->SetData(vector_array("positions", positions, tissue));
  grid.SetPoints(points);
  vtkNew<vtkCellArray> elements;
  for (const std::array<NodeId, 8>& nodes : tissue.elements) {
    std::array<vtkIdType, 8> ids;
    for (int i = 0; i < 8; ++i) ids[i] = nodes[i].number();
    elements->InsertNextCell(8, ids.data());
  }
  grid.SetCells(VTK_HEXAHEDRON, elements);
}

}  // namespace

void write_mesh(const std::filesystem::path& file, const Tissue& tissue, std::span<const Vec3> positions,
                const MeshArrays& arrays, std::optional<double> time_s) {
  vtkNew<vtkUnstructuredGrid> grid;
  add_elements(tissue, positions, *grid);
  for (const auto& [name, values] : arrays.node_vectors)
    grid->GetPointData()->AddArray(vector_array(name, values, tissue));
  for (const auto& [name, values] : arrays.node_scalars)
    grid->GetPointData()->AddArray(scalar_array(name, values, tissue));
  for (const auto& [name, values] : arrays.cell_scalars)
    grid->GetCellData()->AddArray(element_array<vtkDoubleArray>(name, values, tissue));
  for (const auto& [name, values] : arrays.cell_integers)
    grid->GetCellData()->AddArray(element_array<vtkIntArray>(name, values, tissue));
  if (time_s) {
    require(std::isfinite(*time_s), "the time", "is not finite");
    vtkNew<vtkDoubleArray> time;
    time->SetName("TimeValue");
    time->InsertNextValue(*time_s);
    grid->GetFieldData()->AddArray(time);
  }

  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetInputData(grid);
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  writer->SetCompressorTypeToZLib();
  writer->SetHeaderTypeToUInt64();
  writer->WriteToOutputStringOn();
  if (writer->Write() != 1 || writer->GetErrorCode() != 0 || writer->GetOutputString().empty())
    throw FileError(fmt::format("{}: cannot be written: VTK gave up on it", file.string()));
  write_file(file, writer->GetOutputString());
}

}  // namespace plica
