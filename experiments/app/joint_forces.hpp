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

/// Throws ConfigError with the reason if joint forces are requested and the mechanism has no model of them.
void expect_reactions(const Mechanism& mechanism, const ReactionArguments& arguments);

/// Removes the joints that --joint does not select. Throws ConfigError for an unknown joint.
void select_joints(const ReactionArguments& arguments, Reactions& reactions);

/// {NAME: {on, force, couple}}
Json reactions_json(const Reactions& reactions);

/// Adds the forces and couples at one state to the output.
void report_reactions(const Reactions& reactions, Printout& out);
/// Adds axial forces, stresses and buckling loads of all rods whose cross-sections have a Young's modulus.
/// @param pose  a pose that can be assembled
void report_rods(const Target& target, const std::string& mode, const Pose<double>& pose, const Reactions& reactions,
                 Printout& out);
/// Adds the extrema of these quantities along a trajectory with reactions to the output and to out.json["summary"].
void report_rods(const Target& target, const std::string& mode, const Trajectory& trajectory, Printout& out);

/// Adds the peak and root-mean-square magnitudes along a trajectory to the output and to out.json["summary"].
void report_reactions(const Trajectory& trajectory, Printout& out);

}  // namespace pkm
