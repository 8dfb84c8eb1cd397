// Expression graph: directed acyclic graph of elementary operations with hash-consing.
//
// A node is a constant, an input, or an operation on nodes that were added before it. Nodes are hash-consed: adding a
// node that exists already returns the existing one, so common subexpressions of all formulas of a graph are computed
// once. Operations on constants are folded, and integer powers become products. None of this changes the result: values
// have the same bits as those of the formulas evaluated one by one.
//
// Every input belongs to a group (the parameters, one coordinate, ...), and every node records the set of groups that
// it depends on. A Program (program.hpp) uses this for loop-invariant code motion.
//
// References: Filliatre, Conchon, "Type-safe modular hash-consing", ML Workshop 2006; Aho, Lam, Sethi, Ullman,
// "Compilers", 2nd ed., section 6.1.2 (value-number method for constructing DAGs).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "engine/expression/operation.hpp"

namespace pkm::expression {

enum class Node : std::uint32_t {};  ///< index of a node in its graph; operands have smaller indices

using Groups = std::uint32_t;  ///< set of input groups, one bit each

class ImplicitSystem;

/// A system of equations whose coefficients and start are nodes of a graph.
struct Solution {
  std::shared_ptr<const ImplicitSystem> system;
  std::vector<Node> operands;
};

/// The contents of a node: an operation with its arguments, an input, or a constant.
struct Entry {
  const Operation* operation = nullptr;  ///< the operation; null if the node is a constant or an input
  std::array<Node, kMaxArguments> arguments{};
  std::uint8_t count = 0;   ///< number of arguments
  std::int32_t input = -1;  ///< index of the node among the inputs of the graph; -1 if the node is not an input
  /// Value of a constant; for a node that is an unknown of a system of equations, index of the unknown.
  double number = 0;
  Groups groups = 0;  ///< groups of all inputs that the node depends on, directly or through its arguments
  const Solution* solution = nullptr;  ///< the system that the node solves, if its operation is solving()

  bool is_number() const { return !operation && input < 0; }
  std::span<const Node> operands() const {
    return solution ? std::span<const Node>(solution->operands) : std::span<const Node>(arguments.data(), count);
  }
};

class Graph {
 public:
  Node number(double value);
  /// @param position  index among all inputs. An input has one node; a repeated call keeps the group of the first call.
  Node input(std::size_t position, Groups group = 1);
  /// The node of operation(arguments). More than two arguments of min or max are nested: min(min(a, b), c).
  Node apply(const Operation& operation, std::span<const Node> arguments);
  /// The node of the same operation as `entry`, which may belong to another graph, with these operands.
  Node apply_like(const Entry& entry, std::span<const Node> operands);
  /// Adds the solution of a system of equations.
  /// @return the node of its status (1 where the system is solved, otherwise -1), followed by the nodes of its unknowns
  ///         (NaN where it is not solved)
  std::vector<Node> solve(std::shared_ptr<const ImplicitSystem> system, std::vector<Node> operands);
  /// The nodes of the unknowns of a system of equations, given the node of its status.
  std::vector<Node> unknowns(Node status);

  const Entry& operator[](Node node) const { return entries_[static_cast<std::size_t>(node)]; }
  std::size_t size() const { return entries_.size(); }

  /// All nodes that `roots` depend on, roots included, each once, in topological order (operands first).
  /// @param is_known  the search stops at nodes for which this is true, and omits them
  std::vector<Node> reachable(std::span<const Node> roots, const std::function<bool(Node)>& is_known = {}) const;

 private:
  struct Hash {
    std::size_t operator()(const Entry& entry) const;
  };
  struct Equal {
    bool operator()(const Entry& x, const Entry& y) const;
  };

  /// The node with these contents; adds it if the graph has none yet.
  Node intern(const Entry& entry);
  Node power(Node base, int exponent);

  std::vector<Entry> entries_;
  std::vector<std::shared_ptr<const Solution>> solutions_;  ///< systems that the entries solve
  /// The nodes of the graph by their contents, to find an existing node (hash-consing).
  std::unordered_map<Entry, Node, Hash, Equal> nodes_;
};

/// Copies the subgraph of `roots` into a new graph in which constants replace some of the inputs (partial evaluation).
/// @param numbers  the constants, by index of the input; an input without a constant, or with an index beyond the end,
///                 stays
/// @param roots    become the corresponding nodes of the new graph
Graph substitute_numbers(const Graph& graph, std::span<const std::optional<double>> numbers, std::vector<Node>& roots);

/// Copies the subgraph of `roots` into a new graph in which inputs replace all constants. Operations added later on
/// these nodes are then not folded in double precision, so that interval arithmetic can enclose their rounding errors.
/// @param first    index of the first of the new inputs
/// @param group    group of every input of the new graph, by its index
/// @param numbers  the values of the new inputs are appended, in their order
Graph without_numbers(const Graph& graph, std::size_t first, const std::function<Groups(std::size_t)>& group,
                      std::vector<double>& numbers, std::vector<Node>& roots);
/// Copies the subgraph of `roots` into a new graph in which nodes replace some of the inputs (substitution).
/// @param nodes  the replacements, nodes of `graph`, by index of the input; they must not depend on replaced inputs
Graph substitute_nodes(const Graph& graph, std::span<const std::optional<Node>> nodes, std::vector<Node>& roots);

/// A node as a scalar type with overloaded operators, to build a graph from equations written in C++:
/// Term a = .., b = ..; a * b + sqrt(a). Unlike Graph::apply, the operators simplify x + 0, x - x, x * 1 and x * 0.
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

}  // namespace pkm::expression
