// The equations of motion of a description as nodes of its graph.
//
// Twice a body's kinetic energy is a sum of weights times products of rates f' g' (BodyNodes). With the derivatives
// f_X by the coordinates and the acceleration f'' where Xddot = 0,
//
//   M_X = sum of w (f_X g_X^T + g_X f_X^T) / 2,   h_X = sum of w (f_X g'' + g_X f'') / 2,   G_X = g sum of m z_X
//
// by virtual work, and weights of what has the same derivatives are added first. Nothing but derivatives of the graph
// is needed; those of arms follow from their turn.
#pragma once

#include "engine/generic/model.hpp"

namespace pkm::generic {

EquationNodes equations_of(Model& model);

/// EquationNodes::J alone.
std::vector<Node> jacobian_of(Model& model);

}  // namespace pkm::generic
