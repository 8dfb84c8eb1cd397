// Feasibility of a motion: every pose along it must satisfy the limits of poses.
//
// The margin is the minimum of all pose margins (reach, strokes, distances from singularities, clearance, ...) over the
// samples of the motion, with the limits of the study. For gradient solvers this minimum is replaced by a smooth lower
// bound (soft_minimum). Studies have this constraint for every motion that an objective, a constraint or an output
// uses, unless that [[motion]] has follow = false: forces along a motion that the robot cannot follow are meaningless.
#include <cmath>

#include "constraints/list.hpp"
#include "constraints/pose_margins.hpp"
#include "engine/mechanism/ordered_margins.hpp"
#include "engine/problem/motion_options.hpp"
#include "engine/problem/pose_options.hpp"

namespace pkm {
namespace {

constexpr double kUnlimited = 1;  // margin of a motion if the mechanism has no limits of poses

class MinimumAlong final : public Quantity {
 public:
  explicit MinimumAlong(const EntryContext& context)
      : motion_(context),
        along_{{}, mode_of(context), context.plan.limits},
        sharpness_(context.options.number("sharpness")) {
    const DesignMotion& motion = motion_of(context);
    depends_on_design_ = static_cast<bool>(motion.of_design);
    if (!depends_on_design_) along_.poses = poses_of(sample(*motion.motion, motion_.size()));
    why_no_derivatives_ = motion_.why_no_derivatives();
    if (!why_no_derivatives_)
      why_no_derivatives_ = no_margin_derivatives(context.mechanism, along_.limits, kMotionConstraint);
  }

  double value(const DesignView<double>& design) const override {
    if (!depends_on_design_) return minimum_or_unlimited(margins_of(design, along_));
    return minimum_or_unlimited(margins_of(design, {poses_of(motion_.of(design)), along_.mode, along_.limits}));
  }
  Dual4 smooth(const DesignView<Dual4>& design) const override {
    if (!depends_on_design_) return minimum_or_unlimited(margins_of(design, along_));
    return motion_.with(design, [&](const auto& samples) {
      std::vector<Pose<Dual4>> poses;
      for (const auto& at : samples) poses.push_back(at.pose);
      std::vector<Dual4> margins;
      find_ordered_margins(design.mechanism)
          ->append_ordered(design.parameters, along_.mode, along_.limits, poses, design.scratch, margins);
      // A margin that does not exist (NaN) counts as -1.
      for (Dual4& margin : margins)
        if (std::isnan(margin.a)) margin = Dual4(-1.0);
      return minimum_or_unlimited(margins);
    });
  }
  Unsupported why_no_derivatives() const override { return why_no_derivatives_; }

 private:
  static std::vector<Pose<double>> poses_of(std::span<const MotionSample> samples) {
    std::vector<Pose<double>> poses;
    for (const MotionSample& at : samples) poses.push_back(at.pose);
    return poses;
  }
  static double minimum_or_unlimited(const std::vector<double>& margins) {
    return margins.empty() ? kUnlimited : minimum(margins);
  }
  Dual4 minimum_or_unlimited(const std::vector<Dual4>& margins) const {
    return margins.empty() ? Dual4(kUnlimited) : soft_minimum(margins, sharpness_);
  }

  SampledMotion motion_;
  MarginPoses along_;  ///< the poses along the motion; empty if the motion depends on the design
  double sharpness_;
  bool depends_on_design_ = false;
  Unsupported why_no_derivatives_;
};

}  // namespace

ConstraintEntry motion_constraint() {
  return {
      .name = kMotionConstraint,
      .meaning =
          "every pose along a motion satisfies the limits of poses: minimum of all margins, each in its own unit (m, "
          "rad or 1)",
      .options =
          [](const MechanismInfo&) {
            return std::vector<OptionSpec>{motion_option(), samples_option(), mode_option(), sharpness_of_minimum()};
          },
      .unit = unit_of_minimum,
      .make = [](const EntryContext& context) { return std::make_unique<MinimumAlong>(context); },
      .detail =
          [](const EntryContext& context) {
            return "minimum margin of a pose along the motion " + context.options.word("motion") + ", over " +
                   std::to_string(context.options.integer("samples")) + " samples" +
                   (unit_of_minimum(context) == "1" ? ", in the unit of its limit: m, rad or 1" : "");
          },
  };
}

}  // namespace pkm
