// Closed forms of one mechanism that replace abilities of the generic engine where they are measurably faster.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "engine/mechanism/abilities/columns.hpp"
#include "engine/mechanism/abilities/kinematics.hpp"

namespace pkm {

/// Columns in closed form, for some plans.
class ColumnAccelerator {
 public:
  virtual ~ColumnAccelerator() = default;
  /// Whether it serves the plan; else the generic engine does. It may throw std::invalid_argument with a sentence where
  /// nothing serves the plan.
  virtual bool serves(const WorkspacePlan& plan, const ColumnOptions& columns, const Demand& demand) const = 0;
  virtual std::unique_ptr<const WorkspaceEvaluator> prepare(const WorkspacePlan& plan, const ColumnOptions& columns,
                                                            const Demand& demand) const = 0;
};

/// Feasible cells in closed form, for some plans.
class VoxelAccelerator {
 public:
  virtual ~VoxelAccelerator() = default;
  virtual bool serves(const WorkspacePlan& plan, const VoxelOptions& voxels, const Demand& demand) const = 0;
  virtual std::unique_ptr<const VoxelEvaluator> prepare(const WorkspacePlan& plan, const VoxelOptions& voxels,
                                                        const Demand& demand) const = 0;
};

/// Whether a plan sweeps these coordinates, those that a plan sweeps which names none of them.
inline bool sweeps(const WorkspacePlan& plan, const std::vector<int>& usual) {
  if (!plan.swept.empty()) return std::ranges::is_permutation(plan.swept, usual);
  return std::ranges::none_of(
      plan.held, [&](const FixedCoordinate& held) { return std::ranges::find(usual, held.coordinate) != usual.end(); });
}

/// Each may be null: there is none.
struct Accelerators {
  std::shared_ptr<const ColumnAccelerator> columns = {};
  std::shared_ptr<const VoxelAccelerator> voxels = {};
  std::shared_ptr<const ForwardKinematics> forward = {};  ///< every assembly mode
};

}  // namespace pkm
