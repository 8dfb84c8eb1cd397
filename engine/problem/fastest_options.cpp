#include "engine/problem/fastest_options.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/error.hpp"
#include "engine/mechanism/with_drive_trains.hpp"
#include "engine/problem/pose_options.hpp"

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

}  // namespace

std::vector<OptionSpec> fastest_options() {
  return {
      {.name = "nodes",
       .kind = OptionKind::integer,
       .initial = std::int64_t{400},
       .lower = 4,
       .upper = 100'000,
       .meaning = "nodes along each move; even"},
      {.name = "tool_speed", .unit = "m/s", .meaning = "maximum speed of the tool", .positive = true},
      {.name = "tool_acceleration", .unit = "m/s^2", .meaning = "maximum acceleration of the tool", .positive = true}};
}

FastestOfDesign::FastestOfDesign(const EntryContext& context)
    : limits_(limits_of(context)),
      motion_(motion_of(context)),
      law_(context.options.word("law") == "own" ? FastestLaw::own : FastestLaw::optimal),
      nodes_(nodes_of(context)),
      moves_(std::make_shared<const MovesOfMotion>(motion_.motion, law_, nodes_)),
      mode_(mode_of(context)),
      wrench_(wrench_of(context)) {}

MovesOfMotion FastestOfDesign::moves_of(std::span<const double> parameters) const {
  try {
    return MovesOfMotion(motion_.of_design(parameters), law_, nodes_);
  } catch (const std::invalid_argument& reason) {
    throw DesignError(reason.what());
  }
}

std::string FastestOfDesign::why_undefined(const DesignView<double>& design) const {
  try {
    with_times(design, [](const auto&...) {});
  } catch (const DesignError& reason) {
    return reason.what();
  }
  return {};
}

}  // namespace pkm
