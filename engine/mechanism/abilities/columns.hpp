// Abilities of workspace analysis: by columns (cylindrical decomposition), and by voxels without testing every cell.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "engine/core/scratch.hpp"
#include "engine/geometry/pose.hpp"
#include "engine/mechanism/plan.hpp"
#include "engine/mechanism/workspace_evaluator.hpp"

namespace pkm {

class Columns {
 public:
  virtual ~Columns() = default;
  /// Prepares the analysis of workspaces by columns. Throws std::invalid_argument with one sentence if the plan is not
  /// supported.
  virtual std::unique_ptr<const WorkspaceEvaluator> prepare(const WorkspacePlan& plan, const ColumnOptions& columns,
                                                            const FieldRequest& request) const = 0;
  /// @return true if the analysis can be restricted to ColumnOptions::box
  virtual bool supports_box() const { return false; }
  /// @return true if the drive inertias of FieldRequest::rotors are supported
  virtual bool supports_rotors() const { return false; }
};

/// Determines on which side of the singularities a pose lies: the sign of det J = det G / det Jq. The sign changes
/// where a mechanism in one working mode crosses a parallel (det G = 0) or a serial singularity (det Jq = 0). Immutable
/// and thread-safe.
class PoseSides {
 public:
  static constexpr std::int8_t kInfeasible = 0, kPositive = 1, kNegative = -1, kSingular = 2;

  virtual ~PoseSides() = default;
  /// Prepares the scratch memory for the poses of one design.
  virtual void start(std::span<const double> parameters, Scratch& scratch) const = 0;
  /// @param feasible  true if the caller knows that all poses are feasible
  /// @param sides     receives kPositive, kNegative, kSingular (det J is 0 to working precision) or kInfeasible for
  /// each pose. If there are more joints than coordinates, singularities do not separate poses, and every feasible pose
  /// is kPositive
  virtual void find(std::span<const Pose<double>> poses, bool feasible, Scratch& scratch,
                    std::span<std::int8_t> sides) const = 0;
};

class Voxels {
 public:
  virtual ~Voxels() = default;
  /// Prepares the analysis of workspaces by voxels. Throws std::invalid_argument with one sentence if the plan is not
  /// supported.
  virtual std::unique_ptr<const VoxelEvaluator> prepare(const WorkspacePlan& plan, const VoxelOptions& voxels,
                                                        const FieldRequest& request) const = 0;
  /// Prepares PoseSides for a plan; null if no test is faster than inspecting each pose.
  /// @param mode  working mode; "": the first
  virtual std::unique_ptr<const PoseSides> prepare_sides(const WorkspacePlan& /*plan*/,
                                                         const std::string& /*mode*/) const {
    return nullptr;
  }
  /// @return true if the drive inertias of FieldRequest::rotors are supported
  virtual bool supports_rotors() const { return false; }
  /// @return true if a clearance limit may apply to obstacles as well as to links
  virtual bool supports_obstacles() const { return false; }
};

}  // namespace pkm
