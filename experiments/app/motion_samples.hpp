// The samples of a trajectory as JSON objects, and the text that locates a sample in a message.
#pragma once

#include <string>

#include "engine/mechanism/trajectory.hpp"
#include "experiments/app/print.hpp"

namespace pkm {

Json sample_json(const Mechanism& mechanism, const TrajectoryPoint& point);

/// Text that locates a sample in a message, for example " at t = 0.5 s (sample 51)". Samples are counted from 1.
/// @param point  an element of trajectory.points
std::string sample_location(const Trajectory& trajectory, const TrajectoryPoint& point);

}  // namespace pkm
