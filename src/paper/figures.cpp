#include <fmt/format.h>

#include <algorithm>

#include "core/errors.hpp"
#include "paper/mechanism.hpp"
#include "paper/pictures.hpp"
#include "paper/reproduce.hpp"
#include "show/chart.hpp"

namespace plica {
namespace {

// Fig. 8: speeds of both barycentres.
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

Plot onset_plot(const Onsets& pill, const Onsets& sphere) {
  return {"Onset of midline cells: a tenth of their final depth",
          {"place along the axis at rest, um"},
          {"time, s", false, 0.0, {}},
          {{"pill", pill.ap_um, pill.time_s, true}, {"sphere", sphere.ap_um, sphere.time_s, true}},
          {},
          {}};
}

// Effect of the ratio of springs across to along; figures relative to printed values.
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
  return chart("fig4-volumes", plot,
               "**Fig. 4, volumes.** Each daughter grows from half to all of the mother's volume; neighbours keep "
               "theirs.");
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
      "**Fig. 5, lips.** Distance between the furrow lips (borders of the contractile rows at x = 0), with and "
      "without division.");
}

Figure division_push(const Results& results) {
  Plot plot{"Push of the furrow's cells on the row to their right", {"time, s"}, {"force across, nN"}, {}, {}, {}};
  for (const auto& [id, words] :
       {std::pair{"division-without", "without division"}, {"division", "with division of the floor"}})
    if (results.has(id))
      plot.curves.push_back(column_of(read_series(results.folder(id) / "series.csv"), words, "push.force_nN"));
  return chart("fig5-push", plot,
               "**Fig. 5, forces.** Force of the contractile cells on the adjacent row, across the embryo; positive: "
               "outward. Dividing cells push outward at all times; the lips close because the furrow bottom buckles "
               "inward and tilts them.");
}

}  // namespace

std::vector<Figure> reproduction_figures(const Results& results, const Measured& measured,
                                         std::vector<std::string>& missing) {
  std::vector<Figure> figures;
  const auto add = [&](const char* name, std::initializer_list<const char*> runs, const auto& make) {
    if (!std::ranges::all_of(runs, [&](const char* run) { return results.has(run); })) return;
    try {
      figures.push_back(make());
    } catch (const FileError& error) {
      missing.push_back(fmt::format("{}: {}", name, error.what()));
    }
  };
  ReproductionPictures pictures(results);
  add("fig4-division", {"division-demo"}, [&] { return pictures.division_demo(); });
  add("fig4-volumes", {"division-demo"}, [&] { return division_volumes(results); });
  add("fig5-sections", {"division", "division-without"}, [&] { return pictures.division_sections(); });
  add("fig5-lips", {"division", "division-without"}, [&] { return division_lips(results); });
  add("fig5-push", {"division", "division-without"}, [&] { return division_push(results); });
  add("fig7-pill", {"main-pill"}, [&] {
    return pictures.moments("main-pill", {"antero-ventral", "ventral"}, {0, 60, 300, 900}, "fig7-pill",
                            "**Fig. 7.** Pill at four times, antero-ventral (upper row) and ventral view (lower row, "
                            "anterior left). Colour: displacement.");
  });
  add("fig8a-speeds", {"main-pill"}, [&] {
    return speeds(results, "pill", "fig8a-speeds",
                  "**Fig. 8a.** Pill: the end (VCE) starts several times as fast as the centre (VML), which later "
                  "overtakes it. Logarithmic axes, unlike the paper's.");
  });
  add("fig8b-speeds", {"main-sphere"}, [&] {
    return speeds(results, "sphere", "fig8b-speeds",
                  "**Fig. 8b.** Sphere with the same springs: both speeds are similar throughout.");
  });
  add("fig9-sections", {"main-pill"}, [&] {
    return pictures.moments(
        "main-pill", {"cross-section", "sagittal-section"}, {900}, "fig9-sections",
        "**Fig. 9.** Pill at 15 min, cross-section and sagittal section, ventral side down. Colour: "
        "displacement. In the chosen reading the centre has overtaken the ends by then.");
  });
  add("fig10-ventral", {"main-pill"}, [&] {
    return pictures.moments(
        "main-pill", {"ventral"}, {60, 300, 600, 900, 1200}, "fig10-ventral",
        "**Fig. 10.** Pill at 1 min and at the paper's times, ventral view. Colour: displacement. At "
        "1 min the ends of the strip have moved most; after 5 min mainly the centre deepens.");
  });
  add("fig11-sphere", {"main-sphere"}, [&] {
    return pictures.moments("main-sphere", {"antero-ventral", "ventral"}, {0, 60, 300, 900}, "fig11-sphere",
                            "**Fig. 11.** Sphere at the same times, same views and colours.");
  });
  const Mechanism why = mechanism();
  figures.push_back(
      chart("mechanism", why.plot,
            "**Why the ends lead** (section 4). At t = 0 equal springs everywhere press the caps inwards more than the "
            "cylinder, and a sphere uniformly, in agreement with Laplace's law. On the strip of the chosen reading "
            "the last cells are also pulled along the axis. Axial springs alone do not press on the cylinder."));
  if (!measured.pill_onsets.ap_um.empty())
    figures.push_back(chart("onset", onset_plot(measured.pill_onsets, measured.sphere_onsets),
                            "**Onset**: time at which each contractile midline cell reaches a tenth of its final depth "
                            "(`midline.csv`)."));
  if (const auto plot = trade_off(measured))
    figures.push_back(chart(
        "trade-off", *plot,
        "**Trade-off.** Ratio of springs across to springs along the axis, the only free parameter at a fixed depth "
        "of the pill, compared with all printed numbers. Only 0.35 to 0.4 meets the pill's speed ratio, VCE's "
        "displacement and the sphere's depth together."));
  return figures;
}

}  // namespace plica
