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
/// The angle in (-pi, pi] that is the same modulo a revolution.
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

HaarMeasure::HaarMeasure(const Model& model) : angles_(angles_of(model)) {
  is_proper_euler_ = axis_of(model, angles_[0]) == axis_of(model, angles_[2]);
  std::vector<Node> nodes;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto coordinate = static_cast<std::size_t>(angles_[i]);
    inputs_[i] = model.inputs.coordinate(coordinate);
    nodes.insert(nodes.end(), model.rotation_directions[coordinate].begin(),
                 model.rotation_directions[coordinate].end());
  }
  directions_ = expression::Program(model.graph, nodes);
  count_ = model.inputs.count();
}

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

double HaarMeasure::measure_of_cell(const std::array<std::array<double, 2>, 3>& cell) const {
  // Gauss-Legendre quadrature with two nodes along each angle
  std::vector<double> inputs(count_), registers;
  double sum = 0, volume = 1;
  for (const auto& [lower, upper] : cell) volume *= upper - lower;
  for (unsigned node = 0; node < 8; ++node) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double middle = (cell[i][0] + cell[i][1]) / 2, half = (cell[i][1] - cell[i][0]) / 2;
      inputs[inputs_[i]] = middle + (node >> i & 1 ? half : -half) / std::sqrt(3.0);
    }
    directions_.run_all<double>(inputs, registers);
    const auto e = [&](std::size_t column, std::size_t row) {
      return registers[directions_.outputs()[3 * column + row]];
    };
    sum += std::fabs(e(0, 0) * (e(1, 1) * e(2, 2) - e(1, 2) * e(2, 1)) +
                     e(0, 1) * (e(1, 2) * e(2, 0) - e(1, 0) * e(2, 2)) +
                     e(0, 2) * (e(1, 0) * e(2, 1) - e(1, 1) * e(2, 0)));
  }
  return volume * sum / 8;
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
    const double middle = grid.centre(1, cell[1]);
    for (cell[0] = 0; cell[0] < grid.cells[0]; ++cell[0])
      for (cell[2] = 0; cell[2] < grid.cells[2]; ++cell[2]) {
        if (!map.feasible[grid.index(cell)]) continue;
        if (!is_principal(middle)) {
          const auto same = equivalent({grid.centre(0, cell[0]), middle, grid.centre(2, cell[2])});
          const Cell other{cell_at(0, same[0]), cell_at(1, same[1]), cell_at(2, same[2])};
          if (other[0] >= 0 && other[1] >= 0 && other[2] >= 0 && map.feasible[grid.index(other)]) continue;
        }
        std::array<std::array<double, 2>, 3> sides;
        for (std::size_t i = 0; i < 3; ++i) {
          const double lower = grid.lower[i] + static_cast<double>(cell[i]) * grid.step[i];
          sides[i] = {lower, lower + grid.step[i]};
        }
        sum += measure_of_cell(sides);
      }
  }
  return sum;
}

}  // namespace pkm::generic
