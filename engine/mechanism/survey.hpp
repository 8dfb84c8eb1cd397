// What a survey of a design's workspace found: voxels and exact columns fill the same structure.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/math/scalar.hpp"
#include "engine/model/pose.hpp"

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
  std::vector<S> conditioning;  ///< inverse condition number of J in [0, 1]
  std::vector<Pose<S>> pose;
  std::array<std::vector<S>, kMostJoints> dci;  ///< dynamic coupling index per joint, in [0, 1]; as many as there are
  std::vector<S> inertia_condition;             ///< inverse condition number of M_q in [0, 1]

  void clear() {
    volume = S{};
    cells = feasible_cells = columns = 0;
    cell_volume = error = 0;
    touches_box = false;
    weight.clear();
    conditioning.clear();
    pose.clear();
    for (auto& joint : dci) joint.clear();
    inertia_condition.clear();
  }
};

/// Appends the samples of another survey.
template <class S>
void append_samples(const Survey<S>& from, Survey<S>& to) {
  const auto append = [](const auto& source, auto& target) {
    target.insert(target.end(), source.begin(), source.end());
  };
  append(from.weight, to.weight);
  append(from.conditioning, to.conditioning);
  append(from.pose, to.pose);
  for (std::size_t i = 0; i < to.dci.size(); ++i) append(from.dci[i], to.dci[i]);
  append(from.inertia_condition, to.inertia_condition);
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
  const auto copy = [](const std::vector<S>& source, std::vector<double>& target) {
    target.resize(source.size());
    for (std::size_t i = 0; i < source.size(); ++i) target[i] = value_of(source[i]);
  };
  copy(from.weight, to.weight);
  copy(from.conditioning, to.conditioning);
  to.pose.clear();
  for (const Pose<S>& p : from.pose) {
    to.pose.emplace_back(p.size());
    for (std::size_t i = 0; i < p.size(); ++i) to.pose.back()[i] = value_of(p[i]);
  }
  for (std::size_t i = 0; i < to.dci.size(); ++i) copy(from.dci[i], to.dci[i]);
  copy(from.inertia_condition, to.inertia_condition);
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
