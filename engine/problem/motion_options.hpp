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
inline const DesignMotion& motion_of(const EntryContext& context) {
  const std::string& name = context.options.word("motion");
  if (const DesignMotion* found = find_named(context.motions, name)) return *found;
  const auto known = names_of(context.motions);
  if (known.empty())
    throw std::invalid_argument("the study has no motion called '" + name +
                                "'; define it in a table [[motion]] with name = \"" + name + "\"");
  throw std::invalid_argument("the study has no motion called '" + name + "'; it has " + join(known) +
                              did_you_mean(name, known));
}

/// The samples of the motion named in the options, for any design.
class SampledMotion {
 public:
  /// Throws std::invalid_argument if a sample is not finite.
  explicit SampledMotion(const EntryContext& context)
      : named_(motion_of(context)),
        samples_(sample(*named_.motion, static_cast<std::size_t>(context.options.integer("samples")))) {
    for (const MotionSample& at : samples_)
      for (std::size_t i = 0; i < at.pose.size(); ++i)
        if (!std::isfinite(at.pose[i] + at.velocity[i] + at.acceleration[i]))
          throw std::invalid_argument("the pose, velocity or acceleration of the motion " + named_.name +
                                      " is not finite at t = " + with_unit(at.time, "s"));
  }

  const std::string& name() const { return named_.name; }
  std::size_t size() const { return samples_.size(); }
  Unsupported why_no_derivatives() const { return named_.of_design ? named_.why_no_derivatives : Unsupported(); }

  /// The samples of the motion for a design; they are valid until the next call with the same scratch memory.
  std::span<const MotionSample> of(const DesignView<double>& design) const {
    if (!named_.of_design) return samples_;
    auto& samples = design.scratch.template get<std::vector<MotionSample>>();
    return samples = sample(*named_.of_design(design.parameters), samples_.size());
  }
  /// Calls work(samples) with the samples of the motion for a design: std::span<const MotionSample> or, if they have
  /// derivatives, std::span<const DualMotionSample>.
  template <class Work>
  auto with(const DesignView<double>& design, const Work& work) const {
    return work(of(design));
  }
  template <class Work>
  auto with(const DesignView<Dual4>& design, const Work& work) const {
    if (!named_.of_design) return work(std::span<const MotionSample>(samples_));
    const auto samples = sample_with_derivatives(named_, design.parameters, samples_.size());
    return work(std::span<const DualMotionSample>(samples));
  }

 private:
  DesignMotion named_;
  /// Samples for the parameters of the study; all designs share them unless the motion depends on parameters.
  std::vector<MotionSample> samples_;
};

}  // namespace pkm
