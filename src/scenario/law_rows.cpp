// Rows of the force laws.
#include "scenario/pattern_rows.hpp"

namespace plica {
namespace {

using S = Scenario;
using E = ElasticityInput;
using R = RegionElasticityInput;
using C = ContractionInput;
using P = PressureInput;
using X = CortexInput;
using N = EnclosedInput;
using F = SelfContactInput;
using A = AblationInput;

/// Adds the keys of an activity time course.
template <class Table>
void add_program(std::vector<Row>& rows, const RowsIn<Table>& table, ProgramInput Table::*program,
                 const std::array<std::string_view, 3>& keys) {
  rows.push_back(table(keys[0], program, &ProgramInput::time_s, anything,
                       "Times (s), increasing. A time given twice marks a jump, at which a step ends."));
  rows.push_back(table(keys[1], program, &ProgramInput::time_s, anything, "The times in minutes.",
                       {.instead_of = keys[0], .scale = 60}));
  rows.push_back(table(keys[2], program, &ProgramInput::activity, not_negative, "Activity at these times."));
}

constexpr std::array<std::string_view, 3> program_keys = {"program.time_s", "program.time_min", "program.activity"};

}  // namespace

std::vector<Row> law_rows() {
  const auto elasticity = rows_in("elasticity", &S::elasticity);
  const auto of_region = rows_in("elasticity.*", &S::region_elasticities);
  const auto contraction = rows_in("contraction.*", &S::contractions);
  const auto cortex = rows_in("cortex.*", &S::cortices);
  const auto enclosed = rows_in("enclosed.*", &S::enclosed);
  const auto contact = rows_in("self_contact", &S::self_contact);
  const auto pressure = rows_in("pressure.*", &S::pressures);
  const auto ablation = rows_in("ablation.*", &S::ablations);
  std::vector<Row> rows = {
      elasticity("model", &E::model, one_of(words::elastic_models),
                 "`corotational`: linear isotropic in a frame that rotates with the cell. `neo-hookean`: for soft "
                 "cells at large strains, with optional relaxation. `shape-memory`: springs from nodes to their places "
                 "in a reference shape that follows the cell."),
      elasticity("young_modulus_Pa", &E::young_modulus_Pa, positive, "Young's modulus (Pa)."),
      elasticity(
          "poisson_ratio", &E::poisson_ratio, {.low = -1, .high = 0.5, .low_included = false, .high_included = false},
          "Poisson's ratio; with coupled volumes it affects only the shear modulus and the dilatation within a cell."),
      elasticity("relaxation_s", &E::relaxation_s, {.low = 0, .low_included = false, .word_for_none = "none"},
                 "Maxwell relaxation time of the stress-free shape (s), model `neo-hookean`."),
      elasticity("relaxation_min", &E::relaxation_s, {.low = 0, .low_included = false, .word_for_none = "none"},
                 "`relaxation_s` in minutes.", {.instead_of = "relaxation_s", .scale = 60}),
      elasticity("attractor_stiffness_nN_per_um", &E::attractor_stiffness_nN_per_um,
                 {.low = 0, .low_included = false, .word_for_none = "derived"},
                 "Stiffness of the `shape-memory` springs (nN/µm), or derived: mean shear modulus as by Young's "
                 "modulus and Poisson's ratio."),
      elasticity("attractor_preload_nN", &E::attractor_preload_nN, not_negative,
                 "Pre-tension of these springs, independent of length (nN)."),
      elasticity("attractor_preload_length_um", &E::attractor_preload_length_um, positive,
                 "Spring length at which 0.7 of the pre-tension acts (µm); its direction is undefined at 0."),
      elasticity("corner_barrier_Pa", &E::corner_barrier_Pa, {.low = 0, .word_for_none = "automatic"},
                 "Inversion barrier (Pa): energy that diverges as a corner Jacobian vanishes, active below 0.15 of its "
                 "reference value; 0: off. `automatic`: a tenth of Young's modulus if cells are polygons, come from a "
                 "file or divide, else 0."),
      of_region("region", &R::region, anything, "Cells with these values.", {.required = true}),
      of_region("height_percent", &R::height_percent, between(0, 100),
                "Layer: only elements with their centre in this part of the cell height (0: basal, 100: apical). "
                "Requires several elements through the height."),
      of_region("young_modulus_Pa", &R::young_modulus_Pa, positive,
                "Young's modulus (Pa), times `profile` and `variation`."),
      of_region("poisson_ratio", &R::poisson_ratio,
                {.low = -1, .high = 0.5, .low_included = false, .high_included = false}, "Poisson's ratio."),
      of_region("relaxation_s", &R::relaxation_s, positive,
                "Relaxation time of the stress-free shape (s), model `neo-hookean`."),
      of_region("relaxation_min", &R::relaxation_s, positive, "`relaxation_s` in minutes.",
                {.instead_of = "relaxation_s", .scale = 60}),
  };
  add_strengths(rows, of_region);

  const std::vector<Row> of_contraction = {
      contraction("region", &C::region, anything, "Cells that contract.", {.required = true}),
      contraction("edges", &C::edges, one_of(words::edges), "Edges that carry springs."),
      contraction("stiffness_nN_per_um", &C::stiffness_nN_per_um, not_negative, "Spring stiffness (nN/µm)."),
      contraction("along_ratio", &C::along_ratio, not_negative, "Factor on edges along the axis."),
      contraction("across_ratio", &C::across_ratio, not_negative, "Factor on edges across the axis."),
      contraction("diagonals", &C::diagonals, anything, "Add springs on face diagonals."),
      contraction("rest_length_ratio", &C::rest_length_ratio, not_negative, "Slack length / initial length."),
      contraction("preload_nN", &C::preload_nN, anything, "Pre-tension of a spring, independent of length (nN)."),
      contraction("tension_mN_per_m", &C::tension_mN_per_m, not_negative,
                  "Tension per length across the face (mN/m = nN/µm), independent of cell size. Stiffness and "
                  "pre-tension act on every edge, so smaller cells contract more strongly."),
      contraction("damping_nN_s_per_um", &C::damping_nN_s_per_um, not_negative, "Spring damping (nN s/µm)."),
  };
  rows.insert(rows.end(), of_contraction.begin(), of_contraction.end());
  add_program(rows, contraction, &C::program, program_keys);
  add_pattern(rows, contraction);

  const std::vector<Row> of_cortex = {
      cortex("region", &X::region, anything, "Cells with this cortex.", {.required = true}),
      cortex("faces", &X::faces, one_of(words::edges),
             "Faces with this cortex. A lateral face is shared by two cells and takes half of its values from each."),
      cortex("tension_mN_per_m", &X::tension_mN_per_m, not_negative, "Active tension of a large face (mN/m = nN/µm)."),
      cortex("saturation_ratio", &X::saturation_ratio, not_negative,
             "Tension saturates at small area: factor A/(A + `saturation_ratio` A₀) at area A and reference area A₀. "
             "0: constant tension."),
      cortex("stiffness_mN_per_m", &X::stiffness_mN_per_m, not_negative,
             "Area elasticity: tension at doubled area (mN/m)."),
      cortex("compression_ratio", &X::compression_ratio, between(0, 1),
             "Stiffness in compression / in extension; 0: slack below the stress-free area."),
      cortex("crowding_mN_per_m", &X::crowding_mN_per_m, not_negative,
             "Area-loss resistance: compressive tension, times (A₀/A)² (mN/m)."),
      cortex("relaxation_s", &X::relaxation_s, {.low = 0, .low_included = false, .word_for_none = "none"},
             "Maxwell relaxation time of the stress-free area (s)."),
      cortex("relaxation_min", &X::relaxation_s, {.low = 0, .low_included = false, .word_for_none = "none"},
             "`relaxation_s` in minutes.", {.instead_of = "relaxation_s", .scale = 60}),
  };
  rows.insert(rows.end(), of_cortex.begin(), of_cortex.end());
  add_program(rows, cortex, &X::program, program_keys);
  add_program(rows, cortex, &X::stiffness_program,
              {"stiffness_program.time_s", "stiffness_program.time_min", "stiffness_program.activity"});
  const std::vector<Row> of_own_state = {
      cortex("trigger.measure", &X::trigger, &TriggerInput::measure, one_of(words::own_measures),
             "Measure that starts the time courses."),
      cortex("trigger.below", &X::trigger, &TriggerInput::below, positive, "Start below this value."),
      cortex("trigger.above", &X::trigger, &TriggerInput::above, positive, "Start above this value."),
      cortex("follow.measure", &X::follow, &FollowInput::measure, one_of(words::own_measures),
             "Measure that scales the active tension."),
      cortex("follow.from", &X::follow, &FollowInput::from, not_negative,
             "Value at which, and before which, the factor is 0."),
      cortex("follow.to", &X::follow, &FollowInput::to, not_negative,
             "Value at which, and beyond which, the factor is 1."),
  };
  rows.insert(rows.end(), of_own_state.begin(), of_own_state.end());
  add_pattern(rows, cortex);

  const std::vector<Row> of_enclosed = {
      enclosed("surface", &N::surface, one_of({"basal"}),
               "Closed surface around the volume: the basal surface of the cells."),
      enclosed("volume", &N::volume, one_of(words::enclosed_states),
               "`held`: conserved, with a Lagrange multiplier as pressure. `compliant`: by `bulk_modulus_Pa`. `free`: "
               "unconstrained."),
      enclosed("bulk_modulus_Pa", &N::bulk_modulus_Pa, positive,
               "Pressure per relative volume loss (Pa); 50 000 conserves the yolk of a furrow to about 0.1 %."),
  };
  rows.insert(rows.end(), of_enclosed.begin(), of_enclosed.end());

  const std::vector<Row> of_contact = {
      contact("surface", &F::surface, one_of(words::contact_surfaces), "Surfaces that resist self-intersection."),
      contact("distance_um", &F::distance_um, positive, "Distance at which repulsion starts (µm)."),
      contact("stiffness_kPa_per_um", &F::stiffness_kPa_per_um, positive,
              "Contact pressure per µm below that distance (kPa/µm). At the pressure between furrow lips, tens of Pa, "
              "the overlap is about 0.1 µm."),
      contact("search_um", &F::search_um, positive,
              "Search distance at the start of a step (µm); must exceed the motion in a step."),
      contact("friction", &F::friction, not_negative,
              "Coefficient of friction: tangential / normal force at which sliding starts. 0: frictionless."),
  };
  rows.insert(rows.end(), of_contact.begin(), of_contact.end());

  const std::vector<Row> of_pressure = {
      pressure("region", &P::region, anything, "Cells whose faces carry the pressure.", {.required = true}),
      pressure("face", &P::face, one_of(words::pressure_faces), "Loaded face."),
      pressure("pressure_Pa", &P::pressure_Pa, anything,
               "Pressure into the cell (Pa); dead load on the reference face.", {.required = true}),
  };
  rows.insert(rows.end(), of_pressure.begin(), of_pressure.end());
  add_program(rows, pressure, &P::program, program_keys);
  add_strengths(rows, pressure);

  const std::vector<Row> of_ablation = {
      ablation("region", &A::region, anything, "Cells that lose strength.", {.required = true}),
      ablation("faces", &A::faces, one_of(words::edges),
               "Affected faces: cortices lose tension and stiffness, contractions of their edges all forces. A lateral "
               "face keeps the half of a neighbour outside the region."),
      ablation("only", &A::only, anything,
               "Affected tables, such as [\"cortex.apical\"]; [] for all. A laser cuts the whole cortex, light "
               "inactivates its myosin.",
               {.may_be_empty = true}),
      ablation("at_s", &A::at_s, not_negative, "Start (s); 0: from the beginning."),
      ablation("at_min", &A::at_s, not_negative, "`at_s` in minutes.", {.instead_of = "at_s", .scale = 60}),
      ablation("until_s", &A::until_s, {.low = 0, .low_included = false, .word_for_none = "none"},
               "End (s); none: permanent."),
      ablation("until_min", &A::until_s, {.low = 0, .low_included = false, .word_for_none = "none"},
               "`until_s` in minutes.", {.instead_of = "until_s", .scale = 60}),
      ablation("remaining", &A::remaining, between(0, 1), "Residual activity."),
  };
  rows.insert(rows.end(), of_ablation.begin(), of_ablation.end());
  return rows;
}

}  // namespace plica
