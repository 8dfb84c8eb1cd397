// Newton's and Euler's equations of the bodies and joints of a description.
#pragma once

#include "engine/dynamics/newton_euler.hpp"
#include "engine/generic/evaluation.hpp"

namespace pkm::generic {

/// At a pose that assembles, of a model that is jointed. Throws DesignError where a mass is not positive.
/// @param wrench  on the platform, where the model says
NewtonEuler newton_euler(const Evaluation& evaluation, std::span<const double> parameters, std::size_t mode,
                         const MotionState<double>& state, const AxisVector<double>& acceleration,
                         const Wrench<double>& wrench);

}  // namespace pkm::generic
