// Critical points of a solid in the workspace: the local minima, over all points of the solid, of the margins of poses.
#pragma once

#include <functional>

#include "engine/mechanism/ordered_margins.hpp"
#include "engine/workspace/solid.hpp"

namespace pkm {

/// A local minimum of a margin over a solid.
struct CriticalPoint {
  std::size_t margin = 0, orientation = 0;
  UnitPoint unit{};                ///< point of the unit solid
  double distance = 0;             ///< margin divided by the norm of its gradient: signed distance from its zero [m]
  std::array<double, 3> normal{};  ///< gradient by the swept coordinates, divided by its norm
  double norm = 0;                 ///< of the gradient; 0: the margin does not exist here, and `distance` and `normal`
                                   ///< are those of a plane across the ray from the centre
};

/// A margin that is computed from the report of a pose; it has no derivatives.
struct ReportMargin {
  std::string name;
  std::function<double(const PoseReport&)> value;  ///< NaN: undefined
};

/// The margins of one design over solids. Not thread-safe: holds scratch memory.
class SolidMargins {
 public:
  /// @param mechanism     with find_ordered_margins(); must outlive this object
  /// @param orientations  poses whose fixed coordinates have the values at which the solid has to be reachable
  /// @param reported      further margins
  SolidMargins(const Mechanism& mechanism, std::span<const double> parameters, const LimitSpec& limits,
               std::vector<int> swept, std::vector<Pose<double>> orientations, const SolidShape& shape,
               std::vector<ReportMargin> reported);

  std::vector<std::string> names() const;
  const std::vector<Pose<double>>& orientations() const { return orientations_; }
  Pose<double> pose(const std::array<double, 3>& point, std::size_t orientation) const;
  /// All critical points with a distance below `range`, found from samples of the solid.
  std::vector<CriticalPoint> critical_points(const Solid& solid, double range, const SolidSamples& samples);
  /// The local minimum of a margin that is found from a point of the solid.
  CriticalPoint minimise(const Solid& solid, std::size_t margin, std::size_t orientation, const UnitPoint& start);
  /// A margin at a point of the solid, which need not be a local minimum.
  CriticalPoint linearised(const Solid& solid, std::size_t margin, std::size_t orientation, const UnitPoint& unit);
  /// @return true if all margins are >= 0 at a point, in all orientations
  bool is_feasible(const std::array<double, 3>& point);
  /// Derivative of a margin by the design, along each component of the parameters' derivatives.
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
  std::size_t count_;  ///< number of margins
  Scratch scratch_;
  std::vector<double> values_;
  std::vector<Dual4> dual_parameters_, duals_;
  std::optional<Pose<double>> dual_pose_;  ///< pose of `duals_`
};

}  // namespace pkm
