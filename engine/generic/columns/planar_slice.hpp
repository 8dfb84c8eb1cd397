// Area of a planar slice in closed form: the conics that bound it intersect at roots of polynomials of degree four, and
// between those the endpoints of columns are arcs whose areas have closed forms.
#pragma once

#include <algorithm>

#include "engine/generic/columns/critical_value_solver.hpp"
#include "engine/generic/columns/endpoints.hpp"
#include "engine/generic/columns/sign_changes.hpp"
#include "engine/generic/conic.hpp"
#include "engine/generic/slice_plan.hpp"
#include "engine/math/quadrature.hpp"

namespace pkm::generic {

/// Scratch memory of PlanarSlice, with the results of measure(). The coordinates t and s in [-1, 1] stand for v and z.
struct PlanarSliceScratch {
  /// A vertex of the slice: a point at which arcs of its boundary can end. It has the coordinate t and a label
  /// (vertices.hpp).
  struct Vertex {
    double t;
    std::uint32_t label;
    bool touches = false;  ///< true: the vertex is an intersection of two conics that are tangent to each other there
    double s = 0;          ///< coordinate s of an intersection or turning point; 0 for other vertices
  };
  /// A feasible interval of z, which exists in all columns of a piece (an interval of t), by the labels of its lower
  /// and upper endpoint.
  struct Span {
    EndLabel lower, upper;

    bool operator==(const Span&) const = default;
  };
  /// An interval [from, to] of t in which all columns have the same endpoints.
  struct Piece {
    double from, to;
    /// Index of the first vertex with t = from, and with t = to; vertices.size() stands for a vertical side of the
    /// slice.
    std::size_t from_vertex, to_vertex;
    std::size_t first, count;  ///< index of the piece's first element in `spans`, and number of its elements
  };
  /// The constraints that a conic with the polynomial P represents, as two sets: constraints P >= 0, and constraints -P
  /// >= 0.
  struct Meaning {
    Signs same, opposite;
  };
  std::array<Conic, kMaxSurfaces> conics;
  std::array<Meaning, kMaxSurfaces> meaning;
  std::array<double, 2> v, z;  ///< centre and half width of the slice in v, and in z
  /// Indices of the conics that change their sign in the slice; equal conics are listed once.
  std::vector<std::size_t> active;
  Signs always = 0;  ///< set of the constraints that are >= 0 in the whole slice
  std::vector<Vertex> vertices;
  std::vector<Piece> pieces;
  std::vector<Span> spans, column;
  Ends ends;
  std::vector<double> before, now, other_adjoints;
  SliceType type = 0;
};

/// The coordinate s of the endpoint with the label `end` in the column at t.
inline double end_at(EndLabel end, double t, const PlanarSliceScratch& scratch) {
  return place_on(scratch.conics[end >> 1U], static_cast<int>(end & 1U), t);
}

/// Provides endpoints of pieces (intervals of t) and of columns as numbers for PlanarSlice::for_each_node();
/// PlanarSliceSensitivity provides them with derivatives.
struct PlanarSliceValues {
  using Scalar = double;
  const PlanarSliceScratch& scratch;

  double vertex(std::size_t, double t) const { return t; }
  double end(EndLabel end, double t) const { return end_at(end, t, scratch); }
};

class PlanarSlice {
 public:
  explicit PlanarSlice(SlicePlan plan) : plan_(std::move(plan)) {}

  const SlicePlan& plan() const { return plan_; }
  /// Returns the area of the slice, and sets its type and its pieces in `scratch`.
  /// @param registers  values of the program's registers after all stages except that of v
  /// @param changes    sign changes along v of the constraints that are independent of z; null: sampling finds them
  double measure(std::span<double> registers, PlanarSliceScratch& scratch,
                 const std::vector<SignChange>* changes = nullptr) const;
  /// Adds the derivatives of factor times the area to the adjoints of the program's registers; to be called after
  /// measure().
  void add_gradient(double factor, std::span<double> registers, std::span<double> adjoints,
                    PlanarSliceScratch& scratch) const;
  /// Calls visit(v, z, weight) at quadrature nodes in the slice; to be called after measure().
  /// @param ends  PlanarSliceValues, or PlanarSliceSensitivity for nodes with derivatives
  template <class Ends, class Visit>
  void for_each_node(const GaussRule& along_v, const GaussRule& along_z, const PlanarSliceScratch& scratch,
                     const Ends& ends, const Visit& visit) const {
    using S = typename Ends::Scalar;
    for (const auto& piece : scratch.pieces) {
      const Subinterval<S> range{ends.vertex(piece.from_vertex, piece.from), ends.vertex(piece.to_vertex, piece.to),
                                 has_sqrt_singularity(piece.from_vertex, scratch),
                                 has_sqrt_singularity(piece.to_vertex, scratch)};
      visit_nodes(range, along_v, [&](const S& t, const S& jacobian, double weight_v) {
        for (std::size_t k = piece.first; k < piece.first + piece.count; ++k) {
          const S low = ends.end(scratch.spans[k].lower, t), high = ends.end(scratch.spans[k].upper, t);
          const S weight = scratch.v[1] * scratch.z[1] * jacobian * weight_v * (high - low);
          for (std::size_t j = 0; j < along_z.node.size(); ++j)
            visit(scratch.v[0] + scratch.v[1] * t, scratch.z[0] + scratch.z[1] * (low + (high - low) * along_z.node[j]),
                  weight * along_z.weight[j]);
        }
      });
    }
  }

