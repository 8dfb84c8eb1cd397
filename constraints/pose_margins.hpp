// What constraints on the margins of several poses share.
#pragma once

#include <string>
#include <type_traits>
#include <vector>

#include "engine/math/statistics.hpp"
#include "engine/problem/quantity.hpp"

namespace pkm {

/// The poses whose margins a constraint looks at.
struct MarginPoses {
  std::vector<Pose<double>> poses;
  std::string mode;
  LimitSpec limits;
};

template <class S>
struct MarginsOfPoses {
  std::vector<S> all;
};

/// All margins of the poses: by the mechanism's ability, else those that inspect names, where a margin that is not a
/// number, and a pose that does not assemble, count as -1. Valid until the next call with this scratch.
template <class S>
const std::vector<S>& margins_of(const DesignView<S>& design, const MarginPoses& of) {
  const Mechanism& mechanism = design.mechanism;
  std::vector<S>& margins = design.scratch.template get<MarginsOfPoses<S>>().all;
  margins.clear();
  if (const PoseMargins* const ability = mechanism.pose_margins()) {
    ability->append(design.parameters, of.mode, of.limits, of.poses, margins);
  } else if constexpr (std::is_same_v<S, double>) {
    for (const Pose<double>& pose : of.poses) {
      const PoseReport report = mechanism.inspect(design.parameters, pose, of.mode, of.limits);
      for (const auto& [name, margin] : report.margins) margins.push_back(margin == margin ? margin : -1);
      if (!report.assembles) margins.push_back(-1);
    }
  }
  return margins;
}

/// A smooth lower bound of the minimum, below it by at most ln(number of margins) / sharpness.
inline Dual4 soft_minimum(const std::vector<Dual4>& margins, double sharpness) {
  const double shift = least(margins).a;
  Dual4 sum(0.0);
  for (const Dual4& margin : margins) sum += exp((margin - shift) * -sharpness);
  return shift - log(sum) / sharpness;
}

/// Unit of the minimum: that of all margins, or "1" where they have different ones.
inline std::string unit_of_minimum(const EntryContext& context) {
  const PoseMargins* const margins = context.mechanism.pose_margins();
  return margins && !margins->margin_unit().empty() ? margins->margin_unit() : std::string("1");
}

/// Why the minimum has no derivatives.
inline Refusal no_margin_derivatives(const Mechanism& mechanism, const std::string& constraint) {
  if (mechanism.pose_margins()) return {};
  return "the margins of mechanism " + mechanism.info().name + " under " + constraint + " have none";
}

inline OptionSpec sharpness_of_minimum() {
  return {.name = "sharpness",
          .initial = 1e5,
          .lower = 1,
          .upper = 1e9,
          .meaning = "of the smooth lower bound that gradient solvers are given: larger is nearer"};
}

}  // namespace pkm
