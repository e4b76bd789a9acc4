#include "mechanics/obstacles/shell_drag.hpp"

namespace plica {

ShellDrag::ShellDrag(const Tissue& tissue, const OuterShape& shell, double drag) : shell_(tissue, shell), drag_(drag) {
  add_areas(tissue, tissue.apical_facets, drag);
}

}  // namespace plica
