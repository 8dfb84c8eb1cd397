// Options that objectives and constraints of a motion have in common.
#pragma once

#include <cmath>

#include "engine/core/catalogue.hpp"
#include "engine/core/unit.hpp"
#include "engine/problem/quantity.hpp"

namespace pkm {

/// The type of the constraint that a motion keeps every limit of a pose (constraints/motion.cpp). Studies have it for
/// every motion that an objective, a constraint or a report names (engine/setup/quantity_sections.cpp).
inline constexpr const char* kMotionConstraint = "motion";

inline OptionSpec motion_option() {
  return {.name = "motion", .kind = OptionKind::word, .required = true, .meaning = "name of a [[motion]] of the study"};
}

inline OptionSpec samples_option() {
  return {.name = "samples",
          .kind = OptionKind::integer,
          .initial = std::int64_t{201},
          .lower = 2,
          .upper = 100'000,
          .meaning = "poses along the motion, at equal distances in time, both ends included"};
}

/// The motion that the options name. Throws std::invalid_argument where the study has none of that name.
inline const NamedMotion& motion_of(const EntryContext& context) {
  const std::string& name = context.options.word("motion");
  if (const NamedMotion* found = find_named(context.motions, name)) return *found;
  const auto known = names_of(context.motions);
  if (known.empty())
    throw std::invalid_argument("the study has no motion called '" + name +
                                "'; describe it in a table [[motion]] with name = \"" + name + "\"");
  throw std::invalid_argument("the study has no motion called '" + name + "'; it has " + join(known) +
                              did_you_mean(name, known));
}

/// Its samples. Throws std::invalid_argument where one is not finite.
inline std::vector<MotionSample> samples_of(const EntryContext& context) {
  const NamedMotion& named = motion_of(context);
  auto samples = sample(*named.motion, static_cast<std::size_t>(context.options.integer("samples")));
  for (const MotionSample& at : samples)
    for (std::size_t i = 0; i < at.pose.size(); ++i)
      if (!std::isfinite(at.pose[i] + at.velocity[i] + at.acceleration[i]))
        throw std::invalid_argument("the motion " + named.name +
                                    " has no finite pose, velocity and acceleration at t = " + with_unit(at.time, "s"));
  return samples;
}

}  // namespace pkm
