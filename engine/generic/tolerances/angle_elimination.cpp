#include "engine/generic/tolerances/angle_elimination.hpp"

#include <optional>

namespace pkm::generic {
namespace {

using expression::Code, expression::Entry, expression::Graph, expression::Node, expression::Term;

struct SineAndCosine {
  Term sine, cosine;
};

class AngleElimination {
 public:
  AngleElimination(Graph& graph, const std::function<bool(Node)>& is_sign) : graph_(graph), is_sign_(is_sign) {}

  /// Sine and cosine of an angle as formulas without inverse functions; std::nullopt if the angle contains no inverse
  /// function.
  std::optional<SineAndCosine> of(Node angle) const {
    const Entry entry = graph_[angle];
    if (!entry.operation) return {};
    const auto argument = [&](std::size_t i) { return Term(graph_, entry.arguments[i]); };
    const std::string& name = entry.operation->name;
    if (name == "atan2") {
      const Term y = argument(0), x = argument(1), radius = sqrt(x * x + y * y);
      return SineAndCosine{y / radius, x / radius};
    }
    if (name == "acos" || name == "asin") {
      const Term u = argument(0), other = sqrt(Term(graph_, 1.0) - u * u);
      return name == "acos" ? SineAndCosine{other, u} : SineAndCosine{u, other};
    }
    if (is_wrapping(entry)) return of(entry.arguments[0]);
    switch (entry.operation->code) {
      case Code::negate: {
        const auto a = of(entry.arguments[0]);
        return a ? std::optional(SineAndCosine{-a->sine, a->cosine}) : std::nullopt;
      }
      case Code::multiply:
        for (const std::size_t i : {0, 1})
          if (const auto a = of(entry.arguments[1 - i]); a && is_sign_(entry.arguments[i]))
            return SineAndCosine{argument(i) * a->sine, a->cosine};
        return {};
      case Code::add:
        for (const std::size_t i : {0, 1})
          if (const auto wrapped = unwrapped_sum(entry.arguments[i], entry.arguments[1 - i])) return of(*wrapped);
        return of_sum(entry, false);
      case Code::subtract:
        return of_sum(entry, true);
      default:
        return {};
    }
  }

 private:
  static bool is_wrapping(const Entry& entry) {
    return entry.operation && *entry.operation == expression::angle_wrapping();
  }
  /// If a sum is a + wrap(b - a), the angle b, from which the sum differs by full turns; otherwise std::nullopt.
  std::optional<Node> unwrapped_sum(Node a, Node wrapping) const {
    if (!is_wrapping(graph_[wrapping])) return {};
    const Entry difference = graph_[graph_[wrapping].arguments[0]];
    if (!difference.operation || difference.operation->code != Code::subtract || difference.arguments[1] != a)
      return {};
    return difference.arguments[0];
  }
  std::optional<SineAndCosine> of_sum(const Entry& entry, bool is_difference) const {
    auto a = of(entry.arguments[0]), b = of(entry.arguments[1]);
    if (!a && !b) return {};
    for (const std::size_t i : {0, 1})
      if (auto& angle = i == 0 ? a : b; !angle)
        angle = {sin(Term(graph_, entry.arguments[i])), cos(Term(graph_, entry.arguments[i]))};
    const Term sine = is_difference ? -b->sine : b->sine;
    return SineAndCosine{a->sine * b->cosine + a->cosine * sine, a->cosine * b->cosine - a->sine * sine};
  }

  Graph& graph_;
  const std::function<bool(Node)>& is_sign_;
};

}  // namespace

void eliminate_angles(Graph& graph, const std::function<bool(Node)>& is_sign, std::vector<Node>& roots) {
  const AngleElimination angles(graph, is_sign);
  std::vector<Node> rewritten(graph.size());
  for (const Node node : graph.reachable(roots)) {
    const Entry entry = graph[node];
    Node& to = rewritten[static_cast<std::size_t>(node)] = node;
    if (!entry.operation) continue;
    std::vector<Node> arguments;
    for (const Node operand : entry.operands()) arguments.push_back(rewritten[static_cast<std::size_t>(operand)]);
    const bool is_sine = entry.operation->name == "sin";
    if (is_sine || entry.operation->name == "cos")
      if (const auto found = angles.of(arguments[0])) {
        to = (is_sine ? found->sine : found->cosine).node();
        continue;
      }
    to = graph.apply_like(entry, arguments);
  }
  for (Node& root : roots) root = rewritten[static_cast<std::size_t>(root)];
}

}  // namespace pkm::generic
