// What all quantities that read the joint-space inertia of poses have in common.
#pragma once

#include "engine/problem/quantity.hpp"

namespace pkm {

inline bool has_dynamics(const MechanismInfo& mechanism) { return mechanism.has_dynamics; }

/// "" or why a mechanism cannot serve the objective.
inline std::string refuse_without_dynamics(const std::string& objective, const MechanismInfo& mechanism) {
  if (mechanism.has_dynamics) return {};
  return "objective " + objective + " needs dynamics, and mechanism " + mechanism.name + " has no masses";
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

inline void demand_dci(const EntryContext& context, Demand& demand) {
  demand.dci = true;
  demand.mode = mode_of(context);
}

template <class S>
struct CouplingField {
  std::vector<S> of_samples;
};

/// Of every sample: the coupling index of one joint, of the joint where it is largest, or the mean over the joints.
/// Valid until the next call with this scratch.
/// @param limb  "1" to "4", "worst" or "mean"
template <class S>
const std::vector<S>& coupling_of(const Survey<S>& survey, const std::string& limb, Scratch& scratch) {
  if (limb != "worst" && limb != "mean") return survey.dci[static_cast<std::size_t>(limb[0] - '1')];
  std::vector<S>& field = scratch.get<CouplingField<S>>().of_samples;
  field.resize(survey.dci[0].size());
  for (std::size_t k = 0; k < field.size(); ++k) {
    const S &a = survey.dci[0][k], &b = survey.dci[1][k], &c = survey.dci[2][k], &d = survey.dci[3][k];
    field[k] = limb == "worst" ? max(max(a, b), max(c, d)) : S(((a + b) + (c + d)) * 0.25);
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
          .choices = {"1", "2", "3", "4", "worst", "mean"},
          .meaning = "whose index: one limb's, the largest of each pose, or the mean over the limbs"};
}

}  // namespace pkm
