// Links that are not joined keep clear of each other: different limbs, platforms, sliders on one rail, rails. Links are
// capsules; which pairs count is written down with the mechanism.
#include "constraints/list.hpp"
#include "constraints/pose_level.hpp"

namespace pkm {
namespace {

const LimitInfo* limit_of(const MechanismInfo& mechanism) {
  for (const auto& limit : mechanism.limits)
    if (limit.group == "clearance") return &limit;
  return nullptr;
}

std::vector<OptionSpec> options(const MechanismInfo& mechanism) {
  const LimitInfo* const limit = limit_of(mechanism);
  if (!limit) return {};
  return {{.name = "min",
           .kind = OptionKind::number,
           .unit = limit->unit,
           .initial = 0.0,
           .lower = 0,
           .upper = limit->upper,
           .meaning = "least distance of links that are not joined; 0: they do not touch"}};
}

LimitSpec limits(const MechanismInfo& mechanism, const Options& options) {
  LimitSpec spec = no_limits(mechanism);
  for (std::size_t i = 0; i < mechanism.limits.size(); ++i)
    if (mechanism.limits[i].group == "clearance") spec.given[i] = options.number("min");
  return spec;
}

}  // namespace

ConstraintEntry clearance() {
  return {
      .name = "clearance",
      .meaning = "links that are not joined (limbs, platforms, sliders or rails), as capsules, keep a least distance",
      .pose_level = true,
      .options = options,
      .unit = nullptr,
      .refusal = [](const Mechanism& mechanism) { return refuse_without_limits(mechanism, "clearance"); },
      .limits = limits,
      .make = nullptr,
  };
}

}  // namespace pkm
