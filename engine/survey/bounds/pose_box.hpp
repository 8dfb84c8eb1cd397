// Whether conditions hold at every pose of a box, and whether matrices are regular there: boxes are halved until each
// is decided.
//
// A condition that only rises or only falls along each axis, or stays, is least and greatest at corners; any other is
// no further from its value in the middle than its slopes lead. A matrix is
// regular over a box if, multiplied with an inverse from its middle, it is near enough to the unit matrix: its diagonal
// outweighs the rest of each row (Levy and Desplanques).
#pragma once

#include <span>

#include "engine/mechanism/abilities/bounds.hpp"
#include "engine/survey/bounds/conditions.hpp"

namespace pkm::bounds {

/// A square matrix of formulas.
struct NamedMatrix {
  std::string name;
  std::size_t rows = 0;
  std::vector<graph::Node> entries;  ///< row by row
};

/// Immutable, shared by threads.
class Matrices {
 public:
  using Room = std::vector<Interval>;

  Matrices(const graph::Graph& graph, const std::vector<NamedMatrix>& matrices, std::vector<std::size_t> axes,
           const std::vector<Interval>& inputs);

  const Room& room() const { return start_; }
  /// The first of them that may be singular somewhere in a box; null: none is.
  const std::string* singular(const Place& place, Room& room) const;

 private:
  bool is_regular(std::span<const Interval> entries, std::size_t rows) const;

  std::vector<NamedMatrix> matrices_;
  std::vector<std::size_t> axes_;
  graph::Program program_;
  Room start_;
};

/// @param ranges    by axis
/// @param matrices  null: nobody asks
PosesCertificate certify(const Conditions& conditions, const Matrices* matrices,
                         std::span<const std::array<double, 2>> ranges, const BoundsOptions& options);

}  // namespace pkm::bounds
