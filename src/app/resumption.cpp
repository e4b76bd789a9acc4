#include "app/resumption.hpp"

#include <fmt/format.h>

#include "core/errors.hpp"
#include "core/version.hpp"
#include "record/archive.hpp"
#include "record/run_directory.hpp"
#include "scenario/print.hpp"

namespace plica {

std::optional<Checkpoint> checkpoint_to_resume(const std::string& out, const Scenario& scenario, const Model& at_rest) {
  if (!can_archive()) throw UsageError("this plica was built without HDF5: it has no checkpoints to resume from");
  std::string complaint;
  std::optional<Checkpoint> checkpoint = read_checkpoint(out, complaint);
  if (!complaint.empty()) fmt::print(stderr, "plica: {}; going on from the checkpoint before it\n", complaint);
  if (!checkpoint) {
    if (holds_steps(out))
      throw FileError(out + ": holds results without a checkpoint; begin anew with --overwrite, or give another --out");
    return std::nullopt;
  }
  const std::string now = resolved_toml(scenario);
  if (const auto other = other_scenario(checkpoint->scenario, now))
    throw UsageError(
        fmt::format("{}: the checkpoint is of another scenario: {}; only [time], [stop] and [output] may change: give "
                    "another --out",
                    out, *other));
  if (checkpoint->at_rest != fingerprint(at_rest.tissue))
    throw UsageError(fmt::format("{}: the checkpoint is of another embryo ({}; this one has {}); has its mesh changed?",
                                 out, checkpoint->at_rest, fingerprint(at_rest.tissue)));
  if (checkpoint->program != version())
    fmt::print(stderr, "plica: {} was written by version {}; what follows may differ from it in the last digits\n", out,
               checkpoint->program);
  // What ended the run may not end it any more: the next step is asked.
  if (other_stop(checkpoint->scenario, now)) checkpoint->run.criterion_met = checkpoint->run.at_equilibrium = false;
  return checkpoint;
}

void go_on_from(Checkpoint checkpoint, const std::string& out, Simulation& simulation, Recorder& recorder,
                const std::string& input_toml) {
  try {
    simulation.go_on_from(std::move(checkpoint.run), checkpoint.record.rows.back());
  } catch (const UnfitMemory& error) {
    throw FileError(out + ": the checkpoint is damaged: " + error.what());
  }
  recorder.go_on(input_toml, std::move(checkpoint.record));
}

}  // namespace plica
