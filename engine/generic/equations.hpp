// Equations of motion by the principle of virtual work, as nodes of the mechanism's expression graph.
//
// Twice the kinetic energy of a body is a sum of weighted products of rates, w f' g' (BodyNodes). With the derivatives
// f_X by the coordinates, and the acceleration f'' for Xddot = 0,
//
//   M_X = sum of w (f_X g_X^T + g_X f_X^T) / 2,   h_X = sum of w (f_X g'' + g_X f'') / 2,   G_X = g sum of m z_X
//
// All derivatives are symbolic. Those of an arm follow from its angular velocity (limbs::Arm), which is much shorter
// than the derivative of its closed form. Functions with the same derivatives share one product, with the sum of their
// weights.
#pragma once

#include "engine/generic/model.hpp"

namespace pkm::generic {

/// Adds the equations of motion to the graph of a model with bodies.
EquationNodes equations_of(Model& model);

/// The Jacobian EquationNodes::J alone, for models without bodies.
std::vector<Node> jacobian_of(Model& model);

}  // namespace pkm::generic
