// What a design's workspace is made of, cell by cell: what pictures and exports are drawn from.
//
// The cells are those of voxel_map() on one value of each held coordinate. Fields have a value per cell; those
// that describe the mechanism at a pose exist at the centres of feasible cells and are NaN elsewhere. The joints stand
// between the quantities of poses (engine/survey/pose_quantities.hpp) that need no inertia and those that do.
//
//   feasible           1 or 0, as every voxel survey counts it
//   margin             least margin of the pose: > 0 in feasible cells, < 0 in the others; the surface is where it is 0
//   conditioning       inverse condition number of the Jacobian in [0, 1], by the mechanism's own characteristic length
//   rho1 ..            joint positions, by the mechanism's names
//   dci_1 ..           dynamic coupling indices of the limbs in [0, 1], where the mechanism has masses
//   dci_worst          the largest of them
//   inertia_condition  inverse condition number of the inertia that the joints feel in [0, 1]
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/mechanism/mechanism.hpp"
#include "engine/survey/voxel_grid.hpp"

namespace pkm {

/// Cells per axis of pictures of studies that survey columns.
inline constexpr std::int64_t kPictureCells = 48;

/// Equal cells from `lower` to `upper`.
struct WorkspaceAxis {
  int coordinate = 0;  ///< of MechanismInfo::coordinates
  std::string name;    ///< "theta"
  std::string unit;    ///< "m" or "rad"
  double lower = 0, upper = 0;
  std::int64_t cells = 0;
};

struct WorkspaceField {
  std::string name;
  std::string unit;  ///< "1", "m", or "mixed" for a least of lengths and angles
  std::string meaning;
  std::vector<double> values;  ///< one per cell
};

struct WorkspaceFields {
  std::string mechanism;
  std::vector<WorkspaceAxis> axes;     ///< one to three, order of Sweep::swept; of cells the last axis runs fastest
  std::vector<WorkspaceAxis> held;     ///< the other coordinates, each on one value: lower = upper, no cells
  std::vector<std::string> held_note;  ///< why these values, in words: "the middle of the design"
  std::vector<WorkspaceField> fields;
  double volume = 0;  ///< of the feasible cells
  std::string volume_unit;
  bool touches_box = false;  ///< feasible cells lie on the outer layer of a box that the plan gives

  /// Rising.
  std::vector<std::size_t> feasible_cells() const;
  std::size_t cells() const { return fields.front().values.size(); }
  /// Along each axis; behind them as in a VoxelMap.
  VoxelGrid grid() const;
  /// Centre of a cell.
  Pose<double> pose(std::size_t cell) const;
  /// The pose with these values along the axes, as many as there are.
  Pose<double> pose(const std::array<double, 3>& at) const;
  /// Null: there is no field of this name.
  const WorkspaceField* find(std::string_view name) const;
  /// Throws std::out_of_range where there is none.
  const WorkspaceField& field(std::string_view name) const;
};

/// Least margin of any pose of a design, in the sense of the field `margin`: >= 0 where surveys find it feasible.
class PoseMargin {
 public:
  /// @param mechanism  must live as long
  PoseMargin(const Mechanism& mechanism, std::span<const double> parameters, const LimitSpec& limits);
  /// @param scratch  overwritten; reuse one per thread
  double operator()(const Pose<double>& pose, std::vector<double>& scratch) const;

 private:
  const Mechanism& mechanism_;
  std::vector<double> parameters_;
  LimitSpec limits_;
};

/// The fields of one design. Threads: those of the caller's team; the bits do not depend on them.
/// @param parameters  all of the mechanism's; throws std::invalid_argument where they describe no mechanism
/// @param plan        as of the study; one of columns is pictured by kPictureCells cells per axis, and one that
///                    integrates over a held coordinate on the middle of it
/// @param mode        working mode of what depends on inertia; "": the mechanism's first, which all else is of
WorkspaceFields workspace_fields(const Mechanism& mechanism, std::span<const double> parameters, const SurveyPlan& plan,
                                 const std::string& mode);

/// The same fields but `feasible` at feasible poses; NaN where one does not exist.
/// @param limits  as of the plan
std::vector<WorkspaceField> fields_at(const Mechanism& mechanism, std::span<const double> parameters,
                                      const LimitSpec& limits, const std::string& mode,
                                      const std::vector<Pose<double>>& poses);

/// Limits under which the margins of a pose say what surveys say: those leave out a clearance that is not given.
LimitSpec survey_limits(const MechanismInfo& info, LimitSpec limits);

/// Least and greatest value of a field; absent where it has none.
struct FieldRange {
  double least, greatest;
};
std::optional<FieldRange> range_of(const WorkspaceField& field);

}  // namespace pkm