  /// Calls visit(end, first, t) for each endpoint of the arcs that bound the slice; to be called after measure(). end:
  /// label of the arc; t: coordinate of its endpoint; first: index of the first vertex at t.
  template <class Visit>
  void for_each_arc_end(const PlanarSliceScratch& scratch, const Visit& visit) const {
    const auto continues = [&](const PlanarSliceScratch::Piece& piece, EndLabel end, bool above) {
      return std::any_of(
          scratch.spans.begin() + static_cast<std::ptrdiff_t>(piece.first),
          scratch.spans.begin() + static_cast<std::ptrdiff_t>(piece.first + piece.count),
          [&](const PlanarSliceScratch::Span& span) { return (above ? span.upper : span.lower) == end; });
    };
    for (std::size_t p = 0; p < scratch.pieces.size(); ++p) {
      const auto& piece = scratch.pieces[p];
      const auto* const before = p > 0 && scratch.pieces[p - 1].to == piece.from ? &piece - 1 : nullptr;
      const auto* const after =
          p + 1 < scratch.pieces.size() && scratch.pieces[p + 1].from == piece.to ? &piece + 1 : nullptr;
      for (std::size_t i = piece.first; i < piece.first + piece.count; ++i)
        for (const bool above : {false, true}) {
          const EndLabel end = above ? scratch.spans[i].upper : scratch.spans[i].lower;
          if (!before || !continues(*before, end, above)) visit(end, piece.from_vertex, piece.from);
          if (!after || !continues(*after, end, above)) visit(end, piece.to_vertex, piece.to);
        }
    }
  }
  /// Appends to `pieces` the intervals of v in which all columns have the same endpoints; to be called after measure().
  void append_smooth_intervals(const PlanarSliceScratch& scratch, std::vector<Subinterval<double>>& pieces) const;
  /// The feasible intervals of z at a value of v, in ascending order; to be called after measure().
  std::vector<std::array<double, 2>> columns(double v, std::span<double> registers, PlanarSliceScratch& scratch) const;
  /// Appends to `features` the vertices that determine the type of the slice; to be called after measure().
  void find_features(const PlanarSliceScratch& scratch, BoundaryFeatures& features) const;
  /// Distance of a vertex from the surfaces that intersect at a vertex `other` of a neighbouring slice: residual of
  /// their equations, relative to the size of their terms. Infinity if the vertex lies on these surfaces, or if one of
  /// the two vertices is no intersection.
  static double distance(const BoundaryFeature& vertex, const BoundaryFeature& other,
                         const PlanarSliceScratch& scratch);
  /// Derivative with respect to v, at t, of the constraint with index k among those that are independent of z.
  /// @param by  receives the derivatives by registers, see expression::stage_derivative()
  double slope_of_independent(std::size_t k, double t, std::span<double> registers, const PlanarSliceScratch& scratch,
                              std::vector<double>& by) const;

 private:
  bool load(std::span<const double> registers, PlanarSliceScratch& scratch) const;
  void find_vertices(PlanarSliceScratch& scratch) const;
  void add_vertex(double t, double s, Signs of, std::uint32_t label, PlanarSliceScratch& scratch) const;
  void find_independent_vertices(std::span<double> registers, PlanarSliceScratch& scratch) const;
  void find_pieces(bool independent, std::span<double> registers, PlanarSliceScratch& scratch) const;
  void find_column(double t, const double* registers, PlanarSliceScratch& scratch) const;
  /// Computes those registers that depend on v, but not on z. @param t  in [-1, 1], stands for v
  void evaluate_stage_of_v(double t, std::span<double> registers, const PlanarSliceScratch& scratch) const;
  /// Evaluates, at t, the constraints that are independent of z. @param values  receives their values
  void evaluate_independent(double t, std::span<double> registers, const PlanarSliceScratch& scratch,
                            std::vector<double>& values) const;
  bool independent_constraints_hold(double t, std::span<double> registers, const PlanarSliceScratch& scratch) const;
  /// Integrals of 1, s and s^2 over the feasible intervals of s at t, in a piece that contains t.
  std::array<double, 3> moments(const PlanarSliceScratch::Piece& piece, double t,
                                const PlanarSliceScratch& scratch) const;
  void find_combinatorial_type(PlanarSliceScratch& scratch) const;
  /// Whether the length of the columns, as a function of t, has a square-root singularity at a vertex.
  static bool has_sqrt_singularity(std::size_t vertex, const PlanarSliceScratch& scratch);
  std::size_t stage_of_v() const { return plan_.program.stages().size() - 1; }

  SlicePlan plan_;
};

}  // namespace pkm::generic
