#include "engine/generic/outer_quadrature.hpp"

#include <algorithm>

#include "engine/core/stop.hpp"
#include "engine/expression/reverse_mode.hpp"

namespace pkm::generic {
namespace {

constexpr std::size_t kMaxCells = 100;

/// Adds factor() times the gradient of the first output of a program with a single stage to the derivatives by input.
template <class Factor>
void add_gradient(const expression::Program& program, const std::vector<double>& inputs, const Factor& factor,
                  std::span<double> by_input) {
  if (program.stages().front().inputs.empty()) return;  // the output is constant, so that its gradient is 0
  std::vector<double> registers;
  program.run_all<double>(inputs, registers);
  std::vector<double> adjoints(registers.size());
  adjoints[program.outputs().front()] = factor();
  expression::backward_sweep(program, 0, registers, adjoints);
  for (const auto& input : program.stages().front().inputs) by_input[input.position] += adjoints[input.to];
}

/// A subinterval of the range of an outer coordinate, with the integral over it.
struct OuterCell : QuadratureCell<double> {
  double inner_error = 0;  ///< integral over the subinterval of the estimated error of the inner volume
  std::vector<double> by_input{};
};

}  // namespace

Integral<double> OuterQuadrature::at(std::size_t level, double value, std::vector<double>& inputs,
                                     std::span<double> by_input, const Inner& inner) const {
  check_stop();
  inputs[e_.model.inputs.coordinate(coordinates_[level])] = value;
  return level + 1 < coordinates_.size() ? measure(level + 1, inputs, by_input, inner) : inner(inputs, by_input);
}

Integral<double> OuterQuadrature::measure(std::size_t level, std::vector<double>& inputs, std::span<double> by_input,
                                          const Inner& inner) const {
  const Subinterval<double> range = this->range(level, inputs);
  const double width = range.upper - range.lower;
  if (!(width > 0)) return {};
  std::vector<OuterCell> cells;
  Integral<double> sum;
  const Quadrature settings{.rule = patterson_rule()};
  std::array<double, NestedRule::kNodes> error_at;
  std::array<std::vector<double>, NestedRule::kNodes> by_input_at;
  const auto integrate = [&](OuterCell& cell) {
    std::size_t nodes = 0;
    const auto volume_at = [&](double point) {
      by_input_at[nodes].assign(by_input.size(), 0);
      const Integral<double> found = at(level, point, inputs, by_input_at[nodes], inner);
      error_at[nodes++] = found.error;
      sum.evaluations += found.evaluations;
      return found.value;
    };
    // If the workspace is empty at the first nodes, the remaining nodes are evaluated, too.
    const auto is_accurate = [&] {
      return cell.integral.value > 0 && cell.integral.error <= tolerance_ * cell.integral.value;
    };
    cell.levels = 0;
    do apply_rule(volume_at, settings, cell);
    while (!is_accurate() && cell.levels < settings.rule.level.size());
    cell.inner_error = 0;
    cell.by_input.assign(by_input.size(), 0);
    for (std::size_t i = 0; i < nodes; ++i) {
      const double weight = settings.rule.level[cell.levels - 1].weight[i];
      const double jacobian = map_node(cell.interval, settings.rule.node[i]).jacobian;
      cell.inner_error += weight * (jacobian * error_at[i]);
      for (std::size_t k = 0; k < by_input.size(); ++k) cell.by_input[k] += weight * (jacobian * by_input_at[i][k]);
    }
  };
  // Many mechanisms are symmetric about the middle of the range, where their volumes may have a kink.
  const double middle = range.lower + 0.5 * width;
  for (const Subinterval<double>& half : {Subinterval<double>{range.lower, middle}, {middle, range.upper}}) {
    cells.emplace_back().interval = half;
    integrate(cells.back());
  }
  while (true) {
    double error = 0, inner_error = 0;
    sum.value = 0;
    for (const OuterCell& cell : cells) {
      sum.value += cell.integral.value;
      error += cell.integral.error;
      inner_error += cell.inner_error;
    }
    sum.error = error + inner_error;
    if (error <= std::max(tolerance_ * sum.value, inner_error) || cells.size() >= kMaxCells) break;
    const auto worst = std::ranges::max_element(cells, {}, [](const OuterCell& cell) { return cell.integral.error; });
    bisect_cell(cells, static_cast<std::size_t>(worst - cells.begin()), integrate);
  }
  if (by_input.empty()) return sum;
  const std::size_t own = e_.model.inputs.coordinate(coordinates_[level]);
  const double of_coordinate = by_input[own];
  for (const OuterCell& cell : cells)
    for (std::size_t k = 0; k < by_input.size(); ++k) by_input[k] += cell.by_input[k];
  by_input[own] = of_coordinate;
  const auto value_at = [&](double end) { return at(level, end, inputs, {}, inner).value; };
  const std::size_t coordinate = coordinates_[level];
  add_gradient(
      e_.upper[coordinate], inputs, [&] { return value_at(range.upper); }, by_input);
  add_gradient(
      e_.lower[coordinate], inputs, [&] { return -value_at(range.lower); }, by_input);
  return sum;
}

}  // namespace pkm::generic
