#include "engine/expression/implicit_system.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "engine/core/error.hpp"
#include "engine/expression/derivative.hpp"
#include "engine/expression/newton.hpp"
#include "engine/expression/reverse_mode.hpp"

namespace pkm::expression {
namespace {

constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();
constexpr Groups kCoefficients = 1, kUnknowns = 2;

}  // namespace

ImplicitSystem::ImplicitSystem(Graph graph, std::vector<Node> equations, std::size_t coefficients)
    : graph_(std::move(graph)), equations_(std::move(equations)), coefficients_(coefficients) {
  PKM_EXPECTS(!equations_.empty() && equations_.size() <= kMaxUnknowns);
  for (const Node equation : equations_)
    for (std::size_t j = 0; j < unknowns(); ++j)
      jacobian_.push_back(derivative(graph_, equation, graph_.input(j, kUnknowns)));
  constexpr std::array kStages{kCoefficients, kUnknowns};
  std::vector<Node> all = equations_;
  residuals_ = Program(graph_, all, kStages);
  all.insert(all.end(), jacobian_.begin(), jacobian_.end());
  linearisation_ = Program(graph_, all, kStages);
}

std::size_t ImplicitSystem::scratch_size() const { return linearisation_.registers() + operands(); }

void ImplicitSystem::solve(std::span<const double> operands, std::span<double> results,
                           std::span<double> scratch) const {
  Vector u{};
  std::copy_n(operands.begin() + static_cast<std::ptrdiff_t>(coefficients_), unknowns(), u.begin());
  const bool solved = Newton(*this, operands.first(coefficients_), scratch).solve(u);
  results[0] = solved ? 1 : -1;
  for (std::size_t i = 0; i < unknowns(); ++i) results[i + 1] = solved ? u[i] : kUndefined;
}

namespace {

// The derivatives that a scalar carries, by index, and the number of chord steps after which they are exact: one per
// order of differentiation.
constexpr int parts_of(const Dual4&) { return 4; }
constexpr int parts_of(const Taylor&) { return 2; }
double derivative_part(const Dual4& x, int i) { return x.v[i]; }
double derivative_part(const Taylor& x, int i) { return i == 0 ? x.d : x.dd; }
void add_to_part(Dual4& x, int i, double change) { x.v[i] += change; }
void add_to_part(Taylor& x, int i, double change) { (i == 0 ? x.d : x.dd) += change; }
template <class S>
constexpr int kOrders = std::is_same_v<S, Taylor> ? 2 : 1;

}  // namespace

/// Chord steps u - J^-1 f in the arithmetic of S, from the solution in double precision. They leave the value as it is.
template <class S>
void ImplicitSystem::differentiate(std::span<const S> operands, std::span<S> results) const {
  std::vector<double> values, solution(1 + unknowns()), scratch(scratch_size());
  for (const S& operand : operands) values.push_back(value_of(operand));
  solve(values, solution, scratch);
  std::ranges::copy(solution, results.begin());
  if (solution[0] < 0) return;
  Newton newton(*this, std::span(values).first(coefficients_), scratch);
  Vector u{};
  std::copy_n(solution.begin() + 1, unknowns(), u.begin());
  newton.evaluate(u);
  if (!newton.factor()) {
    for (S& result : results.subspan(1)) result = S(kUndefined);
    return;
  }
  std::vector<S> inputs(results.begin() + 1, results.end()), registers;
  inputs.insert(inputs.end(), operands.begin(), operands.end());
  for (int order = 0; order < kOrders<S>; ++order) {
    std::copy(results.begin() + 1, results.end(), inputs.begin());
    residuals_.run_all<S>(inputs, registers);
    for (int k = 0; k < parts_of(S()); ++k) {
      Vector f{};
      for (std::size_t i = 0; i < unknowns(); ++i) f[i] = derivative_part(registers[residuals_.outputs()[i]], k);
      const Vector change = newton.factors.solve(f);
      for (std::size_t i = 0; i < unknowns(); ++i) add_to_part(results[i + 1], k, -change[i]);
    }
  }
}

void ImplicitSystem::solve(std::span<const Dual4> operands, std::span<Dual4> results) const {
  differentiate(operands, results);
}
void ImplicitSystem::solve(std::span<const Taylor> operands, std::span<Taylor> results) const {
  differentiate(operands, results);
}

std::vector<double> ImplicitSystem::adjoints(std::span<const double> operands, std::span<const double> unknowns,
                                             std::span<const double> of_unknowns) const {
  std::vector<double> scratch(scratch_size());
  Newton newton(*this, operands.first(coefficients_), scratch);
  Vector u{}, weights{};
  std::ranges::copy(unknowns, u.begin());
  std::ranges::copy(of_unknowns, weights.begin());
  std::vector<double> found(operands.size());
  newton.evaluate(u);
  if (!newton.factor()) return std::vector<double>(operands.size(), kUndefined);
  const Vector of_equations = newton.factors.solve_transposed(weights);
  std::vector<double> by(linearisation_.registers());
  for (std::size_t i = 0; i < equations_.size(); ++i) by[linearisation_.outputs()[i]] -= of_equations[i];
  for (const std::size_t stage : {1, 0}) backward_sweep(linearisation_, stage, newton.registers(), by);
  for (const Program::Input& input : linearisation_.stages()[0].inputs)
    found[input.position - equations_.size()] = by[input.to];
  return found;
}

ImplicitSystem::Nodes ImplicitSystem::nodes(Graph& to, std::span<const Node> unknowns,
                                            std::span<const Node> operands) const {
  std::vector<Node> roots = equations_, copies(graph_.size()), arguments;
  roots.insert(roots.end(), jacobian_.begin(), jacobian_.end());
  for (const Node node : graph_.reachable(roots)) {
    const Entry& entry = graph_[node];
    const auto input = static_cast<std::size_t>(entry.input);
    arguments.clear();
    for (const Node operand : entry.operands()) arguments.push_back(copies[static_cast<std::size_t>(operand)]);
    copies[static_cast<std::size_t>(node)] = entry.operation           ? to.apply_like(entry, arguments)
                                             : entry.is_number()       ? to.number(entry.number)
                                             : input < unknowns.size() ? unknowns[input]
                                                                       : operands[input - unknowns.size()];
  }
  const auto copied = [&](const std::vector<Node>& nodes) {
    std::vector<Node> made;
    for (const Node node : nodes) made.push_back(copies[static_cast<std::size_t>(node)]);
    return made;
  };
  return {copied(equations_), copied(jacobian_)};
}

}  // namespace pkm::expression
