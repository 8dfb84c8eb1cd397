// The samples of a trajectory as a CSV table and as JSON objects, and the text that locates a sample in a message.
#pragma once

#include <string>

#include "engine/mechanism/trajectory.hpp"
#include "engine/report/csv_table.hpp"
#include "experiments/app/print.hpp"

namespace pkm {

/// One row per sample, in SI units; undefined values are empty cells.
CsvTable trajectory_table(const Mechanism& mechanism, const Trajectory& trajectory);

Json sample_json(const Mechanism& mechanism, const TrajectoryPoint& point);

/// " at t = 0.5 s (sample 51)"; samples are counted from 1.
/// @param point  an element of trajectory.points
std::string sample_location(const Trajectory& trajectory, const TrajectoryPoint& point);

}  // namespace pkm
