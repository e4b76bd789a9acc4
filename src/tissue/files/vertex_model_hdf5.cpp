// Tables written by pandas into an HDF5 file in "fixed" format: one group per table, with the index (axis1) and blocks
// of columns of one type, each with names (block0_items) and values (block0_values, row by row).
#include <fmt/format.h>
#include <hdf5.h>

#include <array>
#include <optional>

#include "core/files.hpp"
#include "tissue/files/child_reading.hpp"
#include "tissue/files/polygon_file.hpp"
#include "tissue/mesh_input.hpp"

namespace plica {
namespace {

constexpr hsize_t most_numbers = hsize_t{1} << 30;

// Closed when it goes.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }  // NOLINT: it stands for the id
  [[nodiscard]] bool is_open() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

bool has(hid_t place, const std::string& name) { return H5Lexists(place, name.c_str(), H5P_DEFAULT) > 0; }

struct Shape {
  hsize_t rows = 0, columns = 1;
};

std::optional<Shape> shape_of(hid_t data) {
  const Handle space(H5Dget_space(data), H5Sclose);
  std::array<hsize_t, 2> sizes = {0, 1};
  const int dimensions = H5Sget_simple_extent_ndims(space);
  if (dimensions < 1 || dimensions > 2 || H5Sget_simple_extent_dims(space, sizes.data(), nullptr) < 0) return {};
  if (sizes[1] > 0 && sizes[0] > most_numbers / sizes[1]) throw MeshError("a table is too large");
  return Shape{sizes[0], sizes[1]};
}

// Empty where it holds no numbers. Booleans, of a byte each, are numbers.
std::vector<double> numbers_in(hid_t group, const std::string& name, Shape& shape) {
  const Handle data(H5Dopen2(group, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!data.is_open()) return {};
  const Handle type(H5Dget_type(data), H5Tclose);
  const H5T_class_t kind = H5Tget_class(type);
  const bool is_boolean = (kind == H5T_BITFIELD || kind == H5T_ENUM) && H5Tget_size(type) == 1;
  if (!is_boolean && kind != H5T_INTEGER && kind != H5T_FLOAT) return {};
  const std::optional<Shape> found = shape_of(data);
  if (!found) return {};
  shape = *found;
  std::vector<double> values(shape.rows * shape.columns);
  std::vector<unsigned char> bytes(is_boolean ? values.size() : 0);
  void* const to = is_boolean ? static_cast<void*>(bytes.data()) : values.data();
  const hid_t type_read = is_boolean ? hid_t{type} : H5T_NATIVE_DOUBLE;
  if (!values.empty() && H5Dread(data, type_read, H5S_ALL, H5S_ALL, H5P_DEFAULT, to) < 0)
    throw MeshError("HDF5 cannot read {}; save it without compression, or with gzip", name);
  if (is_boolean) values.assign(bytes.begin(), bytes.end());
  return values;
}

// Texts of a fixed length.
std::vector<std::string> texts_in(hid_t group, const std::string& name) {
  const Handle data(H5Dopen2(group, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!data.is_open()) return {};
  const Handle type(H5Dget_type(data), H5Tclose);
  const std::optional<Shape> shape = shape_of(data);
  const std::size_t length = H5Tget_size(type);
  if (!shape || H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0 || length == 0 ||
      shape->rows > most_numbers / length)
    return {};
  std::string letters(shape->rows * length, '\0');
  if (letters.empty() || H5Dread(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, letters.data()) < 0) return {};
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < shape->rows; ++i) {
    const std::string text = letters.substr(i * length, length);
    texts.push_back(text.substr(0, text.find('\0')));
  }
  return texts;
}

NumberedTable table_in(hid_t file, const std::string& name) {
  if (!has(file, name)) throw MeshError("no table \"{}\"; write vert, edge and face by tyssue's save_datasets", name);
  const Handle group(H5Gopen2(file, name.c_str(), H5P_DEFAULT), H5Gclose);
  if (!group.is_open() || !has(group, "axis1"))
    throw MeshError(
        "the table \"{}\" is not in pandas' \"fixed\" format; write it by tyssue's save_datasets, or DataFrame.to_hdf "
        "without format=\"table\"",
        name);
  NumberedTable table;
  Shape shape;
  table.index = numbers_in(group, "axis1", shape);
  for (int block = 0; has(group, fmt::format("block{}_values", block)); ++block) {
    const std::vector<std::string> names = texts_in(group, fmt::format("block{}_items", block));
    const std::vector<double> values = numbers_in(group, fmt::format("block{}_values", block), shape);
    if (values.empty() || names.size() != shape.columns || table.index.size() != shape.rows) continue;  // texts, say
    for (std::size_t c = 0; c < names.size(); ++c)
      for (std::size_t row = 0; row < shape.rows; ++row)
        table.columns[names[c]].push_back(values[row * shape.columns + c]);
  }
  return table;
}

VertexModelTables tables_in(const std::filesystem::path& path) {
  H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file.is_open()) throw MeshError("not an HDF5 file");
  if (has(file, "cell"))
    throw MeshError(
        "it contains three-dimensional cells; give a surface with one cell per face: of a monolayer, Python's "
        "plica.polygons_of_monolayer takes apical faces and heights");
  return {table_in(file, "vert"), table_in(file, "edge"), table_in(file, "face")};
}

}  // namespace

PolygonFile read_vertex_model(const std::filesystem::path& path) {
  read_file(path);  // throws if unreadable
  return polygons_of(read_in_child(
      path, [&] { return tables_in(path); }, "HDF5"));
}

}  // namespace plica
