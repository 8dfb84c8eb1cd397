// Equations of motion of a mechanism file, evaluated at states of one design.
#pragma once

#include "engine/dynamics/pose_dynamics.hpp"
#include "engine/generic/evaluation.hpp"

namespace pkm::generic {

/// Throws DesignError with a message if a mass or an inertia of the mechanism is not positive.
template <class S>
void check_masses(const Evaluation& evaluation, std::span<const S> parameters);

/// Evaluates the equations of motion at several states. S is double or Dual4. Throws DesignError if a mass or an
/// inertia is not positive.
/// @param evaluation  evaluation of a model with bodies
/// @param found       receives the equations of motion of each state, in the order of `states`; same size as `states`
template <class S>
void find_dynamics(const Evaluation& evaluation, std::span<const S> parameters, std::size_t mode,
                   std::span<const MotionState<S>> states, std::span<PoseDynamics<S>> found);

/// Total mass of the moving bodies [kg]. S is double or Dual4. Throws DesignError if a mass or an inertia is not
/// positive.
/// @param evaluation  evaluation of a model with bodies
template <class S>
S total_mass(const Evaluation& evaluation, std::span<const S> parameters);

/// Limits of the drive forces of a design, and how redundant drives share a load.
DriveLimits drive_limits(const Evaluation& evaluation, std::span<const double> parameters);

}  // namespace pkm::generic
