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
  /// Throws std::invalid_argument with one sentence if the plan is not supported.
  virtual std::unique_ptr<const WorkspaceEvaluator> prepare(const WorkspacePlan& plan, const ColumnOptions& columns,
                                                            const FieldRequest& request) const = 0;
  /// @return true if ColumnOptions::box is supported
  virtual bool supports_box() const { return false; }
  /// @return true if FieldRequest::rotors is supported
  virtual bool supports_rotors() const { return false; }
};

/// Side of the singularities on which a pose lies: the sign of det J = det G / det Jq, which changes where a mechanism
/// in one working mode crosses a parallel (det G = 0) or a serial singularity (det Jq = 0). Immutable and thread-safe.
class PoseSides {
 public:
  static constexpr std::int8_t kInfeasible = 0, kPositive = 1, kNegative = -1, kSingular = 2;

  virtual ~PoseSides() = default;
  /// Prepares the scratch memory for the poses of one design.
  virtual void start(std::span<const double> parameters, Scratch& scratch) const = 0;
  /// @param feasible  true if all poses are known to be feasible
  /// @param sides     receives kPositive, kNegative, kSingular (to working precision) or kInfeasible for each pose;
  /// with
  ///                  more joints than coordinates, singularities separate no poses, and feasible poses are kPositive
  virtual void find(std::span<const Pose<double>> poses, bool feasible, Scratch& scratch,
                    std::span<std::int8_t> sides) const = 0;
};

class Voxels {
 public:
  virtual ~Voxels() = default;
  /// Throws std::invalid_argument with one sentence if the plan is not supported.
  virtual std::unique_ptr<const VoxelEvaluator> prepare(const WorkspacePlan& plan, const VoxelOptions& voxels,
                                                        const FieldRequest& request) const = 0;
  /// Test of the side of poses under a plan; null if there is none that is faster than inspecting each pose.
  /// @param mode  working mode; "": the first
  virtual std::unique_ptr<const PoseSides> prepare_sides(const WorkspacePlan& /*plan*/,
                                                         const std::string& /*mode*/) const {
    return nullptr;
  }
  /// @return true if FieldRequest::rotors is supported
  virtual bool supports_rotors() const { return false; }
  /// @return true if a clearance limit may refer to obstacles, too
  virtual bool supports_obstacles() const { return false; }
};

}  // namespace pkm
