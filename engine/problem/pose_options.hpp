// What all quantities that read the conditioning or the joint-space inertia of poses have in common.
#pragma once

#include "engine/core/catalogue.hpp"
#include "engine/problem/quantity.hpp"

namespace pkm {

inline bool has_jacobian(const Mechanism& mechanism) { return !mechanism.info().characteristic_length.empty(); }

inline OptionSpec characteristic_length_option() {
  return {.name = "characteristic_length",
          .kind = OptionKind::number,
          .unit = "m",
          .lower = 1e-6,
          .upper = 1e6,
          .meaning = "length that the Jacobian's angular column is divided by; default: the mechanism's own"};
}

/// @param value  the name of the value with kinks
inline OptionSpec sharpness_option(const std::string& value) {
  return {.name = "sharpness",
          .kind = OptionKind::number,
          .initial = 200.0,
          .lower = 1,
          .upper = 1e6,
          .meaning = "of the smooth stand-in for " + value + " that gradient solvers are given: larger is nearer"};
}

inline bool has_dynamics(const Mechanism& mechanism) { return mechanism.dynamics() != nullptr; }

/// Why a mechanism cannot serve the objective.
inline Refusal refuse_without_dynamics(const std::string& objective, const Mechanism& mechanism) {
  const Refusal reason = no_joint_forces(mechanism);
  return reason ? "objective " + objective + " needs dynamics, and " + *reason : Refusal();
}

inline OptionSpec mode_option() {
  return {.name = "mode",
          .kind = OptionKind::word,
          .meaning = "working mode (see 'pkmopt list mechanisms NAME'); default: the mechanism's first"};
}

/// The working mode asked for. Throws std::invalid_argument where the mechanism has none of that name.
inline std::string mode_of(const EntryContext& context) {
  const std::vector<std::string>& known = context.mechanism.info().modes;
  if (!context.options.has("mode")) return known.front();
  const std::string& mode = context.options.word("mode");
  if (contains(known, mode)) return mode;
  throw std::invalid_argument("mechanism " + context.mechanism.info().name + " has no working mode '" + mode + "'" +
                              did_you_mean(mode, known));
}

/// The numbers that a mechanism's joints can have, and what may stand instead.
inline std::vector<std::string> numbers_of_joints(const std::vector<std::string>& others) {
  std::vector<std::string> choices;
  for (std::size_t i = 1; i <= kMostJoints; ++i) choices.push_back(std::to_string(i));
  choices.insert(choices.end(), others.begin(), others.end());
  return choices;
}

/// Throws std::invalid_argument where the number is that of no joint.
inline void refuse_unknown_joint(const Mechanism& mechanism, const std::string& joint) {
  const std::size_t joints = mechanism.info().joints.size();
  if (joint.size() == 1 && joint[0] > static_cast<char>('0' + joints))
    throw std::invalid_argument("mechanism " + mechanism.info().name + " has " + std::to_string(joints) +
                                " joints, so none has the number " + joint);
}

}  // namespace pkm
