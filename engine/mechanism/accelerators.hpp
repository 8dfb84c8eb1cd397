// Closed forms of one mechanism, which replace abilities of the generic engine where they are measurably faster.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "engine/mechanism/abilities/columns.hpp"
#include "engine/mechanism/abilities/kinematics.hpp"

namespace pkm {

/// Workspace analysis by columns in closed form, for the plans that it supports.
class ColumnAccelerator {
 public:
  virtual ~ColumnAccelerator() = default;
  /// @return false if the generic engine has to analyse the plan. May throw std::invalid_argument with one sentence if
  /// the generic engine does not support the plan either.
  virtual bool serves(const WorkspacePlan& plan, const ColumnOptions& columns, const FieldRequest& request) const = 0;
  virtual std::unique_ptr<const WorkspaceEvaluator> prepare(const WorkspacePlan& plan, const ColumnOptions& columns,
                                                            const FieldRequest& request) const = 0;
};

/// Workspace analysis by voxels in closed form, for the plans that it supports.
class VoxelAccelerator {
 public:
  virtual ~VoxelAccelerator() = default;
  virtual bool serves(const WorkspacePlan& plan, const VoxelOptions& voxels, const FieldRequest& request) const = 0;
  virtual std::unique_ptr<const VoxelEvaluator> prepare(const WorkspacePlan& plan, const VoxelOptions& voxels,
                                                        const FieldRequest& request) const = 0;
};

/// @return true if a plan sweeps the coordinates `default_swept`, either because it names them, or because it names no
/// swept coordinates and fixes none of `default_swept`
inline bool sweeps(const WorkspacePlan& plan, const std::vector<int>& default_swept) {
  if (!plan.swept.empty()) return std::ranges::is_permutation(plan.swept, default_swept);
  return std::ranges::none_of(plan.fixed, [&](const FixedCoordinate& fixed) {
    return std::ranges::find(default_swept, fixed.coordinate) != default_swept.end();
  });
}

/// The accelerators of a mechanism; a null pointer for each kind that it does not have.
struct Accelerators {
  std::shared_ptr<const ColumnAccelerator> columns = {};
  std::shared_ptr<const VoxelAccelerator> voxels = {};
  std::shared_ptr<const ForwardKinematics> forward = {};  ///< finds all assembly modes
};

}  // namespace pkm
