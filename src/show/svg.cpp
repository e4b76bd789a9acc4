#include "show/svg.hpp"

#include <fmt/format.h>

#include "core/markup.hpp"

namespace plica {
namespace {

// Tenths of a pixel: finer is invisible and enlarges files.
std::string joined(const std::vector<Pixel>& points) {
  std::string text;
  for (const Pixel& point : points) text += fmt::format("{}{:.1f},{:.1f}", text.empty() ? "" : " ", point[0], point[1]);
  return text;
}

}  // namespace

void Svg::polyline(const std::vector<Pixel>& points, const std::string& colour, double width,
                   const std::string& dashes) {
  const std::string pattern = dashes.empty() ? "" : fmt::format(" stroke-dasharray=\"{}\"", dashes);
  shapes_ += fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{:.2g}\"{}/>\n",
                         joined(points), colour, width, pattern);
}

void Svg::circle(const Pixel& centre, double radius, const std::string& fill) {
  shapes_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" fill=\"{}\"/>\n", centre[0], centre[1],
                         radius, fill);
}

void Svg::rectangle(const Pixel& corner, double width, double height, const std::string& fill) {
  shapes_ += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"/>\n",
                         corner[0], corner[1], width, height, fill);
}

void Svg::text(const Pixel& place, const std::string& words, const TextStyle& style) {
  const std::string turn =
      style.upwards ? fmt::format(" transform=\"rotate(-90 {:.1f} {:.1f})\"", place[0], place[1]) : "";
  shapes_ += fmt::format(
      "<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"{:.3g}\" text-anchor=\"{}\"{}{} fill=\"#111\">{}</text>\n", place[0],
      place[1], style.size, style.anchor, style.bold ? " font-weight=\"bold\"" : "", turn, xml_escaped(words));
}

std::string Svg::file(const std::string& title) const {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "font-family=\"Helvetica, Arial, sans-serif\" role=\"img\">\n<title>{2}</title>\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n{3}</svg>\n",
      width_, height_, xml_escaped(title), shapes_);
}

}  // namespace plica
