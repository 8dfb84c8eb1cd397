// Result of a workspace analysis, the same structure for voxels and for columns.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "engine/math/scalar.hpp"
#include "engine/mechanism/pose_quantity.hpp"

namespace pkm {

/// Volume of the feasible set, and fields at weighted samples of this set. The mean of a field is its weighted sum
/// divided by the sum of the weights. The scalar type S is double, or Dual4 for derivatives.
template <class S>
struct WorkspaceResult {
  S volume{};  ///< volume (or area or length) of the feasible set, in the unit of volume_unit()
  // The following members are set by voxel analyses:
  std::int64_t cells = 0;
  std::int64_t feasible_cells = 0;
  double cell_volume = 0;
  bool touches_box = false;  ///< true if a feasible cell lies in the outermost layer of the box
  // The following members are set by analyses by columns:
  std::int64_t columns = 0;  ///< number of columns that were evaluated, or of nodes along edges of the workspace
  double error = 0;          ///< estimated relative error of the volume
  bool is_sampled = false;   ///< true if parts of the workspace that lie between sampled slices may have been missed
  // The following vectors have one element per feasible sample if they were requested; otherwise they are empty:
  std::vector<S> weight;
  std::vector<Pose<S>> pose;
  /// For each requested quantity, the vector of its values at the samples, or one such vector for each joint.
  std::map<const PoseQuantity*, std::array<std::vector<S>, kMaxJoints>> fields;

  /// Values of a quantity at all samples; empty if the quantity was not requested.
  const std::vector<S>& field(const PoseQuantity& quantity, std::size_t joint = 0) const {
    static const std::vector<S> none;
    const auto found = fields.find(&quantity);
    return found == fields.end() ? none : found->second[joint];
  }
  /// The vectors to which the samples of a quantity are appended; null if the quantity was not requested.
  std::vector<S>* find(const PoseQuantity& quantity) {
    const auto found = fields.find(&quantity);
    return found == fields.end() ? nullptr : found->second.data();
  }

  /// Resets the result to an empty workspace without releasing its memory.
  /// @param requested  the quantities for which samples will be appended
  void clear(std::span<const PoseQuantity* const> requested = {}) {
    volume = S{};
    cells = feasible_cells = columns = 0;
    cell_volume = error = 0;
    touches_box = is_sampled = false;
    weight.clear();
    pose.clear();
    std::erase_if(fields,
                  [&](const auto& field) { return std::ranges::find(requested, field.first) == requested.end(); });
    for (const PoseQuantity* const quantity : requested)
      for (auto& component : fields[quantity]) component.clear();
  }
};

/// Appends the samples of the result `from` to `to`.
template <class S>
void append_samples(const WorkspaceResult<S>& from, WorkspaceResult<S>& to) {
  const auto append = [](const auto& source, auto& target) {
    target.insert(target.end(), source.begin(), source.end());
  };
  append(from.weight, to.weight);
  append(from.pose, to.pose);
  for (const auto& [quantity, field] : from.fields)
    for (std::size_t i = 0; i < field.size(); ++i) append(field[i], to.fields[quantity][i]);
}

/// Copies a result without its derivatives.
template <class S>
void copy_values(const WorkspaceResult<S>& from, WorkspaceResult<double>& to) {
  to.volume = value_of(from.volume);
  to.cells = from.cells;
  to.feasible_cells = from.feasible_cells;
  to.cell_volume = from.cell_volume;
  to.touches_box = from.touches_box;
  to.columns = from.columns;
  to.error = from.error;
  to.is_sampled = from.is_sampled;
  const auto copy = [](const auto& source, auto& target) {
    target.resize(source.size());
    std::ranges::transform(source, target.begin(), [](const S& x) { return value_of(x); });
  };
  copy(from.weight, to.weight);
  to.pose.clear();
  for (const Pose<S>& p : from.pose) {
    to.pose.emplace_back(p.size());
    std::ranges::transform(p, to.pose.back().begin(), [](const S& x) { return value_of(x); });
  }
  std::erase_if(to.fields, [&](const auto& field) { return !from.fields.contains(field.first); });
  for (const auto& [quantity, field] : from.fields)
    for (std::size_t i = 0; i < field.size(); ++i) copy(field[i], to.fields[quantity][i]);
}

/// The feasible cells of a box that is divided into voxels. The axes are in the order of Sweep::swept, and the last one
/// varies fastest; an axis without a coordinate has a single cell, [0, 1].
struct VoxelMap {
  std::vector<std::uint8_t> feasible;  ///< for each cell, 1 if it is feasible, otherwise 0
  std::int64_t cells[3] = {0, 0, 0};
  double lower[3] = {0, 0, 0};
  double upper[3] = {0, 0, 0};
};

}  // namespace pkm
