// How a workspace is to be surveyed.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pkm {

/// Thresholds of the pose-level constraints, in the order of MechanismInfo::limits. A limit that is neither given nor
/// derived keeps its inactive value.
struct LimitSpec {
  std::vector<std::optional<double>> given;  ///< threshold set by the study
  std::vector<bool> derived;                 ///< computed from the design's parameters by the mechanism's formula
};

enum class Method { voxels, columns };

/// The one coordinate that is not swept over: held at a value, at the design's own middle, or integrated over.
struct HeldCoordinate {
  enum class Kind { middle, value, integrated };
  Kind kind = Kind::middle;
  double value = 0;
  std::optional<int> coordinate;  ///< which one, 0 to 3; none: the mechanism's usual one
};

struct SurveyPlan {
  Method method = Method::columns;
  HeldCoordinate held;
  std::vector<double> held_values;  ///< not empty: one survey per value of the held coordinate, each of the same weight
  LimitSpec limits;
  std::array<std::int64_t, 3> cells{};  ///< voxels, in the order of Sweep::swept
  std::int64_t held_cells = 0;          ///< voxels integrated over the held coordinate: its number of cells
  /// Voxels: none is derived from each design. Columns: cuts the workspace where the mechanism's can be cut.
  std::optional<std::array<std::array<double, 2>, 3>> box;
  double tolerance = 1e-8;     ///< columns: relative
  std::array<int, 2> nodes{};  ///< columns: fixed nodes per piece and coordinate; 0: chosen from the tolerance
};

/// What objectives and constraints need beyond the volume. The union over all of them is computed in one pass.
struct Demand {
  bool conditioning = false;
  std::optional<double> characteristic_length;  ///< [m]; none: the mechanism's own
  bool poses = false;                           ///< where the samples of dci and inertia_condition are
  bool dci = false;                             ///< dynamic coupling indices of every joint
  bool inertia_condition = false;               ///< inverse condition number of M_q
  std::string mode;                             ///< working mode of both; "": the mechanism's default
};

}  // namespace pkm
