// Bindings of studies: points, single runs, and the results directory.
#include "study/study.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "core/threads.hpp"
#include "show/report.hpp"
#include "signals.hpp"
#include "simulation.hpp"
#include "study/study_directory.hpp"
#include "study/study_report.hpp"
#include "thread_count.hpp"

namespace plica::python {
namespace {

using Start = StudyDirectory::Start;

StudyDirectory begin(const std::filesystem::path& directory, const Study& study, const std::string& start) {
  return StudyDirectory::begin(directory, study,
                               start == "resumed" ? Start::resumed
                               : start == "over"  ? Start::over
                                                  : Start::fresh);
}

/// Run one point and return its row of runs.csv. KeyboardInterrupt on Ctrl-C.
std::string row_of(const Study& study, std::size_t run, const std::filesystem::path& directory) {
  Signals signals;
  std::optional<RunRow> row;
  {
    const nb::gil_scoped_release free;
    const SafeThreadCount count(1);
    row = study.run(run, directory, [&] { return signals.have_come(); });
  }
  signals.rethrow();
  return row ? study.line_of(run, *row) : "";
}

}  // namespace

void bind_study(nb::module_& module) {
  nb::class_<Study>(module, "Study")
      .def(
          "__init__",
          [](Study* self, const std::string& name, const std::string& file, const std::string& text,
             const std::string& points, const std::vector<std::string>& measures) {
            StudyInput input = parse_study(name, file, text);
            const SafeThreadCount count(1);
            if (points.empty())
              new (self) Study(std::move(input));
            else
              new (self) Study(std::move(input), points_of_csv(points), measures);
          },
          nb::arg("name"), nb::arg("file"), nb::arg("text"), nb::arg("points") = "",
          nb::arg("measures") = std::vector<std::string>{})
      .def_prop_ro("runs", &Study::runs)
      .def_prop_ro("scenario_name", [](const Study& s) { return s.input().scenario.name; })
      .def_prop_ro("keys", [](const Study& s) { return s.design().keys; })
      .def_prop_ro("measures", &Study::measures)
      .def_prop_ro("header", &Study::header)
      .def_prop_ro("points_csv", [](const Study& s) { return points_csv(s.design()); })
      .def_prop_ro("keeps_files", [](const Study& s) { return s.input().each != KeptOfRun::row; })
      .def("name_of", &Study::name_of, nb::arg("run"))
      .def("row", &row_of, nb::arg("run"), nb::arg("directory"))
      .def("crashed", &Study::line_without_result, nb::arg("run"), nb::arg("reason"))
      .def(
          "not_run", [](const Study& s, std::size_t run) { return s.line_without_result(run); }, nb::arg("run"));
  nb::class_<StudyDirectory>(module, "StudyDirectory")
      .def_static("begin", &begin, nb::arg("directory"), nb::arg("study"), nb::arg("start"))
      .def_static("open", &StudyDirectory::open, nb::arg("directory"))
      .def_prop_ro("rows", &StudyDirectory::rows)
      .def("add", &StudyDirectory::add, nb::arg("run"), nb::arg("row"))
      .def("gather", &StudyDirectory::gather, nb::arg("study"))
      .def("report", [](const StudyDirectory& directory) {
        if (can_report()) write_study_report(directory.path());
      });
}

}  // namespace plica::python
