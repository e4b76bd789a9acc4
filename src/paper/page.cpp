#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "core/version.hpp"
#include "paper/claims.hpp"
#include "paper/reproduce.hpp"

namespace plica {
namespace {

// Four digits, or more if needed to distinguish it from a nearby integer.
std::string number(std::optional<double> value, const std::string& none = "never") {
  if (!value) return none;
  if (std::abs(*value - 1) < 1e-6 && *value != 1)
    return fmt::format("1 {} {:.1e}", *value > 1 ? "+" : "-", std::abs(*value - 1));
  return std::abs(*value) >= 1e4 ? fmt::format("{:.0f}", *value) : fmt::format("{:.4g}", *value + 0.0);
}

std::string signed_number(double value) {
  if (value == 0) return "0";
  return std::abs(value) >= 1e3 ? fmt::format("{:+.0f}", value) : fmt::format("{:+.3g}", value);
}

std::string with_unit(const std::string& text, const std::string& unit) {
  return unit.empty() || text.empty() || !std::isdigit(static_cast<unsigned char>(text.back())) ? text
                                                                                                : text + " " + unit;
}

// Ids of the runs of figures: the part before the first dot.
std::string group_of(const std::string& figure) { return figure.substr(0, figure.find('.')); }

bool group_was_measured(const Figures& figures, const std::string& group) {
  return std::ranges::any_of(figures, [&](const auto& entry) { return group_of(entry.first) == group; });
}

std::vector<std::string> claim_row(const Claim& claim, const Measured& measured, ReproduceOutcome& outcome) {
  const std::optional<double> ours = figure_named(measured.figures, claim.figure);
  std::vector<std::optional<double>> scanned;
  for (const PaperReading& reading : readings()) {
    const auto found = measured.readings.find(reading.id);
    if (reading.options.scanned && found != measured.readings.end())
      scanned.push_back(figure_named(found->second, claim.figure));
  }
  const Verdict found = verdict(claim, ours, scanned);
  ++outcome.claims;
  if (found == Verdict::reproduced) ++outcome.reproduced;
  if (found == Verdict::under_this_reading) ++outcome.under_this_reading;
  const std::string difference = ours && claim.value ? signed_number(*ours - *claim.value) : "";
  return {claim.section,
          claim.text,
          with_unit(claim.printed, claim.unit),
          with_unit(number(ours), claim.unit),
          difference,
          word_of(found),
          found == Verdict::not_reproduced ? claim.cause : claim.remark};
}

void add_claims(Document& page, const Measured& measured, ReproduceOutcome& outcome) {
  Table table{{"section", "claim, in our words", "printed", "ours", "difference", "verdict", "cause or remark"}, {}};
  std::vector<std::string> left_out;
  for (const Claim& claim : claims()) {
    if (group_was_measured(measured.figures, group_of(claim.figure)))
      table.rows.push_back(claim_row(claim, measured, outcome));
    else
      left_out.push_back(fmt::format("{} ({})", claim.text, claim.section));
  }
  page.blocks.emplace_back(Heading{2, "Claims"});
  page.blocks.emplace_back(Paragraph{
      "Measurable statements of the paper's sections 2 to 5. Verdicts follow from our figure and the tolerance of "
      "the claim: *reproduced*: met in every scanned reading (across/along 0.2 to 1; 3, 5 and 7 rows), or a "
      "count or invariant; *reproduced under this reading*: met in the chosen reading but not in all scanned "
      "ones, or fitted; *not reproduced*: otherwise. For printed ranges, the difference is to the middle."});
  page.blocks.emplace_back(Paragraph{fmt::format(
      "Of {} claims, {} are reproduced, {} under this reading, and {} are not.", outcome.claims, outcome.reproduced,
      outcome.under_this_reading, outcome.claims - outcome.reproduced - outcome.under_this_reading)});
  page.blocks.emplace_back(std::move(table));
  if (left_out.empty()) return;
  std::string text = "Not measured, since runs are missing:";
  for (const std::string& claim : left_out) text += (&claim == &left_out.front() ? " " : "; ") + claim;
  page.blocks.emplace_back(Paragraph{text + "."});
}

void add_readings(Document& page, const Measured& measured, const Plan& plan) {
  struct Row {
    double rms;
    std::vector<std::string> cells;
  };
  std::vector<Row> rows;
  std::vector<std::string> absent;
  for (const PaperReading& reading : readings()) {
    const auto found = measured.readings.find(reading.id);
    const auto skipped = plan.skipped.find(reading.id + "-pill");
    if (skipped != plan.skipped.end())
      absent.push_back(fmt::format("{}, {}: {}", reading.group, reading.text, skipped->second));
    if (found == measured.readings.end()) continue;
    const Figures& figures = found->second;
    const auto shown = [&](const std::string& name, double factor = 1) {
      const auto value = figure_in(reading, name, figures);
      return number(value ? std::optional(*value * factor) : value, "–");
    };
    const std::optional<Score> scored = score(reading, figures);
    rows.push_back(
        {scored ? scored->rms : 1e9,
         {reading.group, reading.text, scored ? fmt::format("{:.2f}", scored->rms) : "–",
          scored ? fmt::format("{} of {}", scored->met, printed_numbers().size()) : "–",
          shown("pill.depth_um") + ", " + shown("sphere.depth_um"),
          number(figure_named(figures, "pill.depth_below_lips_um"), "–"), shown("pill.vml_area_loss_percent"),
          shown("pill.peak_ratio") + ", " + shown("sphere.peak_ratio"),
          shown("pill.vml_at_equal_um") + ", " + shown("pill.vce_at_equal_um"), shown("pill.rest_min"),
          shown("pill.equal_speeds_s"), shown("pill.peak_ratio_time_s") + ", " + shown("sphere.peak_ratio_time_s")}});
  }
  std::ranges::stable_sort(rows, {}, &Row::rms);
  Table table{{"varied", "reading", "score", "met", "depth, um: pill, sphere", "pill below lips, um",
               "VML area loss, %", "speed ratio: pill, sphere", "VML, VCE at equal speeds, um", "pill at rest, min",
               "speeds equal, s", "largest difference, s: pill, sphere"},
              {}};
  table.rows.push_back({"", "the paper", "0", fmt::format("{0} of {0}", printed_numbers().size()), "28.89, 27.44", "",
                        "30", "3.65, 1.23", "7–10, 13–17", "15", "900", "30, 30"});
  for (Row& row : rows) table.rows.push_back(std::move(row.cells));
  page.blocks.emplace_back(Heading{2, "Readings"});
  std::string text = fmt::format(
      "Readings that the text allows, each with one choice changed from the chosen reading, best score first. Score: "
      "root "
      "mean square over {} printed numbers of |ours - printed| / tolerance (for a range: from its middle, divided by "
      "half "
      "its width), each at most {:.0f}; a number is met up to 1. Events that never happen count as {:.0f}. The "
      "numbers:",
      printed_numbers().size(), largest_miss, largest_miss);
  for (const PrintedNumber& printed : printed_numbers())
    text += (&printed == &printed_numbers().front() ? " " : "; ") + printed.text;
  page.blocks.emplace_back(Paragraph{text + "."});
  page.blocks.emplace_back(
      Paragraph{fmt::format("Stiffness k (nN/um), where given, is fitted to a depth of the pill of 28.89 um; else "
                            "4.82. The pre-tension is 60 nN "
                            "for 4.82 nN/um and proportional to k, unless given. The step tolerance is {} um here and "
                            "0.02 um elsewhere; compare "
                            "the chosen row with the headlines below.",
                            matrix_tolerance_um)});
  page.blocks.emplace_back(std::move(table));
  for (const std::string& one : absent) page.blocks.emplace_back(Paragraph{"Not in this build: " + one + "."});
}

void add_error_bars(Document& page, const Measured& measured) {
  struct Headline {
    const char *name, *text, *unit, *printed;
  };
  constexpr std::array headlines = {
      Headline{"depth_um", "depth from the shell", "um", "28.89; 27.44"},
      Headline{"vml_area_loss_percent", "area loss of VML", "%", "30; –"},
      Headline{"rest_min", "at rest", "min", "15; –"},
      Headline{"peak_ratio", "speed ratio at the largest difference", "", "3.65; 1.23"},
      Headline{"vml_at_equal_um", "VML displaced at equal speeds", "um", "7–10; –"},
      Headline{"vce_at_equal_um", "VCE displaced at equal speeds", "um", "13–17; –"},
  };
  Table table{{"headline", "printed (pill; sphere)", "pill", "error in space", "error in time", "sphere",
               "error in space", "error in time"},
              {}};
  const Figures& figures = measured.figures;
  for (const Headline& headline : headlines) {
    std::vector<std::string> row = {
        headline.unit[0] ? fmt::format("{}, {}", headline.text, headline.unit) : headline.text, headline.printed};
    for (const std::string embryo : {"pill", "sphere"}) {
      const auto value = [&](const std::string& which) {
        return figure_named(figures, which + embryo + "." + headline.name);
      };
      const auto difference = [&](const std::string& fine, const std::string& coarse) {
        const auto a = value(fine), b = value(coarse);
        return a && b ? fmt::format("{:+.2g}", *a - *b) : std::string("–");
      };
      row.push_back(number(value(""), "–"));
      row.push_back(difference("fine-space-", "chosen-"));
      row.push_back(difference("fine-time-", ""));
    }
    table.rows.push_back(std::move(row));
  }
  page.blocks.emplace_back(Heading{2, "Headlines with their errors"});
  page.blocks.emplace_back(Paragraph{fmt::format(
      "Error in space: 2 x 2 x 2 elements per cell minus one element per cell, with equal springs and a step "
      "tolerance of {} um (difference, not extrapolated). Error in time: tolerance of {} um minus 0.02 um. The "
      "stiffness was fitted with one element per cell, which is too soft in apical compression; with more "
      "elements it would be fitted again, so most of the difference in depth is due to the calibration.",
      matrix_tolerance_um, fine_tolerance_um)});
  page.blocks.emplace_back(std::move(table));
}

void add_figures(Document& page, const Results& results, const Measured& measured, ReproduceOutcome& outcome) {
  page.blocks.emplace_back(Heading{2, "Figures"});
  std::vector<Figure> figures = reproduction_figures(results, measured, outcome.missing_figures);
  for (const std::string& one : outcome.missing_figures) page.blocks.emplace_back(Paragraph{"Missing: " + one + "."});
  for (Figure& figure : figures) page.blocks.emplace_back(std::move(figure));
}

}  // namespace

Document reproduction_document(const Results& results, const Measured& measured, const Plan& plan, bool quick,
                               ReproduceOutcome& outcome) {
  Document page{"Reproduction of the paper", {}};
  page.blocks.emplace_back(Paragraph{
      fmt::format("Demongeot, Lontos and Promayon, *Discrete mesh approach in morphogenesis modelling: the example of "
                  "gastrulation*, compared with plica {} ({}). The chosen reading is the built-in `drosophila`, and "
                  "`xenopus` with the same springs, drag and material: 5 rows, across/along 0.35, k = 4.82 nN/um and a "
                  "preload of 60 nN, drag 131 Pa s/um. Runs are in `runs/`, plot data in `figures/`.{}",
                  version(), commit(),
                  quick ? " **Quick run: few runs, coarse steps; figures are off by several per cent.**" : "")});
  add_claims(page, measured, outcome);
  add_error_bars(page, measured);
  add_readings(page, measured, plan);
  for (const auto& [id, why] : plan.skipped)
    if (id.starts_with("division"))
      page.blocks.emplace_back(Paragraph{fmt::format("Not in this build: {}: {}.", id, why)});
  add_figures(page, results, measured, outcome);
  return page;
}

}  // namespace plica
