// Options shared by the objectives and constraints that are evaluated along a motion.
#pragma once

#include <cmath>

#include "engine/core/catalogue.hpp"
#include "engine/core/unit.hpp"
#include "engine/problem/quantity.hpp"

namespace pkm {

/// Type of the constraint that all poses of a motion satisfy their limits (constraints/motion.cpp). The reader of study
/// files adds it for every motion that an objective, a constraint or an output uses.
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
          .meaning = "number of poses along the motion, equally spaced in time, including both ends"};
}

inline OptionSpec wrench_option() {
  OptionSpec option = {.name = "wrench",
                       .kind = OptionKind::named_numbers,
                       .meaning = "constant force and moment on the platform; default: none"};
  for (std::size_t i = 0; i < wrench_names().size(); ++i)
    option.fields.emplace_back(wrench_names()[i], i < 3 ? "N" : "N m");
  return option;
}

/// The wrench in the options; components that are not given are 0.
inline Wrench<double> wrench_of(const EntryContext& context) {
  Wrench<double> wrench;
  if (!context.options.has("wrench")) return wrench;
  const NamedNumbers& given = context.options.numbers("wrench");
  for (std::size_t i = 0; i < wrench_names().size(); ++i)
    if (const auto at = given.find(wrench_names()[i]); at != given.end()) wrench[i] = at->second;
  return wrench;
}

/// The motion named in the options. Throws std::invalid_argument if the study has none of that name.
inline const NamedMotion& motion_of(const EntryContext& context) {
  const std::string& name = context.options.word("motion");
  if (const NamedMotion* found = find_named(context.motions, name)) return *found;
  const auto known = names_of(context.motions);
  if (known.empty())
    throw std::invalid_argument("the study has no motion called '" + name +
                                "'; define it in a table [[motion]] with name = \"" + name + "\"");
  throw std::invalid_argument("the study has no motion called '" + name + "'; it has " + join(known) +
                              did_you_mean(name, known));
}

/// Samples of the motion named in the options. Throws std::invalid_argument if a sample is not finite.
inline std::vector<MotionSample> samples_of(const EntryContext& context) {
  const NamedMotion& named = motion_of(context);
  auto samples = sample(*named.motion, static_cast<std::size_t>(context.options.integer("samples")));
  for (const MotionSample& at : samples)
    for (std::size_t i = 0; i < at.pose.size(); ++i)
      if (!std::isfinite(at.pose[i] + at.velocity[i] + at.acceleration[i]))
        throw std::invalid_argument("the pose, velocity or acceleration of the motion " + named.name +
                                    " is not finite at t = " + with_unit(at.time, "s"));
  return samples;
}

}  // namespace pkm
