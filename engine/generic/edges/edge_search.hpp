// The edges of a solid: the intervals of the intersection curves of its faces that belong to its boundary.
#pragma once

#include <vector>

#include "engine/generic/edges/curves.hpp"

namespace pkm::generic::edges {

/// An interval of the parameter u of an arc, all of whose points belong to the boundary of the solid.
struct Edge {
  const Arc* arc;
  double from, to;
  double sign;  ///< 1: in the direction of increasing u, the first face is on the left; -1: the second face is
};

/// Finds the edges of solids; its memory is reused from one solid to the next.
class EdgeSearch {
 public:
  /// @return false if two faces are on the same surface, or if there are too many bodies
  bool find(const Solid& solid);

  const std::vector<PreparedBody>& bodies() const { return bodies_; }
  const std::vector<Face>& faces() const { return faces_; }
  std::vector<Face>& faces() { return faces_; }
  const std::vector<Edge>& edges() const { return edges_; }
  /// Point of an edge at the value u of the parameter of its arc.
  static Enclosure3 point_at(const Edge& edge, double u) { return point(*edge.arc, Enclosure::variable(u, 0)).p; }
  /// Whether a point belongs to all bodies but one.
  bool is_in_others(std::size_t body, const CurvePoint& at) const;

  /// false: the search was given up, so that edges may be missing
  bool is_complete() const { return is_complete_; }
  /// Estimate of the volume that intervals without a decision can change [m^3].
  double undecided() const { return undecided_; }
  long boxes() const { return boxes_; }  ///< number of intervals that were examined
  /// The size of the solid, i.e. the largest of all lengths that describe it, raised to a power up to 4.
  double size_to_the(std::size_t power) const { return powers_[power]; }

 private:
  /// A test that all points of an intersection curve have to pass: to belong to a body or, if the curve lies on the
  /// surface of one of the body's faces, to that face.
  struct Test {
    std::size_t body;
    const Rule* rule;
  };
  using Tests = std::uint64_t;  ///< set of tests: bit i stands for tests_[i]
  /// A function whose sign is unknown in an interval. Its test; the number of tests_ stands for Curve::cut.
  struct Undecided {
    std::size_t test, function;
  };

  bool add_curves();
  void trace(const Curve& curve);
  void trace(const Curve& curve, const TorusBox& box, long& boxes);
  bool is_inactive(const Curve& curve, const TorusBox& box) const;
  void set_tests(const Curve& curve);
  void search(const Arc& arc);
  void search(double from, double to, int depth, Tests tests);
  template <class Sign>
  SignSets examine(const Test& test, const CurvePoint& at, std::array<Enclosure, kFunctions>& values,
                   const Sign& sign_of) const;
  Enclosure function_at(std::size_t test, std::size_t number, double u) const;
  std::optional<double> find_root(std::size_t test, std::size_t number, double from, double to) const;
  bool is_active(double u, Tests tests) const;
  bool is_in(const Test& test, const CurvePoint& at) const;
  void emit(double from, double to);

  double bound_ = 0;
  std::array<double, 5> powers_{1};
  std::vector<PreparedBody> bodies_;
  std::vector<Face> faces_;
  std::vector<Curve> curves_;
  std::vector<Arc> arcs_;
  std::vector<Edge> edges_;
  std::vector<CurveRoot> roots_;
  double undecided_ = 0;
  long boxes_ = 0;
  bool is_complete_ = true;

  // Variables of the search along the arc arc_.
  const Arc* arc_ = nullptr;
  std::vector<Test> tests_;
  std::vector<Undecided> undecided_functions_;
  std::vector<double> ends_;
  std::size_t first_edge_ = 0;
};

}  // namespace pkm::generic::edges
