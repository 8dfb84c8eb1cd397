#include "engine/expression/graph.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "engine/core/error.hpp"
#include "engine/expression/implicit_system.hpp"
#include "engine/math/hash.hpp"

namespace pkm::expression {
namespace {

bool commutes(const Operation& operation) { return operation.code == Code::add || operation.code == Code::multiply; }

// Operations that are applied often, found by name only once.
struct CommonOperations {
  const Operation &add = operation("+"), &subtract = operation("-"), &multiply = operation("*"),
                  &divide = operation("/"), &power = operation("^");
};
const CommonOperations& common() {
  static const CommonOperations operations;
  return operations;
}

}  // namespace

std::size_t Graph::Hash::operator()(const Entry& entry) const {
  Fnv1a hash;
  hash.add(std::bit_cast<std::uint64_t>(entry.number));
  hash.add(reinterpret_cast<std::uintptr_t>(entry.operation));
  hash.add(static_cast<std::uint64_t>(entry.input));
  for (const Node node : entry.operands()) hash.add(static_cast<std::uint64_t>(node));
  return static_cast<std::size_t>(hash.value() ^ (hash.value() >> 32U));
}

bool Graph::Equal::operator()(const Entry& x, const Entry& y) const {
  return x.operation == y.operation && x.input == y.input && std::ranges::equal(x.operands(), y.operands()) &&
         std::bit_cast<std::uint64_t>(x.number) == std::bit_cast<std::uint64_t>(y.number) &&
         (x.solution ? x.solution->system : nullptr) == (y.solution ? y.solution->system : nullptr);
}

Node Graph::intern(const Entry& entry) {
  const auto [found, is_new] = nodes_.try_emplace(entry, static_cast<Node>(entries_.size()));
  if (is_new) entries_.push_back(entry);
  return found->second;
}

Node Graph::number(double value) { return intern({.number = value}); }

Node Graph::input(std::size_t position, Groups group) {
  return intern({.input = static_cast<std::int32_t>(position), .groups = group});
}

/// base^exponent as products by repeated squaring, in the same order as in operation ^, so that the result has the same
/// bits.
Node Graph::power(Node base, int exponent) {
  const auto product = [&](Node x, Node y) { return apply(common().multiply, std::array{x, y}); };
  if (exponent == 0) return number(1);
  if (exponent < 0) return apply(common().divide, std::array{number(1), power(base, -exponent)});
  Node result{};
  for (bool first = true; exponent > 0; exponent /= 2) {
    if (exponent % 2 != 0) {
      result = first ? base : product(result, base);
      first = false;
    }
    if (exponent > 1) base = product(base, base);
  }
  return result;
}

Node Graph::apply(const Operation& operation, std::span<const Node> arguments) {
  if (operation.arguments == 0 && arguments.size() > 2) {
    Node result = arguments[0];
    for (const Node next : arguments.subspan(1)) result = apply(operation, std::array{result, next});
    return result;
  }
  PKM_EXPECTS(arguments.size() <= kMaxArguments && !arguments.empty());
  Entry entry{.operation = &operation, .count = static_cast<std::uint8_t>(arguments.size())};
  std::ranges::copy(arguments, entry.arguments.begin());
  if (commutes(operation)) std::sort(entry.arguments.begin(), entry.arguments.begin() + 2);
  bool are_constants = true;
  double values[kMaxArguments] = {};
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const Entry& argument = (*this)[arguments[i]];
    entry.groups |= argument.groups;
    are_constants = are_constants && argument.is_number();
    values[i] = argument.number;
  }
  if (are_constants) return number(std::get<Rule<double>>(operation.rules)(values, arguments.size()));
  if (operation == common().power && (*this)[entry.arguments[1]].is_number() &&
      values[1] == std::nearbyint(values[1]) && std::fabs(values[1]) <= 1024)
    return power(entry.arguments[0], static_cast<int>(values[1]));
  return intern(entry);
}

Node Graph::apply_like(const Entry& entry, std::span<const Node> operands) {
  if (entry.solution) return solve(entry.solution->system, {operands.begin(), operands.end()}).front();
  if (entry.operation == &unknown()) return unknowns(operands.front())[static_cast<std::size_t>(entry.number)];
  return apply(*entry.operation, operands);
}

std::vector<Node> Graph::solve(std::shared_ptr<const ImplicitSystem> system, std::vector<Node> operands) {
  PKM_EXPECTS(operands.size() == system->operands());
  const auto solution = std::make_shared<const Solution>(Solution{std::move(system), std::move(operands)});
  Entry entry{.operation = &solving(), .solution = solution.get()};
  for (const Node operand : solution->operands) entry.groups |= (*this)[operand].groups;
  const Node status = intern(entry);
  if ((*this)[status].solution == solution.get()) solutions_.push_back(solution);
  std::vector<Node> nodes = unknowns(status);
  nodes.insert(nodes.begin(), status);
  return nodes;
}

std::vector<Node> Graph::unknowns(Node status) {
  const Entry of = (*this)[status];
  std::vector<Node> nodes;
  for (std::size_t i = 0; i < of.solution->system->unknowns(); ++i)
    nodes.push_back(intern({.operation = &unknown(),
                            .arguments = {status},
                            .count = 1,
                            .number = static_cast<double>(i),
                            .groups = of.groups}));
  return nodes;
}

