// Models that tests share.
#pragma once

#include "mechanics/active/contraction.hpp"
#include "mechanics/elasticity/corotational.hpp"
#include "mechanics/model.hpp"
#include "mechanics/surroundings.hpp"
#include "solver/linear/system_matrix.hpp"
#include "support/tissues.hpp"

namespace plica::support {

constexpr double usual_drag = 0.14;  // nN s/um^3: 140 Pa s/um

void add_elasticity(Model& model, double poisson = 0.45);

void add_contraction(Model& model, const CellSet& cells, const ContractionRule& rule, Program program = {});

void add_drag(Model& model, double drag = usual_drag);

/// A sheet of 3 x 3 cells whose middle cell contracts its apex; elastic, dragged, volumes held.
Model dimpling_sheet(std::array<int, 3> elements_per_cell = {1, 1, 1});

/// The sphere of the paper, elastic, dragged, in its shell, contracting a patch of its ventral face.
Model furrowing_sphere();

/// All forces on the nodes at a step's end: laws, pressures and the shell, as the State says them.
Vectors unbalanced_forces(const Model& model, const State& before, const State& after);

/// A times a vector, column by column; zero on nodes that hang.
Vectors product_of(const SystemMatrix& matrix, const Vectors& direction);

/// Largest force of a law alone at a step's end: what the balance is judged by.
double force_size(const Model& model, const State& before, const State& after);

}  // namespace plica::support
