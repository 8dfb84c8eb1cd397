// Limits of pose quantities that are not given by a formula, such as the conditioning: their margins are computed from
// the report of each pose.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "engine/generic/evaluation.hpp"

namespace pkm::generic {

/// The quantity that the first limit in force without a formula refers to; null if no such limit is in force.
const PoseQuantity* first_report_limit(const Model& model, const LimitSpec& limits);

/// Throws std::invalid_argument if a limit of a quantity without a formula is in force.
/// @param what  the analysis that does not support such limits, for the message: "exact columns"
void refuse_report_limits(const Model& model, const LimitSpec& limits, const std::string& what);

/// Calls add(name, margin) for each limit in force of a quantity without a formula. If the quantity has one value per
/// joint, the margin is the minimum over the joints. It is NaN if the quantity is undefined.
/// @param report  report of the pose, which contains the Jacobian
template <class Add>
void visit_report_margins(const Model& model, const LimitSpec& limits, const PoseReport& report, const Add& add) {
  for (const ReportLimit& each : model.report_limits) {
    const auto& threshold = limits.given[each.limit];
    if (!threshold) continue;
    std::array<double, kMaxJoints> values{};
    each.quantity->evaluate(report, values.data());
    double margin = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < (each.quantity->per_joint ? model.inputs.joints : 1); ++i) {
      const double own = each.is_minimum ? values[i] - *threshold : *threshold - values[i];
      if (!std::isnan(margin) && !(own >= margin)) margin = own;
    }
    add(model.info.limits[each.limit].name, margin);
  }
}

}  // namespace pkm::generic
