#include "engine/generic/haar_measure.hpp"

#include <cmath>

#include "engine/workspace/voxel_grid.hpp"

namespace pkm::generic {
namespace {

/// Indices of the coordinates that are angles.
std::vector<int> angles_of(const Model& model) {
  std::vector<int> angles;
  for (std::size_t i = 0; i < model.rotation_axes.size(); ++i)
    if (model.rotation_axes[i]) angles.push_back(static_cast<int>(i));
  return angles;
}
std::size_t axis_of(const Model& model, int coordinate) {
  return *model.rotation_axes[static_cast<std::size_t>(coordinate)];
}
/// The angle in (-pi, pi] that differs from the given angle by whole revolutions.
double wrapped(double angle) { return angle > kPi ? angle - 2 * kPi : angle <= -kPi ? angle + 2 * kPi : angle; }

}  // namespace

Unsupported HaarMeasure::refusal(const Model& model) {
  const std::vector<int> angles = angles_of(model);
  if (angles.size() != 3)
    return "the orientations of a platform need three coordinates that are angles; mechanism " + model.info.name +
           " has " + std::to_string(angles.size());
  if (axis_of(model, angles[0]) == axis_of(model, angles[1]) || axis_of(model, angles[1]) == axis_of(model, angles[2]))
    return "two successive rotations of mechanism " + model.info.name + " have the same axis, so that its " +
           "coordinates do not describe all orientations";
  return {};
}

HaarMeasure::HaarMeasure(const Model& model)
    : angles_(angles_of(model)), is_proper_euler_(axis_of(model, angles_[0]) == axis_of(model, angles_[2])) {}

Box HaarMeasure::principal_ranges() const {
  const std::array<double, 2> middle = is_proper_euler_ ? std::array{0.0, kPi} : std::array{-kPi / 2, kPi / 2};
  return {{{-kPi, kPi}, middle, {-kPi, kPi}}};
}

bool HaarMeasure::is_principal(double middle_angle) const {
  const auto [lower, upper] = principal_ranges()[1];
  return lower <= middle_angle && middle_angle <= upper;
}

std::array<double, 3> HaarMeasure::equivalent(const std::array<double, 3>& angles) const {
  const auto [a, b, c] = angles;
  return {wrapped(a + kPi), wrapped(is_proper_euler_ ? -b : kPi - b), wrapped(c + kPi)};
}

double HaarMeasure::antiderivative(double middle_angle) const {
  const double b = middle_angle;
  if (is_proper_euler_) return std::copysign(1 - std::cos(b), b);
  return std::fabs(b) <= kPi / 2 ? std::sin(b) : std::copysign(2 - std::fabs(std::sin(b)), b);
}

double HaarMeasure::measure(const VoxelMap& map) const {
  const VoxelGrid grid(map);
  // the index of the cell with an angle, or -1 if the angle is outside the box
  const auto cell_at = [&](std::size_t axis, double angle) -> std::int64_t {
    const double position = std::floor((angle - grid.lower[axis]) / grid.step[axis]);
    return position >= 0 && position < static_cast<double>(grid.cells[axis]) ? static_cast<std::int64_t>(position) : -1;
  };
  double sum = 0;
  Cell cell;
  for (cell[1] = 0; cell[1] < grid.cells[1]; ++cell[1]) {
    const double middle = grid.centre(1, cell[1]), lower = grid.lower[1] + static_cast<double>(cell[1]) * grid.step[1];
    const double measure_of_cell =
        grid.step[0] * grid.step[2] * (antiderivative(lower + grid.step[1]) - antiderivative(lower));
    for (cell[0] = 0; cell[0] < grid.cells[0]; ++cell[0])
      for (cell[2] = 0; cell[2] < grid.cells[2]; ++cell[2]) {
        if (!map.feasible[grid.index(cell)]) continue;
        if (!is_principal(middle)) {
          const auto same = equivalent({grid.centre(0, cell[0]), middle, grid.centre(2, cell[2])});
          const Cell other{cell_at(0, same[0]), cell_at(1, same[1]), cell_at(2, same[2])};
          if (other[0] >= 0 && other[1] >= 0 && other[2] >= 0 && map.feasible[grid.index(other)]) continue;
        }
        sum += measure_of_cell;
      }
  }
  return sum;
}

}  // namespace pkm::generic
