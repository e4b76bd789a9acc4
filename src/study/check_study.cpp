#include "study/check_study.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <set>
#include <system_error>

#include "core/errors.hpp"
#include "core/files.hpp"

namespace plica {
namespace fs = std::filesystem;
namespace {

class TemporaryDirectory {
 public:
  TemporaryDirectory() : path_(fs::temp_directory_path() / "plica-study-XXXXXX") {
    std::string name = path_.string();
    if (::mkdtemp(name.data()) == nullptr)
      throw FileError(path_.string() + ": cannot be created: " + std::generic_category().message(errno));
    path_ = name;
  }
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;
  ~TemporaryDirectory() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

}  // namespace

StudyForecast forecast(const Study& study, const std::function<bool()>& stop) {
  StudyForecast result;
  result.runs = study.runs();
  std::set<int> points;
  std::optional<std::size_t> first;
  for (std::size_t r = 0; r < study.runs(); ++r) {
    const StudyPoint& run = study.design().runs[r];
    if (!points.insert(run.point).second) continue;
    try {
      (void)study.scenario_of(r);
      if (!first) first = r;
    } catch (const ScenarioError& error) {
      result.refused.push_back(fmt::format("point {}: {}", run.point, error.what()));
    }
  }
  result.points = points.size();
  result.first_run = first.value();  // exists in any valid study
  const TemporaryDirectory directory;
  if (const std::optional<RunRow> row = study.run(result.first_run, directory.path(), stop)) result.first = *row;
  result.bytes_a_run = static_cast<double>(bytes_in(directory.path())) +
                       2 * static_cast<double>(study.line_of(result.first_run, result.first).size());
  return result;
}

}  // namespace plica
