// How a workspace is to be surveyed.
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
  std::vector<std::optional<double>> given;  ///< threshold set by the study
  std::vector<bool> derived;                 ///< computed from the design's parameters by the mechanism's formula
  Obstacles obstacles = {};                  ///< what links keep clear of beside each other
};

/// One coordinate that is not swept over: held at a value, at the design's own middle, at each of several values (one
/// survey each, all of the same weight), or integrated over.
struct FixedCoordinate {
  enum class Kind { middle, value, listed, integrated };
  int coordinate = 0;  ///< which one, of MechanismInfo::coordinates
  Kind kind = Kind::middle;
  double value = 0;
  std::vector<double> values = {};  ///< listed
  std::int64_t cells = 0;           ///< voxels integrated over it: their number
};

/// Ranges of the swept coordinates, in the order of Sweep::swept; what is not swept has [0, 1].
using Box = std::array<std::array<double, 2>, 3>;

struct VoxelOptions {
  std::array<std::int64_t, 3> cells{1, 1, 1};  ///< in the order of Sweep::swept; 1 where nothing is swept
  std::optional<Box> box;                      ///< none: derived from each design
};

struct ColumnOptions {
  double tolerance = 1e-8;     ///< relative
  std::array<int, 2> nodes{};  ///< fixed nodes per piece and coordinate; 0: chosen from the tolerance
  std::optional<Box> box;      ///< cuts the workspace, where the mechanism's can be cut
  std::optional<double> certain =
      {};  ///< gap of certain bounds that the volume of a design that is kept must be within
};

struct WorkspacePlan {
  std::variant<ColumnOptions, VoxelOptions> method;
  std::vector<int> swept = {};        ///< all of them, where the study names them; else what it holds decides
  std::vector<FixedCoordinate> held;  ///< those that the study names; the others of the sweep are in the middle
  LimitSpec limits;

  const VoxelOptions* voxels() const { return std::get_if<VoxelOptions>(&method); }
  const ColumnOptions* columns() const { return std::get_if<ColumnOptions>(&method); }
  const std::optional<Box>& box() const { return voxels() ? voxels()->box : columns()->box; }
};

/// Of links: they overlap by the sum of their radii at most, and no radius is greater than 1 m.
inline constexpr double kInactiveClearance = -2;

/// Whether a plan asks for a clearance.
/// @param limit  the mechanism's number of it
inline bool asks_clearance(const WorkspacePlan& plan, std::size_t limit) {
  return plan.limits.given[limit].value_or(kInactiveClearance) > kInactiveClearance;
}

/// How the plan holds a coordinate: in the middle where it does not name it.
inline FixedCoordinate how_fixed(const WorkspacePlan& plan, int coordinate) {
  for (const FixedCoordinate& held : plan.held)
    if (held.coordinate == coordinate) return held;
  return {.coordinate = coordinate};
}

/// What objectives and constraints need beyond the volume. The union over all of them is computed in one pass.
struct Demand {
  std::vector<const PoseQuantity*> fields;
  bool poses = false;                           ///< where the samples are, of those of inertia
  std::optional<double> characteristic_length;  ///< of all fields that need no inertia [m]; none: the mechanism's own
  std::string mode;                             ///< working mode of those that do; "": the mechanism's default
  std::vector<double> rotors;                   ///< by joint, what drive trains add to M_q; empty: nothing

  bool has(const PoseQuantity& quantity) const { return std::ranges::find(fields, &quantity) != fields.end(); }
  void add(const PoseQuantity& quantity) {
    if (!has(quantity)) fields.push_back(&quantity);
  }
  bool needs_inertia() const { return std::ranges::any_of(fields, &PoseQuantity::needs_inertia); }
  bool needs_jacobian() const { return !std::ranges::all_of(fields, &PoseQuantity::needs_inertia); }
  bool needs_samples() const { return poses || !fields.empty(); }
};

}  // namespace pkm
