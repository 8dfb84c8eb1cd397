// The options --reactions and --joint: forces and couples in the joints of a mechanism, at one state or along a motion.
#pragma once

#include <string>
#include <vector>

#include "engine/mechanism/reactions_along.hpp"
#include "experiments/app/target.hpp"

namespace pkm {

/// Values of the options --reactions and --joint.
struct ReactionArguments {
  bool reactions = false;
  std::vector<std::string> joint;  ///< names of the selected joints; empty: all joints

  bool any() const { return reactions || !joint.empty(); }
};
/// Declares --reactions and --joint.
void add_reaction_options(CLI::App& command, ReactionArguments& arguments);

/// Throws ConfigError if joint forces are requested but cannot be computed for this mechanism, with the reason.
void expect_reactions(const Mechanism& mechanism, const ReactionArguments& arguments);

/// Removes the joints that --joint does not select. Throws ConfigError for an unknown joint.
void select_joints(const ReactionArguments& arguments, Reactions& reactions);

/// JSON object {NAME: {on, force, couple}} with one member for each joint.
Json reactions_json(const Reactions& reactions);

/// Adds the forces and couples in the joints at one state to the output.
void report_reactions(const Reactions& reactions, Printout& out);
/// Adds axial forces, stresses and buckling loads of all rods whose cross-sections have a Young's modulus.
/// @param pose  the pose, at which the mechanism must be assembled
void report_rods(const Target& target, const std::string& mode, const Pose<double>& pose, const Reactions& reactions,
                 Printout& out);
/// Adds the extreme values of the rods' axial forces, stresses and buckling loads along a trajectory to the output and
/// to out.json["summary"]. The trajectory must have reactions.
void report_rods(const Target& target, const std::string& mode, const Trajectory& trajectory, Printout& out);

/// Adds the peak and root-mean-square magnitudes of forces and couples along a trajectory to the output and to
/// out.json["summary"].
void report_reactions(const Trajectory& trajectory, Printout& out);

}  // namespace pkm
