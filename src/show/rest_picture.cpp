#include "show/rest_picture.hpp"

#include <algorithm>

namespace plica {

std::vector<std::string> colours_of_mesh(const Frame& frame) {
  std::vector<std::string> names = {"region"};
  for (const auto& [name, values] : frame.element_scalars)
    if (name != "cell_id") names.push_back(name);
  return names;
}

Picture rest_picture(Frame frame, const std::string& colour, const std::vector<View>& views, const EmbryoAxes& axes) {
  Picture picture;
  const auto known = std::ranges::find(colour_fields(), colour, &ColourField::name);
  picture.field = known != colour_fields().end() ? *known : ColourField{colour, colour, "", colour};
  const std::vector<double> values = field_values(frame, picture.field);
  const auto [smallest, largest] = std::ranges::minmax(values);
  if (picture.field.kind == ScaleKind::steps) picture.step_names = step_names(frame, picture.field, largest);
  picture.range = colour_range(picture.field, smallest, largest);
  for (const View& view : views) picture.rows.push_back({view, half_size_um(frame.positions, view)});
  picture.letters = picture_letters(axes);
  picture.columns.push_back({"", std::move(frame)});
  return picture;
}

}  // namespace plica
