// The ability to say what is certain of a workspace: bounds that rounding cannot make wrong.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "engine/geometry/pose.hpp"
#include "engine/mechanism/plan.hpp"
#include "engine/motion/motion.hpp"

namespace pkm {

struct BoundsOptions {
  double gap = 1e-2;                 ///< wanted: greatest less least volume, relative to their mean
  std::size_t most_boxes = 4000000;  ///< where bounds end in any case
  std::string* proof = nullptr;      ///< what the text of a proof is given to; null: there is none
  std::function<bool()> stop = {};   ///< called often, by any thread of the team: whether to stop
};

struct VolumeBounds {
  double lower = 0, upper = 0;
  int innermost = 0;         ///< the coordinate along which columns are
  std::size_t boxes = 0;     ///< that the bounds are made of
  std::size_t examined = 0;  ///< on the way to them
  bool stopped = false;

  double gap() const { return upper > 0 ? 2 * (upper - lower) / (upper + lower) : 0; }
};

/// Whether something holds at every pose of a box or of a motion.
struct PosesFinding {
  enum class Kind { holds, fails, undecided, not_examined };
  Kind kind = Kind::holds;
  std::string what = {};                   ///< does not hold, or is undecided, or why it was not examined
  std::optional<Pose<double>> where = {};  ///< a pose where it fails, or near which it is undecided
  std::optional<double> time = {};         ///< of a motion: when it is there [s]
};

struct PosesCertificate {
  PosesFinding feasible;
  PosesFinding regular;   ///< no singularity, parallel or serial; not examined where a pose is not feasible
  std::size_t boxes = 0;  ///< looked at
  bool stopped = false;
};

class RigorousBounds {
 public:
  virtual ~RigorousBounds() = default;
  /// Throws std::invalid_argument with a sentence where there are no bounds of a plan's workspace.
  virtual void refuse_bounds(const WorkspacePlan& plan) const = 0;
  /// Of the workspace within the plan's box, else within the ranges that hold it, as the numbers stand. Throws
  /// std::invalid_argument with a sentence when the mechanism cannot serve the plan.
  virtual VolumeBounds volume(std::span<const double> parameters, const WorkspacePlan& plan, const std::string& mode,
                              const BoundsOptions& options) const = 0;
  /// Of a box of poses, under the plan's limits.
  /// @param ranges  by coordinate; one of no width holds it
  virtual PosesCertificate box(std::span<const double> parameters, const WorkspacePlan& plan, const std::string& mode,
                               std::span<const std::array<double, 2>> ranges, const BoundsOptions& options) const = 0;
  /// Of a motion, at every instant of it. Where it is infeasible, at the first instant that is, to 1e-6 of the
  /// duration.
  virtual PosesCertificate motion(std::span<const double> parameters, const LimitSpec& limits, const std::string& mode,
                                  const Motion& motion, const BoundsOptions& options) const = 0;
};

}  // namespace pkm
