#include "engine/generic/outer_quadrature.hpp"

#include <algorithm>

#include "engine/core/stop.hpp"
#include "engine/expression/reverse_mode.hpp"

namespace pkm::generic {
namespace {

// If the tolerance is at least this, the subdivision begins with a single subinterval.
constexpr double kCoarse = 1e-5;
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
  const NestedRule& rule = kronrod_rule();
  const NestedRule::Level& weights = rule.level.front();
  std::vector<double> by_input_there(by_input.size());
  const auto integrate = [&](OuterCell& cell) {
    cell.value = cell.inner_error = 0;
    cell.by_input.assign(by_input.size(), 0);
    std::array<double, NestedRule::kNodes> term;
    for (std::size_t i = 0; i < NestedRule::kNodes; ++i) {
      const auto [point, jacobian] = map_node(cell.interval, rule.node[i]);
      std::ranges::fill(by_input_there, 0);
      const Integral<double> found = at(level, point, inputs, by_input_there, inner);
      const double weight = jacobian * weights.weight[i];
      term[i] = jacobian * found.value;
      cell.value += weight * found.value;
      cell.inner_error += weight * found.error;
      sum.evaluations += found.evaluations;
      for (std::size_t k = 0; k < by_input.size(); ++k) cell.by_input[k] += weight * by_input_there[k];
    }
    cell.error = rule_error(weights, term, cell.value);
  };
  const int first_cells = tolerance_ >= kCoarse ? 1 : 2;
  for (int i = 0; i < first_cells; ++i) {
    cells.push_back({{range.lower + width * i / first_cells, range.lower + width * (i + 1) / first_cells}});
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
