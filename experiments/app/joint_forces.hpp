// What the joints of a mechanism carry, at one state or along a motion, as --reactions and --joint ask for it.
#pragma once

#include <string>
#include <vector>

#include "engine/mechanism/reactions_along.hpp"
#include "experiments/app/target.hpp"

namespace pkm {

struct ReactionArguments {
  bool reactions = false;
  std::vector<std::string> joint;  ///< of these alone; empty: of all

  bool any() const { return reactions || !joint.empty(); }
};
/// Declares --reactions and --joint.
void add_reaction_options(CLI::App& command, ReactionArguments& arguments);

/// Throws ConfigError where they are asked for and the mechanism does not have them, saying why.
void expect_reactions(const Mechanism& mechanism, const ReactionArguments& arguments);

/// Leaves the joints that are asked for. Throws ConfigError for names that no joint has.
void keep_joints(const ReactionArguments& arguments, Reactions& reactions);

/// {NAME: {on, force, couple}}
Json reactions_json(const Reactions& reactions);

void tell_reactions(const Reactions& reactions, Printout& out);
/// Of a trajectory with reactions the largest and the root mean square of each joint; into out.json["summary"], too.
void tell_reactions(const Trajectory& trajectory, Printout& out);

}  // namespace pkm
