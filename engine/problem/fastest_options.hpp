// Options of objectives that are evaluated along the fastest motion (engine/mechanism/fastest_motion.hpp), and the
// fastest motion of a design.
#pragma once

#include <memory>

#include "engine/mechanism/fastest_motion.hpp"
#include "engine/problem/motion_options.hpp"

namespace pkm {

/// The options `nodes`, `tool_speed` and `tool_acceleration` of objectives that are evaluated along the fastest motion.
std::vector<OptionSpec> fastest_options();

/// The fastest motion along the path of the motion named in the options, for any design.
class FastestOfDesign {
 public:
  /// The option `law` of the context decides on the time law (FastestLaw).
  /// Throws std::invalid_argument with a message if the limits do not bound the speed of the motion, or if the motion
  /// has no fastest execution.
  explicit FastestOfDesign(const EntryContext& context);

  const DesignMotion& motion() const { return motion_; }
  DesignWithLimits with_limits(const Mechanism& mechanism, std::span<const double> parameters) const {
    return {mechanism, parameters, mode_, limits_, wrench_};
  }
  /// The moves of which the motion consists, for the parameters that the study itself defines.
  const MovesOfMotion& moves() const { return *moves_; }
  /// Calls work(moves, times, design) with the shortest times of a design, and returns its result. Throws DesignError
  /// if the design cannot perform the motion at any speed.
  template <class Work>
  auto with_times(const DesignView<double>& design, const Work& work) const {
    const DesignWithLimits at = with_limits(design.mechanism, design.parameters);
    if (!motion_.of_design) return work(*moves_, shortest_times(*moves_, at), at);
    const MovesOfMotion moves = moves_of(design.parameters);
    return work(moves, shortest_times(moves, at), at);
  }
  /// The reason why a design has no fastest motion; "" if it has one.
  std::string why_undefined(const DesignView<double>& design) const;

 private:
  /// The moves of a motion that depends on the design. Throws DesignError if the motion has no moves, or has a corner
  /// at which it does not stop.
  MovesOfMotion moves_of(std::span<const double> parameters) const;

  MotionLimits limits_;
  DesignMotion motion_;
  FastestLaw law_;
  std::size_t nodes_;
  std::shared_ptr<const MovesOfMotion> moves_;
  std::string mode_;
  Wrench<double> wrench_;
};

}  // namespace pkm
