// The options of `pkmopt trajectory --fastest`: the shortest time of a motion within limits.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/mechanism/fastest_motion.hpp"
#include "experiments/app/target.hpp"

namespace pkm {

struct FastestArguments {
  bool fastest = false;
  std::string law = "optimal";
  std::string motor;         ///< name of a motor; "": the motors of the study
  std::size_t nodes = 2000;  ///< number of intervals into which each move is divided
  /// Values of --peak-speed, --peak-acceleration and --peak-force: lists of joint=value.
  std::vector<std::string> peak_speed, peak_acceleration, peak_force;
  std::string tool_speed, tool_acceleration;
};
void add_fastest_options(CLI::App& command, FastestArguments& arguments);
/// Throws ConfigError if an option is given that needs --fastest.
void expect_fastest(const FastestArguments& arguments);

/// Limits of the study and of the options; --motor is one of `motors`.
MotionLimits parse_limits(const Mechanism& mechanism, const FastestArguments& arguments,
                          const std::vector<Motor>& motors);
/// The mechanism with the motor of the limits in its drive trains, if --motor is given.
std::shared_ptr<const Mechanism> with_motor(const std::shared_ptr<const Mechanism>& mechanism,
                                            const FastestArguments& arguments, const MotionLimits& limits);

/// Finds the shortest time of a motion within the limits, for the time law of --law. Throws ConfigError if there is
/// none.
FastestMotion fastest_motion(const DesignWithLimits& design, const std::shared_ptr<const Motion>& motion,
                             const FastestArguments& arguments, std::size_t samples);

/// Adds the time law, and the limits that bound the motion in each period, to the output.
void report_fastest(const MechanismInfo& info, const FastestMotion& found, const FastestArguments& arguments,
                    Printout& out);

}  // namespace pkm