std::vector<Node> Graph::reachable(std::span<const Node> roots, const std::function<bool(Node)>& is_known) const {
  // The order of the indices is a topological order. The nodes are visited in the opposite order; a bit set contains
  // those that have been reached, but not visited yet.
  constexpr std::size_t kBits = 64;
  std::vector<std::uint64_t> reached(entries_.size() / kBits + 1);
  const auto reach = [&](Node node) {
    const auto index = static_cast<std::size_t>(node);
    reached[index / kBits] |= std::uint64_t{1} << index % kBits;
  };
  for (const Node root : roots) reach(root);
  std::vector<Node> all;
  for (std::size_t word = reached.size(); word-- > 0;)
    while (reached[word] != 0) {
      const auto bit = static_cast<std::size_t>(std::bit_width(reached[word]) - 1);
      reached[word] &= ~(std::uint64_t{1} << bit);
      const auto node = static_cast<Node>(word * kBits + bit);
      if (is_known && is_known(node)) continue;
      all.push_back(node);
      for (const Node operand : (*this)[node].operands()) reach(operand);
    }
  std::ranges::reverse(all);
  return all;
}

namespace {

/// Copies the nodes of `order` into a new graph, whose constants and inputs are created by `leaf`, and replaces `roots`
/// by their copies.
/// @param order  nodes that include everything `roots` depend on, operands first
/// @param leaf   leaf(new graph, contents of an old constant or input, new nodes by index of the old ones): its new
///               node
template <class Leaf>
Graph rebuild(const Graph& graph, const std::vector<Node>& order, std::vector<Node>& roots, const Leaf& leaf) {
  Graph made;
  std::vector<Node> copies(graph.size()), operands;
  for (const Node node : order) {
    const Entry& entry = graph[node];
    operands.clear();
    for (const Node operand : entry.operands()) operands.push_back(copies[static_cast<std::size_t>(operand)]);
    copies[static_cast<std::size_t>(node)] =
        entry.operation ? made.apply_like(entry, operands) : leaf(made, entry, std::as_const(copies));
  }
  for (Node& root : roots) root = copies[static_cast<std::size_t>(root)];
  return made;
}

/// Element `i` of `by_input` for the node of input i; std::nullopt if the node is no input or `by_input` has no such
/// element.
template <class T>
std::optional<T> replacement(const Entry& entry, std::span<const std::optional<T>> by_input) {
  const auto input = static_cast<std::size_t>(entry.input);
  return entry.input >= 0 && input < by_input.size() ? by_input[input] : std::nullopt;
}
Node copy_leaf(Graph& made, const Entry& entry) {
  return entry.is_number() ? made.number(entry.number)
                           : made.input(static_cast<std::size_t>(entry.input), entry.groups);
}

}  // namespace

Graph substitute_numbers(const Graph& graph, std::span<const std::optional<double>> numbers, std::vector<Node>& roots) {
  return rebuild(graph, graph.reachable(roots), roots, [&](Graph& made, const Entry& entry, const auto&) {
    const auto number = replacement(entry, numbers);
    return number ? made.number(*number) : copy_leaf(made, entry);
  });
}

Graph without_numbers(const Graph& graph, std::size_t first, const std::function<Groups(std::size_t)>& group,
                      std::vector<double>& numbers, std::vector<Node>& roots) {
  return rebuild(graph, graph.reachable(roots), roots, [&](Graph& made, const Entry& entry, const auto&) {
    auto input = static_cast<std::size_t>(entry.input);
    if (entry.is_number()) {
      input = first + numbers.size();
      numbers.push_back(entry.number);
    }
    return made.input(input, group(input));
  });
}

Graph substitute_nodes(const Graph& graph, std::span<const std::optional<Node>> nodes, std::vector<Node>& roots) {
  std::vector<Node> wanted;
  for (const auto& node : nodes)
    if (node) wanted.push_back(*node);
  // Topological order, in which a replacement precedes the nodes that use it.
  std::vector<Node> order = graph.reachable(wanted);
  const std::vector<Node> others = graph.reachable(roots);
  order.insert(order.end(), others.begin(), others.end());
  return rebuild(graph, order, roots, [&](Graph& made, const Entry& entry, const std::vector<Node>& copies) {
    const auto node = replacement(entry, nodes);
    return node ? copies[static_cast<std::size_t>(*node)] : copy_leaf(made, entry);
  });
}

Term call(const Operation& function, const Term& x) {
  return {x.graph(), x.graph().apply(function, std::array{x.node()})};
}
Term call(const Operation& function, const Term& x, const Term& y) {
  return {x.graph(), x.graph().apply(function, std::array{x.node(), y.node()})};
}

Term operator+(const Term& x, const Term& y) { return x.is(0) ? y : y.is(0) ? x : call(common().add, x, y); }
Term operator-(const Term& x, const Term& y) {
  if (x.node() == y.node()) return {x.graph(), 0.0};
  return y.is(0) ? x : x.is(0) ? -y : call(common().subtract, x, y);
}
Term operator*(const Term& x, const Term& y) {
  if (x.is(0) || y.is(0)) return {x.graph(), 0.0};
  return x.is(1) ? y : y.is(1) ? x : x.is(-1) ? -y : y.is(-1) ? -x : call(common().multiply, x, y);
}
Term operator/(const Term& x, const Term& y) { return y.is(1) || x.is(0) ? x : call(common().divide, x, y); }
Term operator-(const Term& x) { return call(negation(), x); }

}  // namespace pkm::expression
