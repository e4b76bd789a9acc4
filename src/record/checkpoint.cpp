#include "record/checkpoint.hpp"

#include <fmt/format.h>
#include <libdeflate.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <new>
#include <sstream>

#include "core/child_process.hpp"
#include "core/errors.hpp"

namespace plica {
namespace {

constexpr std::size_t trailer_bytes = 64;

std::uint32_t checksum(std::string_view bytes) { return libdeflate_crc32(0, bytes.data(), bytes.size()); }

// Trailer after the HDF5 file; readers of HDF5 ignore it.
std::string trailer(std::string_view image) {
  std::string text =
      fmt::format("\nplica checkpoint {} bytes {} crc32 {:08x}", checkpoint_format, image.size(), checksum(image));
  text.resize(trailer_bytes - 1, ' ');
  return text + "\n";
}

// One list of the contents of a checkpoint for writing and reading: take(name, value).

class Saving {
 public:
  explicit Saving(ArchiveWriter& archive) : archive_(archive) {}
  void operator()(const std::string& name, double value) { archive_.put(name, std::span(&value, 1)); }
  void operator()(const std::string& name, int value) { archive_.put(name, std::span<const int>(&value, 1)); }
  void operator()(const std::string& name, bool value) { (*this)(name, static_cast<int>(value)); }
  void operator()(const std::string& name, std::uint64_t value) { (*this)(name, static_cast<double>(value)); }
  void operator()(const std::string& name, const std::string& text) { archive_.put(name, std::span<const char>(text)); }
  void operator()(const std::string& name, const std::optional<double>& value) {
    archive_.put(name, std::span<const double>(value ? &*value : nullptr, value ? 1 : 0));
  }
  void operator()(const std::string& name, const std::vector<double>& values) { archive_.put(name, values); }
  void operator()(const std::string& name, const std::vector<int>& values) { archive_.put(name, values); }
  void operator()(const std::string& name, const std::vector<char>& values) { archive_.put(name, values); }
  /// Lengths of the lists, then all items.
  void operator()(const std::string& name, const std::vector<std::vector<double>>& lists) {
    std::vector<int> lengths;
    std::vector<double> all;
    for (const std::vector<double>& list : lists) {
      lengths.push_back(static_cast<int>(list.size()));
      all.insert(all.end(), list.begin(), list.end());
    }
    (*this)(name + "_lengths", lengths);
    (*this)(name, all);
  }
  void operator()(const std::string& name, const std::vector<EnergyFlow>& values) {
    std::vector<double> numbers;
    for (const auto& [active, stored, dissipated] : values) numbers.insert(numbers.end(), {active, stored, dissipated});
    archive_.put(name, numbers, 3);
  }
  void operator()(const std::string& name, const Vectors& values) {
    archive_.put(name, std::span(reinterpret_cast<const double*>(values.data()), 3 * values.size()), 3);
  }

 private:
  ArchiveWriter& archive_;
};

class Loading {
 public:
  explicit Loading(const ArchiveReader& archive) : archive_(archive) {}
  void operator()(const std::string& name, double& value) { value = one(name, archive_.doubles(name)); }
  void operator()(const std::string& name, int& value) { value = one(name, archive_.integers(name)); }
  void operator()(const std::string& name, bool& value) { value = one(name, archive_.integers(name)) != 0; }
  void operator()(const std::string& name, std::uint64_t& value) {
    const double number = one(name, archive_.doubles(name));
    constexpr double largest = 9007199254740992.0;  // largest range of exact integers in doubles
    if (!(number >= 0 && number <= largest && number == std::floor(number))) refuse(name);
    value = static_cast<std::uint64_t>(number);
  }
  void operator()(const std::string& name, std::string& text) {
    const std::vector<char> bytes = archive_.bytes(name);
    text.assign(bytes.begin(), bytes.end());
  }
  void operator()(const std::string& name, std::optional<double>& value) {
    const std::vector<double> values = archive_.doubles(name);
    value.reset();
    if (!values.empty()) value = one(name, values);
  }
  void operator()(const std::string& name, std::vector<double>& values) { values = archive_.doubles(name); }
  void operator()(const std::string& name, std::vector<int>& values) { values = archive_.integers(name); }
  void operator()(const std::string& name, std::vector<char>& values) { values = archive_.bytes(name); }
  void operator()(const std::string& name, std::vector<std::vector<double>>& lists) {
    const std::vector<double> all = archive_.doubles(name);
    lists.clear();
    auto from = all.begin();
    for (const int length : archive_.integers(name + "_lengths")) {
      if (length < 0 || length > all.end() - from) refuse(name);
      lists.emplace_back(from, from + length);
      from += length;
    }
    if (from != all.end()) refuse(name);
  }
  void operator()(const std::string& name, std::vector<EnergyFlow>& values) {
    const std::vector<double> numbers = archive_.doubles(name);
    if (numbers.size() % 3 != 0) refuse(name);
    values.clear();
    for (std::size_t i = 0; i < numbers.size(); i += 3) values.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
  }
  void operator()(const std::string& name, Vectors& values) {
    const std::vector<double> numbers = archive_.doubles(name);
    if (numbers.size() % 3 != 0) refuse(name);
    values.clear();
    for (std::size_t i = 0; i < numbers.size(); i += 3) values.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
  }

