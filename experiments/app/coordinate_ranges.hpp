// The option --ranges: the range of each coordinate alone, from a home pose.
#pragma once

#include <string>
#include <vector>

#include "experiments/app/target.hpp"

namespace pkm {

/// Adds to the output the interval of each coordinate about the home pose, with the other coordinates fixed, in which
/// all poses are feasible, and the constraints at its ends. Throws ConfigError if the home pose is unknown or
/// infeasible.
/// @param home_given  values of --home; empty: a pose in the middle of the workspace
void report_ranges(const std::vector<std::string>& home_given, const Target& target, const std::string& mode,
                   Printout& out);

}  // namespace pkm
