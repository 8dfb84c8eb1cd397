// What all quantities that read the joint-space inertia of poses have in common.
#pragma once

#include "engine/problem/quantity.hpp"

namespace pkm {

inline bool has_dynamics(const Mechanism& mechanism) { return mechanism.dynamics() != nullptr; }

/// "" or why a mechanism cannot serve the objective.
inline std::string refuse_without_dynamics(const std::string& objective, const Mechanism& mechanism) {
  if (mechanism.dynamics()) return {};
  return "objective " + objective + " needs dynamics, and mechanism " + mechanism.info().name + " has no masses";
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
  for (const std::string& name : known)
    if (name == mode) return mode;
  const std::string nearest = nearest_name(mode, known);
  throw std::invalid_argument("mechanism " + context.mechanism.info().name + " has no working mode '" + mode + "'" +
                              (nearest.empty() ? "" : "; did you mean '" + nearest + "'?"));
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

inline void demand_dci(const EntryContext& context, Demand& demand) {
  if (context.options.has("limb")) refuse_unknown_joint(context.mechanism, context.options.word("limb"));
  demand.dci = true;
  demand.mode = mode_of(context);
}

template <class S>
struct CouplingField {
  std::vector<S> of_samples;
};

/// Of every sample: the coupling index of one joint, of the joint where it is largest, or the mean over the joints.
/// Valid until the next call with this scratch.
/// @param limb  "1" to "8", "worst" or "mean"
template <class S>
const std::vector<S>& coupling_of(const Survey<S>& survey, const std::string& limb, Scratch& scratch) {
  if (limb != "worst" && limb != "mean") return survey.dci[static_cast<std::size_t>(limb[0] - '1')];
  std::vector<S>& field = scratch.get<CouplingField<S>>().of_samples;
  std::size_t joints = 0;
  while (joints < survey.dci.size() && !survey.dci[joints].empty()) ++joints;
  field.resize(survey.dci[0].size());
  // Pairs of joints, pairs of pairs: the order in which four are compared and added.
  std::array<S, kMostJoints> at;
  for (std::size_t k = 0; k < field.size(); ++k) {
    for (std::size_t i = 0; i < joints; ++i) at[i] = survey.dci[i][k];
    for (std::size_t step = 1; step < joints; step *= 2)
      for (std::size_t i = 0; i + step < joints; i += 2 * step)
        at[i] = limb == "worst" ? max(at[i], at[i + step]) : S(at[i] + at[i + step]);
    field[k] = limb == "worst" ? at[0] : S(at[0] * (1.0 / static_cast<double>(joints)));
  }
  return field;
}
template <class S>
std::vector<S> coupling_of(const Survey<S>& survey, const std::string& limb) {
  Scratch scratch;
  return coupling_of(survey, limb, scratch);
}

inline OptionSpec limb_option() {
  return {.name = "limb",
          .kind = OptionKind::word,
          .initial = std::string("worst"),
          .choices = numbers_of_joints({"worst", "mean"}),
          .meaning = "whose index: one limb's, the largest of each pose, or the mean over the limbs"};
}

}  // namespace pkm