  [[noreturn]] static void refuse(const std::string& name) {
    throw FileError(fmt::format("it is damaged: {} is invalid", name));
  }

 private:
  template <class Number>
  static Number one(const std::string& name, const std::vector<Number>& values) {
    if (values.size() != 1) refuse(name);
    return values.front();
  }
  const ArchiveReader& archive_;
};

template <class Take, class AnyCheckpoint>
void visit(Take& take, AnyCheckpoint& checkpoint) {
  take("program", checkpoint.program);
  take("scenario", checkpoint.scenario);
  take("at_rest", checkpoint.at_rest);
  auto& run = checkpoint.run;
  auto& state = run.state;
  take("state/positions", state.positions);
  take("state/multipliers", state.multipliers);
  take("state/contact_forces", state.contact_forces);
  take("state/in_contact", state.in_contact);
  take("state/time_s", state.time_s);
  take("state/velocities", state.velocities);
  take("state/divided_until_s", state.divided_until_s);
  take("state/trend/step_s", state.trend.step_s);
  take("state/trend/earlier_s", state.trend.earlier_s);
  take("state/trend/mean_velocities", state.trend.mean_velocities);
  take("state/trend/accelerations", state.trend.accelerations);
  take("state/trend/multiplier_rates", state.trend.multiplier_rates);
  take("state/internals", state.internals);
  take("run/steps", run.steps);
  take("run/divisions", run.divisions);
  take("run/equilibrium_time_s", run.equilibrium_time_s);
  take("run/at_equilibrium", run.at_equilibrium);
  take("run/criterion_met", run.criterion_met);
  take("run/wanted_step_s", run.wanted_step_s);
  take("run/pace/since_s", run.pace.since_s);
  take("run/pace/steps", run.pace.steps);
  take("run/pace/iterations", run.pace.iterations);
  take("run/computing_s", run.computing_s);
  take("run/energies", run.energies);
  take("run/whole_internals", run.whole_internals);
  auto& record = checkpoint.record;
  take("record/series_bytes", record.series_bytes);
  take("record/lineage_bytes", record.lineage_bytes);
  take("record/midline_bytes", record.midline_bytes);
  take("record/section_bytes", record.section_bytes);
  take("record/cells_bytes", record.cells_bytes);
  take("record/frame_times_s", record.frame_times_s);
  take("record/wall_s", record.wall_s);
  take("record/solver_s", record.solver_s);
}

std::string in_lines(const std::vector<std::string>& texts) {
  std::string lines;
  for (const std::string& text : texts) lines += text + "\n";
  return lines;
}

std::vector<std::string> of_lines(const std::string& lines) {
  std::vector<std::string> texts;
  for (std::size_t at = 0, end = 0; (end = lines.find('\n', at)) != std::string::npos; at = end + 1)
    texts.push_back(lines.substr(at, end - at));
  return texts;
}

// Rows: one number per column, then one per monitor, each with a flag for presence. Column names are stored, too, so
// that rows of another table are refused instead of misread.
void save_rows(ArchiveWriter& archive, const std::vector<Observation>& rows) {
  std::vector<double> numbers;
  std::vector<char> has;
  for (const Observation& row : rows)
    for (const auto* values : {&row.values, &row.monitors})
      for (const std::optional<double>& value : *values)
        numbers.push_back(value.value_or(0)), has.push_back(value ? 1 : 0);
  const std::size_t monitors = rows.empty() ? 0 : rows.back().monitors.size();
  archive.put("record/rows", numbers, rows.empty() ? 0 : numbers.size() / rows.size());
  archive.put("record/has", has);
  Saving save(archive);
  save("record/columns", in_lines(names_of(columns())));
  save("record/monitors", static_cast<int>(monitors));
  save("record/criteria_met", in_lines(rows.empty() ? std::vector<std::string>() : rows.back().criteria_met));
}

bool is_count(double number) { return std::abs(number) <= 1e9 && number == std::floor(number); }

std::vector<Observation> load_rows(const ArchiveReader& archive) {
  const std::vector<double> numbers = archive.doubles("record/rows");
  const std::vector<char> has = archive.bytes("record/has");
  int monitors = 0;
  std::string names, criteria;
  Loading load(archive);
  load("record/columns", names);
  load("record/monitors", monitors);
  load("record/criteria_met", criteria);
  if (of_lines(names) != names_of(columns()))
    throw FileError("it was written by another version of plica with other columns");
  const std::size_t fixed = columns().size(), width = fixed + static_cast<std::size_t>(std::max(monitors, 0));
  if (numbers.empty() || numbers.size() % width != 0 || has.size() != numbers.size()) Loading::refuse("record/rows");
  std::vector<Observation> rows(numbers.size() / width);
  for (std::size_t at = 0; at < numbers.size(); ++at) {
    const std::size_t c = at % width;
    const std::optional<double> value = has[at] != 0 ? std::optional(numbers[at]) : std::nullopt;
    Observation& row = rows[at / width];
    if (c < fixed && columns()[c].is_count && !is_count(numbers[at])) Loading::refuse("record/rows");
    if (c < fixed)
      row.values[c] = value;
    else
      row.monitors.push_back(value);
  }
  rows.back().criteria_met = of_lines(criteria);
  return rows;
}

void save_divisions(ArchiveWriter& archive, const std::vector<std::shared_ptr<const PastDivision>>& past) {
  Saving save(archive);
  save("divisions/count", static_cast<int>(past.size()));
  for (std::size_t d = 0; d < past.size(); ++d) {
    const std::string at = fmt::format("divisions/{}/", d);
    std::vector<int> cells, first_walls, second_walls;
    std::vector<double> growth_s, volume_ratios;
    for (const PlannedDivision& one : past[d]->planned) {
      cells.push_back(one.cut.cell.number());
      first_walls.push_back(one.cut.first_wall), second_walls.push_back(one.cut.second_wall);
      growth_s.push_back(one.growth_s), volume_ratios.push_back(one.volume_ratio);
    }
    save(at + "time_s", past[d]->time_s), save(at + "positions", past[d]->positions);
    save(at + "cells", cells), save(at + "first_walls", first_walls), save(at + "second_walls", second_walls);
    save(at + "growth_s", growth_s), save(at + "volume_ratios", volume_ratios);
  }
}

std::vector<std::shared_ptr<const PastDivision>> load_divisions(const ArchiveReader& archive) {
  Loading load(archive);
  std::vector<std::shared_ptr<const PastDivision>> past;
  int count = 0;
  load("divisions/count", count);
  for (int d = 0; d < count; ++d) {
    const std::string at = fmt::format("divisions/{}/", d);
    PastDivision one;
    std::vector<int> cells, first_walls, second_walls;
    std::vector<double> growth_s, volume_ratios;
    load(at + "time_s", one.time_s), load(at + "positions", one.positions);
    load(at + "cells", cells), load(at + "first_walls", first_walls), load(at + "second_walls", second_walls);
    load(at + "growth_s", growth_s), load(at + "volume_ratios", volume_ratios);
    if (first_walls.size() != cells.size() || second_walls.size() != cells.size() || growth_s.size() != cells.size() ||
        volume_ratios.size() != cells.size())
      Loading::refuse(at + "cells");
    for (std::size_t i = 0; i < cells.size(); ++i)
      one.planned.push_back({{CellId(cells[i]), first_walls[i], second_walls[i]}, growth_s[i], volume_ratios[i]});
    past.push_back(std::make_shared<const PastDivision>(std::move(one)));
  }
  return past;
}

// Absent from checkpoints of runs without such arrays.
void save_arrays(ArchiveWriter& archive, const std::map<std::string, CellArray>& arrays) {
  if (arrays.empty()) return;
  Saving save(archive);
  save("run/outside_names", in_lines(keys_of(arrays)));
  std::vector<std::vector<double>> values;
  for (const auto& [name, list] : arrays) values.push_back(list);
  save("run/outside_values", values);
}

std::map<std::string, CellArray> load_arrays(const ArchiveReader& archive) {
  std::map<std::string, CellArray> arrays;
  if (!archive.has("run/outside_names")) return arrays;
  Loading load(archive);
  std::string names;
  std::vector<std::vector<double>> values;
  load("run/outside_names", names);
  load("run/outside_values", values);
  const std::vector<std::string> lines = of_lines(names);
  if (lines.size() != values.size()) Loading::refuse("run/outside_names");
  for (std::size_t a = 0; a < lines.size(); ++a) arrays[lines[a]] = std::move(values[a]);
  return arrays;
}

/// Limit of processor time: some seconds, plus one per 10 MB, a hundred times the usual duration.
void limit_time(std::size_t bytes) {
  const rlim_t seconds = 3 + bytes / 10'000'000;
  const rlimit limit{seconds, seconds + 1};
  ::setrlimit(RLIMIT_CPU, &limit);
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
}

}  // namespace

void read_on_trial(const std::function<void()>& read, std::size_t bytes) {
  // Answer: a letter for its kind, then the error.
  const std::optional<std::string> answer = output_of_child("the trial reading of a checkpoint", [&]() -> std::string {
    limit_time(bytes);
    try {
      read();
      return "r";
    } catch (const FileError& error) {
      return std::string("f") + error.what();
    } catch (const std::bad_alloc&) {
      return "m";
    }
  });
  if (!answer || answer->empty()) throw FileError("it is damaged: HDF5 crashed while reading it");
  if (answer->front() == 'f') throw FileError(answer->substr(1));
  if (answer->front() == 'm') throw std::bad_alloc();
}

std::string fingerprint(const Tissue& tissue) {
  std::uint32_t sum = 0;
  const auto add = [&](const void* bytes, std::size_t count) { sum = libdeflate_crc32(sum, bytes, count); };
  add(tissue.rest_positions.data(), tissue.rest_positions.size() * sizeof(Vec3));
  add(tissue.elements.data(), tissue.elements.size() * sizeof(tissue.elements.front()));
  add(tissue.element_cell.data(), tissue.element_cell.size() * sizeof(CellId));
  return fmt::format("{} nodes, {} elements, {} cells, crc32 {:08x}", tissue.node_count(), tissue.elements.size(),
                     tissue.cells.size(), sum);
}

std::string CheckpointBytes::operator()(const Checkpoint& checkpoint) {
  constexpr std::size_t most_kept_bytes = std::size_t{32} << 20;
  auto archive = archive_ ? std::move(archive_) : std::make_unique<ArchiveWriter>();  // none is reused after errors
  Saving save(*archive);
  save("format", checkpoint_format);
  visit(save, checkpoint);
  save_divisions(*archive, checkpoint.run.past_divisions);
  save_rows(*archive, checkpoint.record.rows);
  save_arrays(*archive, checkpoint.run.outside_arrays);
  std::string bytes = archive->image();
  if (bytes.size() <= most_kept_bytes) archive_ = std::move(archive);
  return bytes += trailer(bytes);
}

std::string checkpoint_bytes(const Checkpoint& checkpoint) { return CheckpointBytes()(checkpoint); }

Checkpoint read_checkpoint_bytes(std::string_view bytes) {
  if (bytes.size() < trailer_bytes) throw FileError("it is not a checkpoint, or truncated");
  const std::string_view image = bytes.substr(0, bytes.size() - trailer_bytes), end = bytes.substr(image.size());
  constexpr std::string_view start = "\nplica checkpoint ";
  if (!end.starts_with(start)) throw FileError("it is not a checkpoint, or truncated");
  if (end.substr(start.size(), 2) != fmt::format("{} ", checkpoint_format))
    throw FileError(
        fmt::format("it was written by another version of plica in a format other than {}", checkpoint_format));
  if (end != trailer(image)) throw FileError("it is damaged: its checksum does not match its content");
  const auto read = [&] {
    const ArchiveReader archive(image);
    Loading load(archive);
    Checkpoint checkpoint;
    checkpoint.record.rows = load_rows(archive);  // first: they reveal another version
    visit(load, checkpoint);
    checkpoint.run.past_divisions = load_divisions(archive);
    checkpoint.run.outside_arrays = load_arrays(archive);
    return checkpoint;
  };
  read_on_trial([&] { (void)read(); }, image.size());
  return read();
}

namespace {

// Whether a resumption may change this table of a scenario.
bool may_change(std::string_view table) {
  return table == "[time]" || table == "[output]" || table == "[stop]" || table.starts_with("[stop.");
}

// Lines of a resolved scenario in the tables selected by `counts`, each preceded by the name of its table.
std::vector<std::string> lines_in(const std::string& scenario, const std::function<bool(std::string_view)>& counts) {
  std::vector<std::string> kept;
  std::string table;
  std::istringstream stream(scenario);
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with('['))
      table = line;
    else if (counts(table) && !line.empty() && !line.starts_with('#'))
      kept.push_back(table.empty() ? line : fmt::format("{} {}", table, line));
  }
  return kept;
}

}  // namespace

std::optional<std::string> other_scenario(const std::string& before, const std::string& now) {
  const auto counts = [](std::string_view table) { return !may_change(table); };
  const std::vector<std::string> a = lines_in(before, counts), b = lines_in(now, counts);
  const auto [in_a, in_b] = std::ranges::mismatch(a, b);
  if (in_a == a.end() && in_b == b.end()) return std::nullopt;
  const std::string was = in_a == a.end() ? "nothing" : *in_a, is = in_b == b.end() ? "nothing" : *in_b;
  return fmt::format("it has {}, this one has {}", was, is);
}

bool other_stop(const std::string& before, const std::string& now) {
  const auto counts = [](std::string_view table) { return table.starts_with("[stop"); };
  return lines_in(before, counts) != lines_in(now, counts);
}

}  // namespace plica
