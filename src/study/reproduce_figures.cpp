#include <fmt/format.h>

#include <algorithm>

#include "core/errors.hpp"
#include "measure/reference_run.hpp"
#include "study/plot.hpp"
#include "study/reproduce.hpp"
#include "study/reproduce_mechanism.hpp"
#include "output/results.hpp"
#include "study/sketch.hpp"

namespace plica {
namespace {

constexpr double small_um_per_pixel = 1.9, large_um_per_pixel = 1.2;
const ColourScale displacement_scale{"displacement from rest, um", 0, 35};

Figure chart(const std::string& name, const Plot& plot, const std::string& caption) {
  return {name, draw(plot).file(plot.title), caption, plot_csv(plot)};
}

// The frame whose time is nearest.
Frame frame_near(const ReferenceRun& run, double time_s) {
  const std::vector<double> times = run.times_s();
  const auto nearest = std::ranges::min_element(times, {}, [&](double time) { return std::abs(time - time_s); });
  return run.frame_at(*nearest).value();
}

std::string minutes(double time_s) { return fmt::format("{:.3g} min", time_s / 60); }

Curve column_of(const Series& series, const std::string& name, const std::string& column) {
  Curve curve{name, {}, {}};
  const std::size_t place = series.column(column).value();
  for (const auto& row : series.rows)
    if (row[place]) curve.x.push_back(*row.front()), curve.y.push_back(*row[place]);
  return curve;
}

// Fig. 8: speeds of the two barycentres.
Figure speeds(const Results& results, const std::string& embryo, const std::string& name, const std::string& caption) {
  const Series series = read_series(results.folder("main-" + embryo) / "series.csv");
  Plot plot{"Speeds of the barycentres of VML and VCE, " + embryo,
            {"time, s", true, 0.05, 1200},
            {"speed, um/s", true, 1e-4, {}},
            {column_of(series, "VML, the middle", "vml_speed_um_per_s"),
             column_of(series, "VCE, second-last cell", "vce_speed_um_per_s")},
            {{"largest difference, paper", 30, {}}, {"equal speeds and rest, paper", 900, {}}},
            {}};
  return chart(name, plot, caption);
}

// Figs. 7 and 11: the same moments from two sides.
Figure two_views(const Results& results, const std::string& run_id, const std::string& name, const std::string& title,
                 const std::string& caption) {
  const ReferenceRun run(results.folder(run_id));
  std::vector<std::pair<std::string, Svg>> pictures;
  for (const bool from_front : {true, false})
    for (const double time_s : {0.0, 60.0, 300.0, 900.0}) {
      const Frame frame = frame_near(run, time_s);
      pictures.emplace_back(fmt::format("{}, {}", from_front ? "antero-ventral" : "ventral", minutes(*frame.time_s)),
                            sketch_surface(frame, displacements(frame), displacement_scale,
                                           from_front ? antero_ventral_view() : ventral_view(), small_um_per_pixel));
    }
  return {name, strip(pictures, 4, displacement_scale).file(title), caption, ""};
}

// Fig. 9: sections at 15 min.
Figure sections(const Results& results) {
  const Frame frame = frame_near(ReferenceRun(results.folder("main-pill")), 900);
  const std::vector<double> values = displacements(frame);
  const std::vector<std::pair<std::string, Svg>> pictures = {
      {"across, x = 5 um", sketch_section(frame, values, displacement_scale, 0, 5, large_um_per_pixel)},
      {"along, y = 0", sketch_section(frame, values, displacement_scale, 1, 0, large_um_per_pixel)}};
  return {
      "fig9-sections", strip(pictures, 2, displacement_scale).file("Sections of the pill at 15 min"),
      "**Fig. 9.** The pill at 15 min, cut across its middle and along its axis (belly down), coloured by how far "
      "nodes "
      "have moved. The floor has moved in as a whole; in the chosen reading the middle has by then overtaken the ends.",
      ""};
}

// Fig. 10: from below at four times.
Figure ventral_strip(const Results& results) {
  const ReferenceRun run(results.folder("main-pill"));
  std::vector<std::pair<std::string, Svg>> pictures;
  for (const double time_s : {60.0, 300.0, 600.0, 900.0, 1200.0}) {
    const Frame frame = frame_near(run, time_s);
    pictures.emplace_back(minutes(*frame.time_s), sketch_surface(frame, displacements(frame), displacement_scale,
                                                                 ventral_view(), small_um_per_pixel));
  }
  return {
      "fig10-ventral", strip(pictures, 3, displacement_scale).file("The pill from below"),
      "**Fig. 10.** The pill from below at the paper's times, and at 1 min before them, coloured by how far nodes have "
      "moved. At 1 min the ends of the strip have moved most; from 5 min on little changes but the depth of the "
      "middle.",
      ""};
}

Plot onset_plot(const Onsets& pill, const Onsets& sphere) {
  return {"When midline cells set off: a tenth of their final depth",
          {"place along the axis at rest, um"},
          {"time, s", false, 0.0, {}},
          {{"pill", pill.ap_um, pill.time_s, true}, {"sphere", sphere.ap_um, sphere.time_s, true}},
          {},
          {}};
}

// What the ratio of springs across to along does, each figure over its printed value.
std::optional<Plot> trade_off(const Measured& measured) {
  struct Line {
    const char *name, *figure;
    double printed;
  };
  constexpr std::array lines = {Line{"pill's speed ratio / 3.65", "pill.peak_ratio", 3.65},
                                Line{"sphere's speed ratio / 1.23", "sphere.peak_ratio", 1.23},
                                Line{"sphere's depth / 27.44 um", "sphere.depth_um", 27.44},
                                Line{"VCE at equal speeds / 15 um", "pill.vce_at_equal_um", 15},
                                Line{"VML at equal speeds / 8.5 um", "pill.vml_at_equal_um", 8.5},
                                Line{"VML area loss / 30 %", "pill.vml_area_loss_percent", 30}};
  Plot plot{"The trade-off: pill 28.89 um deep throughout",
            {"springs across / springs along"},
            {"ours / printed"},
            {},
            {{"chosen", 0.35, {}}},
            {{"printed, within 15 %", 0.85, 1.15}}};
  for (const Line& line : lines) {
    Curve curve{line.name, {}, {}, true};
    for (const auto& [id, ratio] : {std::pair{"across-0.2", 0.2},
                                    {"across-0.3", 0.3},
                                    {"chosen", 0.35},
                                    {"across-0.4", 0.4},
                                    {"across-0.6", 0.6},
                                    {"across-1", 1.0}}) {
      const auto reading = measured.readings.find(id);
      if (reading == measured.readings.end() || !reading->second.contains(line.figure)) continue;
      curve.x.push_back(ratio);
      curve.y.push_back(reading->second.at(line.figure) / line.printed);
    }
    if (curve.x.size() > 1) plot.curves.push_back(std::move(curve));
  }
  return plot.curves.empty() ? std::nullopt : std::optional(plot);
}

// Fig. 4: the three cells from the side, at the moments that the paper shows.
Figure division_demo(const Results& results) {
  const ReferenceRun run(results.folder("division-demo"));
  const ColourScale scale{"displacement from rest, um", 0, 12};
  std::vector<std::pair<std::string, Svg>> pictures;
  for (const double time_s : {0.0, 60.0, 90.0, 180.0, 360.0, 1800.0}) {
    const Frame frame = frame_near(run, time_s);
    pictures.emplace_back(minutes(*frame.time_s), sketch_section(frame, displacements(frame), scale, 1, 0.01, 0.5));
  }
  return {
      "fig4-division", strip(pictures, 3, scale).file("Division of one cell among three"),
      "**Fig. 4.** The middle one of three cells is cut across the row at 1 min; its daughters share the new facet and "
      "grow to what their mother was. Cut along the row, seen from the side.",
      ""};
}

Figure division_volumes(const Results& results) {
  const Series cells = read_table(results.folder("division-demo") / "cells.csv");
  const std::size_t id = cells.column("cell_id").value(), volume = cells.column("volume_um3").value();
  Plot plot{"Volumes of the cells of the division", {"time, s"}, {"volume, um3", false, 0.0, {}}, {}, {}, {}};
  std::map<double, Curve> curves;
  for (const auto& row : cells.rows) {
    Curve& curve = curves[*row[id]];
    curve.x.push_back(*row.front());
    curve.y.push_back(*row[volume]);
  }
  for (auto& [number, curve] : curves) {
    curve.name = fmt::format("cell {:.0f}{}", number, number == 1 ? ", the mother" : number > 2 ? ", a daughter" : "");
    plot.curves.push_back(std::move(curve));
  }
  return chart(
      "fig4-volumes", plot,
      "**Fig. 4, volumes.** The daughters begin with half of their mother's volume each and end with the whole of "
      "it; the neighbours keep theirs.");
}

// Fig. 5: cross-sections with and without division, and the distance between the lips.
Figure division_sections(const Results& results) {
  std::vector<std::pair<std::string, Svg>> pictures;
  const ColourScale scale{"displacement from rest, um", 0, 90};
  for (const auto& [id, words] : {std::pair{"division", "with division"},
                                  {"division-without", "without"},
                                  {"division-twice", "with a second round"}}) {
    if (!results.has(id)) continue;
    const Frame frame = ReferenceRun(results.folder(id)).last_frame();
    pictures.emplace_back(fmt::format("{}, {}", words, minutes(*frame.time_s)),
                          sketch_section(frame, displacements(frame), scale, 0, 3, large_um_per_pixel));
  }
  return {"fig5-sections", strip(pictures, 3, scale).file("Cross-sections with and without division"),
          "**Fig. 5.** Cross-sections beside the middle, belly down: where the cells of the floor have divided and "
          "grown, and "
          "where they have not.",
          ""};
}

Figure division_lips(const Results& results) {
  Plot plot{"Distance between the lips, a fixed material pair", {"time, s"}, {"distance, um"}, {}, {}, {}};
  for (const auto& [id, words] : {std::pair{"division-without", "without division"},
                                  {"division", "with division of the floor"},
                                  {"division-twice", "with a second round at the borders"}})
    if (results.has(id))
      plot.curves.push_back(column_of(read_series(results.folder(id) / "series.csv"), words, "lip_distance_um"));
  return chart(
      "fig5-lips", plot,
      "**Fig. 5, lips.** Where the two points that bound the contractile rows in the mid cross-section are, with "
      "division and without.");
}

Figure division_push(const Results& results) {
  Plot plot{"Push of the furrow's cells on the row to their right", {"time, s"}, {"force across, nN"}, {}, {}, {}};
  for (const auto& [id, words] :
       {std::pair{"division-without", "without division"}, {"division", "with division of the floor"}})
    if (results.has(id))
      plot.curves.push_back(column_of(read_series(results.folder(id) / "series.csv"), words, "push.force_nN"));
  return chart(
      "fig5-push", plot,
      "**Fig. 5, forces.** What the contractile cells exert on the row of cells beside them, across the embryo; "
      "positive drives the borders apart. Dividing cells push outward at all times; the lips close because the "
      "floor between them buckles inward and turns them over.");
}

}  // namespace

std::vector<Figure> reproduction_figures(const Results& results, const Measured& measured) {
  std::vector<Figure> figures;
  // Pictures need frames, which a build without VTK neither writes nor reads.
  const auto picture = [&](bool possible, const auto& make) {
    try {
      if (possible) figures.push_back(make());
    } catch (const FileError&) {
    }
  };
  picture(results.has("division-demo"), [&] { return division_demo(results); });
  picture(results.has("division-demo"), [&] { return division_volumes(results); });
  const bool divided = results.has("division") && results.has("division-without");
  picture(divided, [&] { return division_sections(results); });
  picture(divided, [&] { return division_lips(results); });
  picture(divided, [&] { return division_push(results); });
  picture(results.has("main-pill"), [&] {
    return two_views(
        results, "main-pill", "fig7-pill", "The pill invaginates",
        "**Fig. 7.** The pill at four moments, seen from below and in front (upper row) and from below (lower "
        "row; anterior is on the left), coloured by how far nodes have moved.");
  });
  if (results.has("main-pill"))
    figures.push_back(
        speeds(results, "pill", "fig8a-speeds",
               "**Fig. 8a.** On the pill the end (VCE) sets off several times as fast as the middle (VML); the "
               "middle catches up, and overtakes. Both axes are logarithmic: the paper's are not."));
  if (results.has("main-sphere"))
    figures.push_back(
        speeds(results, "sphere", "fig8b-speeds",
               "**Fig. 8b.** On the sphere, with the same springs, the two are close to each other throughout."));
  picture(results.has("main-pill"), [&] { return sections(results); });
  picture(results.has("main-pill"), [&] { return ventral_strip(results); });
  picture(results.has("main-sphere"), [&] {
    return two_views(results, "main-sphere", "fig11-sphere", "The sphere invaginates",
                     "**Fig. 11.** The sphere at the same moments, from the same sides, in the same colours.");
  });
  const Mechanism why = mechanism();
  figures.push_back(
      chart("mechanism", why.plot,
            "**Why the ends lead** (section 4). At t = 0, before anything moves, springs of the same strength "
            "everywhere press the caps inwards harder than the cylinder, and a sphere everywhere "
            "alike, as Laplace's law has it. On the strip of the chosen reading the last cells are drawn "
            "along the axis as well. Springs along the axis alone do not press on the cylinder at all."));
  if (!measured.pill_onsets.ap_um.empty())
    figures.push_back(
        chart("onset", onset_plot(measured.pill_onsets, measured.sphere_onsets),
              "**Onset** along `midline.csv`: when each contractile cell of the midline has reached a tenth of "
              "its final depth below the shell."));
  if (const auto plot = trade_off(measured))
    figures.push_back(
        chart("trade-off", *plot,
              "**The trade-off.** The one number that is free once the pill's depth is met, the ratio of "
              "springs across the axis to springs along it, against everything printed. Nothing below 0.3 or "
              "above 0.4 meets the pill's speed ratio, VCE's displacement and the sphere's depth together."));
  return figures;
}

}  // namespace plica
