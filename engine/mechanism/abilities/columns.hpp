// The ability to survey in columns with exact ends, and to survey voxels faster than cell by cell.
#pragma once

#include <memory>

#include "engine/mechanism/plan.hpp"
#include "engine/mechanism/surveyor.hpp"

namespace pkm {

class Columns {
 public:
  virtual ~Columns() = default;
  /// Throws std::invalid_argument with a sentence when the mechanism cannot serve the plan.
  virtual std::unique_ptr<const WorkspaceEvaluator> prepare(const WorkspacePlan& plan, const ColumnOptions& columns,
                                                            const Demand& demand) const = 0;
  /// Whether ColumnOptions::box can cut them.
  virtual bool take_box() const { return false; }
  /// Whether they count Demand::rotors.
  virtual bool take_rotors() const { return false; }
};

class Voxels {
 public:
  virtual ~Voxels() = default;
  /// Throws std::invalid_argument with a sentence when the mechanism cannot serve the plan.
  virtual std::unique_ptr<const VoxelEvaluator> prepare(const WorkspacePlan& plan, const VoxelOptions& voxels,
                                                        const Demand& demand) const = 0;
  /// Whether they count Demand::rotors.
  virtual bool take_rotors() const { return false; }
  /// Whether they know obstacles under a clearance.
  virtual bool take_obstacles() const { return false; }
};

}  // namespace pkm
