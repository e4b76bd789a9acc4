#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/options.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "show/report.hpp"
#include "study/study_report.hpp"

namespace plica {
namespace {

struct ReportOptions {
  std::vector<std::string> directories;
  std::string out;
  bool overwrite = false;
};

// Make the page of a study, or of several runs side by side.
std::string page_of(const ReportOptions& options, const std::filesystem::path& file) {
  for (const std::string& directory : options.directories) {
    if (!holds_study(directory)) continue;
    if (options.directories.size() > 1)
      throw UsageError(directory + ": contains a study, which has its own page; give it alone");
    return study_report_page(directory, std::filesystem::absolute(file).parent_path());
  }
  return report_page_of({options.directories.begin(), options.directories.end()});
}

void report(const ReportOptions& options) {
  if (options.out.empty() && options.directories.size() > 1)
    throw UsageError("--out: missing; give FILE.html for a page of several runs");
  // The page of one directory follows from its results, so it may be replaced.
  const std::filesystem::path file = options.out.empty()
                                         ? std::filesystem::path(options.directories.front()) / "report.html"
                                         : std::filesystem::path(options.out);
  require_new(file.string(), {".html"}, options.overwrite || options.out.empty());
  const std::string page = page_of(options, file);
  write_file(file, page);
  fmt::print("{} ({:.1f} MB); open it in a browser\n", file.string(), static_cast<double>(page.size()) / 1e6);
}

}  // namespace

void add_report_command(CLI::App& app, int&) {
  CLI::App* command =
      app.add_subcommand("report", "make an HTML page of one run, of several side by side, or of a study");
  auto options = std::make_shared<ReportOptions>();
  command->add_option("DIR", options->directories, "results of a run (repeatable) or of a study")->required();
  add_out_option(*command, options->out, "FILE.html to write (default for one DIR: DIR/report.html)");
  command->add_flag("--overwrite", options->overwrite, "replace an existing file");
  command->footer(
      "The page works without a network.\n"
      "Example: plica report results/drosophila results/xenopus --out embryos.html");
  command->callback([options] { report(*options); });
}

}  // namespace plica
