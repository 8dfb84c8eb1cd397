// What all quantities that follow a motion have in common: forces, power.
//
// They look at the design alone: no survey, and none of the limits of poses, which say where a workspace ends. What a
// motion needs of the workspace is the affair of constraints. Where the mechanism does not assemble somewhere along the
// motion there is no force to speak of: the value is NaN, the design `failed`, and the reason names the time.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/problem/quantity.hpp"

namespace pkm {

/// Options of all of them: motion, joint, samples, mode, wrench, sharpness.
/// @param joints  the words that `joint` knows besides "1" to "4"; the first is the default
std::vector<OptionSpec> motion_options(const std::vector<std::string>& joints);

/// "peak force of joint 2 along the motion pick": what such an entry computes; `what` is "peak force".
std::string motion_detail(const std::string& what, const EntryContext& context);

/// Appends to `field`, per sample, what is to be kept small, >= 0. Which joints it looks at is of its own.
/// @param forces  tau [N], speeds  qdot [m/s] of the four joints
template <class S>
using AppendLoads = void (*)(const std::string& joint, const AxisVector<S>& forces, const AxisVector<S>& speeds,
                             std::vector<S>& field);

/// The greatest of all loads along a motion, and as its smooth stand-in their power mean of exponent `sharpness`.
/// Throws std::invalid_argument when the options name no motion of the study or a mode or wrench that there is not.
std::unique_ptr<const Quantity> make_motion_quantity(const EntryContext& context, AppendLoads<double> value,
                                                     AppendLoads<Dual4> smooth);

/// Unit of the force of the joint that the options name. Throws std::invalid_argument where the joints looked at have
/// different ones.
std::string force_unit(const EntryContext& context);

}  // namespace pkm
