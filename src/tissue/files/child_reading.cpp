#include "tissue/files/child_reading.hpp"

#include <fmt/format.h>

#include "core/child_process.hpp"

namespace plica {

std::string bytes_from_child(const std::filesystem::path& file, const std::function<std::string()>& read,
                             const char* reader) {
  // A letter for the kind of answer, then what was read or the error.
  const std::optional<std::string> answer = output_of_child("reading " + file.string(), [&] {
    try {
      return 'r' + read();
    } catch (const MeshError& error) {
      return std::string("m") + error.what();
    } catch (const FileError& error) {
      return std::string("f") + error.what();
    }
  });
  if (!answer || answer->empty()) throw_unread(file, fmt::format("it is damaged: {} crashes on it", reader));
  if (answer->front() == 'f') throw FileError(answer->substr(1));
  if (answer->front() == 'm') throw MeshError(answer->substr(1));
  return answer->substr(1);
}

}  // namespace plica
