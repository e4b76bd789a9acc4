#include "core/errors.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace plica {
namespace {

std::string joined(const std::vector<Diagnostic>& diagnostics) {
  std::vector<std::string> lines;
  lines.reserve(diagnostics.size());
  for (const Diagnostic& diagnostic : diagnostics) lines.push_back(diagnostic.text());
  return fmt::format("{}", fmt::join(lines, "\n"));
}

}  // namespace

std::string printable(const std::string& text) {
  std::string line;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto code = static_cast<unsigned char>(text[i]);
    const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : 0);
    if (code == '\n') {
      line += "\\n";
    } else if (code < 0x20 || code == 0x7f) {
      line += fmt::format("\\u{:04X}", code);
    } else if (code == 0xc2 && next >= 0x80 && next < 0xa0) {  // C1 control characters in UTF-8
      line += fmt::format("\\u{:04X}", next);
      ++i;
    } else {
      line += text[i];
    }
  }
  return line;
}

std::string Diagnostic::text() const {
  std::string text = file;
  if (line > 0) text += ':' + std::to_string(line);
  text += ": ";
  if (!key.empty()) text += key + ": ";
  text += problem;
  if (!remedy.empty()) text += "; " + remedy;
  return printable(text);
}

ScenarioError::ScenarioError(std::vector<Diagnostic> diagnostics)
    : std::runtime_error(joined(diagnostics)), diagnostics_(std::move(diagnostics)) {}

}  // namespace plica
