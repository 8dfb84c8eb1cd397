#include "engine/expression/derivative.hpp"

#include <algorithm>

#include "engine/expression/implicit_system.hpp"
#include "engine/expression/term_matrix.hpp"

namespace pkm::expression {
namespace {

Term choose(const Term& condition, const Term& x, const Term& y) {
  if (x.node() == y.node()) return x;
  return {x.graph(), x.graph().apply(choice(), std::array{condition.node(), x.node(), y.node()})};
}
Term is_less(const Term& x, const Term& y) { return call(operation("<"), x, y); }

}  // namespace

Term Rates::of(Node root) {
  for (const Node node : graph_.reachable({&root, 1}, [&](Node each) { return rates_.contains(each); }))
    rates_.emplace(node, differentiate(node).node());
  return cached(root);
}

void Rates::add_rates_of_unknowns(Node status) {
  const Solution& solution = *graph_[status].solution;
  const std::vector<Node> unknowns = graph_.unknowns(status);
  const auto add = [&](std::size_t i, const Term& rate) { rates_.emplace(unknowns[i], rate.node()); };
  const std::size_t n = unknowns.size();
  if (std::ranges::all_of(solution.operands, [&](Node operand) { return cached(operand).is(0); })) {
    for (std::size_t i = 0; i < n; ++i) add(i, Term(graph_, 0.0));
    return;
  }
  const ImplicitSystem::Nodes at = solution.system->nodes(graph_, unknowns, solution.operands);
  Rates partial(graph_);  // rates of the equations while the unknowns are fixed
  for (const Node node : unknowns) partial.set_rate(node, graph_.number(0));
  for (const Node operand : solution.operands) partial.set_rate(operand, rates_.at(operand));
  TermMatrix J(graph_, n, n), rates(graph_, n, 1);
  for (std::size_t i = 0; i < n; ++i) {
    rates(i, 0) = partial.of(at.equations[i]);
    for (std::size_t j = 0; j < n; ++j) J(i, j) = Term(graph_, at.jacobian[i * n + j]);
  }
  const Inverse inverse = inverse_of(J);
  const TermMatrix scaled = inverse.adjugate * rates;
  for (std::size_t i = 0; i < n; ++i) add(i, -(scaled(i, 0) / inverse.determinant));
}

Term Rates::differentiate(Node node) {
  const Entry entry = graph_[node];
  const Term zero(graph_, 0.0), one(graph_, 1.0), f(graph_, node);
  if (!entry.operation || entry.solution) return zero;  // the status of a system is piecewise constant
  if (entry.operation == &unknown()) {
    add_rates_of_unknowns(entry.arguments[0]);
    return cached(node);
  }
  const auto argument = [&](std::size_t i) { return Term(graph_, entry.arguments[i]); };
  const auto rate = [&](std::size_t i) { return cached(entry.arguments[i]); };
  const Term x = argument(0), dx = rate(0);
  bool is_constant = true;
  for (const Node each : entry.operands()) is_constant = is_constant && cached(each).is(0);
  if (is_constant) return zero;

  switch (entry.operation->code) {
    case Code::add:
      return dx + rate(1);
    case Code::subtract:
      return dx - rate(1);
    case Code::multiply:
      return dx * argument(1) + x * rate(1);
    case Code::divide:
      return (dx - f * rate(1)) / argument(1);
    case Code::negate:
      return -dx;
    case Code::sqrt:
      return dx * 0.5 / f;
    case Code::abs:
      return choose(is_less(x, zero), -dx, dx);
    case Code::min:
      return choose(is_less(argument(1), x), rate(1), dx);
    case Code::max:
      return choose(is_less(x, argument(1)), rate(1), dx);
    case Code::solve:
    case Code::other:
      break;
  }
  if (entry.operation == &choice()) return choose(x, rate(1), rate(2));
  if (entry.operation == &angle_wrapping()) return dx;
  const std::string& name = entry.operation->name;
  if (name == "sin") return cos(x) * dx;
  if (name == "cos") return -(sin(x) * dx);
  if (name == "tan") return (one + f * f) * dx;
  if (name == "asin") return dx / sqrt(one - x * x);
  if (name == "acos") return -(dx / sqrt(one - x * x));
  if (name == "atan") return dx / (one + x * x);
  if (name == "atan2") {  // y is the first argument of atan2(y, x)
    const Term& y = x;
    const Term abscissa = argument(1);
    return (abscissa * dx - y * rate(1)) / (abscissa * abscissa + y * y);
  }
  if (name == "sinh") return call(operation("cosh"), x) * dx;
  if (name == "cosh") return call(operation("sinh"), x) * dx;
  if (name == "tanh") return (one - f * f) * dx;
  if (name == "exp") return f * dx;
  if (name == "log") return dx / x;
  if (name == "log10") return dx / (x * call(operation("log"), Term(graph_, 10.0)));
  if (name == "^") {
    const Term y = argument(1);
    // The derivative y x^(y - 1) of x^y needs the exponent y - 1. If y is a constant and the difference is exact,
    // compute it here: it is then a constant even in a graph whose other constants have been replaced by inputs
    // (without_numbers).
    const double reduced = graph_[y.node()].number - 1;
    const bool exact = graph_[y.node()].is_number() && reduced + 1 == graph_[y.node()].number;
    const Term by_base = dx.is(0) ? zero : y * call(operation("^"), x, exact ? Term(graph_, reduced) : y - one) * dx;
    return rate(1).is(0) ? by_base : by_base + f * call(operation("log"), x) * rate(1);
  }
  return zero;  // the operation is piecewise constant: a comparison, && or ||, or sign
}

}  // namespace pkm::expression
