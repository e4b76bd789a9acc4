#include <fmt/format.h>

#include <memory>
#include <optional>

#include "app/options.hpp"
#include "study/compare.hpp"

namespace plica {
namespace {

struct CompareOptions {
  std::string a, b, out;
  std::optional<double> time_s;
  bool json = false, overwrite = false;
};

void compare(const CompareOptions& options) {
  if (!options.out.empty()) require_new(options.out, {".vtu"}, options.overwrite);
  const ReferenceRun run_a(options.a), run_b(options.b);
  const Frame a = frame_to_compare(run_a, options.time_s), b = frame_to_compare(run_b, options.time_s);
  const nlohmann::ordered_json comparison = compare_runs(run_a, a, run_b, b);
  if (!options.out.empty()) write_distances(options.out, a, b);
  fmt::print("{}", options.json
                       ? comparison.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n"
                       : comparison_text(comparison));
}

}  // namespace

void add_compare_command(CLI::App& app, int&) {
  CLI::App* command = app.add_subcommand("compare", "compare the results of two runs");
  auto options = std::make_shared<CompareOptions>();
  command->add_option("DIR_A", options->a, "results of a run")->required();
  command->add_option("DIR_B", options->b, "results of the reference run")->required();
  command->add_option("--time_s", options->time_s, "time of the snapshots to compare (default: the last)");
  add_out_option(*command, options->out, "FILE.vtu to write: the mesh of A with its distance from B");
  command->add_flag("--json", options->json, "print JSON instead of a table");
  command->add_flag("--overwrite", options->overwrite, "replace an existing file");
  command->footer(
      "Different meshes: surface-to-surface distances. Equal meshes: node-to-node distances, too.\n"
      "Example: plica compare results/isotropic results/drosophila --out distances.vtu");
  command->callback([options] { compare(*options); });
}

}  // namespace plica
