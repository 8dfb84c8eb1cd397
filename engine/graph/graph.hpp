// All formulas of something as one graph of shared operations: what is written twice is computed once.
//
// A node is a number, an input or an operation on nodes before it. Numbers are folded, whole powers become products,
// and equal nodes are one; values keep the bits of the formulas one by one. Inputs come in groups (parameters, one
// coordinate, ...), and every node knows on which groups it depends: a program computes it in the outermost loop that
// it can stand in (program.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "engine/graph/operation.hpp"

namespace pkm::graph {

enum class Node : std::uint32_t {};  ///< its position in the graph

using Groups = std::uint32_t;  ///< one bit each

struct Entry {
  const Operation* operation = nullptr;  ///< null: a number or an input
  std::array<Node, kMostArguments> arguments{};
  std::uint8_t count = 0;   ///< of arguments
  std::int32_t input = -1;  ///< its position among the inputs; -1: none
  double number = 0;        ///< of a node that is neither
  Groups groups = 0;        ///< on which it depends

  bool is_number() const { return !operation && input < 0; }
  std::span<const Node> operands() const { return {arguments.data(), count}; }
};

class Graph {
 public:
  Node number(double value);
  /// @param position  among all inputs: each is one node, in the group that it was first given
  Node input(std::size_t position, Groups group = 1);
  /// What is folded of min(a, b, c): min(min(a, b), c).
  Node apply(const Operation& operation, std::span<const Node> arguments);

  const Entry& operator[](Node node) const { return entries_[static_cast<std::size_t>(node)]; }
  std::size_t size() const { return entries_.size(); }

  /// The nodes among `roots` and those that they are made of, each once, before those that use it.
  /// @param is_known  of nodes that are left out, with what only they are made of
  std::vector<Node> reachable(std::span<const Node> roots, const std::function<bool(Node)>& is_known = {}) const;

 private:
  struct Hash {
    std::size_t operator()(const Entry& entry) const;
  };
  struct Same {
    bool operator()(const Entry& x, const Entry& y) const;
  };

  Node add(const Entry& entry);
  Node power(Node base, int exponent);

  std::vector<Entry> entries_;
  std::unordered_map<Entry, Node, Hash, Same> known_;
};

/// What `roots` are made of as a graph of its own, in which some inputs are numbers; the roots become its nodes.
/// @param numbers  by position of the input; behind its end, none is a number
Graph with_numbers(const Graph& graph, std::span<const std::optional<double>> numbers, std::vector<Node>& roots);

/// The same with inputs in place of numbers, so that nothing is folded, and so rounded, that is made of the nodes.
/// @param first    position of the first of these inputs
/// @param group    of every input, by its position
/// @param numbers  what the inputs stand for, in their order; appended
Graph without_numbers(const Graph& graph, std::size_t first, const std::function<Groups(std::size_t)>& group,
                      std::vector<double>& numbers, std::vector<Node>& roots);
/// The same with nodes of the graph, which contain none of those inputs, in place of some inputs.
Graph with_nodes(const Graph& graph, std::span<const std::optional<Node>> nodes, std::vector<Node>& roots);

/// Nodes as numbers, for physics that is written as C++: Term a = g(..), b = ..; a * b + sqrt(a). Unlike formulas of a
/// user these drop what is certain: x + 0, x - x, x * 1 and x * 0.
class Term {
 public:
  Term(Graph& graph, Node node) : graph_(&graph), node_(node) {}
  Term(Graph& graph, double value) : Term(graph, graph.number(value)) {}

  Node node() const { return node_; }
  Graph& graph() const { return *graph_; }
  bool is(double value) const { return (*graph_)[node_].is_number() && (*graph_)[node_].number == value; }

  friend Term operator+(const Term& x, const Term& y);
  friend Term operator-(const Term& x, const Term& y);
  friend Term operator*(const Term& x, const Term& y);
  friend Term operator/(const Term& x, const Term& y);
  friend Term operator-(const Term& x);
  friend Term operator+(const Term& x, double y) { return x + Term(*x.graph_, y); }
  friend Term operator-(const Term& x, double y) { return x - Term(*x.graph_, y); }
  friend Term operator*(const Term& x, double y) { return x * Term(*x.graph_, y); }
  friend Term operator/(const Term& x, double y) { return x / Term(*x.graph_, y); }
  friend Term call(const Operation& function, const Term& x);
  friend Term call(const Operation& function, const Term& x, const Term& y);
  friend Term sqrt(const Term& x) { return call(operation("sqrt"), x); }
  friend Term sin(const Term& x) { return call(operation("sin"), x); }
  friend Term cos(const Term& x) { return call(operation("cos"), x); }
  friend Term acos(const Term& x) { return call(operation("acos"), x); }
  friend Term abs(const Term& x) { return call(operation("abs"), x); }
  friend Term atan2(const Term& y, const Term& x) { return call(operation("atan2"), y, x); }

 private:
  Graph* graph_;
  Node node_;
};

}  // namespace pkm::graph
