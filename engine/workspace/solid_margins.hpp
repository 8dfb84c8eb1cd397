// Critical points of a solid in the workspace: the local minima, over all points of the solid, of the margins of poses.
#pragma once

#include <functional>

#include "engine/mechanism/ordered_margins.hpp"
#include "engine/workspace/solid.hpp"

namespace pkm {

/// A local minimum of a margin over a solid.
struct CriticalPoint {
  std::size_t margin = 0, orientation = 0;
  UnitPoint unit{};  ///< position of the minimum, as a point of the unit solid
  /// Margin divided by the norm of its gradient: first-order signed distance from the zero of the margin [m].
  double distance = 0;
  std::array<double, 3> normal{};  ///< gradient with respect to the swept coordinates, divided by its norm
  /// Norm of the gradient of the margin. 0 if the margin does not exist at this point: `distance` and `normal` then
  /// describe a plane normal to the line from the solid's centre to the point.
  double norm = 0;
};

/// A margin that is computed from the report of a pose; it has no derivatives.
struct ReportMargin {
  std::string name;
  /// value(report): the margin at a pose; NaN if it is undefined there.
  std::function<double(const PoseReport&)> value;
};

/// The margins of one design over solids. Not thread-safe, because it contains scratch memory.
class SolidMargins {
 public:
  /// @param mechanism     a mechanism with find_ordered_margins(); must outlive this object
  /// @param orientations  one pose per orientation: its fixed coordinates have the values at which the solid has to be
  ///                      reachable
  /// @param reported      further margins, appended to those of the mechanism
  SolidMargins(const Mechanism& mechanism, std::span<const double> parameters, const LimitSpec& limits,
               std::vector<int> swept, std::vector<Pose<double>> orientations, const SolidShape& shape,
               std::vector<ReportMargin> reported);

  std::vector<std::string> names() const;
  const std::vector<Pose<double>>& orientations() const { return orientations_; }
  Pose<double> pose(const std::array<double, 3>& point, std::size_t orientation) const;
  /// All local minima of margins over the solid whose CriticalPoint::distance is below `range`, found from samples of
  /// the solid.
  std::vector<CriticalPoint> critical_points(const Solid& solid, double range, const SolidSamples& samples);
  /// The local minimum of a margin over the solid that Newton's method finds from a starting point.
  CriticalPoint minimise(const Solid& solid, std::size_t margin, std::size_t orientation, const UnitPoint& start);
  /// Value and gradient of a margin at a point of the solid, which need not be a local minimum.
  CriticalPoint linearised(const Solid& solid, std::size_t margin, std::size_t orientation, const UnitPoint& unit);
  /// @return true if all margins are >= 0 at a point of the workspace, in all orientations
  bool is_feasible(const std::array<double, 3>& point);
  /// Derivatives of a margin at a pose with respect to the parameters, for the seeds of `parameters` (forward mode).
  Dual4 by_parameters(std::span<const Dual4> parameters, std::size_t margin, const Pose<double>& pose);
  PoseReport report(const Pose<double>& pose) const;

 private:
  struct Gradient {
    double value = 0;
    std::array<double, 3> by_axis{};
  };

  void append(std::span<const double> parameters, std::span<const Pose<double>> poses, std::vector<double>& margins);
  double value(std::span<const double> parameters, std::size_t margin, const Pose<double>& pose);
  Gradient gradient(std::size_t margin, const Pose<double>& pose);
  CriticalPoint plane_across_ray(const Solid& solid, std::size_t margin, std::size_t orientation,
                                 const UnitPoint& unit);

  const Mechanism& mechanism_;
  const OrderedMargins& ordered_;
  std::vector<double> parameters_;
  LimitSpec limits_;
  std::vector<int> swept_;
  std::vector<Pose<double>> orientations_;
  SolidShape shape_;
  std::vector<ReportMargin> reported_;
  std::size_t count_;  ///< number of margins, those in `reported_` included
  Scratch scratch_;
  std::vector<double> values_;
  std::vector<Dual4> dual_parameters_, duals_;
  std::optional<Pose<double>> dual_pose_;  ///< pose for which `duals_` holds the margins; std::nullopt if there is none
};

}  // namespace pkm
