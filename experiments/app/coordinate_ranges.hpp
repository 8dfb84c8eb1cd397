// The option --ranges: the range of each coordinate alone, from a home pose.
#pragma once

#include <string>
#include <vector>

#include "experiments/app/commands.hpp"
#include "experiments/app/target.hpp"

namespace pkm {

struct RangeArguments {
  bool ranges = false;
  std::vector<std::string> home;
};
/// Declares --ranges and --home.
void add_range_options(CLI::App& command, RangeArguments& arguments);

/// If requested, adds to the output the interval of each coordinate about the home pose, with the other coordinates
/// fixed, in which all poses are feasible, and the constraints at its ends. Throws ConfigError if the home pose is
/// unknown or infeasible.
void report_ranges(const RangeArguments& arguments, const Target& target, const std::string& mode, Printout& out);

}  // namespace pkm
