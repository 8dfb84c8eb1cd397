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
  /// @return true if the closed form supports the plan; false if the generic engine has to analyse it. May throw
  /// std::invalid_argument with one sentence if the generic engine does not support the plan either.
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

/// @return true if the swept coordinates of a plan are `default_swept`: the plan names exactly these, or it names no
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
  /// Closed-form forward kinematics that finds all assembly modes.
  std::shared_ptr<const ForwardKinematics> forward = {};
};

}  // namespace pkm
