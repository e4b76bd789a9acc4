// [matrix.NAME]: extracellular matrix bonded to faces, such as a basement membrane.
#include "mechanics/matrix.hpp"

#include "scenario/tables/table.hpp"

namespace plica {
namespace of_matrix {

using M = MatrixInput;

void build(const Scenario& scenario, const Origin& origin, Model& model) {
  for (const auto& [name, input] : scenario.matrices) {
    const double shear_modulus = *input.young_modulus_Pa * units::pascal / 3;  // incompressible
    MatrixRule rule{meaning_of(words::surfaces, input.faces),
                    shear_modulus * *input.thickness_um,
                    input.prestretch,
                    input.relaxation_s.value_or(0),
                    make_program(input.program),
                    make_follow(input.follow, scenario)};
    model.laws.push_back(std::make_unique<MatrixLayer>(model.tissue, make_pattern(input, origin), std::move(rule)));
    model.laws.back()->set_label("matrix." + name);
  }
}

void check(const std::string& table, M& input, const Scenario& scenario, Input& errors) {
  check_follow(table, input.follow, scenario, errors);
}

void describe(const M&, const Scenario&, Acting& acting) { acting.faces_key = "faces"; }

}  // namespace of_matrix

ScenarioTable matrix_table() {
  using namespace of_matrix;
  ScenarioTable info{
      "matrix.*",
      "Extracellular matrix, such as a basement membrane: a thin elastic or relaxing layer bonded to cell "
      "faces. Several tables on a face add.",
      "Surroundings"};
  const auto row = key_rows(info, &Scenario::matrices);
  info.rows = {
      row("region", &M::region, anything, "Cells whose faces carry the layer.", {.required = true}),
      row("faces", &M::faces, one_of(words::surfaces), "Faces that carry it."),
      row("young_modulus_Pa", &M::young_modulus_Pa, positive,
          "Young's modulus (Pa), times `program`, `profile` and `variation`; the layer is incompressible.",
          {.required = true}),
      row("thickness_um", &M::thickness_um, positive,
          "Thickness when unstretched (µm), much less than that of the cells: its bending stiffness is neglected.",
          {.required = true}),
      row("prestretch", &M::prestretch, positive,
          "Stretch of the layer in the reference state, in every direction; above 1: under tension."),
      row("relaxation_s", &M::relaxation_s, positive_or_none, "Maxwell relaxation time of the stress-free shape (s)."),
      row("relaxation_min", &M::relaxation_s, positive_or_none, "`relaxation_s` in minutes.",
          {.instead_of = "relaxation_s", .scale = 60}),
  };
  add_program(info.rows, row, &M::program);
  add_follow(info.rows, row);
  add_strengths(info.rows, acting(row));
  info.build = build;
  list_acting(info, &Scenario::matrices, describe, check);
  return info;
}

}  // namespace plica
