#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>

#include "app/options.hpp"
#include "app/progress.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/names.hpp"
#include "core/numbers.hpp"
#include "show/run_pictures.hpp"

namespace plica {
namespace {

namespace fs = std::filesystem;

struct RenderCommand {
  std::string directory, out, range, size;
  std::vector<std::string> times, at_x_um;
  PictureOptions pictures;  // without what the texts above say
  bool strip = false, movie = false, no_edges = false, overwrite = false, quiet = false;
};

double place_in(const std::string& text) {
  const auto place = number_in(text);
  if (!place)
    throw UsageError(fmt::format("--at-x-um {}: not a number (x position in µm); write, for example, 0,125", text));
  return *place;
}

// Numbers on both sides of a letter; empty for another text.
std::array<std::optional<double>, 2> numbers_in(const std::string& text, char between) {
  const std::size_t at = text.find(between);
  if (at == std::string::npos) return {};
  return {number_in(std::string_view(text).substr(0, at)), number_in(std::string_view(text).substr(at + 1))};
}

ColourRange range_in(const std::string& text) {
  const auto [low, high] = numbers_in(text, ':');
  if (!low || !high || *low >= *high)
    throw UsageError(
        fmt::format("--range {}: not LOW:HIGH with LOW < HIGH; write, for example, 0:30 or --range=-2:2", text));
  return {*low, *high};
}

void read_size(const std::string& text, PictureOptions& options) {
  const auto sides = numbers_in(text, 'x');
  for (const auto& side : sides)
    if (!side || *side != std::floor(*side) || *side < smallest_picture_px || *side > largest_picture_px)
      throw UsageError(
          fmt::format("--size {}: not WIDTHxHEIGHT in whole pixels from {} to {}; write, for example, 1200x800", text,
                      smallest_picture_px, largest_picture_px));
  options.width_px = static_cast<int>(*sides[0]);
  options.height_px = static_cast<int>(*sides[1]);
}

PictureOptions options_of(const RenderCommand& command) {
  PictureOptions options = command.pictures;
  for (const std::string& place : command.at_x_um) options.cuts_at_x_um.push_back(place_in(place));
  options.usual_view = options.views.empty() && !options.sections && command.at_x_um.empty();
  if (options.usual_view && command.strip) options.views.emplace_back("cross-section");
  if (!command.range.empty()) options.range = range_in(command.range);
  if (!command.size.empty()) read_size(command.size, options);
  options.edges = !command.no_edges;
  return options;
}

std::vector<double> times_of(const RenderCommand& command, const RunPictures& run) {
  constexpr int panels_of_a_strip = 5;
  if (command.times.empty())
    return command.strip || command.pictures.sections ? run.telling_times_s(panels_of_a_strip)
                                                      : std::vector<double>{run.times_s().back()};
  std::vector<double> times;
  for (const std::string& time : command.times) times.push_back(snapshot_time_s(time, run.times_s()));
  return times;
}

void write_picture(const fs::path& file, const std::string& png) {
  if (file.has_parent_path()) make_directory(file.parent_path());
  write_file(file, png);
}

int draw_picture(const RenderCommand& command, const RunPictures& run) {
  const std::vector<double> times_s = times_of(command, run);
  Painter painter;
  write_picture(command.out, painter.png(run.picture(times_s)));
  if (command.quiet) return exit_done;
  std::vector<std::string> moments;
  moments.reserve(times_s.size());
  for (const double time_s : times_s) moments.push_back(run.time_text(time_s));
  fmt::print("{} ({})\n", command.out, fmt::join(moments, ", "));
  return exit_done;
}

std::string quoted(const std::string& name) {
  std::string text = "'";
  for (const char letter : name) text += letter == '\'' ? "'\\''" : std::string(1, letter);
  return text + "'";
}

std::string movie_command(const std::string& stem, std::size_t count, bool even) {
  std::string pattern;  // ffmpeg's: % is doubled
  for (const char letter : stem) pattern += letter == '%' ? "%%" : std::string(1, letter);
  return fmt::format("ffmpeg -framerate 10 -i {} -frames:v {}{} -pix_fmt yuv420p {}", quoted(pattern + "_%05d.png"),
                     count, even ? "" : " -vf 'pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white'", quoted(stem + ".mp4"));
}

/// Way to ffmpeg without the system's packages; empty if it is there.
std::string way_to_ffmpeg() {
  std::istringstream folders(std::getenv("PATH") == nullptr ? "" : std::getenv("PATH"));
  for (std::string folder; std::getline(folders, folder, ':');)
    if (::access((fs::path(folder) / "ffmpeg").c_str(), X_OK) == 0) return "";
  return "ffmpeg is not installed; after pip install imageio-ffmpeg, write for it:\n"
         "  \"$(python3 -c 'import imageio_ffmpeg as f; print(f.get_ffmpeg_exe())')\"\n";
}

/// Draw all frames into numbered files; on a terminal with a live progress line.
int draw_movie(const RenderCommand& command, const RunPictures& run, bool even) {
  const std::vector<double>& times_s = run.times_s();
  const std::string stem = command.out.substr(0, command.out.size() - 4);  // without .png
  const auto file_of = [&](std::size_t i) { return fs::path(fmt::format("{}_{:05d}.png", stem, i)); };
  for (std::size_t i = 0; i < times_s.size(); ++i) require_free(file_of(i), command.overwrite);
  LiveLine line(command.quiet);
  catch_interruptions();
  Painter painter;
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    write_picture(file_of(i), painter.png(run.picture({times_s[i]})));
    const bool last = i + 1 == times_s.size() || interrupted();
    line.show(fmt::format("{} of {} pictures{}", i + 1, times_s.size(), last && line.is_on_terminal() ? "\n" : ""),
              last);
    if (interrupted()) return interrupted_status();
  }
  if (!command.quiet)
    fmt::print("{}_00000.png to {}\nMake a movie of them with:\n  {}\n{}", stem, file_of(times_s.size() - 1).string(),
               movie_command(stem, times_s.size(), even), way_to_ffmpeg());
  return exit_done;
}

int render(const RenderCommand& command) {
  if (command.out.ends_with(".gif") || command.out.ends_with(".mp4"))
    throw UsageError(
        fmt::format("--out {0}: the file's name must end in .png; to write a movie, pip install 'plica[movie]' and, in "
                    "Python, plica.movie(\"{1}\", \"{0}\")",
                    command.out, command.directory));
  require_new(command.out, {".png"}, command.overwrite || command.movie);
  if (command.movie && (command.strip || !command.times.empty()))
    throw UsageError("--movie: conflicts with --strip and --time, since it draws all snapshots; remove these");
  const PictureOptions options = options_of(command);
  for (const std::string& time : command.times) (void)seconds_in(time);
  const RunPictures run(command.directory, options);
  const bool even = options.width_px % 2 == 0 && options.height_px % 2 == 0;
  return command.movie ? draw_movie(command, run, even) : draw_picture(command, run);
}

}  // namespace

