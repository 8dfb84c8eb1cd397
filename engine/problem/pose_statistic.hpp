// Statistics of the pose quantities of a workspace analysis (mean, standard deviation, extrema, quantile), with the
// helpers that the catalogue entries based on them share.
#pragma once

#include <cmath>
#include <string>
#include <type_traits>

#include "engine/math/statistics.hpp"
#include "engine/problem/pose_options.hpp"
#include "engine/workspace/pose_quantities.hpp"

namespace pkm {

/// Text that states the value for an empty workspace: "; 1 if no pose is feasible", or "" if that value is 0.
inline std::string empty_workspace_note(const PoseQuantity& quantity) {
  if (quantity.value_if_undefined == 0) return {};
  if (std::isnan(quantity.value_if_undefined)) return "; undefined if no pose is feasible";
  return "; " + shortest(quantity.value_if_undefined) + " if no pose is feasible";
}

/// Adds the quantity of an entry to the fields that the workspace analysis computes, with the entry's options.
inline void request_field(const PoseQuantity& quantity, const EntryContext& context, FieldRequest& request) {
  const Options& options = context.options;
  if (options.has("limb")) validate_joint(context.mechanism, options.word("limb"));
  request.add(quantity);
  if (quantity.needs_inertia()) request.mode = mode_of(context);
  if (quantity.needs_report() && options.has("characteristic_length"))
    request.characteristic_length = options.number("characteristic_length");
}

template <class S>
struct JointFieldScratch {
  std::vector<S> field;
};

/// The values of a quantity at all samples, reduced over the joints: the value of one joint, of the worst joint, or the
/// mean. The reference is valid until the next call with the same scratch memory.
/// @param joint  "1" to "8", "worst" or "mean"; ignored for quantities with one value per pose
template <class S>
const std::vector<S>& reduced_field(const WorkspaceResult<S>& workspace, const PoseQuantity& quantity,
                                    const std::string& joint, Scratch& scratch) {
  if (!quantity.per_joint) return workspace.field(quantity);
  if (joint != "worst" && joint != "mean") return workspace.field(quantity, static_cast<std::size_t>(joint[0] - '1'));
  std::vector<S>& field = scratch.get<JointFieldScratch<S>>().field;
  std::array<const S*, kMaxJoints> of_joint;
  std::size_t joints = 0;
  for (; joints < kMaxJoints && !workspace.field(quantity, joints).empty(); ++joints)
    of_joint[joints] = workspace.field(quantity, joints).data();
  field.resize(workspace.field(quantity).size());
  const auto combine = [&, mean = joint == "mean"](const S& a, const S& b) {
    return mean ? S(a + b) : quantity.worst == PoseQuantity::Worst::minimum ? min(a, b) : max(a, b);
  };
  // Pairwise reduction in a fixed order, ((1, 2), (3, 4)) for four joints: rounding does not depend on the caller.
  std::array<S, kMaxJoints> at;
  for (std::size_t k = 0; k < field.size(); ++k) {
    for (std::size_t i = 0; i < joints; ++i) at[i] = of_joint[i][k];
    for (std::size_t step = 1; step < joints; step *= 2)
      for (std::size_t i = 0; i + step < joints; i += 2 * step) at[i] = combine(at[i], at[i + step]);
    field[k] = joint == "mean" ? S(at[0] * (1.0 / static_cast<double>(joints))) : at[0];
  }
  return field;
}

/// A statistic in words, such as "minimum" or "5 % quantile".
inline std::string statistic_in_words(const std::string& statistic) {
  if (statistic[0] == 'p') return statistic.substr(1) + " % quantile";
  if (statistic == "std") return "standard deviation";
  return statistic == "mean" ? "mean" : statistic == "min" ? "minimum" : "maximum";
}

/// A statistic of one quantity over the weighted samples of a workspace analysis.
struct PoseStatistic {
  const PoseQuantity& quantity;
  std::string statistic;        ///< "mean", "std", "min", "max" or a quantile such as "p95" (without derivatives)
  std::string joint = "worst";  ///< number of a joint, or how the joints are combined: "worst", "mean"
  double sharpness = 200;       ///< sharpness of the smooth approximation of "min" and "max" with derivatives

  template <class S>
  S operator()(const WorkspaceResult<S>& workspace, Scratch& scratch) const {
    const std::vector<S>& weight = workspace.weight;
    if (weight.empty()) return S(quantity.value_if_undefined);
    const std::vector<S>& field = reduced_field(workspace, quantity, joint, scratch);
    if (std::ranges::any_of(field, [](const S& x) { return std::isnan(value_of(x)); })) return S(std::nan(""));
    if (statistic == "mean") return weighted_mean(weight, field);
    if (statistic == "std") return weighted_standard_deviation(weight, field);
    if constexpr (std::is_same_v<S, double>) {
      if (statistic[0] == 'p')
        return weighted_quantile(weight, field, std::stoi(statistic.substr(1)) / 100.0,
                                 scratch.get<SortScratch>().order);
      return statistic == "min" ? minimum(field) : maximum(field);
    } else {
      if (quantity.formula) return scaled_extremum(weight, field, scratch.get<ScaledScratch<S>>().field);
      return statistic == "min" ? soft_min(weight, field, sharpness) : soft_max(weight, field, sharpness);
    }
  }
  template <class S>
  S operator()(const DesignView<S>& design) const {
    return (*this)(*design.workspace, design.scratch);
  }

 private:
  struct SortScratch {
    std::vector<std::size_t> order;
  };
  template <class S>
  struct ScaledScratch {
    std::vector<S> field;
  };

  /// The smooth approximation of "min" or "max". The values are scaled to [0, 1]; the result is then independent of
  /// their unit.
  template <class S>
  S scaled_extremum(const std::vector<S>& weight, const std::vector<S>& field, std::vector<S>& scaled) const {
    const S lower = minimum(field), range = maximum(field) - lower;
    if (!(value_of(range) > 0)) return lower;
    scaled.clear();
    for (const S& value : field) scaled.push_back((value - lower) / range);
    return lower +
           range * (statistic == "min" ? soft_min(weight, scaled, sharpness) : soft_max(weight, scaled, sharpness));
  }
};

}  // namespace pkm
