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
struct OuterCell {
  Subinterval<double> interval;
  double value = 0, error = 0;
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
  const NestedRule& rule = patterson_rule();
  std::array<double, NestedRule::kNodes> term, error_term;
  std::array<std::vector<double>, NestedRule::kNodes> by_input_at;
  const auto integrate = [&](OuterCell& cell) {
    std::size_t known = 0;
    for (const NestedRule::Level& weights : rule.level) {
      for (; known < weights.nodes; ++known) {
        const auto [point, jacobian] = map_node(cell.interval, rule.node[known]);
        by_input_at[known].assign(by_input.size(), 0);
        const Integral<double> found = at(level, point, inputs, by_input_at[known], inner);
        term[known] = jacobian * found.value;
        error_term[known] = jacobian * found.error;
        for (double& each : by_input_at[known]) each *= jacobian;
        sum.evaluations += found.evaluations;
      }
      cell.value = cell.inner_error = 0;
      cell.by_input.assign(by_input.size(), 0);
      for (std::size_t i = 0; i < known; ++i) {
        cell.value += weights.weight[i] * term[i];
        cell.inner_error += weights.weight[i] * error_term[i];
        for (std::size_t k = 0; k < by_input.size(); ++k) cell.by_input[k] += weights.weight[i] * by_input_at[i][k];
      }
      cell.error = rule_error(weights, term, cell.value);
      // Where the first nodes find no workspace, the others look for it, too.
      if (cell.value > 0 && cell.error <= tolerance_ * cell.value) break;
    }
  };
  // Many mechanisms are symmetric about the middle of the range, where their volumes may have a kink.
  const double middle = range.lower + 0.5 * width;
  for (const Subinterval<double>& half : {Subinterval<double>{range.lower, middle}, {middle, range.upper}}) {
    cells.push_back({half});
    integrate(cells.back());
  }
  while (true) {
    double error = 0, inner_error = 0;
    sum.value = 0;
    for (const OuterCell& cell : cells) {
      sum.value += cell.value;
      error += cell.error;
      inner_error += cell.inner_error;
    }
    sum.error = error + inner_error;
    if (error <= std::max(tolerance_ * sum.value, inner_error) || cells.size() >= kMaxCells) break;
    const auto worst = std::ranges::max_element(cells, {}, &OuterCell::error);
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
