// Tables that act on cells by strengths (those with list_acting, such as cortex.NAME): a view of each, and its pattern
// on a tissue with resolved regions; per-cell and per-element inputs as arrays.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mechanics/active/cell_pattern.hpp"
#include "scenario/scenario.hpp"
#include "tissue/mirror.hpp"
#include "tissue/tissue.hpp"

namespace plica {

struct Acting {
  /// Force that remedies reduce.
  struct Force {
    std::string_view key;
    double value = 0;
    double most = 0;  // that strains cells by about 1
  };

  std::string table;  // "cortex.apical"
  const ActingInput& input;
  std::string_view faces_key = {};  // faces, edges or face; empty: acts on whole cells
  bool can_be_ablated = false;
  bool contracts = false;         // apical surfaces, where a furrow is measured by default
  bool is_constant = false;       // a tension of the region that does not depend on its deformation
  bool has_sudden_onset = false;  // without its program
  std::vector<Force> forces = {};
};

/// Lists all of a scenario, in the order of a resolved scenario.
std::vector<Acting> acting_tables(const Scenario& scenario);

/// Whole tissue, in which cells are counted from the midline, and the part of it that is solved.
struct Origin {
  const Tissue& whole;
  const Mirror& mirror;
};

/// Whether the tissue has the array of a profile by array.
bool has_array_of(const ProfileInput& profile, const Tissue& tissue);

/// Per-cell activation of a table: region, amplitude factors, delays and pulses.
CellPattern make_pattern(const ActingInput& input, const Tissue& tissue);

/// Makes the pattern on the solved cells.
CellPattern make_pattern(const ActingInput& input, const Origin& origin, std::vector<Ablation> ablations = {});

/// Whether an ablation affects `table` (cortex.NAME or contraction.NAME), which acts on `faces` or their edges.
bool takes_from(const AblationInput& ablation, const std::string& table, const std::string& faces);

/// Makes the pattern on the solved cells, with the ablations that affect this table.
CellPattern make_ablated_pattern(const Scenario& scenario, const std::string& table, const ActingInput& input,
                                 const Origin& origin);

inline Program make_program(const ProgramInput& input) { return {input.time_s, input.activity}; }

inline double longest_step_of_pulses_s(const PulseInput& pulse) { return *pulse.period_s / (12 * (1 + pulse.spread)); }

struct ElasticMaterial {
  double factor = 1;  // on the Young's modulus of [elasticity]
  double poisson_ratio = 0;
  double relaxation_s = 0;  // 0: none
};

/// Elastic properties by element of `tissue`, the solved part: of [elasticity], or of [elasticity.NAME]. Omits profiles
/// by an array that the tissue lacks.
std::vector<ElasticMaterial> elastic_materials(const Scenario& scenario, const Origin& origin, const Tissue& tissue);

using NamedArrays = std::vector<std::pair<std::string, std::vector<double>>>;

struct RestArrays {
  NamedArrays cells;     // the tissue's arrays; strength_TABLE.NAME; if used, delay_s_ and pulse_phase_TABLE.NAME
  NamedArrays elements;  // young_modulus_Pa and poisson_ratio, if [elasticity.NAME] changes them
};

/// Collects the arrays on a tissue with resolved regions. Omits profiles by an array that the tissue lacks, and arrays
/// that are not finite in every cell.
RestArrays rest_arrays(const Scenario& scenario, const Tissue& tissue);

}  // namespace plica
