#include "study/compare_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace plica {
namespace {

using Json = nlohmann::ordered_json;

Json number(std::optional<double> value) { return value && std::isfinite(*value) ? Json(*value) : Json(nullptr); }

Json moment_json(const RunMoment& moment) {
  const auto text = [](const std::string& value) { return value.empty() ? Json(nullptr) : Json(value); };
  return {{"directory", moment.directory.string()},
          {"scenario", text(moment.scenario)},
          {"status", text(moment.status)},
          {"time_s", moment.time_s},
          {"nodes", moment.nodes},
          {"elements", moment.elements}};
}

Json distances_json(const Distances& distances) {
  return {{"mean_um", distances.mean}, {"rms_um", distances.rms}, {"max_um", distances.max}};
}

Json pair_json(const NumberPair& pair) {
  return {{"a", number(pair.a)}, {"b", number(pair.b)}, {"difference", number(pair.difference())}};
}

Json pairs_json(const std::vector<NumberPair>& pairs) {
  Json result = Json::object();
  for (const NumberPair& pair : pairs) result[pair.name] = pair_json(pair);
  return result;
}

constexpr int name_width = 36;

std::string cell(std::optional<double> value) {
  return value ? fmt::format("{:>15.7g}", *value) : fmt::format("{:>15}", "none");
}

std::string heading(const std::string& title, const std::vector<std::string>& columns) {
  std::string line = fmt::format("\n{:<{}}", title, name_width);
  for (const std::string& column : columns) line += fmt::format("{:>15}", column);
  return line + '\n';
}

std::string row(const std::string& name, const std::vector<std::optional<double>>& values,
                const std::string& remark = "") {
  std::string line = fmt::format("  {:<{}}", name, name_width - 2);
  for (const std::optional<double>& value : values) line += cell(value);
  return line + (remark.empty() ? "" : "  " + remark) + '\n';
}

std::string moment_line(char letter, const RunMoment& moment) {
  return fmt::format("{}  {}: {}{}, frame at {:g} s, {} elements, {} nodes\n", letter, moment.directory.string(),
                     moment.scenario.empty() ? "no summary" : moment.scenario,
                     moment.status.empty() ? "" : ", " + moment.status, moment.time_s, moment.elements, moment.nodes);
}

std::string same_line(std::size_t count) {
  return count == 0 ? "" : fmt::format("  {} more {} equal\n", count, count == 1 ? "is" : "are");
}

std::string distance_text(const Comparison& comparison) {
  std::string text;
  const auto distances = [&](const std::string& name, const Distances& d, const std::string& remark = "") {
    text += row(name, {d.mean, d.rms, d.max}, remark);
  };
  if (comparison.nodes) {
    text += heading("node by node", {"mean", "rms", "max"});
    distances("distance, um", comparison.nodes->distances,
              fmt::format("(node {})", comparison.nodes->farthest.number()));
    text += row("relative energy norm", {comparison.nodes->relative_energy_norm});
  } else {
    text += "\nThe meshes differ: no nodes to compare.\n";
  }
  text += heading("apical surfaces", {"mean", "rms", "max"});
  distances("from A to B, um", comparison.apical.a_to_b);
  distances("from B to A, um", comparison.apical.b_to_a);
  text += fmt::format("  {:<{}}{:>45.7g}\n", "Hausdorff distance, um", name_width - 2, comparison.apical.hausdorff);
  text += fmt::format("  facets are cut into triangles, exact to {:.2g} um\n", comparison.apical.facet_error);
  return text;
}

std::string keys_text(const std::vector<KeyDifference>& keys) {
  if (keys.empty()) return "";
  // As wide as its texts; numbers as those of the other tables.
  const auto value = [](const std::string& of_key) {
    if (of_key.empty()) return std::string("none");
    // Numbers, those of lists too.
    std::string text;
    for (const char* at = of_key.c_str(); *at != '\0';) {
      const bool begins = text.empty() || text.back() == '[' || text.back() == ' ';
      char* end = nullptr;
      const double number = begins && *at != ' ' ? std::strtod(at, &end) : 0;
      if (end != nullptr && end != at && (*end == '\0' || *end == ',' || *end == ']')) {
        text += fmt::format("{:.7g}", number);
        at = end;
      } else {
        text += *at++;
      }
    }
    return text;
  };
  std::size_t widest = name_width - 2, width = 13;
  for (const auto& [key, a, b] : keys) {
    widest = std::max(widest, key.size());
    width = std::max({width, value(a).size(), value(b).size()});
  }
  const auto line = [&](const std::string& name, const std::string& a, const std::string& b) {
    return fmt::format("{:<{}}  {:>{}}  {:>{}}\n", name, widest + 2, a, width, b, width);
  };
  std::string text = fmt::format("\n{}", line("keys of the scenario that differ", "A", "B"));
  for (const auto& [key, a, b] : keys) text += line(fmt::format("  {}", key), value(a), value(b));
  return text;
}

std::string pairs_text(const std::string& title, const std::vector<NumberPair>& pairs, bool all) {
  if (pairs.empty()) return "";
  std::string text = heading(title, {"A", "B", "A - B"});
  std::size_t same = 0;
  for (const NumberPair& pair : pairs) {
    if (all || !pair.same()) {
      text += row(pair.name, {pair.a, pair.b, pair.difference()});
    } else {
      ++same;
    }
  }
  return text + same_line(same);
}

std::string series_text(const std::vector<ColumnPair>& columns) {
  if (columns.empty()) return "";
  std::string text = heading("series.csv, at equal times", {"A's frame", "B's frame", "largest |A-B|", "at s"});
  std::size_t same = 0;
  for (const ColumnPair& column : columns) {
    if (column.at_time.same() && column.largest_difference.value_or(0) == 0) {
      ++same;
    } else {
      const std::optional<double> at_s = column.largest_difference ? std::optional(column.largest_at_s) : std::nullopt;
      text += row(column.at_time.name, {column.at_time.a, column.at_time.b, column.largest_difference, at_s});
    }
  }
  return text + same_line(same);
}

}  // namespace

