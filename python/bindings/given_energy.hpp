// Force law whose energy is a Python function of groups of nodes (plica.LocalEnergy).
#pragma once

#include <nanobind/nanobind.h>

#include <memory>
#include <string>

#include "mechanics/law.hpp"
#include "simulation/simulation.hpp"

namespace plica::python {

namespace nb = nanobind;

/// Add laws to a simulation in its reference state. `energies`: names, nodes of groups (int32, groups x nodes), and a
/// function of their positions (groups x nodes x 3, um) and of an order, which returns energies (nN um), or gradients
/// (groups x coordinates), or Hessians (groups x coordinates x coordinates), as C-contiguous float64. Throws UsageError
/// where nodes of the scenario do not stay.
void add_energies(const nb::list& energies, Simulation::Parts& parts);

}  // namespace plica::python
