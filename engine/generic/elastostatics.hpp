// Compliance of the platform at a pose, with the elasticity of drives, rods, legs, cranks and slides.
//
// The forces and couples x in the joints are in equilibrium with a wrench w at the platform, A x = B w (the
// Newton-Euler equations at rest, without weight). Among all x in equilibrium, that of an elastic mechanism minimises
// the complementary energy x^T Q x / 2 (Castigliano; Menabrea for overconstrained mechanisms), so that
//
//   [Q  A^T] [x]   [ 0 ]
//   [A   0 ] [u] = [B w],     displacement of the platform C w,  C = B^T u(w)
//
// This is the virtual joint method (Pashkevich, Chablat, Wenger, Mechanism and Machine Theory 44 (2009), 966) in terms
// of forces: a virtual joint of compliance c adds c f^2 / 2. Beams are slender: shear is neglected.
#pragma once

#include "engine/generic/evaluation.hpp"
#include "engine/mechanism/abilities/elasticity.hpp"

namespace pkm::generic {

/// @param evaluation  evaluation of a model whose Model::jointed is present
/// @param pose        a pose that assembles
PlatformCompliance platform_compliance(const Evaluation& evaluation, std::span<const double> parameters,
                                       const Pose<double>& pose, std::size_t mode);

}  // namespace pkm::generic
