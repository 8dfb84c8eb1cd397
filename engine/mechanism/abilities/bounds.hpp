// Rigorous bounds of workspace volume and feasibility, by interval arithmetic with outward rounding.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/geometry/pose.hpp"
#include "engine/mechanism/plan.hpp"
#include "engine/motion/motion.hpp"

namespace pkm {

struct BoundsOptions {
  /// Target for upper minus lower bound, divided by their mean; the search for bounds stops when this target is
  /// reached.
  double gap = 1e-2;
  std::size_t max_boxes = 4000000;  ///< the search for bounds stops at this number of boxes
  std::string* proof = nullptr;     ///< receives the text of a proof of the bounds; null: no proof is written
  std::function<bool()> stop = {};  ///< called often, by any thread; the search for bounds stops if it returns true
};

struct VolumeBounds {
  double lower = 0, upper = 0;
  int innermost = 0;         ///< index, among MechanismInfo::coordinates, of the coordinate along which the columns run
  std::size_t boxes = 0;     ///< number of boxes into which the search box was divided; the bounds are sums over them
  std::size_t examined = 0;  ///< number of boxes examined, including those that were bisected
  bool stopped = false;

  double gap() const { return upper > 0 ? 2 * (upper - lower) / (upper + lower) : 0; }
};

/// A box of poses, or a cylinder or sphere in it, as Cartesian product of intervals and balls.
struct PoseSolid {
  std::vector<std::array<double, 2>> ranges;  ///< range of each coordinate; lower = upper fixes the coordinate
  /// Indices of the coordinates of each ball: of the box of their ranges, only the inscribed ellipsoid belongs to the
  /// solid.
  std::vector<std::vector<std::size_t>> balls = {};
};

/// Result of the attempt to prove that a property holds at every pose of a solid, or of a motion.
struct PropertyResult {
  enum class Kind { holds, fails, undecided, not_examined };
  Kind kind = Kind::holds;
  /// Name of the constraint or matrix for which the property (feasibility or regularity) fails or is undecided; if the
  /// property was not examined: the reason.
  std::string detail = {};
  /// A pose at which the property (feasibility or regularity) fails, or near which it is undecided.
  std::optional<Pose<double>> pose = {};
  /// The instant of the motion at which `pose` is attained [s]; std::nullopt for a box of poses.
  std::optional<double> time = {};
};

struct PoseCertificate {
  PropertyResult feasible;
  /// Result for regularity, i.e. that there is no parallel or serial singularity; not examined if a pose is infeasible.
  PropertyResult regular;
  std::size_t boxes = 0;  ///< number of boxes examined
  bool stopped = false;
};

/// Result of the attempt to prove that no path leads from one pose to another.
struct Separation {
  enum class Kind { boxes, signs, undecided };
  /// What proves the separation: boxes without feasible poses, or different signs of a determinant at the two poses.
  Kind kind = Kind::undecided;
  /// Kind::signs: name of the matrix whose determinant has different signs at the two poses; Kind::undecided: the
  /// reason why nothing was proven.
  std::string detail = {};
  std::size_t boxes = 0;  ///< number of boxes examined
};

class RigorousBounds {
 public:
  virtual ~RigorousBounds() = default;
  /// Checks a plan: throws std::invalid_argument with one sentence if its workspace cannot be bounded.
  virtual void require_bounds(const WorkspacePlan& plan) const = 0;
  /// Bounds of the workspace volume within the plan's box or, if it has none, within ranges that contain the workspace.
  /// The parameters are taken as exact. Throws std::invalid_argument with one sentence if the plan is not supported.
  virtual VolumeBounds volume(std::span<const double> parameters, const WorkspacePlan& plan, const std::string& mode,
                              const BoundsOptions& options) const = 0;
  /// Feasibility and regularity of all poses of a solid, under the plan's limits.
  virtual PoseCertificate solid(std::span<const double> parameters, const WorkspacePlan& plan, const std::string& mode,
                                const PoseSolid& poses, const BoundsOptions& options) const = 0;
  /// Feasibility and regularity at every instant of a motion. If the motion is infeasible, PropertyResult::time is its
  /// first infeasible instant, to 1e-6 of the duration.
  virtual PoseCertificate motion(std::span<const double> parameters, const LimitSpec& limits, const std::string& mode,
                                 const Motion& motion, const BoundsOptions& options) const = 0;
  /// Tries to prove that every path from one pose to another along which only the swept coordinates of the plan vary
  /// leaves the limits, the plan's box (if it has none, the ranges that contain the workspace), or the working mode,
  /// or crosses a singularity. Throws std::invalid_argument with one sentence if the plan is not supported.
  virtual Separation separate(std::span<const double> parameters, const WorkspacePlan& plan, const std::string& mode,
                              const Pose<double>& from, const Pose<double>& to, const BoundsOptions& options) const = 0;
};

}  // namespace pkm
