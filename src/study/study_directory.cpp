#include "study/study_directory.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>

#include "core/errors.hpp"
#include "core/numbers.hpp"
#include "core/version.hpp"
#include "record/run_directory.hpp"
#include "record/summary.hpp"
#include "scenario/print.hpp"
#include "study/csv_fields.hpp"

namespace plica {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

std::string resolved_scenario(const StudyInput& input) {
  try {
    return resolved_toml(load_scenario(input.scenario, input.overrides));
  } catch (const ScenarioError&) {  // points repair it
    return input.scenario.text;
  }
}

std::string this_plica() { return fmt::format("{} ({}, {})", version(), commit(), compiler()); }

void require_same_plica(const fs::path& directory, const Json& begun) {
  const std::string with = begun.value("plica", "");
  if (with != this_plica())
    throw UsageError(
        fmt::format("{}: begun by plica {}, but this is {}; rows of two versions are not mixed: continue "
                    "with the former, or restart with --overwrite",
                    directory.string(), with, this_plica()));
}

constexpr const char* change_back = "revert the change, restart with --overwrite, or give another --out";

// Refuse a change of more than comments or blanks since the start, with the first key and both values.
void require_unchanged(const fs::path& file, const std::string& now, const std::string& what, const char* since) {
  const std::vector<KeyDifference> all = scenario_differences(read_file(file), now);
  if (all.empty()) return;
  const std::string others = all.size() > 1 ? fmt::format(" (and {} more)", all.size() - 1) : "";
  throw UsageError(fmt::format("{}: the {} has changed since {}: {}{}; {}", file.parent_path().string(), what, since,
                               all.front().text(), others, change_back));
}

void require_same_scenario(const fs::path& directory, const StudyInput& input) {
  require_unchanged(directory / "scenario.toml", resolved_scenario(input), "scenario " + input.scenario.file,
                    "the start of the study");
}

// Files of a study killed at its start.
constexpr std::array<std::string_view, 5> first_files = {"rows", "study.toml", "scenario.toml", "points.csv",
                                                         "study.json"};

// Complete rows of a file: "run,row".
void read_rows(const fs::path& file, StudyRows& rows, std::size_t runs) {
  const std::string text = read_file(file);
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    if (end == std::string::npos) return;  // was being written when its process was killed
    std::size_t run = 0;
    const auto [comma, error] = std::from_chars(text.data() + begin, text.data() + end, run);
    if (error == std::errc() && *comma == ',' && run < runs)
      rows.try_emplace(run, text.substr(static_cast<std::size_t>(comma + 1 - text.data()),
                                        static_cast<std::size_t>(text.data() + end - comma - 1)));
    begin = end + 1;
  }
}

}  // namespace

StudyDirectory StudyDirectory::begin(const fs::path& directory, const Study& study, Start start) {
  StudyDirectory result(directory);
  const StudyInput& input = study.input();
  const bool holds_one = is_there(directory / "study.json");
  if (holds_one && start == Start::resumed) {
    require_same_plica(directory, result.begun());
    require_unchanged(directory / "study.toml", input.text, "study " + input.file, "its start");
    require_same_scenario(directory, input);
    if (read_file(directory / "points.csv") != points_csv(study.design()))
      throw UsageError(fmt::format("{}: the points of the study, or their order, have changed since its start; {}",
                                   directory.string(), change_back));
    return result;
  }
  if (holds_one && start == Start::fresh)
    throw UsageError(
        directory.string() +
        ": contains a study; continue it with --resume, replace it with --overwrite, or give another --out");
  if (!holds_one && holds_other_files(directory, first_files))
    throw UsageError(directory.string() + ": exists and contains no study; give another --out");
  make_directory(directory);
  std::error_code ignored;
  for (const char* name : {"study.json", "rows", "points", "unfinished", "slurm", "runs.csv", "report.html"})
    fs::remove_all(directory / name, ignored);
  make_directory(directory / "rows");
  write_file(directory / "study.toml", input.text);
  write_file(directory / "scenario.toml", resolved_scenario(input));
  write_file(directory / "points.csv", points_csv(study.design()));
  const Json begun = {{"format", 1},
                      {"plica", this_plica()},
                      {"processor", processor_name()},
                      {"name", input.name},
                      {"file", fs::absolute(input.file).lexically_normal().string()},
                      {"runs", study.runs()},
                      {"keys", study.design().keys},
                      {"measures", study.measures()}};
  write_file(directory / "study.json", begun.dump(2) + '\n');
  return result;
}

