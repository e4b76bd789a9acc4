#include "show/report_page.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/base64.hpp"
#include "core/errors.hpp"
#include "core/markup.hpp"
#include "record/deflate.hpp"

namespace plica {
namespace {

using nlohmann::ordered_json;

constexpr std::string_view title_place = "<!--plica:title-->", data_place = "<!--plica:data-->";

// Convert to JSON for a script element, without "</script>" and "<!--". Invalid UTF-8 becomes U+FFFD.
std::string in_script(const ordered_json& json) {
  const std::string text = json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  std::string result;
  result.reserve(text.size());
  for (const char c : text) {
    if (c == '<')
      result += "\\u003c";
    else
      result += c;
  }
  return result;
}

std::string replaced(std::string_view text, std::string_view place, const std::string& by) {
  const std::size_t at = text.find(place);
  if (at == std::string_view::npos) throw std::logic_error("the page has no place for its data");
  return fmt::format("{}{}{}", text.substr(0, at), by, text.substr(at + place.size()));
}

}  // namespace

#ifdef PLICA_REPORT_TEMPLATE
// Included by the assembler, since the compiler takes seconds for literals of this size.
#define PLICA_TEMPLATE(name, file)                                                                                     \
  __asm__(".pushsection .rodata\nplica_" #name ":\n.incbin \"" file "\"\nplica_" #name "_end:\n.byte 0\n.popsection\n"); \
  extern "C" const char plica_##name[], plica_##name##_end[];                                                          \
  std::string_view name() { return {plica_##name, plica_##name##_end}; }
#else
#define PLICA_TEMPLATE(name, file) \
  std::string_view name() { return {}; }
#endif
PLICA_TEMPLATE(report_template, PLICA_REPORT_TEMPLATE)
PLICA_TEMPLATE(study_template, PLICA_STUDY_TEMPLATE)

std::string filled_page(std::string_view page, const std::string& title, const ordered_json& data,
                        const std::vector<PageBytes>& packed) {
  if (page.empty()) throw FileError("reports are not available (built with PLICA_WITH_VIEWER=OFF)");
  std::string elements = fmt::format("<script type=\"application/json\" id=\"data\">{}</script>\n", in_script(data));
  for (const auto& [id, bytes] : packed) {
    std::string deflated;
    Deflater(Deflater::Effort::small).append(bytes, deflated);
    elements += fmt::format("<script type=\"text/plain\" id=\"{}\">{}</script>\n", id, base64(deflated));
  }
  // Data first, so that a title containing the mark of another place is harmless.
  return replaced(replaced(page, data_place, elements), title_place, xml_escaped(title));
}

}  // namespace plica
