// Systems of equations f(u, a) = 0 that define unknowns u as implicit functions of operands a.
//
// The value of u is the limit of Newton's method, damped by the natural monotonicity test (Deuflhard, "Newton Methods
// for Nonlinear Problems", 2011, section 3.3), from a start that depends on the operands only. The solution has to be
// on the branch of the start: the determinant of the Jacobian df/du has to have the same sign at the start and at the
// solution. Derivatives follow from the implicit function theorem, df/du u' = -df/da a'. Intervals are enclosed by
// Krawczyk's test (Moore, Kearfott, Cloud, "Introduction to Interval Analysis", 2009, section 8.2), which proves that
// the system has exactly one solution near an approximate one, for all operands in their intervals.
#pragma once

#include <vector>

#include "engine/expression/program.hpp"

namespace pkm::expression {

/// The system f(u, a) = 0 with unknowns u and operands a. Immutable and thread-safe.
class ImplicitSystem {
 public:
  static constexpr std::size_t kMaxUnknowns = 6;

  /// @param graph      its inputs are the n unknowns, which come first, and the coefficients; it has no constants,
  ///                   because interval arithmetic could not take the rounding errors of folded constants into account
  /// @param equations  n nodes of `graph`, the left sides f
  /// @param coefficients  number of the coefficients
  ImplicitSystem(Graph graph, std::vector<Node> equations, std::size_t coefficients);

  std::size_t unknowns() const { return equations_.size(); }
  /// Number of operands: the coefficients, then the start of every unknown.
  std::size_t operands() const { return coefficients_ + unknowns(); }
  /// Number of numbers that solving the system in double precision needs as scratch memory.
  std::size_t scratch_size() const;

  /// Solves the system. S is double, Dual4, Taylor or Interval; the values of the first three have the same bits.
  /// @param results  receives the status, which is 1 if the system is solved and otherwise -1, and the unknowns, which
  ///                 are NaN if it is not solved. Intervals: if the test proves nothing, the status is [-1, 1] and the
  ///                 unknowns are unbounded
  /// @param scratch  memory with scratch_size() elements
  void solve(std::span<const double> operands, std::span<double> results, std::span<double> scratch) const;
  void solve(std::span<const Dual4> operands, std::span<Dual4> results) const;
  void solve(std::span<const Taylor> operands, std::span<Taylor> results) const;
  void solve(std::span<const Interval> operands, std::span<Interval> results) const;

  /// Reverse-mode differentiation: the adjoints of the operands, from those of the unknowns at a solution.
  std::vector<double> adjoints(std::span<const double> operands, std::span<const double> unknowns,
                               std::span<const double> of_unknowns) const;

  /// The equations and the elements of their Jacobian, by rows, as nodes of another graph.
  struct Nodes {
    std::vector<Node> equations, jacobian;
  };
  Nodes nodes(Graph& to, std::span<const Node> unknowns, std::span<const Node> operands) const;

 private:
  using Vector = std::array<double, kMaxUnknowns>;
  struct Factors;
  class Newton;
  class Krawczyk;

  template <class S>
  void differentiate(std::span<const S> operands, std::span<S> results) const;

  Graph graph_;
  std::vector<Node> equations_, jacobian_;
  std::size_t coefficients_;
  /// Outputs: the equations; in `linearisation_` also the Jacobian. The first stage depends on the coefficients only.
  Program residuals_, linearisation_;
};

}  // namespace pkm::expression
