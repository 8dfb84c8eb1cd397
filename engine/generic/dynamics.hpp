// A description's equations of motion at states of one design.
#pragma once

#include "engine/dynamics/pose_dynamics.hpp"
#include "engine/generic/evaluation.hpp"

namespace pkm::generic {

/// Throws DesignError with a sentence where a mass or an inertia is not positive.
template <class S>
void check_masses(const Evaluation& evaluation, std::span<const S> parameters);

/// Of double and Dual4. Throws DesignError as check_masses. @param evaluation  of a model with bodies
template <class S>
void find_dynamics(const Evaluation& evaluation, std::span<const S> parameters, std::size_t mode,
                   std::span<const MotionState<S>> states, std::span<PoseDynamics<S>> found);

}  // namespace pkm::generic
