// Minimum clearance (distance) between links that are not connected by a joint, for example links of different limbs,
// platforms, rails, and sliders on one rail. Links are modelled as capsules; the mechanism defines which pairs are
// tested.
#include "constraints/list.hpp"
#include "constraints/pose_level.hpp"

namespace pkm {
namespace {

std::vector<OptionSpec> clearance_options(const MechanismInfo& mechanism) {
  const auto owned = limits_of(mechanism, "clearance");
  if (owned.empty()) return {};
  const LimitInfo& limit = mechanism.limits[owned.front()];
  return {{.name = "min",
           .unit = limit.unit,
           .initial = 0.0,
           .lower = limit.lower,
           .upper = limit.upper,
           .meaning = "minimum distance of links that are not joined; 0: no contact; < 0: permitted overlap"}};
}

LimitSpec clearance_limits(const MechanismInfo& mechanism, const Options& options) {
  LimitSpec spec = no_limits(mechanism);
  for (const std::size_t i : limits_of(mechanism, "clearance")) spec.given[i] = options.number("min");
  return spec;
}

}  // namespace

ConstraintEntry clearance() {
  return {
      .name = "clearance",
      .meaning = "minimum distance of links that are not joined (limbs, platforms, sliders or rails), as capsules",
      .options = clearance_options,
      .refusal = check_limits("clearance"),
      .limits = clearance_limits,
  };
}

}  // namespace pkm
