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

// Bytes of the UTF-8 character at this place; 0 if there is none.
std::size_t utf8_length(const std::string& text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(i < text.size() ? text[i] : 0); };
  const unsigned char first = byte(at);
  const std::size_t length = first < 0x80   ? 1
                             : first < 0xc2 ? 0
                             : first < 0xe0 ? 2
                             : first < 0xf0 ? 3
                             : first < 0xf5 ? 4
                                            : 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(at + i) & 0xc0) != 0x80) return 0;
  const unsigned char second = byte(at + 1);
  const bool is_none = (first == 0xe0 && second < 0xa0) || (first == 0xed && second >= 0xa0) ||
                       (first == 0xf0 && second < 0x90) || (first == 0xf4 && second >= 0x90);
  return is_none ? 0 : length;
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
    } else if (const std::size_t length = utf8_length(text, i); length == 0) {
      line += fmt::format("\\x{:02X}", code);
    } else {
      line += text.substr(i, length);
      i += length - 1;
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
