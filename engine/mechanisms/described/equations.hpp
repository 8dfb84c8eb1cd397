// The equations of motion of a description as nodes of its graph.
//
// A body's kinetic energy is the sum of weights times squared rates: of the coordinates of its centre (its mass), of
// directions fixed in it (second moments of its mass along them). With s(X) for such a number and w for the sum of the
// weights of all that have the same derivatives,
//
//   M_X = sum of w s_X s_X^T,   h_X = sum of w s_X s'' where Xddot = 0,   G_X = g sum of m z_X  (virtual work)
//
// so nothing but derivatives of the graph is needed, those of velocities for s'' included.
#pragma once

#include "engine/mechanisms/described/model.hpp"

namespace pkm::described {

EquationNodes equations_of(Model& model);

}  // namespace pkm::described
