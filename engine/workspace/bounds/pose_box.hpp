// Whether conditions hold at every pose of a box, and whether matrices are regular there: boxes are halved until each
// is decided.
//
// A condition that only rises or only falls along each axis, or stays, is least and greatest at corners; any other is
// no further from its value in the middle than its slopes lead. A matrix is regular over a box if, multiplied with an
// inverse from its middle, it is an H-matrix: with weights u > 0 of the columns, its diagonal outweighs the rest of
// each row (generalised diagonal dominance). One with more rows than columns has the full rank if the same holds with a
// left inverse (A^T A)^-1 A^T. A pose is singular to working precision if |A v| <= kSingularRcond |A| |v| for some v,
// in intervals. A square matrix is singular between two poses where its determinant has two signs, if its entries are
// continuous there.
#pragma once

#include <span>

#include "engine/mechanism/abilities/bounds.hpp"
#include "engine/workspace/bounds/conditions.hpp"

namespace pkm::bounds {

/// A matrix of formulas, with at least as many rows as columns.
struct NamedMatrix {
  std::string name;
  std::size_t rows = 0, columns = 0;
  std::vector<expression::Node> entries;  ///< row by row
};

/// Immutable, shared by threads.
class Matrices {
 public:
  using Room = std::vector<Interval>;

  Matrices(const expression::Graph& graph, const std::vector<NamedMatrix>& matrices, std::vector<std::size_t> axes,
           const std::vector<Interval>& inputs);

  const Room& room() const { return start_; }
  std::size_t size() const { return matrices_.size(); }
  const std::string& name(std::size_t k) const { return matrices_[k].name; }
  /// The first of them that may lack rank somewhere in a box; none: all have the full rank everywhere.
  std::optional<std::size_t> singular(const Place& place, Room& room) const;
  /// Sign of the determinant of a square one at a pose; 0: unknown.
  int sign(std::size_t k, const Place& pose, Room& room) const;
  /// Whether it lacks rank at a pose to working precision (engine/geometry/singular.hpp).
  bool is_singular_at(std::size_t k, const Place& pose, Room& room) const;
  /// Whether its entries are continuous over a box.
  bool is_continuous(std::size_t k, const Place& place, Room& room) const;

 private:
  void enter(const Place& place, Room& room) const;
  std::vector<Interval> entries(std::size_t k, const Room& room) const;  ///< over the box that was entered

  std::vector<NamedMatrix> matrices_;
  std::vector<std::size_t> axes_;
  expression::Program program_;
  Room start_;
};

/// @param ranges    by axis
/// @param matrices  null: not requested
PosesCertificate certify(const Conditions& conditions, const Matrices* matrices,
                         std::span<const std::array<double, 2>> ranges, const BoundsOptions& options);

}  // namespace pkm::bounds
