// Shortest time of a motion within the limits of joints, motors and the tool (engine/mechanism/fastest_motion.hpp).
//
// The value depends on the design only. Its derivatives follow from the active limits by implicit differentiation; they
// exist wherever the active limits do not change (envelope theorem). If the mechanism cannot perform the motion at any
// speed, the value is NaN and the design `failed`, unless the constraint `motion` has rejected it.
#include <cmath>
#include <limits>

#include "engine/core/catalogue.hpp"
#include "engine/mechanism/fastest_motion.hpp"
#include "engine/mechanism/with_drive_trains.hpp"
#include "engine/problem/motion_options.hpp"
#include "engine/problem/pose_options.hpp"
#include "objectives/list.hpp"

namespace pkm {
namespace {

MotionLimits limits_of(const EntryContext& context) {
  MotionLimits limits{.joints = joint_limits(context.mechanism)};
  if (context.options.has("tool_speed")) limits.tool_speed = context.options.number("tool_speed");
  if (context.options.has("tool_acceleration")) limits.tool_acceleration = context.options.number("tool_acceleration");
  if (const Unsupported reason = why_no_limits(context.mechanism, limits)) throw std::invalid_argument(*reason);
  const bool is_bounded =
      std::isfinite(limits.tool_acceleration) || std::ranges::any_of(limits.joints, [](const JointLimits& joint) {
        return std::isfinite(joint.acceleration) || std::isfinite(joint.force) || joint.motor;
      });
  if (!is_bounded)
    throw std::invalid_argument(
        "no limit of acceleration, force or torque bounds the time; give tool_acceleration, or peak_acceleration, "
        "peak_force or motor in [[drive_train]]");
  return limits;
}

std::size_t nodes_of(const EntryContext& context) {
  const std::int64_t nodes = context.options.integer("nodes");
  if (nodes % 2 != 0)
    throw std::invalid_argument("nodes = " + std::to_string(nodes) + " is odd; expected an even number");
  return static_cast<std::size_t>(nodes);
}

class CycleTime final : public Quantity {
 public:
  explicit CycleTime(const EntryContext& context)
      : limits_(limits_of(context)),
        motion_(motion_of(context)),
        law_(context.options.word("law") == "own" ? FastestLaw::own : FastestLaw::optimal),
        nodes_(nodes_of(context)),
        moves_(std::make_shared<const MovesOfMotion>(motion_.motion, law_, nodes_)),
        mode_(mode_of(context)),
        wrench_(wrench_of(context)) {
    if (motion_.of_design)
      why_no_derivatives_ = "cycle-time has no derivatives by parameters of the motion, and the motion " +
                            motion_.name + " depends on the design; use an optimiser without gradients";
    if (const Unsupported reason = why_no_joint_forces(context.mechanism))
      why_no_derivatives_ = "joint speeds along a motion have no derivatives without dynamics: " + *reason;
  }

  Unsupported why_no_derivatives() const override { return why_no_derivatives_; }

  double value(const DesignView<double>& design) const override {
    try {
      return times_of(design).duration;
    } catch (const DesignError&) {
      return std::numeric_limits<double>::quiet_NaN();
    }
  }
  Dual4 smooth(const DesignView<Dual4>& design) const override {
    std::vector<double> parameters;
    for (const Dual4& parameter : design.parameters) parameters.push_back(parameter.a);
    const DesignWithLimits at = with_limits(design.mechanism, parameters);
    try {
      return duration_with_derivatives(*moves_, shortest_times(*moves_, at), at, design.parameters);
    } catch (const DesignError&) {
      return Dual4(std::numeric_limits<double>::quiet_NaN());
    }
  }
  std::string why_undefined(const DesignView<double>& design) const override {
    try {
      times_of(design);
    } catch (const DesignError& reason) {
      return reason.what();
    }
    return {};
  }

 private:
  ShortestTimes times_of(const DesignView<double>& design) const {
    const DesignWithLimits at = with_limits(design.mechanism, design.parameters);
    if (!motion_.of_design) return shortest_times(*moves_, at);
    try {
      return shortest_times(MovesOfMotion(motion_.of_design(design.parameters), law_, nodes_), at);
    } catch (const std::invalid_argument& reason) {  // a motion without moves, or with corners
      throw DesignError(reason.what());
    }
  }
  DesignWithLimits with_limits(const Mechanism& mechanism, std::span<const double> parameters) const {
    return {mechanism, parameters, mode_, limits_, wrench_};
  }

  MotionLimits limits_;
  DesignMotion motion_;
  FastestLaw law_;
  std::size_t nodes_;
  std::shared_ptr<const MovesOfMotion> moves_;  ///< moves of the motion, if the motion does not depend on the design
  std::string mode_;
  Wrench<double> wrench_;
  Unsupported why_no_derivatives_;
};

}  // namespace

ObjectiveEntry cycle_time() {
  return {
      .name = "cycle-time",
      .meaning = "shortest time of a motion within limits of the joints, the motors and the tool",
      .direction = Direction::minimise,
      .options = {motion_option(),
                  {.name = "law",
                   .kind = OptionKind::word,
                   .initial = std::string("optimal"),
                   .choices = {"optimal", "own"},
                   .meaning =
                       "optimal: time-optimal speed along the path; own: the motion's time law, each move scaled "
                       "by one factor"},
                  {.name = "nodes",
                   .kind = OptionKind::integer,
                   .initial = std::int64_t{400},
                   .lower = 4,
                   .upper = 100'000,
                   .meaning = "nodes along each move; even"},
                  mode_option(),
                  wrench_option(),
                  {.name = "tool_speed", .unit = "m/s", .meaning = "maximum speed of the tool", .positive = true},
                  {.name = "tool_acceleration",
                   .unit = "m/s^2",
                   .meaning = "maximum acceleration of the tool",
                   .positive = true}},
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
