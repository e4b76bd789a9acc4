#include "show/document.hpp"

#include <fmt/format.h>

#include "core/base64.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/markup.hpp"

namespace plica {
namespace fs = std::filesystem;
namespace {

template <class... Takes>
struct Overloaded : Takes... {
  using Takes::operator()...;
};
template <class... Takes>
Overloaded(Takes...) -> Overloaded<Takes...>;  // needed by clang-tidy 14, not by C++20

std::string file_name(const Figure& figure) { return figure.name + (figure.png.empty() ? ".svg" : ".png"); }

// `|` would end a cell of a Markdown table.
std::string cell_text(const std::string& text) {
  std::string safe;
  for (const char letter : text) safe += letter == '|' ? "\\|" : std::string(1, letter);
  return safe;
}

std::string markdown(const Document& document) {
  std::string text = fmt::format("# {}\n", document.title);
  const Overloaded write = {
      [&](const Heading& heading) { text += fmt::format("\n{} {}\n", std::string(heading.level, '#'), heading.text); },
      [&](const Paragraph& paragraph) { text += "\n" + paragraph.text + "\n"; },
      [&](const Table& table) {
        const auto row = [&](const std::vector<std::string>& cells) {
          for (const std::string& cell : cells) text += "| " + cell_text(cell) + " ";
          text += "|\n";
        };
        text += "\n";
        row(table.header);
        for (std::size_t i = 0; i < table.header.size(); ++i) text += "|---";
        text += "|\n";
        for (const auto& cells : table.rows) row(cells);
      },
      [&](const Figure& figure) {
        text += fmt::format("\n![{}](figures/{})\n\n{}", figure.name, file_name(figure), figure.caption);
        if (!figure.csv.empty()) text += fmt::format(" Data: `figures/{}.csv`.", figure.name);
        text += "\n";
      }};
  for (const auto& block : document.blocks) std::visit(write, block);
  return text;
}

// Convert inline marks to HTML; unpaired marks are kept.
std::string inline_html(const std::string& text) {
  std::string html = xml_escaped(text);
  const auto turn = [&](const std::string& mark, const std::string& tag) {
    std::size_t from = 0;
    while ((from = html.find(mark, from)) != std::string::npos) {
      const std::size_t to = html.find(mark, from + mark.size());
      if (to == std::string::npos) return;
      const std::string inner = html.substr(from + mark.size(), to - from - mark.size());
      const std::string whole = fmt::format("<{0}>{1}</{0}>", tag, inner);
      html.replace(from, to + mark.size() - from, whole);
      from += whole.size();
    }
  };
  turn("`", "code");
  turn("**", "strong");
  turn("*", "em");
  return html;
}

constexpr const char* style =
    "body{font:15px/1.5 system-ui,sans-serif;color:#111;background:#fff;max-width:75rem;margin:2rem auto;padding:0 "
    "1rem}table{border-collapse:collapse;margin:1rem 0;font-size:13px}th,td{border:1px solid #ccc;padding:.3rem "
    ".5rem;text-align:left;vertical-align:top}th{background:#f3f3f3}tbody tr:nth-child(even){background:#fafafa}"
    "figure{margin:2rem 0}figure svg,figure "
    "img{max-width:100%;height:auto}figcaption{max-width:60rem}.yes{background:#dcefe6}"
    ".open{background:#f5ecc8}.no{background:#f6dcd2}";

// Verdicts have a colour in addition to the word.
std::string cell_class(const std::string& cell) {
  if (cell == "*reproduced*" || cell == "*hit*") return " class=\"yes\"";
  if (cell == "*reproduced under this reading*" || cell == "*undecided*") return " class=\"open\"";
  if (cell == "*not reproduced*" || cell == "*miss*") return " class=\"no\"";
  return "";
}

std::string html(const Document& document) {
  std::string body;
  const Overloaded write = {[&](const Heading& heading) {
                              body += fmt::format("<h{0}>{1}</h{0}>\n", heading.level, inline_html(heading.text));
                            },
                            [&](const Paragraph& paragraph) { body += "<p>" + inline_html(paragraph.text) + "</p>\n"; },
                            [&](const Table& table) {
                              body += "<table>\n<thead><tr>";
                              for (const std::string& cell : table.header) body += "<th>" + inline_html(cell) + "</th>";
                              body += "</tr></thead>\n<tbody>\n";
                              for (const auto& row : table.rows) {
                                body += "<tr>";
                                for (const std::string& cell : row)
                                  body += fmt::format("<td{}>{}</td>", cell_class(cell), inline_html(cell));
                                body += "</tr>\n";
                              }
                              body += "</tbody></table>\n";
                            },
                            [&](const Figure& figure) {
                              if (!figure.png.empty()) {
                                body += fmt::format(
                                    "<figure>\n<img alt=\"{}\" src=\"data:image/png;base64,{}\">"
                                    "<figcaption>{}</figcaption>\n</figure>\n",
                                    xml_escaped(figure.name), base64(figure.png), inline_html(figure.caption));
                                return;
                              }
                              // Inline SVG needs no namespace, so that the page contains no URL.
                              std::string svg = figure.svg;
                              constexpr std::string_view name_space = " xmlns=\"http://www.w3.org/2000/svg\"";
                              if (const auto at = svg.find(name_space); at != std::string::npos)
                                svg.erase(at, name_space.size());
                              body += fmt::format("<figure>\n{}<figcaption>{}</figcaption>\n</figure>\n", svg,
                                                  inline_html(figure.caption));
                            }};
  for (const auto& block : document.blocks) std::visit(write, block);
  const std::string title = xml_escaped(document.title);
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>{0}</title><style>{1}</style></head>\n"
      "<body>\n<h1>{0}</h1>\n{2}</body>\n</html>\n",
      title, style, body);
}

}  // namespace

void write_document(const fs::path& directory, const std::string& name, const Document& document) {
  std::error_code error;
  fs::create_directories(directory / "figures", error);
  if (error) throw FileError((directory / "figures").string() + ": cannot be created: " + error.message());
  for (const auto& block : document.blocks)
    if (const auto* figure = std::get_if<Figure>(&block)) {
      write_file(directory / "figures" / file_name(*figure), figure->png.empty() ? figure->svg : figure->png);
      if (!figure->csv.empty()) write_file(directory / "figures" / (figure->name + ".csv"), figure->csv);
    }
  write_file(directory / (name + ".md"), markdown(document));
  write_file(directory / (name + ".html"), html(document));
}

}  // namespace plica