Json comparison_json(const Comparison& comparison) {
  Json result;
  result["a"] = moment_json(comparison.a);
  result["b"] = moment_json(comparison.b);
  result["scenario"] = Json::object();
  const auto value = [](const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); };
  for (const auto& [key, a, b] : comparison.scenario) result["scenario"][key] = {{"a", value(a)}, {"b", value(b)}};
  result["same_mesh"] = comparison.nodes.has_value();
  result["nodes"] = nullptr;
  result["relative_energy_norm"] = nullptr;
  if (comparison.nodes) {
    result["nodes"] = distances_json(comparison.nodes->distances);
    result["nodes"]["farthest_node"] = comparison.nodes->farthest.number();
    result["relative_energy_norm"] = number(comparison.nodes->relative_energy_norm);
  }
  result["apical_surface"] = {{"a_to_b", distances_json(comparison.apical.a_to_b)},
                              {"b_to_a", distances_json(comparison.apical.b_to_a)},
                              {"hausdorff_um", comparison.apical.hausdorff},
                              {"facet_error_um", comparison.apical.facet_error}};
  result["geometry"] = pairs_json(comparison.geometry);
  result["summary"] = pairs_json(comparison.summary);
  result["series"] = Json::object();
  for (const ColumnPair& column : comparison.series) {
    Json pair = pair_json(column.at_time);
    pair["largest_difference"] = number(column.largest_difference);
    pair["largest_at_s"] = column.largest_difference ? Json(column.largest_at_s) : Json(nullptr);
    result["series"][column.at_time.name] = pair;
  }
  return result;
}

std::string comparison_text(const Comparison& comparison) {
  return moment_line('A', comparison.a) + moment_line('B', comparison.b) + keys_text(comparison.scenario) +
         distance_text(comparison) + pairs_text("at these frames", comparison.geometry, true) +
         series_text(comparison.series) + pairs_text("summary.json, at the runs' ends", comparison.summary, false);
}

}  // namespace plica
