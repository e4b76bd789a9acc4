#include "mesh.hpp"

#include <fstream>
#include <sstream>

namespace plica::reference {
namespace {

// Lines of a file that are not comments, read as numbers.
class Lines {
 public:
  explicit Lines(const std::filesystem::path& file) : file_(file), in_(file) {
    if (!in_) throw FileError(file.string() + ": cannot be read");
  }

  bool next() {
    std::string text;
    while (std::getline(in_, text)) {
      ++number_;
      if (text.empty() || text.front() == '#') continue;
      words_ = std::istringstream(text);
      return true;
    }
    return false;
  }

  template <class Value>
  Value value(const char* what) {
    Value value;
    if (!(words_ >> value)) fail(std::string("expected ") + what);
    return value;
  }

  int node(std::size_t count) {
    const long node = value<long>("the number of a node");
    if (node < 0 || static_cast<std::size_t>(node) >= count)
      fail("no node " + std::to_string(node) + "; there are " + std::to_string(count));
    return static_cast<int>(node);
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw FileError(file_.string() + ":" + std::to_string(number_) + ": " + what);
  }

 private:
  std::filesystem::path file_;
  std::ifstream in_;
  std::istringstream words_;
  std::size_t number_ = 0;
};

void read_nodes(Lines& lines, std::size_t count, std::vector<double>& nodes) {
  for (std::size_t n = 0; n < count; ++n) {
    if (!lines.next()) lines.fail("ends after " + std::to_string(n) + " of " + std::to_string(count) + " nodes");
    for (int k = 0; k < 3; ++k) nodes.push_back(lines.value<double>("three coordinates"));
  }
}

}  // namespace

Mesh read_mesh(const std::filesystem::path& file) {
  Lines lines(file);
  Mesh mesh;
  while (lines.next()) {
    const auto what = lines.value<std::string>("nodes, hexes or springs");
    const auto count = lines.value<std::size_t>("a number");
    const std::size_t nodes = mesh.nodes.size() / 3;
    if (what == "nodes") {
      read_nodes(lines, count, mesh.nodes);
    } else if (what == "hexes" || what == "springs") {
      for (std::size_t n = 0; n < count; ++n) {
        if (!lines.next()) lines.fail("ends before the last of " + what);
        if (what == "hexes") {
          for (int& node : mesh.hexes.emplace_back()) node = lines.node(nodes);
        } else {
          Spring spring{};
          spring.i = lines.node(nodes);
          spring.j = lines.node(nodes);
          spring.stiffness = lines.value<double>("a stiffness");
          spring.damping = lines.value<double>("a damping");
          spring.rest_length = lines.value<double>("a rest length");
          mesh.springs.push_back(spring);
        }
      }
    } else {
      lines.fail("'" + what + "' is none of nodes, hexes, springs");
    }
  }
  if (mesh.hexes.empty()) lines.fail("has no hexes");
  return mesh;
}

std::vector<double> read_positions(const std::filesystem::path& file, std::size_t count) {
  Lines lines(file);
  std::vector<double> positions;
  read_nodes(lines, count, positions);
  if (lines.next()) lines.fail("more than " + std::to_string(count) + " positions");
  return positions;
}

}  // namespace plica::reference
