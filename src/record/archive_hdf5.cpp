#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/errors.hpp"
#include "core/memory.hpp"
#include "record/archive.hpp"

namespace plica {
namespace {

class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t), const std::string& what) : id_(id), close_(close) {
    if (id_ < 0) throw FileError(what);
  }
  ~Handle() { close_(id_); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }  // NOLINT: converts to the id

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

// HDF5 refuses to open an image under the name of an existing file; no file can have this name.
constexpr const char* no_file = "/dev/null/checkpoint";

constexpr const char* cannot_make = "HDF5 cannot create a checkpoint, probably for lack of memory";

// Unique names: HDF5 cannot open two files of one name, even in memory.
std::string new_name() {
  static std::atomic<int> count = 0;
  return fmt::format("checkpoint {}", ++count);
}

void must(herr_t result, const std::string& what) {
  if (result < 0) throw FileError(what);
}

// Check for the memory that HDF5 needs besides `bytes` of arrays: without it HDF5 (1.10) ends the process or crashes.
void make_sure_of_room(std::size_t bytes) {
  constexpr std::size_t own_bytes = std::size_t{8} << 20;
  make_sure_of_memory(own_bytes + 2 * bytes);
}

// Errors of HDF5 are read from return values, so its messages on stderr are disabled. Files need no closing at exit,
// since they are in memory.
void prepare_library() {
  constexpr std::size_t library_bytes = std::size_t{32} << 20;
  make_sure_of_memory(library_bytes);
  [[maybe_unused]] static const herr_t ignored = H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

// Access to files in memory that HDF5 never writes to disk.
hid_t in_memory(const void* image, std::size_t size) {
  prepare_library();
  make_sure_of_room(size);
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  if (access < 0) return access;
  constexpr std::size_t growth = std::size_t{1} << 20;
  H5Pset_fapl_core(access, growth, false);
  if (image != nullptr) H5Pset_file_image(access, const_cast<void*>(image), size);  // copied
  return access;
}

}  // namespace

bool can_archive() { return true; }

std::string archive_bytes(const Archive& archive) {
  const Handle access(in_memory(nullptr, 0), H5Pclose, cannot_make);
  const Handle untimed(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, cannot_make);
  must(H5Pset_obj_track_times(untimed, false), cannot_make);
  const Handle file(H5Fcreate(new_name().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose, cannot_make);
  const auto put = [&](const std::string& name, hid_t type, const auto& values) {
    make_sure_of_room(values.size() * H5Tget_size(type));
    const hsize_t count = values.size();
    const Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose, cannot_make);
    const Handle set(H5Dcreate2(file, name.c_str(), type, space, H5P_DEFAULT, untimed, H5P_DEFAULT), H5Dclose,
                     cannot_make);
    if (count > 0) must(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), cannot_make);
  };
  for (const auto& [name, text] : archive.texts) put(name, H5T_NATIVE_CHAR, text);
  for (const auto& [name, numbers] : archive.numbers) put(name, H5T_NATIVE_DOUBLE, numbers);
  must(H5Fflush(file, H5F_SCOPE_GLOBAL), cannot_make);
  const ssize_t size = H5Fget_file_image(file, nullptr, 0);
  if (size <= 0) throw FileError(cannot_make);
  make_sure_of_room(static_cast<std::size_t>(size));
  std::string image(static_cast<std::size_t>(size), '\0');
  if (H5Fget_file_image(file, image.data(), image.size()) != size) throw FileError(cannot_make);
  return image;
}

void read_archive(std::string_view bytes, Archive& archive) {
  const Handle access(in_memory(bytes.data(), bytes.size()), H5Pclose,
                      "HDF5 cannot read it, probably for lack of memory");
  const Handle file(H5Fopen(no_file, H5F_ACC_RDONLY, access), H5Fclose, "it is not an HDF5 file, or damaged");
  const auto get = [&](const std::string& name, H5T_class_t kind, hid_t type, auto& values) {
    make_sure_of_room(0);
    const std::string damaged = fmt::format("it is damaged: {} is missing or invalid", name);
    const Handle set(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, damaged);
    const Handle stored(H5Dget_type(set), H5Tclose, damaged);
    const Handle space(H5Dget_space(set), H5Sclose, damaged);
    const hssize_t count = H5Sget_simple_extent_npoints(space);
    // The claimed size must exist, so that memory use is bounded by the size of the file.
    constexpr std::size_t item_bytes = sizeof values.front();
    if (H5Tget_class(stored) != kind || H5Tget_size(stored) != item_bytes || count < 0 ||
        static_cast<std::size_t>(count) > bytes.size() / item_bytes ||
        (count > 0 && H5Dget_storage_size(set) != static_cast<std::size_t>(count) * item_bytes))
      throw FileError(damaged);
    values.resize(static_cast<std::size_t>(count));
    if (count > 0) must(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), damaged);
  };
  for (auto& [name, text] : archive.texts) get(name, H5T_INTEGER, H5T_NATIVE_CHAR, text);
  for (auto& [name, numbers] : archive.numbers) {
    get(name, H5T_FLOAT, H5T_NATIVE_DOUBLE, numbers);
    if (!std::ranges::all_of(numbers, [](double number) { return std::isfinite(number); }))
      throw FileError(fmt::format("it is damaged: {} contains values that are not finite", name));
  }
}

}  // namespace plica
