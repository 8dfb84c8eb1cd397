// Rigorous bounds of workspace volume and feasibility, by interval arithmetic with outward rounding.
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
  double gap = 1e-2;                ///< target: upper minus lower bound, relative to their mean
  std::size_t max_boxes = 4000000;  ///< stop at this number of boxes
  std::string* proof = nullptr;     ///< receives the text of a proof; null: no proof
  std::function<bool()> stop = {};  ///< called often, by any thread; returns true to stop
};

struct VolumeBounds {
  double lower = 0, upper = 0;
  int innermost = 0;         ///< index of the coordinate along columns, among MechanismInfo::coordinates
  std::size_t boxes = 0;     ///< number of boxes whose bounds are summed
  std::size_t examined = 0;  ///< number of boxes examined, including bisected ones
  bool stopped = false;

  double gap() const { return upper > 0 ? 2 * (upper - lower) / (upper + lower) : 0; }
};

/// Result of the attempt to prove that a property holds at every pose of a box, or of a motion.
struct PropertyResult {
  enum class Kind { holds, fails, undecided, not_examined };
  Kind kind = Kind::holds;
  std::string detail = {};                ///< the constraint or matrix that fails or is undecided; not_examined: why
  std::optional<Pose<double>> pose = {};  ///< a pose at which the property fails, or near which it is undecided
  std::optional<double> time = {};        ///< time of that pose [s], for motions
};

struct PoseCertificate {
  PropertyResult feasible;
  PropertyResult regular;  ///< no parallel or serial singularity; not examined if a pose is infeasible
  std::size_t boxes = 0;   ///< number of boxes examined
  bool stopped = false;
};

/// Result of the attempt to prove that no path leads from one pose to another.
struct Separation {
  enum class Kind { boxes, signs, undecided };
  Kind kind = Kind::undecided;  ///< boxes without feasible poses, or signs of a determinant, separate the poses
  std::string detail = {};      ///< Kind::signs: the matrix; Kind::undecided: what is undecided
  std::size_t boxes = 0;        ///< number of boxes examined
};

class RigorousBounds {
 public:
  virtual ~RigorousBounds() = default;
  /// Throws std::invalid_argument with one sentence if the workspace of a plan cannot be bounded.
  virtual void require_bounds(const WorkspacePlan& plan) const = 0;
  /// Bounds of the workspace volume within the plan's box or, if it has none, within ranges that contain the workspace.
  /// The parameters are taken as exact. Throws std::invalid_argument with one sentence if the plan is not supported.
  virtual VolumeBounds volume(std::span<const double> parameters, const WorkspacePlan& plan, const std::string& mode,
                              const BoundsOptions& options) const = 0;
  /// Feasibility and regularity of all poses of a box, under the plan's limits.
  /// @param ranges  range of each coordinate; lower = upper fixes the coordinate
  virtual PoseCertificate box(std::span<const double> parameters, const WorkspacePlan& plan, const std::string& mode,
                              std::span<const std::array<double, 2>> ranges, const BoundsOptions& options) const = 0;
  /// Feasibility and regularity at every instant of a motion. If the motion is infeasible, PropertyResult::time is its
  /// first infeasible instant, to 1e-6 of the duration.
  virtual PoseCertificate motion(std::span<const double> parameters, const LimitSpec& limits, const std::string& mode,
                                 const Motion& motion, const BoundsOptions& options) const = 0;
  /// Tries to prove that every path from one pose to another along which only the swept coordinates of the plan vary
  /// leaves the limits, the plan's box (if it has none, the ranges that contain the workspace), or the working mode,
  /// or crosses a singularity. Throws std::invalid_argument like volume().
  virtual Separation separate(std::span<const double> parameters, const WorkspacePlan& plan, const std::string& mode,
                              const Pose<double>& from, const Pose<double>& to, const BoundsOptions& options) const = 0;
};

}  // namespace pkm
