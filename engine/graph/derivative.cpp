#include "engine/graph/derivative.hpp"

#include <unordered_map>

namespace pkm::graph {
namespace {

/// f' where f is the operation on x and y.
std::optional<Term> chained(const std::string& name, Code code, const Term& f, const Term& x, const Term& dx,
                            const Term& y, const Term& dy) {
  const auto call_1 = [](const char* function, const Term& u) { return call(operation(function), u); };
  switch (code) {
    case Code::add:
      return dx + dy;
    case Code::subtract:
      return dx - dy;
    case Code::multiply:
      return dx * y + x * dy;
    case Code::divide:
      return dy.is(0) ? dx / y : (dx - f * dy) / y;
    case Code::negate:
      return -dx;
    case Code::sqrt:
      return dx / (f * 2.0);
    case Code::abs:
      return call_1("sign", x) * dx;
    default:
      break;
  }
  if (name == "sin") return cos(x) * dx;
  if (name == "cos") return -(sin(x) * dx);
  if (name == "tan") return (f * f + 1.0) * dx;
  if (name == "asin") return dx / sqrt(Term(x.graph(), 1.0) - x * x);
  if (name == "acos") return -(dx / sqrt(Term(x.graph(), 1.0) - x * x));
  if (name == "atan") return dx / (x * x + 1.0);
  if (name == "atan2") return (y * dx - x * dy) / (x * x + y * y);  // of x by y, as they are written
  if (name == "sinh") return call_1("cosh", x) * dx;
  if (name == "cosh") return call_1("sinh", x) * dx;
  if (name == "tanh") return (Term(x.graph(), 1.0) - f * f) * dx;
  if (name == "exp") return f * dx;
  if (name == "log") return dx / x;
  if (name == "turn") return dx;
  if (name == "^") return f * (dy * call_1("log", x) + y * dx / x);
  return {};
}

/// x where the question is answered with yes, else y.
Term chosen(const Term& question, const Term& x, const Term& y) {
  if (x.node() == y.node()) return x;
  return {x.graph(), x.graph().apply(choice(), std::array{question.node(), x.node(), y.node()})};
}

}  // namespace

std::optional<Node> derivative(Graph& graph, Node f, Node input) {
  const Term zero(graph, 0.0);
  std::unordered_map<Node, Term> known;
  for (const Node node : graph.reachable({&f, 1})) {
    const Entry entry = graph[node];
    const auto put = [&](const Term& d) { known.emplace(node, d); };
    if (!entry.operation) {
      put(node == input ? Term(graph, 1.0) : zero);
      continue;
    }
    const auto argument = [&](std::size_t i) { return Term(graph, entry.arguments[i]); };
    const auto slope = [&](std::size_t i) { return known.at(entry.arguments[i]); };
    bool constant = true;
    for (std::size_t i = 0; i < entry.count; ++i) constant = constant && slope(i).is(0);
    const std::string& name = entry.operation->name;
    const Code code = entry.operation->code;
    const bool is_question = entry.count == 2 && code == Code::other && name != "atan2" && name != "^";
    if (constant || is_question || name == "sign") {
      put(zero);
    } else if (entry.operation == &choice()) {
      put(chosen(argument(0), slope(1), slope(2)));
    } else if (code == Code::min || code == Code::max) {
      put(chosen(call(operation(code == Code::min ? "<=" : ">="), argument(0), argument(1)), slope(0), slope(1)));
    } else {
      const std::size_t last = entry.count - std::size_t{1};
      const auto d = chained(name, code, Term(graph, node), argument(0), slope(0), argument(last), slope(last));
      if (!d) return {};
      put(*d);
    }
  }
  return known.at(f).node();
}

}  // namespace pkm::graph
