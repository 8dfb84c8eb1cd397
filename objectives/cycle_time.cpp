// Shortest time of a motion within the limits of joints, motors and the tool (engine/mechanism/fastest_motion.hpp).
//
// The value depends on the design only. Its derivatives follow from the active limits by implicit differentiation; they
// exist wherever the active limits do not change (envelope theorem). If the mechanism cannot perform the motion at any
// speed, the value is NaN and the design `failed`, unless the constraint `motion` has rejected it.
#include <algorithm>
#include <iterator>
#include <limits>

#include "engine/core/error.hpp"
#include "engine/problem/fastest_options.hpp"
#include "engine/problem/pose_options.hpp"
#include "objectives/list.hpp"

namespace pkm {
namespace {

class CycleTime final : public Quantity {
 public:
  explicit CycleTime(const EntryContext& context) : fastest_(context) {
    if (fastest_.motion().of_design)
      why_no_derivatives_ = "cycle-time has no derivatives by parameters of the motion, and the motion " +
                            fastest_.motion().name + " depends on the design; use an optimiser without gradients";
    if (const Unsupported reason = why_no_joint_forces(context.mechanism))
      why_no_derivatives_ = "joint speeds along a motion have no derivatives without dynamics: " + *reason;
  }

  Unsupported why_no_derivatives() const override { return why_no_derivatives_; }

  double value(const DesignView<double>& design) const override {
    try {
      return fastest_.with_times(design,
                                 [](const auto&, const ShortestTimes& times, const auto&) { return times.duration; });
    } catch (const DesignError&) {
      return std::numeric_limits<double>::quiet_NaN();
    }
  }
  Dual4 smooth(const DesignView<Dual4>& design) const override {
    std::vector<double> parameters;
    for (const Dual4& parameter : design.parameters) parameters.push_back(parameter.a);
    const DesignWithLimits at = fastest_.with_limits(design.mechanism, parameters);
    const MovesOfMotion& moves = fastest_.moves();
    try {
      return duration_with_derivatives(moves, shortest_times(moves, at), at, design.parameters);
    } catch (const DesignError&) {
      return Dual4(std::numeric_limits<double>::quiet_NaN());
    }
  }
  std::string why_undefined(const DesignView<double>& design) const override { return fastest_.why_undefined(design); }

 private:
  FastestOfDesign fastest_;
  Unsupported why_no_derivatives_;
};

}  // namespace

ObjectiveEntry cycle_time() {
  std::vector<OptionSpec> options = {
      motion_option(),
      {.name = "law",
       .kind = OptionKind::word,
       .initial = std::string("optimal"),
       .choices = {"optimal", "own"},
       .meaning =
           "optimal: time-optimal speed along the path; own: the motion's time law, each move scaled by one factor"},
      mode_option(),
      wrench_option()};
  std::ranges::move(fastest_options(), std::back_inserter(options));
  return {
      .name = "cycle-time",
      .meaning = "shortest time of a motion within limits of the joints, the motors and the tool",
      .direction = Direction::minimise,
      .options = std::move(options),
      .unit = [](const EntryContext&) { return std::string("s"); },
      .refusal =
          [](const Mechanism& mechanism) {
            const Unsupported reason = why_no_limits(mechanism, {});
            return reason ? "objective cycle-time: " + *reason : Unsupported();
          },
      .make = [](const EntryContext& context) { return std::make_unique<CycleTime>(context); },
      .detail =
          [](const EntryContext& context) {
            return "shortest time of the motion " + context.options.word("motion") +
                   (context.options.word("law") == "own" ? " with its own time law" : "");
          },
      .range = nonnegative,
      .uses_workspace = false,
  };
}

}  // namespace pkm
