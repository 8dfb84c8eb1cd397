// Statistics of a survey's fields, and what every entry of the catalogues that reads one has in common.
#pragma once

#include <type_traits>

#include "engine/math/statistics.hpp"
#include "engine/problem/pose_options.hpp"
#include "engine/survey/pose_quantities.hpp"

namespace pkm {

/// "; 1 where no pose is feasible", or "" where that is 0.
inline std::string where_empty(const PoseQuantity& quantity) {
  if (quantity.without_value == 0) return {};
  return "; " + shortest(quantity.without_value) + " where no pose is feasible";
}

inline bool gives(const Mechanism& mechanism, const PoseQuantity& quantity) {
  return quantity.needs_inertia() ? has_dynamics(mechanism) : has_jacobian(mechanism);
}

/// What a survey has to compute.
inline void demand_field(const PoseQuantity& quantity, const EntryContext& context, Demand& demand) {
  const Options& options = context.options;
  if (options.has("limb")) refuse_unknown_joint(context.mechanism, options.word("limb"));
  demand.add(quantity);
  if (quantity.needs_inertia()) demand.mode = mode_of(context);
  if (!quantity.needs_inertia() && options.has("characteristic_length"))
    demand.characteristic_length = options.number("characteristic_length");
}

template <class S>
struct JointField {
  std::vector<S> of_samples;
};

/// Of every sample: the value of one joint, of the joint where it is worst, or the mean over the joints. Valid until
/// the next call with this scratch.
/// @param joint  "1" to "8", "worst" or "mean"; of a quantity with one value per pose nothing else is meant
template <class S>
const std::vector<S>& field_of(const Survey<S>& survey, const PoseQuantity& quantity, const std::string& joint,
                               Scratch& scratch) {
  if (!quantity.per_joint) return survey.of(quantity);
  if (joint != "worst" && joint != "mean") return survey.of(quantity, static_cast<std::size_t>(joint[0] - '1'));
  std::vector<S>& field = scratch.get<JointField<S>>().of_samples;
  std::array<const S*, kMostJoints> of_joint;
  std::size_t joints = 0;
  for (; joints < kMostJoints && !survey.of(quantity, joints).empty(); ++joints)
    of_joint[joints] = survey.of(quantity, joints).data();
  field.resize(survey.of(quantity).size());
  const auto combine = [&, mean = joint == "mean"](const S& a, const S& b) {
    return mean ? S(a + b) : quantity.worst == PoseQuantity::Worst::least ? min(a, b) : max(a, b);
  };
  // Pairs of joints, pairs of pairs: the order in which four are compared and added.
  std::array<S, kMostJoints> at;
  for (std::size_t k = 0; k < field.size(); ++k) {
    for (std::size_t i = 0; i < joints; ++i) at[i] = of_joint[i][k];
    for (std::size_t step = 1; step < joints; step *= 2)
      for (std::size_t i = 0; i + step < joints; i += 2 * step) at[i] = combine(at[i], at[i + step]);
    field[k] = joint == "mean" ? S(at[0] * (1.0 / static_cast<double>(joints))) : at[0];
  }
  return field;
}

/// One number of the samples.
struct PoseStatistic {
  const PoseQuantity& quantity;
  std::string statistic;        ///< "mean", "std", "min", "max" or "p95", which has no derivatives
  std::string joint = "worst";  ///< of field_of()
  double sharpness = 200;       ///< of what stands for "min" and "max" where derivatives count

  template <class S>
  S operator()(const Survey<S>& survey, Scratch& scratch) const {
    const std::vector<S>& weight = survey.weight;
    if (weight.empty()) return S(quantity.without_value);
    const std::vector<S>& field = field_of(survey, quantity, joint, scratch);
    if (statistic == "mean") return weighted_mean(weight, field);
    if (statistic == "std") return weighted_deviation(weight, field);
    if constexpr (std::is_same_v<S, double>) {
      if (statistic == "p95") return weighted_quantile(weight, field, 0.95, scratch.get<Order>().of_samples);
      return statistic == "min" ? least(field) : greatest(field);
    } else {
      return statistic == "min" ? soft_least(weight, field, sharpness) : soft_greatest(weight, field, sharpness);
    }
  }
  template <class S>
  S operator()(const DesignView<S>& design) const {
    return (*this)(*design.survey, design.scratch);
  }

 private:
  struct Order {
    std::vector<std::size_t> of_samples;
  };
};

}  // namespace pkm