void add_render_command(CLI::App& app, int& status) {
  CLI::App* command =
      app.add_subcommand("render", "draw pictures of a run (no screen needed): one time, several, or all");
  auto options = std::make_shared<RenderCommand>();
  command->add_option("DIR", options->directory, "results of a run")->required();
  add_out_option(*command, options->out, "FILE.png to write; with --movie FILE_00000.png, ...")->required();
  add_view_option(*command, options->pictures.views);
  command
      ->add_option("--at-x-um", options->at_x_um,
                   "cross-sections at these x, one row each; write --at-x-um=-100 for a negative first")
      ->delimiter(',')
      ->type_name("X,...");
  command->add_flag("--sections", options->pictures.sections,
                    "cross-sections at 25, 50 and 75 % of the length, at five times or those of --time");
  command->add_option("--time", options->times, "times, one column each: 5min, 300s, 300 or last (default)")
      ->delimiter(',')
      ->type_name("TIME,...");
  command->add_flag("--strip", options->strip,
                    "five times, outside view and cross-section; --time and --view override these");
  command->add_flag("--movie", options->movie, "draw every snapshot; print the command that makes a movie of them");
  add_colour_option(*command, options->pictures.colour,
                    fmt::format("quantity to colour by: {}, or a cell array of the mesh file",
                                fmt::join(names_of(colour_fields()), ", ")));
  command->add_option("--range", options->range, "ends of the colour scale (default: range over the run)")
      ->type_name("LOW:HIGH");
  command->add_option("--size", options->size, "size in pixels (default: at least 1000 wide, height as needed)")
      ->type_name("WxH");
  command->add_flag("--no-edges", options->no_edges, "do not draw cell outlines");
  command->add_flag("--shell", options->pictures.shell, "draw the vitelline membrane of the run");
  command->add_flag("--overwrite", options->overwrite, "replace an existing file");
  command->add_flag("--quiet", options->quiet, "print only errors");
  command->footer(
      "Examples: plica render results/drosophila --out fold.png\n"
      "          plica render results/drosophila --out strip.png --strip\n"
      "          plica render results/drosophila --out rows.png --view ventral,side --time 30s,2min,last \\\n"
      "            --color pressure --range=-200:200\n"
      "          plica render results/drosophila --out sections.png --sections\n"
      "          plica render results/drosophila --out cuts.png --at-x-um=-100,0,100 --time last");
  command->callback([options, &status] { status = render(*options); });
}

}  // namespace plica
