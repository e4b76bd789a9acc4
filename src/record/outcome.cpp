#include "record/outcome.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <vector>

#include "core/words.hpp"
#include "record/results.hpp"
#include "scenario/embryo_axes.hpp"
#include "simulation/run_warnings.hpp"

namespace plica {
namespace {

using Json = nlohmann::ordered_json;

constexpr double least_change = 0.005;  // smallest reported change of a ratio

// Parts of the line; values that the run lacks are left out.
class Parts {
 public:
  explicit Parts(const Json& summary) : summary_(summary) {}

  void value(const char* words, const char* key, const char* unit = "", const char* after = "") {
    if (const auto number = number_of(summary_, key)) text(fmt::format("{} {:.2f}{}{}", words, *number, unit, after));
  }
  void change(const char* words, const char* key) {
    if (std::abs(number_of(summary_, key).value_or(1) - 1) > least_change) value(words, key);
  }
  void text(std::string part) { parts_.push_back(std::move(part)); }
  [[nodiscard]] std::string line() const { return fmt::format("{}", fmt::join(parts_, ", ")); }

 private:
  const Json& summary_;
  std::vector<std::string> parts_;
};

void add_furrow(const Json& summary, Parts& parts) {
  parts.value("furrow depth", "furrow_depth_um", " um");
  parts.value("apical area ratio", "vml_apical_area_ratio", "", " (midline centre)");
  parts.value("peak speed ratio", "peak_speed_ratio", "", " (end/centre)");
  const auto closed = number_of(summary, "lips_closed"), closed_s = number_of(summary, "lips_closed_time_s");
  if (closed && closed_s)
    parts.text(fmt::format("lips {} at {}", *closed == 1 ? "closed" : "open again, closed", moment(*closed_s)));
  else if (closed)
    parts.text("lips open");
}

}  // namespace

std::string outcome_text(const Scenario& scenario, const Tissue& tissue, const Json& summary) {
  Parts parts(summary);
  if (have_furrow(axes_of(scenario.embryo)) && number_of(summary, "furrow_depth_um")) {
    add_furrow(summary, parts);
  } else {
    parts.value("fold depth", "furrow_depth_um", " um");
    parts.value("largest displacement", "max_displacement_um", " um");
    parts.value("smallest apical area ratio", "min_apical_area_ratio");
    parts.change("lumen volume ratio", "lumen_volume_ratio");
  }
  if (const auto divisions = number_of(summary, "divisions").value_or(0); divisions > 0)
    parts.text(fmt::format("{} cells after {} division{}", tissue.cells.size(), divisions, divisions == 1 ? "" : "s"));
  parts.change("tissue volume ratio", "tissue_volume_ratio");
  return parts.line();
}

std::string crossing_text(const Scenario& scenario, const Json& summary) {
  const auto time_s = number_of(summary, "self_intersections_time_s");
  if (!time_s) return "";
  return fmt::format("self-intersects since {} ({} pairs of faces at most); later results are unphysical{}",
                     moment(*time_s), summary.at("self_intersections").get<int>(), crossing_remedy(scenario));
}

}  // namespace plica
