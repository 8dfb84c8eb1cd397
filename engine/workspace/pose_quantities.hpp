// List of all per-pose quantities, and their evaluation. To add a built-in quantity, add a file to quantities/, declare
// its constant here and append it to the list; voxels, objectives, expressions, tables, plots and the report then offer
// it. Formulas of mechanism files and studies, [[quantity]], are per-pose quantities of their mechanism.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "engine/mechanism/mechanism.hpp"
#include "engine/mechanism/workspace_result.hpp"

namespace pkm {

extern const PoseQuantity kConditioning, kCouplingIndex, kInertiaCondition;

/// The built-in quantities in the order of tables: first those computed from a PoseReport, then those of the
/// joint-space inertia.
const std::vector<const PoseQuantity*>& pose_quantities();
/// The quantities of a mechanism: the built-in ones, then its formulas.
std::vector<const PoseQuantity*> pose_quantities(const MechanismInfo& info);
/// The pose quantity of this name. Throws std::invalid_argument if there is none, for example if the name is that of a
/// formula of the design alone, of time derivatives or of a single limb.
const PoseQuantity& pose_quantity_called(const MechanismInfo& info, const std::string& name);

/// Appends the values of all requested quantities that are computed from a PoseReport.
/// @param joints  number of actuated joints of the mechanism
inline void add_report(const PoseReport& report, std::size_t joints, WorkspaceResult<double>& to) {
  for (auto& [quantity, field] : to.fields) {
    if (!quantity->needs_report()) continue;
    std::array<double, kMaxJoints> values;
    quantity->from_report(report, values.data());
    const std::size_t count = quantity->per_joint ? joints : 1;
    for (std::size_t i = 0; i < count; ++i)
      field[i].push_back(std::isfinite(values[i]) ? values[i] : quantity->value_if_undefined);
  }
}

/// Computes all requested quantities of a joint-space inertia M_q, and calls visit(field, values) for each. A value is
/// PoseQuantity::value_if_undefined if it is not finite, or if M_q is infinite or has a diagonal element <= 0 (at the
/// workspace boundary, if no limit keeps a distance from singularities).
/// @param except  a quantity to skip because it has been computed elsewhere; null if there is none
template <class S, SmallMatrix M, class Visit>
void evaluate_inertia(const M& M_q, WorkspaceResult<S>& result, const PoseQuantity* except, const Visit& visit) {
  bool is_valid = true;
  for (std::size_t i = 0; i < M_q.rows(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) is_valid = is_valid && std::isfinite(value_of(M_q(i, j)));
    is_valid = is_valid && value_of(M_q(i, i)) > 0;
  }
  for (auto& [quantity, field] : result.fields) {
    if (!quantity->needs_inertia() || quantity == except) continue;
    std::array<S, kMaxJoints> buffer;
    const std::span<S> values(buffer.data(), quantity->per_joint ? M_q.rows() : 1);
    if (is_valid) quantity->from_inertia(M_q, buffer.data());
    for (S& value : values)
      if (!is_valid || !std::isfinite(value_of(value))) value = S(quantity->value_if_undefined);
    visit(field, values);
  }
}

/// Appends the values of all requested quantities of a joint-space inertia M_q.
template <class S, SmallMatrix M>
void add_inertia(const M& M_q, WorkspaceResult<S>& result, const PoseQuantity* except = nullptr) {
  evaluate_inertia(M_q, result, except, [](auto& field, std::span<const S> values) {
    for (std::size_t i = 0; i < values.size(); ++i) field[i].push_back(values[i]);
  });
}

}  // namespace pkm