StudyDirectory StudyDirectory::look(const fs::path& directory) {
  if (!is_there(directory / "study.json"))
    throw FileError(directory.string() + ": contains no study; create one with plica study STUDY.toml --out DIR");
  return StudyDirectory(directory);
}

std::pair<StudyDirectory, Study> StudyDirectory::open(const fs::path& directory) {
  StudyDirectory result = look(directory);
  const Json begun = result.begun();
  StudyInput input =
      parse_study(begun.value("name", "study"), begun.value("file", "study.toml"), read_file(directory / "study.toml"));
  return {std::move(result), Study(std::move(input), points_of_csv(read_file(directory / "points.csv")),
                                   begun.value("measures", std::vector<std::string>{}))};
}

std::pair<StudyDirectory, Study> StudyDirectory::open_to_run(const fs::path& directory) {
  auto opened = open(directory);
  require_same_plica(directory, opened.first.begun());
  require_same_scenario(directory, opened.second.input());
  return opened;
}

Json StudyDirectory::begun() const {
  const fs::path file = directory_ / "study.json";
  try {
    return Json::parse(read_file(file));
  } catch (const Json::exception&) {
    throw FileError(file.string() + ": is damaged; restart the study with --overwrite");
  }
}

StudyRows StudyDirectory::rows() const {
  const std::size_t runs = begun().value("runs", std::size_t{0});
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(directory_ / "rows", error)) files.push_back(entry.path());
  std::ranges::sort(files);
  StudyRows rows;
  for (const fs::path& file : files) read_rows(file, rows, runs);
  return rows;
}

std::vector<std::size_t> StudyDirectory::open_runs() const {
  const StudyRows ended = rows();
  const std::size_t runs = begun().value("runs", std::size_t{0});
  std::vector<std::size_t> open;
  for (std::size_t run = 0; run < runs; ++run)
    if (!ended.contains(run)) open.push_back(run);
  return open;
}

void StudyDirectory::add(std::size_t run, const std::string& row) {
  if (!own_rows_) {
    std::string host(256, '\0');
    ::gethostname(host.data(), host.size() - 1);
    host.resize(host.find('\0'));
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    own_rows_ = std::make_unique<RowFile>(
        directory_ / "rows" / fmt::format("{}-{}-{}.csv", host, ::getpid(), now / std::chrono::nanoseconds(1)));
  }
  own_rows_->append(fmt::format("{},{}", run, row));
}

void StudyDirectory::gather(const Study& study) const {
  const StudyRows rows = this->rows();
  std::string text = study.header() + '\n';
  for (std::size_t r = 0; r < study.runs(); ++r) {
    const auto row = rows.find(r);
    text += row != rows.end() ? row->second : study.line_without_result(r);
    text += '\n';
  }
  write_file(directory_ / "runs.csv", text);
}

void StudyStatus::add(const std::string& row, const Study& study) {
  const std::size_t status_at = study.design().keys.size() + 2;
  const auto rows = csv_fields(row);
  if (rows.size() != 1 || rows.front().size() < status_at + 4) return;
  const auto& fields = rows.front();
  ++by_status[fields[status_at]];
  if (!fields.back().empty()) ++by_reason[fields.back()];
  run_s += number_in(fields[fields.size() - 2]).value_or(0);
}

std::size_t StudyStatus::ended() const {
  std::size_t sum = 0;
  for (const auto& [word, count] : by_status) sum += count;
  return sum;
}

std::size_t StudyStatus::without_result() const {
  std::size_t sum = 0;
  for (const char* word : {"refused", "failed", "crashed"})
    if (const auto found = by_status.find(word); found != by_status.end()) sum += found->second;
  return sum;
}

StudyStatus status_of(const StudyDirectory& directory, const Study& study) {
  StudyStatus status;
  status.runs = study.runs();
  for (const auto& [run, row] : directory.rows()) status.add(row, study);
  return status;
}

}  // namespace plica
