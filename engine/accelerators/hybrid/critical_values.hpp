// Hybrid robot: the intervals of beta, between critical values, on which slices have one combinatorial type.
//
// Slices are decomposed at samples of beta. If two adjacent samples differ in type, the degeneracy that separates the
// types is identified, and Newton's method solves for it, simultaneously in beta and in the heights of intersections.
// Decompositions slightly below and above the solution show whether there are further critical values between the
// samples; these are then searched for recursively.
#pragma once

#include <deque>
#include <limits>
#include <optional>
#include <vector>

#include "engine/accelerators/hybrid/strips.hpp"

namespace pkm::hybrid {

/// A slice of a design at one beta, in double precision.
struct SampledSlice {
  double beta = 0;
  Slice<double> slice;
  Decomposition decomposition;
};

/// What degenerates in a slice at a critical value of beta: two features of the boundary coincide there.
struct Degeneracy {
  enum class Kind : std::uint8_t {
    heights,  ///< the bounds `first` and `second` of z coincide
    edges,    ///< the edges `left` and `right` intersect at the bound `first` of z
    /// The edges `left` and `right` are tangent at the height of `first`, where two strips meet or one vanishes.
    tangency
  } kind = Kind::heights;
  StripBound first, second;
  Edge left, right;
};

/// An interval of beta on which all slices have the same combinatorial type.
struct BetaInterval {
  double lower = 0, upper = 0;
  std::optional<Degeneracy> at_lower, at_upper;  ///< degeneracies at the endpoints; std::nullopt: not identified
  Decomposition decomposition;                   ///< decomposition of a slice near the lower endpoint
};

/// Scratch memory of find_beta_intervals().
struct CriticalValueScratch {
  std::vector<BetaInterval> intervals;
  std::size_t count = 0;  ///< number of elements of `intervals` that are in use
  std::deque<SampledSlice> samples;
  StripScratch strips;
};

/// Finds the intervals of beta on which slices are not empty, in ascending order.
/// @param plain    the design in double precision
/// @param by_beta  the design with zero derivatives, for derivatives with respect to beta
/// @param scratch  receives the intervals in `intervals`
void find_beta_intervals(const SlicedDesign<double>& plain, const SlicedDesign<Dual<1>>& by_beta,
                         CriticalValueScratch& scratch);

/// Index of the curve whose square root vanishes at a bound of z; kCurves if there is none.
inline std::size_t vanishing_curve(const StripBound& end) {
  if (end.kind == StripBound::Kind::hole) return kCurveH;
  if (end.kind == StripBound::Kind::intersection) return kCurves;
  if (end.index == kEndP1 || end.index == kEndP2) return kCurveP;
  if (end.index == kEndL && end.kind == StripBound::Kind::upper) return kCurveL;
  return end.index == kEndQ && end.kind == StripBound::Kind::lower ? std::size_t{kCurveQ} : std::size_t{kCurves};
}

/// The x of an edge at a bound of z, at which the square root in the formula of the edge may vanish.
template <class S>
S edge_at_end(const Slice<S>& s, const Edge& edge, const StripBound& end) {
  return edge.curve == vanishing_curve(end) ? S(0.0) : edge_at(s, edge, height(s, end));
}

/// Returns true if the derivative of the area with respect to beta has a square-root singularity at a degeneracy, so
/// that the area varies like the power 3/2 of the distance: at a tangency, or at a bound of z at which the radicand of
/// a square root is zero.
inline bool has_sqrt_singularity(const Degeneracy& degeneracy) {
  return degeneracy.kind == Degeneracy::Kind::tangency || vanishing_curve(degeneracy.first) != kCurves ||
         (degeneracy.kind == Degeneracy::Kind::heights && vanishing_curve(degeneracy.second) != kCurves);
}

/// Distance of the two features of a slice that coincide at the critical value of beta; 0 there.
template <class S>
S distance(const Slice<S>& s, const Degeneracy& degeneracy) {
  if (degeneracy.kind == Degeneracy::Kind::tangency) {  // the distance is the minimum or maximum over z
    const S z(degeneracy.first.z);
    return edge_at(s, degeneracy.right, z) - edge_at(s, degeneracy.left, z);
  }
  if (degeneracy.kind == Degeneracy::Kind::edges)
    return edge_at_end(s, degeneracy.right, degeneracy.first) - edge_at_end(s, degeneracy.left, degeneracy.first);
  return height(s, degeneracy.second) - height(s, degeneracy.first);
}

/// The critical value of beta at which a degeneracy occurs, with derivatives by the implicit function theorem.
template <class S>
S lift_critical_value(const SlicedDesign<S>& d, const SlicedDesign<Dual<1>>& by_beta, double at,
                      const Degeneracy& degeneracy) {
  if constexpr (std::is_same_v<S, double>) {
    return at;
  } else {
    const double derivative = distance(slice(by_beta, Dual<1>::variable(at, 0)), degeneracy).v[0];
    return implicit_root(at, distance(slice(d, S(at)), degeneracy), derivative);
  }
}

}  // namespace pkm::hybrid
