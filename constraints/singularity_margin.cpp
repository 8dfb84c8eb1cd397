// Minimum distance from serial and parallel singularities at every pose: one option for each limit of the mechanism.
#include "constraints/list.hpp"
#include "constraints/pose_level.hpp"

namespace pkm {
namespace {

std::vector<OptionSpec> singularity_options(const MechanismInfo& mechanism) {
  std::vector<OptionSpec> specs;
  for (const std::size_t i : limits_of(mechanism, "singularity-margin")) {
    const LimitInfo& limit = mechanism.limits[i];
    specs.push_back(
        {.name = limit.name, .unit = limit.unit, .lower = limit.lower, .upper = limit.upper, .meaning = limit.meaning});
    if (!limit.derivation.empty())
      specs.push_back(
          {.name = limit.name + "_derived",
           .kind = OptionKind::flag,
           .initial = false,
           .meaning = limit.name + " = " + limit.derivation + ", derived from the parameters of the design"});
  }
  return specs;
}

LimitSpec singularity_limits(const MechanismInfo& mechanism, const Options& options) {
  LimitSpec spec = no_limits(mechanism);
  std::vector<std::string> names;
  bool any = false;
  for (const std::size_t i : limits_of(mechanism, "singularity-margin")) {
    const LimitInfo& limit = mechanism.limits[i];
    names.push_back(limit.name);
    if (options.has(limit.name)) spec.given[i] = options.number(limit.name);
    spec.derived[i] = !limit.derivation.empty() && options.flag(limit.name + "_derived");
    if (spec.given[i] && spec.derived[i])
      throw std::invalid_argument("found both " + limit.name + " and " + limit.name + "_derived; expected one of them");
    any = any || spec.given[i] || spec.derived[i];
  }
  if (!any) throw std::invalid_argument("found no threshold; expected at least one of " + join(names));
  return spec;
}

}  // namespace

ConstraintEntry singularity_margin() {
  return {
      .name = "singularity-margin",
      .meaning = "every pose has a minimum distance from singularities",
      .options = singularity_options,
      .refusal = check_limits("singularity-margin"),
      .limits = singularity_limits,
  };
}

}  // namespace pkm
