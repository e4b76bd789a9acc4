// Force law whose energy is a Python function of groups of nodes (plica.LocalEnergy).
#pragma once

#include <nanobind/nanobind.h>

#include "simulation/tape.hpp"

namespace plica::python {

namespace nb = nanobind;

/// Return what adds laws to a simulation in its reference state, without the GIL. `energies`: names, nodes of groups
/// (int32, groups x nodes), and a function of their positions (groups x nodes x 3, um) and of an order, which returns
/// energies (nN um), or gradients (groups x coordinates), or Hessians (groups x coordinates x coordinates), as
/// C-contiguous float64. It throws UsageError where nodes of the scenario do not stay.
PartsAddition adding_energies(const nb::list& energies);

}  // namespace plica::python
