// Input of a workspace analysis: method and box, swept and fixed coordinates, limits, and the quantities to compute.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "engine/geometry/obstacle.hpp"
#include "engine/mechanism/pose_quantity.hpp"

namespace pkm {

/// Thresholds of the pose-level constraints, in the order of MechanismInfo::limits. A limit that is neither given nor
/// derived keeps its inactive value.
struct LimitSpec {
  /// For each limit, the threshold that the study sets; std::nullopt: not set.
  std::vector<std::optional<double>> given;
  /// For each limit, true if the mechanism's formula computes the threshold from the design's parameters.
  std::vector<bool> derived;
  Obstacles obstacles = {};  ///< obstacles to which a clearance limit refers, in addition to links
};

/// A coordinate that is not swept: fixed at the default value of the design, at a given value, at each value of a list
/// (the analyses are averaged), or integrated over.
struct FixedCoordinate {
  enum class Kind { default_value, value, listed, integrated };
  int coordinate = 0;  ///< index of the coordinate in MechanismInfo::coordinates
  Kind kind = Kind::default_value;
  double value = 0;
  std::vector<double> values = {};  ///< values of the coordinate, for Kind::listed; otherwise empty
  /// Number of cells along the coordinate, for Kind::integrated in an analysis by voxels; otherwise 0.
  std::int64_t cells = 0;
};

/// Ranges of the swept coordinates, in the order of Sweep::swept; [0, 1] for axes without a swept coordinate.
using Box = std::array<std::array<double, 2>, 3>;

struct VoxelOptions {
  /// Number of cells along each axis, in the order of Sweep::swept; 1 for axes without a coordinate.
  std::array<std::int64_t, 3> cells{1, 1, 1};
  std::optional<Box> box;  ///< box that is divided into cells; std::nullopt: computed for each design
};

struct ColumnOptions {
  double tolerance = 1e-8;  ///< requested relative error of the volume
  /// Number of quadrature nodes per subinterval of each outer coordinate; 0: adaptive, from the tolerance.
  std::array<int, 2> nodes{};
  /// Box to which the workspace is restricted, if Columns::supports_box(); std::nullopt: unrestricted.
  std::optional<Box> box;
  /// Relative gap of certified bounds that the volume of a recorded design must satisfy; std::nullopt: not checked.
  std::optional<double> certified = {};
};

struct WorkspacePlan {
  std::variant<ColumnOptions, VoxelOptions> method;
  std::vector<int> swept = {};  ///< all swept coordinates; empty: they are derived from `fixed`
  /// The fixed coordinates that the study names; all others have their default values.
  std::vector<FixedCoordinate> fixed;
  LimitSpec limits;
  /// A pose that selects one component of the workspace, which alone is measured: values of the swept coordinates, in
  /// the order of Sweep::swept. std::nullopt: all components are measured.
  std::optional<std::array<double, 3>> home = {};

  const VoxelOptions* voxels() const { return std::get_if<VoxelOptions>(&method); }
  const ColumnOptions* columns() const { return std::get_if<ColumnOptions>(&method); }
  const std::optional<Box>& box() const { return voxels() ? voxels()->box : columns()->box; }
};

/// Clearance limit that no pose violates [m]: radii are at most 1 m, so two links overlap by at most 2 m.
inline constexpr double kInactiveClearance = -2;

/// @return true if a plan sets a limit on the clearance of links
/// @param limit  index of the clearance limit in MechanismInfo::limits
inline bool requires_clearance(const WorkspacePlan& plan, std::size_t limit) {
  return plan.limits.given[limit].value_or(kInactiveClearance) > kInactiveClearance;
}

/// How the plan fixes a coordinate that is not swept; at its default value if the plan does not name it.
inline FixedCoordinate how_fixed(const WorkspacePlan& plan, int coordinate) {
  for (const FixedCoordinate& fixed : plan.fixed)
    if (fixed.coordinate == coordinate) return fixed;
  return {.coordinate = coordinate};
}

/// Per-pose quantities to compute in addition to the volume: the union over all objectives and constraints, so that one
/// analysis of a workspace serves all of them.
struct FieldRequest {
  std::vector<const PoseQuantity*> fields;
  /// True: the poses of all samples are stored, too; columns may omit them if no field needs the inertia.
  bool poses = false;
  /// True: an analysis by voxels stores the pose of every cell, also of cells that are symmetric images of others.
  bool every_pose = false;
  /// Characteristic length for fields that need a Jacobian [m]; std::nullopt: the default of the mechanism.
  std::optional<double> characteristic_length;
  std::string mode;  ///< working mode for fields that need the inertia; "": the default of the mechanism
  /// Inertia of the drive train of each joint, reflected to the joint [kg or kg m^2]; empty: none.
  std::vector<double> rotors;

  bool has(const PoseQuantity& quantity) const { return std::ranges::find(fields, &quantity) != fields.end(); }
  void add(const PoseQuantity& quantity) {
    if (!has(quantity)) fields.push_back(&quantity);
  }
  bool needs_inertia() const { return std::ranges::any_of(fields, &PoseQuantity::needs_inertia); }
  bool needs_jacobian() const { return std::ranges::any_of(fields, &PoseQuantity::needs_report); }
  bool has_formulas() const { return std::ranges::any_of(fields, is_formula); }
  bool needs_samples() const { return poses || !fields.empty(); }

  static bool is_formula(const PoseQuantity* quantity) { return quantity->formula.has_value(); }
};

}  // namespace pkm
