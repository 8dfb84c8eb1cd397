// Minimum margin over several poses, with a smooth lower bound for gradient solvers: shared by the constraints on a
// motion and on a region.
#pragma once

#include <string>
#include <type_traits>
#include <vector>

#include "engine/math/statistics.hpp"
#include "engine/problem/quantity.hpp"

namespace pkm {

/// The poses that a constraint tests.
struct MarginPoses {
  std::vector<Pose<double>> poses;
  std::string mode;
  LimitSpec limits;
};

template <class S>
struct MarginsOfPoses {
  std::vector<S> all;
};

/// All margins of all poses, from the mechanism's PoseMargins capability or, without this capability (double only),
/// from Mechanism::inspect(). In the latter case, a NaN margin and a pose that does not assemble count as -1. The
/// reference is valid until the next call with the same scratch memory.
template <class S>
const std::vector<S>& margins_of(const DesignView<S>& design, const MarginPoses& of) {
  const Mechanism& mechanism = design.mechanism;
  std::vector<S>& margins = design.scratch.template get<MarginsOfPoses<S>>().all;
  margins.clear();
  if (const PoseMargins* const ability = mechanism.pose_margins()) {
    ability->append(design.parameters, of.mode, of.limits, of.poses, design.scratch, margins);
  } else if constexpr (std::is_same_v<S, double>) {
    for (const Pose<double>& pose : of.poses) {
      const PoseReport report = mechanism.inspect(design.parameters, pose, of.mode, of.limits);
      for (const auto& [name, margin] : report.margins) margins.push_back(margin == margin ? margin : -1);
      if (!report.assembles) margins.push_back(-1);
    }
  }
  return margins;
}

/// Smooth lower bound of the minimum (log-sum-exp, Kreisselmeier-Steinhauser function); the error is at most
/// ln(number of margins) / sharpness.
inline Dual4 soft_minimum(const std::vector<Dual4>& margins, double sharpness) {
  const double shift = minimum(margins).a;
  Dual4 sum(0.0);
  for (const Dual4& margin : margins) sum += exp((margin - shift) * -sharpness);
  return shift - log(sum) / sharpness;
}

/// Unit of the minimum margin: the common unit of the margins, or "1" if their units differ.
inline std::string unit_of_minimum(const EntryContext& context) {
  const PoseMargins* const margins = context.mechanism.pose_margins();
  return margins && !margins->margin_unit().empty() ? margins->margin_unit() : std::string("1");
}

/// The reason why the minimum margin has no derivatives; empty if it has derivatives.
inline Unsupported no_margin_derivatives(const Mechanism& mechanism, const LimitSpec& limits,
                                         const std::string& constraint) {
  if (mechanism.pose_margins()) return mechanism.pose_margins()->why_no_derivatives(limits);
  return "the margins of constraint " + constraint + " have none for mechanism " + mechanism.info().name;
}

inline OptionSpec sharpness_of_minimum() {
  return {.name = "sharpness",
          .initial = 1e5,
          .lower = 1,
          .upper = 1e9,
          .meaning = "sharpness of the smooth lower bound for gradient solvers; larger is more accurate"};
}

}  // namespace pkm
