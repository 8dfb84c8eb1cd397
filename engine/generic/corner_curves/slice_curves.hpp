// Boundary curves of the slices of a segment of the outer coordinate, from the coefficients of the constraint surfaces
// at the Chebyshev nodes.
//
// Surfaces that have one sign in a rectangle around the feasible part become constants of the feasibility formula,
// equal curves become one, and curves that the rest of the formula does not contain are left out. All of this is
// decided by bounds that hold in the whole segment.
#pragma once

#include "engine/generic/corner_curves/boundary_curve.hpp"
#include "engine/generic/corner_curves/outer_plan.hpp"
#include "engine/generic/corner_curves/slice_formula.hpp"
#include "engine/generic/corner_curves/v_limits.hpp"

namespace pkm::generic::corner_curves {

/// Coordinates (x, y) in which the boundary curves are given: a point has v = Frame::v + scale x and z = Frame::z +
/// scale y.
struct Frame {
  double v = 0, z = 0, scale = 1;
};

/// The constraint from which a boundary curve originates; derivatives need it.
struct CurveSource {
  enum class Kind : std::uint8_t { circle, line, conic, lower_root, upper_root, v_bound, limit };
  Kind kind;
  /// Index of the surface; v_bound: 0 for the lower and 1 for the upper bound; limit: index of the limit.
  std::size_t surface;
  /// 1 or -1: direction of a line's normal relative to the gradient of the surface; conic: factor by which the surface
  /// is multiplied.
  double sign;
};

/// Values at the Chebyshev nodes of a segment of all registers from which the boundary curves are computed.
struct NodeValues {
  std::vector<std::array<Samples, 6>> surfaces;  ///< for each surface, its coefficients of 1, v, z, v^2, v z, z^2
  std::array<Samples, 2> v;                      ///< lower and upper bound of v
};

/// The boundary curves of the slices of a segment, and the formula that decides which points are feasible.
struct SliceCurves {
  Frame frame;
  std::vector<BoundaryCurve> curves;
  std::vector<CurveSource> sources;  ///< for each curve, the constraint from which it originates
  SliceFormula formula;

  enum class Status { empty, filled, unresolved };
  /// Computes all members for a segment.
  /// @return empty: no point of the segment is feasible; unresolved: a coefficient is not analytic, or its
  ///         interpolation error is too large
  Status build(const SlicePlan& plan, const OuterPlan& outer, const NodeValues& nodes,
               const std::vector<LimitRoot>& limits, const Frame& where, const double* registers);

 private:
  bool add_surface(std::size_t surface, Shape shape, const std::array<Samples, 6>& c);
  void add_conic(std::size_t surface, const std::array<Samples, 6>& c);
  bool add_strip(std::size_t surface, bool along_v, const std::array<Samples, 6>& c);
  void add_line(BoundaryCurve& line, CurveSource source, Signs positive, std::size_t* number = nullptr);
  void add_bound(BoundaryCurve& line, bool upper);
  bool add_limits(const std::vector<LimitRoot>& roots);
  std::size_t add_curve(const BoundaryCurve& curve, const CurveSource& source);
  Status simplify();
  void remove_constant(std::size_t i, bool outside);
  void remove_irrelevant();
};

}  // namespace pkm::generic::corner_curves
