// `plica run --resume`: what there is to go on from, and bringing a run to there.
#pragma once

#include <optional>
#include <string>

#include "record/recorder.hpp"
#include "simulation/simulation.hpp"

namespace plica {

/// The checkpoint in the directory `out`; nothing: begin. UsageError when it is of another run; FileError when it is
/// damaged, or when there are results that belong to none.
std::optional<Checkpoint> checkpoint_to_resume(const std::string& out, const Scenario& scenario, const Model& at_rest);

/// Brings simulation and recorder from rest to where the checkpoint is.
void go_on_from(Checkpoint checkpoint, const std::string& out, Simulation& simulation, Recorder& recorder,
                const std::string& input_toml);

}  // namespace plica
