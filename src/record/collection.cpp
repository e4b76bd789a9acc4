#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "core/files.hpp"
#include "core/markup.hpp"
#include "record/mesh_writer.hpp"

namespace plica {

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
