#include "show/report_writer.hpp"

#include "core/files.hpp"
#include "show/report.hpp"

namespace plica {

ReportWriter::ReportWriter(std::filesystem::path directory)
    : directory_(std::move(directory)), frames_(most_frame_bytes) {}

void ReportWriter::end() {
  write_file(directory_ / "report.html", report_page({make_report_run(directory_, frames_)}));
}

}  // namespace plica
