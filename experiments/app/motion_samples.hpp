// The samples of a motion: as a table, as JSON, and by their places in messages.
#pragma once

#include <string>

#include "engine/mechanism/trajectory.hpp"
#include "engine/report/csv_table.hpp"
#include "experiments/app/print.hpp"

namespace pkm {

/// A row for each; what does not exist is an empty cell.
CsvTable table_of(const Mechanism& mechanism, const Trajectory& trajectory);

Json sample_json(const Mechanism& mechanism, const TrajectoryPoint& point);

/// " at t = 0.5 s (sample 51)", counted from 1.
/// @param point  one of the trajectory's
std::string place_of(const Trajectory& trajectory, const TrajectoryPoint& point);

}  // namespace pkm
