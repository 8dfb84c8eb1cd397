// Options and capability checks shared by the quantities based on the conditioning or the joint-space inertia of poses.
#pragma once

#include "engine/core/catalogue.hpp"
#include "engine/problem/quantity.hpp"

namespace pkm {

inline OptionSpec characteristic_length_option() {
  return {.name = "characteristic_length",
          .kind = OptionKind::number,
          .unit = "m",
          .lower = 1e-6,
          .upper = 1e6,
          .meaning = "length that the Jacobian's angular column is divided by; default: the mechanism's own"};
}

/// Option for the sharpness of a smooth approximation.
/// @param value  name of the non-smooth value that is approximated
inline OptionSpec sharpness_option(const std::string& value) {
  return {.name = "sharpness",
          .kind = OptionKind::number,
          .initial = 200.0,
          .lower = 1,
          .upper = 1e6,
          .meaning =
              "sharpness of the smooth approximation of " + value + " for gradient solvers; larger is more accurate"};
}

/// The reason why the mechanism lacks the dynamics that an objective needs; empty if it has them.
inline Unsupported check_dynamics(const std::string& objective, const Mechanism& mechanism) {
  const Unsupported reason = why_no_joint_forces(mechanism);
  return reason ? "objective " + objective + " needs dynamics, and " + *reason : Unsupported();
}

inline OptionSpec mode_option() {
  return {.name = "mode",
          .kind = OptionKind::word,
          .meaning = "working mode (see 'pkmopt list mechanisms NAME'); default: the mechanism's first"};
}

/// The working mode in the options, by default the mechanism's first. Throws std::invalid_argument if it is unknown.
inline std::string mode_of(const EntryContext& context) {
  const std::vector<std::string>& known = context.mechanism.info().modes;
  if (!context.options.has("mode")) return known.front();
  const std::string& mode = context.options.word("mode");
  if (contains(known, mode)) return mode;
  throw std::invalid_argument("mechanism " + context.mechanism.info().name + " has no working mode '" + mode + "'" +
                              did_you_mean(mode, known));
}

/// Choices of an option that selects a joint: the numbers of all joints, then `others`.
inline std::vector<std::string> joint_choices(const std::vector<std::string>& others) {
  std::vector<std::string> choices;
  for (std::size_t i = 1; i <= kMaxJoints; ++i) choices.push_back(std::to_string(i));
  choices.insert(choices.end(), others.begin(), others.end());
  return choices;
}

/// Throws std::invalid_argument if `joint` is a number greater than the mechanism's number of joints.
inline void validate_joint(const Mechanism& mechanism, const std::string& joint) {
  const std::size_t joints = mechanism.info().joints.size();
  if (joint.size() == 1 && joint[0] > static_cast<char>('0' + joints))
    throw std::invalid_argument("mechanism " + mechanism.info().name + " has " + std::to_string(joints) +
                                " joints; found joint " + joint);
}

}  // namespace pkm
