// Evaluates quantities of poses on a voxel grid over the workspace of a design, for plots and exports.
//
// The cells are those of the voxel analysis, with one value of each fixed coordinate. A field has one value per cell.
// Fields that describe the mechanism at a pose are evaluated at the centres of feasible cells and are NaN elsewhere.
// The order of the fields is: feasible, margin, quantities of poses (engine/workspace/pose_quantities.hpp) without
// inertia, joint positions, quantities of inertia.
//
//   feasible           1 or 0, as counted by voxel workspace analysis
//   margin             minimum margin of the pose: > 0 in feasible cells, < 0 in the others; 0 on the boundary surface.
//                      Feasible poses of components that do not count as workspace have the negative margin
//   conditioning       inverse condition number of the Jacobian in [0, 1], with the mechanism's characteristic length
//   LTI ..             quantities that are formulas ([[quantity]]), named as in the mechanism file or the study
//   rho1 ..            joint positions, named as in the mechanism
//   dci_1 ..           dynamic coupling indices of the limbs in [0, 1], if the mechanism has masses
//   dci_worst          the largest of them
//   inertia_condition  inverse condition number of the joint-space inertia matrix in [0, 1]
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/mechanism/mechanism.hpp"
#include "engine/workspace/voxel_grid.hpp"

namespace pkm {

/// Default number of cells per axis for studies that analyse the workspace by columns and so have no cells.
inline constexpr std::int64_t kPictureCells = 48;

/// One axis of the grid: `cells` equal cells from `lower` to `upper`.
struct WorkspaceAxis {
  int coordinate = 0;  ///< index in MechanismInfo::coordinates
  std::string name;    ///< name of the coordinate, such as "theta"
  std::string unit;    ///< "m" or "rad"
  double lower = 0, upper = 0;
  std::int64_t cells = 0;
};

struct WorkspaceField {
  std::string name;
  /// Unit of the values: "1", "m" or another unit; "mixed" for the minimum of lengths, angles and numbers.
  std::string unit;
  std::string meaning;
  std::vector<double> values;  ///< one value per cell, in the order of VoxelGrid::index(); NaN where undefined
};

struct WorkspaceFields {
  std::string mechanism;
  /// The swept axes, one to three, in the order of Sweep::swept; the index along the last axis varies fastest.
  std::vector<WorkspaceAxis> axes;
  std::vector<WorkspaceAxis> fixed;  ///< the fixed coordinates: lower and upper are both the value, and `cells` is 0
  /// Origin of the value of each fixed coordinate, such as "default value of the design".
  std::vector<std::string> fixed_note;
  std::vector<WorkspaceField> fields;
  double volume = 0;  ///< volume of the feasible cells, in `volume_unit`
  std::string volume_unit;
  bool touches_box = false;  ///< true if the plan has a box, and feasible cells lie in its outermost layer of cells

  /// Indices of the feasible cells, in ascending order.
  std::vector<std::size_t> feasible_cells() const;
  std::size_t cells() const { return fields.front().values.size(); }
  /// The grid with three axes; axes beyond `axes` have the single cell [0, 1], as in a VoxelMap.
  VoxelGrid grid() const;
  /// The pose at the centre of a cell.
  Pose<double> pose(std::size_t cell) const;
  /// The pose whose coordinate of axis i has the value at[i].
  Pose<double> pose(const std::array<double, 3>& at) const;
  /// The field of this name; null if there is none.
  const WorkspaceField* find(std::string_view name) const;
  /// The field of this name. Throws std::out_of_range if there is none.
  const WorkspaceField& field(std::string_view name) const;
};

/// Function that evaluates the field `margin` at any pose of a design: >= 0 where the workspace analysis counts the
/// pose as feasible.
class PoseMargin {
 public:
  /// @param mechanism  must outlive this object
  PoseMargin(const Mechanism& mechanism, std::span<const double> parameters, const LimitSpec& limits);
  /// @param scratch  scratch memory of the calling thread
  double operator()(const Pose<double>& pose, Scratch& scratch) const;

 private:
  const Mechanism& mechanism_;
  std::vector<double> parameters_;
  LimitSpec limits_;
};

/// Evaluates the fields of one design, in parallel on the caller's threads; the result does not depend on their number.
/// Throws DesignError if a parameter is outside its range.
/// @param parameters  all parameters of the mechanism, SI
/// @param plan        plan of the study; a plan of columns is replaced by kPictureCells voxels per axis, and an
///                    integrated coordinate is fixed at its default value
/// @param mode        working mode for quantities of inertia; "": the mechanism's first. All other fields are those of
///                    the first working mode
WorkspaceFields workspace_fields(const Mechanism& mechanism, std::span<const double> parameters,
                                 const WorkspacePlan& plan, const std::string& mode);

/// Evaluates all fields except `feasible` at given feasible poses; NaN where a quantity is undefined.
/// @param limits  constraint limits of the workspace plan
std::vector<WorkspaceField> fields_at(const Mechanism& mechanism, std::span<const double> parameters,
                                      const LimitSpec& limits, const std::string& mode,
                                      const std::vector<Pose<double>>& poses);

/// Limits for which the margins of a pose agree with the workspace analysis: a clearance that is not specified is set
/// to its inactive value.
LimitSpec workspace_limits(const MechanismInfo& info, LimitSpec limits);

/// Minimum and maximum of a field, ignoring NaN; std::nullopt if all values are NaN.
struct FieldRange {
  double least, greatest;
};
std::optional<FieldRange> range_of(const WorkspaceField& field);

/// Bounding box of the feasible cells: [minimum, maximum] along each axis; std::nullopt if no cell is feasible.
std::optional<std::vector<std::array<double, 2>>> feasible_extents(const WorkspaceFields& workspace);

}  // namespace pkm
