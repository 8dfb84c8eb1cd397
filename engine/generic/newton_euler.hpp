// Newton-Euler equations of the bodies and joints of a mechanism file, for the reactions in the joints.
#pragma once

#include "engine/dynamics/newton_euler.hpp"
#include "engine/generic/evaluation.hpp"

namespace pkm::generic {

/// The Newton-Euler equations at a state of motion. Throws DesignError if a mass is not positive.
/// @param evaluation  evaluation of a model whose Model::jointed is present
/// @param state       state with a pose that assembles
/// @param wrench      load on the platform, at Model::wrench_point
NewtonEuler newton_euler(const Evaluation& evaluation, std::span<const double> parameters, std::size_t mode,
                         const MotionState<double>& state, const AxisVector<double>& acceleration,
                         const Wrench<double>& wrench);

}  // namespace pkm::generic
