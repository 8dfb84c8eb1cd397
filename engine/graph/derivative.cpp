#include "engine/graph/derivative.hpp"

namespace pkm::graph {
namespace {

Term choose(const Term& condition, const Term& x, const Term& y) {
  if (x.node() == y.node()) return x;
  return {x.graph(), x.graph().apply(choice(), std::array{condition.node(), x.node(), y.node()})};
}
Term is_less(const Term& x, const Term& y) { return call(operation("<"), x, y); }

}  // namespace

Term Rates::of(Node root) {
  for (const Node node : graph_.reachable({&root, 1}, [&](Node each) { return known_.contains(each); }))
    known_.emplace(node, of_operation(node).node());
  return known(root);
}

Term Rates::of_operation(Node node) {
  const Entry entry = graph_[node];
  const Term zero(graph_, 0.0), one(graph_, 1.0), f(graph_, node);
  if (!entry.operation) return zero;
  const auto argument = [&](std::size_t i) { return Term(graph_, entry.arguments[i]); };
  const auto moves = [&](std::size_t i) { return known(entry.arguments[i]); };
  const Term x = argument(0), dx = moves(0);
  bool still = true;
  for (const Node each : entry.operands()) still = still && known(each).is(0);
  if (still) return zero;

  switch (entry.operation->code) {
    case Code::add:
      return dx + moves(1);
    case Code::subtract:
      return dx - moves(1);
    case Code::multiply:
      return dx * argument(1) + x * moves(1);
    case Code::divide:
      return (dx - f * moves(1)) / argument(1);
    case Code::negate:
      return -dx;
    case Code::sqrt:
      return dx * 0.5 / f;
    case Code::abs:
      return choose(is_less(x, zero), -dx, dx);
    case Code::min:
      return choose(is_less(argument(1), x), moves(1), dx);
    case Code::max:
      return choose(is_less(x, argument(1)), moves(1), dx);
    case Code::other:
      break;
  }
  if (entry.operation == &choice()) return choose(x, moves(1), moves(2));
  if (entry.operation == &turn()) return dx;
  const std::string& name = entry.operation->name;
  if (name == "sin") return cos(x) * dx;
  if (name == "cos") return -(sin(x) * dx);
  if (name == "tan") return (one + f * f) * dx;
  if (name == "asin") return dx / sqrt(one - x * x);
  if (name == "acos") return -(dx / sqrt(one - x * x));
  if (name == "atan") return dx / (one + x * x);
  if (name == "atan2") {  // of y = x, x = argument(1)
    const Term& y = x;
    const Term along = argument(1);
    return (along * dx - y * moves(1)) / (along * along + y * y);
  }
  if (name == "sinh") return call(operation("cosh"), x) * dx;
  if (name == "cosh") return call(operation("sinh"), x) * dx;
  if (name == "tanh") return (one - f * f) * dx;
  if (name == "exp") return f * dx;
  if (name == "log") return dx / x;
  if (name == "log10") return dx / (x * call(operation("log"), Term(graph_, 10.0)));
  if (name == "^") {
    const Term y = argument(1);
    const double less = graph_[y.node()].number - 1;  // 2 - 1 is a number also in graphs that fold none
    const bool exact = graph_[y.node()].is_number() && less + 1 == graph_[y.node()].number;
    const Term of_base = dx.is(0) ? zero : y * call(operation("^"), x, exact ? Term(graph_, less) : y - one) * dx;
    return moves(1).is(0) ? of_base : of_base + f * call(operation("log"), x) * moves(1);
  }
  return zero;  // steps: comparisons, && and ||, sign
}

}  // namespace pkm::graph
