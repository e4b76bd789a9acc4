// Rows of the tables by which cells act and resist.
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

/// The keys of a program within a table; `meaning`: of its activity.
template <class Table>
void add_program(std::vector<Row>& rows, const RowsIn<Table>& table, ProgramInput Table::*program,
                 const std::array<std::string_view, 3>& keys, std::string_view meaning) {
  rows.push_back(table(keys[0], program, &ProgramInput::time_s, anything,
                       "Times of the points of the activity (s), increasing; the same time twice is a jump, on which a "
                       "step ends. Before the first point and after the last it is as there. Without a program it is "
                       "always 1."));
  rows.push_back(table(keys[1], program, &ProgramInput::time_s, anything, "The same in minutes.",
                       {.instead_of = keys[0], .scale = 60}));
  rows.push_back(table(keys[2], program, &ProgramInput::activity, not_negative, meaning));
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
      elasticity(
          "model", &E::model, one_of(words::elastic_models),
          "Elastic law of a cell: linear and isotropic in a frame that turns with it; neo-Hookean, for soft cells "
          "at large strains, with a rest shape that may flow; or springs from its nodes to their places in the "
          "rest shape that follows it."),
      elasticity("young_modulus_Pa", &E::young_modulus_Pa, positive, "Young's modulus (Pa)."),
      elasticity(
          "poisson_ratio", &E::poisson_ratio, {.low = -1, .high = 0.5, .low_included = false, .high_included = false},
          "Poisson's ratio; with coupled volumes it only sets the shear modulus and the dilatation inside a cell."),
      elasticity(
          "relaxation_s", &E::relaxation_s, {.low = 0, .low_included = false, .word_for_none = "none"},
          "Model neo-hookean: time in which the rest shape of a cell follows its shape (s): what is held in another "
          "shape forgets the old one."),
      elasticity("relaxation_min", &E::relaxation_s, {.low = 0, .low_included = false, .word_for_none = "none"},
                 "The same in minutes.", {.instead_of = "relaxation_s", .scale = 60}),
      elasticity("attractor_stiffness_nN_per_um", &E::attractor_stiffness_nN_per_um,
                 {.low = 0, .low_included = false, .word_for_none = "derived"},
                 "Model shape-memory: stiffness of the springs from the nodes of a cell to the attractor (nN/µm), or "
                 "such that the mean shear modulus is that of young_modulus_Pa and poisson_ratio."),
      elasticity("attractor_preload_nN", &E::attractor_preload_nN, not_negative,
                 "Model shape-memory: tension of these springs that does not depend on their length (nN)."),
      elasticity(
          "attractor_preload_length_um", &E::attractor_preload_length_um, positive,
          "Model shape-memory: how far from its place a node feels 0.7 of the preload (µm); it has no direction at 0."),
      elasticity("corner_barrier_Pa", &E::corner_barrier_Pa, not_negative,
                 "Pushes corners of elements back that have under 0.15 of their Jacobian at rest, before they turn "
                 "inside out (Pa); 0: nothing does. For tight folds of soft cells, about the elastic modulus."),
      of_region("region", &R::region, anything, "Region whose cells have other values.", {.required = true}),
      of_region("height_percent", &R::height_percent, between(0, 100),
                "Only elements whose middle lies in this part of the cell's height, 0 at the base and 100 at the apex: "
                "a layer. Cells need several elements through their height."),
      of_region("young_modulus_Pa", &R::young_modulus_Pa, positive,
                "Young's modulus of its cells (Pa), times the factor of `profile` and `variation`; without it that of "
                "all."),
      of_region("poisson_ratio", &R::poisson_ratio,
                {.low = -1, .high = 0.5, .low_included = false, .high_included = false},
                "Poisson's ratio of its cells; without it that of all."),
      of_region("relaxation_s", &R::relaxation_s, positive,
                "Model neo-hookean: time in which their rest shapes follow their shapes (s); without it that of all."),
      of_region("relaxation_min", &R::relaxation_s, positive, "The same in minutes.",
                {.instead_of = "relaxation_s", .scale = 60}),
  };
  add_strengths(rows, of_region);

  const std::vector<Row> of_contraction = {
      contraction("region", &C::region, anything, "Region whose cells contract.", {.required = true}),
      contraction("edges", &C::edges, one_of(words::edges), "Edges of the cells that contract."),
      contraction("stiffness_nN_per_um", &C::stiffness_nN_per_um, not_negative, "Stiffness of a spring (nN/µm)."),
      contraction("along_ratio", &C::along_ratio, not_negative, "Factor on edges along the axis."),
      contraction("across_ratio", &C::across_ratio, not_negative, "Factor on edges across the axis."),
      contraction("diagonals", &C::diagonals, anything, "Whether the diagonals of the face contract too."),
      contraction("rest_length_ratio", &C::rest_length_ratio, not_negative,
                  "Length at which a spring is slack, over its initial length."),
      contraction("preload_nN", &C::preload_nN, anything,
                  "Tension of a spring that does not depend on its length (nN)."),
      contraction("tension_mN_per_m", &C::tension_mN_per_m, not_negative,
                  "Tension of the cells' faces, per length across it (mN/m, that is nN/µm), whatever the size of "
                  "cells: what stiffness and preload do, they do on every edge, so smaller cells pull harder."),
      contraction("damping_nN_s_per_um", &C::damping_nN_s_per_um, not_negative, "Damping of a spring (nN s/µm)."),
  };
  rows.insert(rows.end(), of_contraction.begin(), of_contraction.end());
  add_program(rows, contraction, &C::program, program_keys,
              "Activity at these times: a factor on the tension, linear between them.");
  add_pattern(rows, contraction);

  const std::vector<Row> of_cortex = {
      cortex("region", &X::region, anything, "Region whose cells have it.", {.required = true}),
      cortex("faces", &X::faces, one_of(words::edges),
             "Faces that have it. A wall between two cells is one face, with half of what each of them is told."),
      cortex("tension_mN_per_m", &X::tension_mN_per_m, not_negative,
             "Active tension of a face that is large (mN/m, that is nN/µm)."),
      cortex(
          "saturation_ratio", &X::saturation_ratio, not_negative,
          "The active tension of a face of area A is a part A/(A + saturation_ratio A₀) of that, A₀ its area at rest: "
          "half of it where the area is this part of A₀, none at area 0. 0: the same at any area."),
      cortex("stiffness_mN_per_m", &X::stiffness_mN_per_m, not_negative,
             "Area elasticity: tension for a doubled area (mN/m)."),
      cortex("compression_ratio", &X::compression_ratio, between(0, 1),
             "Part of the stiffness that acts where a face is smaller than its rest area; 0: it is slack there."),
      cortex("crowding_mN_per_m", &X::crowding_mN_per_m, not_negative,
             "Pressure within a face against vanishing, times (A₀/A)² (mN/m)."),
      cortex("relaxation_s", &X::relaxation_s, {.low = 0, .low_included = false, .word_for_none = "none"},
             "Time in which the rest area follows the area (s): what is held stretched forgets it."),
      cortex("relaxation_min", &X::relaxation_s, {.low = 0, .low_included = false, .word_for_none = "none"},
             "The same in minutes.", {.instead_of = "relaxation_s", .scale = 60}),
  };
  rows.insert(rows.end(), of_cortex.begin(), of_cortex.end());
  add_program(rows, cortex, &X::program, program_keys,
              "Activity at these times: a factor on the active tension, linear between them.");
  add_program(rows, cortex, &X::stiffness_program,
              {"stiffness_program.time_s", "stiffness_program.time_min", "stiffness_program.activity"},
              "The same for the stiffness.");
  const std::vector<Row> of_own_state = {
      cortex(
          "trigger.measure", &X::trigger, &TriggerInput::measure, one_of(words::own_measures),
          "Both programs begin, cell by cell, when this measure of the cell passes a threshold, and not at time 0: an "
          "area, the height or the largest stretch of the apex over that at rest, as it is at the beginning of a step. "
          "Before, the tension is 0 and the stiffness that of the program's time 0."),
      cortex("trigger.below", &X::trigger, &TriggerInput::below, positive, "They begin when it is smaller than this."),
      cortex("trigger.above", &X::trigger, &TriggerInput::above, positive, "They begin when it is larger."),
      cortex("follow.measure", &X::follow, &FollowInput::measure, one_of(words::own_measures),
             "The active tension follows this measure of the cell, as it is at the beginning of a step: another factor "
             "on it, beside the program."),
      cortex("follow.from", &X::follow, &FollowInput::from, not_negative, "Where that factor is 0, and before."),
      cortex("follow.to", &X::follow, &FollowInput::to, not_negative, "Where it is 1, and beyond."),
  };
  rows.insert(rows.end(), of_own_state.begin(), of_own_state.end());
  add_pattern(rows, cortex);

  const std::vector<Row> of_enclosed = {
      enclosed("surface", &N::surface, one_of({"basal"}), "The closed surface: the cells' basal one, around the yolk."),
      enclosed("volume", &N::volume, one_of(words::enclosed_states),
               "How the volume inside is kept: exactly, with a pressure of its own; by bulk_modulus_Pa; or not."),
      enclosed("bulk_modulus_Pa", &N::bulk_modulus_Pa, positive,
               "Volume compliant: pressure for the loss of all of the volume (Pa); 50 000 keeps a furrow's yolk to "
               "about a thousandth."),
  };
  rows.insert(rows.end(), of_enclosed.begin(), of_enclosed.end());

  const std::vector<Row> of_contact = {
      contact("surface", &F::surface, one_of(words::contact_surfaces),
              "Surfaces of the sheet that do not pass through themselves."),
      contact("distance_um", &F::distance_um, positive, "Where they begin to push each other away (µm)."),
      contact("stiffness_kPa_per_um", &F::stiffness_kPa_per_um, positive,
              "Pressure for each µm by which they are nearer than that (kPa/µm); the pressure between lips, tens of "
              "pascals, leaves them a tenth of a µm inside."),
      contact("search_um", &F::search_um, positive,
              "How near two places must be at the beginning of a step to push each other in it (µm): more than they "
              "move in a step."),
      contact("friction", &F::friction, not_negative,
              "Coefficient of friction: what is pressed together does not slide before the force along it is this part "
              "of the pressing one. 0: it slides freely."),
  };
  rows.insert(rows.end(), of_contact.begin(), of_contact.end());

  const std::vector<Row> of_pressure = {
      pressure("region", &P::region, anything, "Region whose faces carry the pressure.", {.required = true}),
      pressure("face", &P::face, one_of(words::pressure_faces), "Face of the cells that carries it."),
      pressure("pressure_Pa", &P::pressure_Pa, anything,
               "Pressure into the cell (Pa), a dead load on the face at rest.", {.required = true}),
  };
  rows.insert(rows.end(), of_pressure.begin(), of_pressure.end());
  add_program(rows, pressure, &P::program, program_keys,
              "Activity at these times: a factor on the pressure, linear between them.");
  add_strengths(rows, pressure);

  const std::vector<Row> of_ablation = {
      ablation("region", &A::region, anything, "Region whose cells lose their strength.", {.required = true}),
      ablation("faces", &A::faces, one_of(words::edges),
               "On which faces: cortices on them lose tension and stiffness, contractions of their edges the whole of "
               "theirs. A wall keeps the half that a neighbour outside the region gives it."),
      ablation("only", &A::only, anything,
               "Names of tables, such as [\"cortex.apical\"], where others on these faces keep their strength; [] for "
               "all: a laser cuts all of a cortex, light switches off its myosin.",
               {.may_be_empty = true}),
      ablation("at_s", &A::at_s, not_negative, "When (s); 0: from the beginning."),
      ablation("at_min", &A::at_s, not_negative, "The same in minutes.", {.instead_of = "at_s", .scale = 60}),
      ablation("until_s", &A::until_s, {.low = 0, .low_included = false, .word_for_none = "none"},
               "When it comes back (s); none: never."),
      ablation("until_min", &A::until_s, {.low = 0, .low_included = false, .word_for_none = "none"},
               "The same in minutes.", {.instead_of = "until_s", .scale = 60}),
      ablation("remaining", &A::remaining, between(0, 1), "The part of it that is left."),
  };
  rows.insert(rows.end(), of_ablation.begin(), of_ablation.end());
  return rows;
}

}  // namespace plica
