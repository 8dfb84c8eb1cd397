// What the contract suites need of any mechanism, found without knowing it.
#pragma once

#include <cctype>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/mechanisms/all.hpp"
#include "engine/motion/motions.hpp"
#include "engine/problem/quantity.hpp"
#include "engine/survey/voxel_grid.hpp"

namespace pkm::test {

inline std::vector<double> nominal(const MechanismInfo& info) {
  std::vector<double> values;
  for (const Parameter& p : info.parameters) values.push_back(p.nominal);
  return values;
}

/// A survey of the design's own middle plane without limits; voxels have `cells` per axis.
inline SurveyPlan plan(const MechanismInfo& info, Method method, std::int64_t cells = 0) {
  SurveyPlan plan;
  plan.method = method;
  plan.limits = no_limits(info);
  plan.cells = {cells, cells, cells};
  return plan;
}

/// The same for another of the mechanism's sweeps.
inline SurveyPlan plan(const MechanismInfo& info, const Sweep& sweep, Method method, std::int64_t cells = 0) {
  SurveyPlan p = plan(info, method, cells);
  p.held.coordinate = sweep.held;
  return p;
}

inline Survey<double> survey(const Mechanism& mechanism, const std::vector<double>& parameters, const SurveyPlan& plan,
                             const Demand& demand = {}) {
  Survey<double> result;
  mechanism.prepare(plan, demand)->survey(parameters, result);
  return result;
}

/// A pose inside the nominal design's workspace, whichever mechanism it is.
inline Vector<double, 4> usual_pose(const MechanismInfo& info) {
  if (info.name == "4ppa-2par") return {{0.3, 0.85, -0.8, 0.1}};
  if (info.name == "2t1r-p-hybrid") return {{0, 0.01, 0.23, 0.1}};
  return {{0.2, 0.17, 0.22, 0.1}};
}

/// Motions called "swing" that the nominal design can follow.
inline std::vector<NamedMotion> motions(const MechanismInfo& info) {
  return {{"swing", oscillation(usual_pose(info), 0.01, 1, 1)}};
}

/// A small box of poses around that one, feasible for the nominal design.
inline Region task(const MechanismInfo& info) {
  const Vector<double, 4> centre = usual_pose(info);
  Region region{"task", plan(info, Method::voxels, 4), {}};
  region.plan.held = {HeldCoordinate::Kind::value, centre[static_cast<std::size_t>(info.held)], {}};
  region.plan.box.emplace();
  for (std::size_t k = 0; k < 3; ++k) {
    const double at = centre[static_cast<std::size_t>(info.swept[k])];
    (*region.plan.box)[k] = {at - 0.01, at + 0.01};
  }
  return region;
}

/// Every limit at the end of its range that is farther from inactive: nothing passes.
inline LimitSpec absurd_limits(const MechanismInfo& info) {
  LimitSpec spec = no_limits(info);
  for (std::size_t i = 0; i < info.limits.size(); ++i) {
    const LimitInfo& l = info.limits[i];
    spec.given[i] = std::fabs(l.upper - l.inactive) > std::fabs(l.inactive - l.lower) ? l.upper : l.lower;
  }
  return spec;
}

/// The same for surveys by a method: limits of a clearance, which columns may refuse, are left inactive there.
inline LimitSpec absurd_limits(const Mechanism& mechanism, const SurveyPlan& plan) {
  const MechanismInfo& info = mechanism.info();
  SurveyPlan limited = plan;
  limited.limits = absurd_limits(info);
  try {
    mechanism.prepare(limited, {});
  } catch (const std::invalid_argument&) {
    for (std::size_t i = 0; i < info.limits.size(); ++i)
      if (info.limits[i].group == "clearance") limited.limits.given[i].reset();
  }
  return limited.limits;
}

/// A name that googletest takes.
inline std::string test_name(std::string name) {
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}

}  // namespace pkm::test
