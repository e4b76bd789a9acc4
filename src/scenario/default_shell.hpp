// Default of `vitelline.enabled` for a tissue that a mesh file defines.
#pragma once

#include "scenario/scenario.hpp"

namespace plica {

/// Sets `vitelline.enabled` of shape "file", unless given, to whether the tissue is closed: its apical surface has no
/// boundary, that is, every edge of it belongs to two facets. Reads the mesh; its errors are left to make_tissue.
/// Throws ScenarioError if an open tissue is given a drag along the membrane.
void set_default_shell(Scenario& scenario);

}  // namespace plica
