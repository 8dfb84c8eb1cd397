// The quantities of poses that surveys can hold. One more is a file in quantities/, its name here and its place in the
// list; surveys by voxels, an objective, its results in expressions, and columns of tables, images and pages follow.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "engine/mechanism/survey.hpp"

namespace pkm {

extern const PoseQuantity kConditioning, kCouplingIndex, kInertiaCondition;

/// In the order in which they are shown: those of reports before those of inertia.
const std::vector<const PoseQuantity*>& pose_quantities();

/// Calls take(components of the field, values) for every field of a survey that inertia gives, with its values at a
/// pose. Where M_q is infinite or has no value, on the edge of the workspace without margins, and where a value is not
/// finite, it is PoseQuantity::without_value.
/// @param except  a field that is known already, or null
template <class S, SmallMatrix M, class Take>
void evaluate_inertia(const M& M_q, Survey<S>& survey, const PoseQuantity* except, const Take& take) {
  bool has_value = true;
  for (std::size_t i = 0; i < M_q.rows(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) has_value = has_value && std::isfinite(value_of(M_q(i, j)));
    has_value = has_value && value_of(M_q(i, i)) > 0;
  }
  for (auto& [quantity, field] : survey.fields) {
    if (!quantity->needs_inertia() || quantity == except) continue;
    std::array<S, kMaxJoints> room;
    const std::span<S> values(room.data(), quantity->per_joint ? M_q.rows() : 1);
    if (has_value) quantity->of_inertia(M_q, room.data());
    for (S& value : values)
      if (!has_value || !std::isfinite(value_of(value))) value = S(quantity->without_value);
    take(field, values);
  }
}

/// Adds them.
template <class S, SmallMatrix M>
void add_inertia(const M& M_q, Survey<S>& survey, const PoseQuantity* except = nullptr) {
  evaluate_inertia(M_q, survey, except, [](auto& field, std::span<const S> values) {
    for (std::size_t i = 0; i < values.size(); ++i) field[i].push_back(values[i]);
  });
}

}  // namespace pkm
