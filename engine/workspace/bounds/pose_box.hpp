// Interval branch and bound over a box of poses, or a cylinder or sphere in it: proves that all constraints are
// satisfied and that given matrices have full rank at every pose, or finds a counterexample. Boxes outside the solid
// are discarded. Counterexamples are poses proven to be in the solid.
//
// Constraints. One that is monotonic along each axis has its minimum at a vertex of the box; any other is bounded by
// the mean value form about the midpoint.
//
// Matrices. A matrix has full rank on a box if its product with an approximate inverse of its midpoint is an H-matrix:
// with weights u > 0 of the columns, each diagonal element outweighs the rest of its row (generalised diagonal
// dominance). A matrix with more rows than columns is multiplied by the left inverse (A^T A)^-1 A^T instead. A pose is
// singular to working precision if |A v| <= kSingularRcond |A| |v| for some v, in interval arithmetic. A square matrix
// with continuous entries is singular at some pose between two poses at which its determinant has different signs.
//
// Reference: A. Neumaier, "Interval Methods for Systems of Equations", Cambridge University Press, 1990, chapter 3
// (H-matrices).
#pragma once

#include <span>

#include "engine/mechanism/abilities/bounds.hpp"
#include "engine/workspace/bounds/constraints.hpp"

namespace pkm::bounds {

/// A matrix of formulas, with at least as many rows as columns.
struct NamedMatrix {
  std::string name;
  std::size_t rows = 0, columns = 0;
  std::vector<expression::Node> entries;  ///< elements of the matrix, row by row
};

/// @return true if all matrices with these entries, row by row, are proved to have full column rank
bool has_full_rank(std::span<const Interval> entries, std::size_t rows, std::size_t columns);

/// Matrices of formulas, compiled to an interval program. Immutable and thread-safe.
class Matrices {
 public:
  /// Inputs of the graph, and registers of the program.
  using Scratch = std::vector<Interval>;

  /// @param axes    indices of the graph's inputs that are the axes
  /// @param inputs  values of all inputs of the graph; inputs that are not axes keep these values
  Matrices(const expression::Graph& graph, const std::vector<NamedMatrix>& matrices, std::vector<std::size_t> axes,
           const std::vector<Interval>& inputs);

  const Scratch& initial_scratch() const { return initial_; }
  std::size_t size() const { return matrices_.size(); }
  const std::string& name(std::size_t k) const { return matrices_[k].name; }
  /// The first matrix without a proof of full rank on a box; std::nullopt if all have full rank.
  std::optional<std::size_t> first_undecided(const IntervalBox& box, Scratch& scratch) const;
  /// Sign of the determinant of a square matrix at a pose; 0: unknown.
  int determinant_sign(std::size_t k, const IntervalBox& pose, Scratch& scratch) const;
  /// @return true if a matrix is rank-deficient at a pose to working precision (engine/geometry/singular.hpp)
  bool is_singular_at(std::size_t k, const IntervalBox& pose, Scratch& scratch) const;
  /// @return true if all entries of a matrix are continuous and bounded on a box
  bool is_continuous(std::size_t k, const IntervalBox& box, Scratch& scratch) const;

 private:
  void evaluate(const IntervalBox& box, Scratch& scratch) const;
  std::vector<Interval> entries(std::size_t k, const Scratch& scratch) const;  ///< entries of matrix k, row by row; to
                                                                               ///< be called after evaluate()

  std::vector<NamedMatrix> matrices_;
  std::vector<std::size_t> axes_;
  expression::Program program_;
  Scratch initial_;
};

/// Tries to prove for all poses of a solid over the axes that all constraints are satisfied and all matrices have full
/// rank.
/// @param matrices  null: regularity is not examined
PoseCertificate certify(const Constraints& constraints, const Matrices* matrices, const PoseSolid& poses,
                        const BoundsOptions& options);

}  // namespace pkm::bounds
