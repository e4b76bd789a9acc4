#include "paper/pictures.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/errors.hpp"

namespace plica {
namespace {

template <class Things>
const auto& named(const Things& things, const std::string& name) {
  return *std::ranges::find_if(things, [&](const auto& thing) { return thing.name == name; });
}

// Nodes that lie where no node was: what a division has added.
Vectors new_places(const Frame& before, const Frame& after) {
  constexpr double same_um = 1e-3;
  Vectors places;
  for (const Vec3& place : after.positions)
    if (std::ranges::none_of(before.positions, [&](const Vec3& old) { return (old - place).norm() < same_um; }))
      places.push_back(place);
  return places;
}

// The frame without the elements of one cell.
Frame without_cell(const Frame& frame, double cell) {
  Frame rest = frame;
  rest.elements.clear();
  for (auto& [name, values] : rest.element_scalars) values.clear();
  const std::vector<double>& cells = frame.element_scalars.at("cell_id");
  for (std::size_t e = 0; e < frame.elements.size(); ++e) {
    if (cells[e] == cell) continue;
    rest.elements.push_back(frame.elements[e]);
    for (const auto& [name, values] : frame.element_scalars) rest.element_scalars[name].push_back(values[e]);
  }
  return rest;
}

}  // namespace

RunPictures ReproductionPictures::run_pictures(const std::string& run, const std::vector<std::string>& names) {
  (void)*painter_;  // where nothing can be drawn, that is the reason to give
  PictureOptions options;
  for (const std::string& name : names) options.views.push_back(named(views(), name));
  return {results_.folder(run), options};
}

Figure ReproductionPictures::drawn(const std::string& name, const Picture& picture, const std::string& caption) {
  return {name, "", caption, "", (*painter_).png(picture)};
}

Figure ReproductionPictures::moments(const std::string& run, const std::vector<std::string>& names,
                                     const std::vector<double>& times_s, const std::string& name,
                                     const std::string& caption) {
  if (!displacement_) {
    displacement_ = ColourRange{0, 0};
    for (const char* embryo : {"main-pill", "main-sphere"})
      if (results_.has(embryo))
        displacement_->high = std::max(displacement_->high, run_pictures(embryo, {"ventral"}).picture({0}).range.high);
  }
  const RunPictures pictures = run_pictures(run, names);
  std::vector<double> shown;
  for (const double time_s : times_s) {
    const double nearest = pictures.nearest_time_s(time_s).value_or(pictures.times_s().back());
    if (shown.empty() || nearest > shown.back()) shown.push_back(nearest);
  }
  Picture picture = pictures.picture(shown);
  picture.range = *displacement_;
  return drawn(name, picture, caption);
}

// Fig. 4: the steps of the paper, (a) to (f).
Figure ReproductionPictures::division_demo() {
  (void)*painter_;
  const ReferenceRun run(results_.folder("division-demo"));
  const auto at = [&](double time_s) {
    const std::optional<Frame> frame = run.frame_at(time_s);
    if (!frame) throw FileError(fmt::format("{}: has no frame at {} s", run.directory().string(), time_s));
    return *frame;
  };
  constexpr double mother = 1, division_s = 60;
  const Frame rest = at(0), divided = at(division_s);
  Picture picture;
  const auto minutes = [](const Frame& frame) { return fmt::format("{:.2g} min", frame.time_s.value_or(0) / 60); };
  const Frame growing = at(180), grown = run.last_frame();
  picture.columns = {{"(a) reference state", rest},
                     {"(b) the cut", rest, new_places(rest, divided)},
                     {"(c) without the mother", without_cell(rest, mother)},
                     {"(d) " + minutes(divided), divided},
                     {"(e) " + minutes(growing), growing},
                     {"(f) " + minutes(grown), grown}};
  const View view = {"", "from the left, in front and above", {0.35, 0.8, -0.5}, {0, 0, 1}, {}};
  picture.rows = {{view, {0, 0}}};
  for (const PictureColumn& column : picture.columns) {
    const auto half = half_size_um(column.frame.positions, view);
    for (int i = 0; i < 2; ++i) picture.rows[0].half_size_um[i] = std::max(picture.rows[0].half_size_um[i], half[i]);
  }
  picture.field = named(colour_fields(), "generation");
  picture.range = colour_range(picture.field, 0, 1);
  picture.letters = {};
  return drawn(
      "fig4-division", picture,
      "**Fig. 4.** Division of the middle one of three cells: (a) reference state; (b) points of the cut; (c) the "
      "mother removed; (d) two daughters with a common facet (1 min); (e) growth; (f) daughters of the mother's "
      "size. Colour: generation.");
}

// Fig. 5: cross-sections with and without division.
Figure ReproductionPictures::division_sections() {
  std::optional<Picture> picture;
  for (const auto& [id, words] : {std::pair{"division", "with division"},
                                  {"division-without", "without"},
                                  {"division-twice", "with a second round"}}) {
    if (!results_.has(id)) continue;
    const RunPictures run = run_pictures(id, {"cross-section"});
    Picture one = run.picture({run.times_s().back()});
    one.columns.front().heading = fmt::format("{}, {}", words, one.columns.front().heading);
    if (!picture) {
      picture = std::move(one);
      continue;
    }
    picture->columns.push_back(std::move(one.columns.front()));
    picture->range.high = std::max(picture->range.high, one.range.high);
  }
  return drawn(
      "fig5-sections", picture.value(),
      "**Fig. 5.** Mid cross-sections, ventral side down, with and without division of the cells of the furrow "
      "bottom. Colour: displacement.");
}

}  // namespace plica
