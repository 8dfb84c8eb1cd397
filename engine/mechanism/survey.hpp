// What a survey of a design's workspace found: voxels and exact columns fill the same structure.
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

/// Weighted samples of the feasible set. A mean is a weighted sum of a field over the sum of the weights.
/// S is double or the derivative scalar.
template <class S>
struct Survey {
  S volume{};  ///< measure of the feasible set, in the unit of volume_unit()
  // voxels
  std::int64_t cells = 0;
  std::int64_t feasible_cells = 0;
  double cell_volume = 0;
  bool touches_box = false;  ///< a feasible cell lies on the box's outer layer
  // columns
  std::int64_t columns = 0;  ///< nodes used
  double error = 0;          ///< estimated relative error of the volume
  // per feasible sample, only what was demanded (empty otherwise), all of one length
  std::vector<S> weight;
  std::vector<Pose<S>> pose;
  std::map<const PoseQuantity*, std::array<std::vector<S>, kMaxJoints>> fields;  ///< the first, or as many as joints

  /// A field; empty where it was not demanded.
  const std::vector<S>& of(const PoseQuantity& quantity, std::size_t joint = 0) const {
    static const std::vector<S> none;
    const auto found = fields.find(&quantity);
    return found == fields.end() ? none : found->second[joint];
  }
  /// The same to add to; null where it was not demanded.
  std::vector<S>* find(const PoseQuantity& quantity) {
    const auto found = fields.find(&quantity);
    return found == fields.end() ? nullptr : found->second.data();
  }

  /// Nothing found yet; memory is kept.
  /// @param demanded  the fields to be filled
  void clear(std::span<const PoseQuantity* const> demanded = {}) {
    volume = S{};
    cells = feasible_cells = columns = 0;
    cell_volume = error = 0;
    touches_box = false;
    weight.clear();
    pose.clear();
    std::erase_if(fields,
                  [&](const auto& field) { return std::ranges::find(demanded, field.first) == demanded.end(); });
    for (const PoseQuantity* const quantity : demanded)
      for (auto& component : fields[quantity]) component.clear();
  }
};

/// Appends the samples of another survey.
template <class S>
void append_samples(const Survey<S>& from, Survey<S>& to) {
  const auto append = [](const auto& source, auto& target) {
    target.insert(target.end(), source.begin(), source.end());
  };
  append(from.weight, to.weight);
  append(from.pose, to.pose);
  for (const auto& [quantity, field] : from.fields)
    for (std::size_t i = 0; i < field.size(); ++i) append(field[i], to.fields[quantity][i]);
}

/// The values of a survey with derivatives.
template <class S>
void copy_values(const Survey<S>& from, Survey<double>& to) {
  to.volume = value_of(from.volume);
  to.cells = from.cells;
  to.feasible_cells = from.feasible_cells;
  to.cell_volume = from.cell_volume;
  to.touches_box = from.touches_box;
  to.columns = from.columns;
  to.error = from.error;
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

/// Which cells of a voxel box are feasible, for pictures and the study file. Order of axes: Sweep::swept, the last
/// one fastest; axes behind them have one cell, [0, 1].
struct VoxelMap {
  std::vector<std::uint8_t> feasible;
  std::int64_t cells[3] = {0, 0, 0};
  double lower[3] = {0, 0, 0};
  double upper[3] = {0, 0, 0};
};

}  // namespace pkm
