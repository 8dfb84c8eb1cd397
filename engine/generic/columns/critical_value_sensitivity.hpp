// Sensitivity of a critical value at which the vertices of a planar slice change, by the implicit function theorem. A
// few boundary curves degenerate there, and their gradients in the slice are linearly dependent: two tangent curves,
// three through one point, a conic that is a single point. With factors f such that sum f grad P = 0, all P = 0 gives
//
//   dx/dp = - sum f P_p / sum f P_x.
#pragma once

#include <optional>
#include <vector>

#include "engine/generic/columns/planar_slice_sensitivity.hpp"

namespace pkm::generic {

/// Endpoint (v, z) of an arc that bounds a planar slice, and the index of the surface of the arc.
struct ArcEnd {
  std::uint32_t label;  ///< label of the vertex at which the arc ends
  std::uint32_t surface;
  double v, z;
};

/// Endpoints of all arcs that bound a planar slice.
/// @param scratch  scratch memory of planar_slice.measure() for the slice
std::vector<ArcEnd> arc_ends(const PlanarSlice& planar_slice, const PlanarSliceScratch& scratch);

/// A critical value with its derivatives with respect to the design; std::nullopt if the curves that degenerate there
/// are not identified.
/// @param at               the critical value
/// @param inside, outside  endpoints of the arcs of two slices, one on each side of the critical value
/// @param scratch          scratch memory of the slice with the endpoints `inside`
/// @param by_design, by_x  sensitivities of this slice with respect to the design, and to the outer coordinate x
std::optional<Dual4> differentiable_critical_value(double at, std::vector<ArcEnd> inside, std::vector<ArcEnd> outside,
                                                   const PlanarSliceScratch& scratch,
                                                   const PlanarSliceSensitivity& by_design,
                                                   const PlanarSliceSensitivity& by_x);

}  // namespace pkm::generic
