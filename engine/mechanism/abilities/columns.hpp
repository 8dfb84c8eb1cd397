// Abilities of workspace analysis: by columns (cylindrical decomposition), and by voxels without testing every cell.
#pragma once

#include <memory>

#include "engine/mechanism/plan.hpp"
#include "engine/mechanism/workspace_evaluator.hpp"

namespace pkm {

class Columns {
 public:
  virtual ~Columns() = default;
  /// Throws std::invalid_argument with one sentence if the plan is not supported.
  virtual std::unique_ptr<const WorkspaceEvaluator> prepare(const WorkspacePlan& plan, const ColumnOptions& columns,
                                                            const FieldRequest& request) const = 0;
  /// @return true if ColumnOptions::box is supported
  virtual bool supports_box() const { return false; }
  /// @return true if FieldRequest::rotors is supported
  virtual bool supports_rotors() const { return false; }
};

class Voxels {
 public:
  virtual ~Voxels() = default;
  /// Throws std::invalid_argument with one sentence if the plan is not supported.
  virtual std::unique_ptr<const VoxelEvaluator> prepare(const WorkspacePlan& plan, const VoxelOptions& voxels,
                                                        const FieldRequest& request) const = 0;
  /// @return true if FieldRequest::rotors is supported
  virtual bool supports_rotors() const { return false; }
  /// @return true if a clearance limit may refer to obstacles, too
  virtual bool supports_obstacles() const { return false; }
};

}  // namespace pkm
