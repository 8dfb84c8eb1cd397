// Interval branch and bound for the largest box of deviations |d_i| <= t within which all constraints are satisfied at
// every pose: minimises max |d_i| over all violations, over poses and deviations together.
//
// A box of the search is a box of poses times a box of deviations. Its bound is a scale t up to which none of its
// points with |d_i| <= t violates a constraint. The target is slightly below the smallest scale of a violation that is
// known. A box is decided if every constraint is proved for all its deviations up to the target; otherwise it is
// bisected, the box with the lowest bound first. The minimum of all bounds and of the target is certified at any time.
//
// For derivatives with the enclosures G over a box, a constraint is bounded by
//     g >= min of g over a vertex of the axes in which it is monotonic - sum |G_j| |x_j - c_j| over the others, and
//     g >= min of g for d = 0 - t sum_i |G_i|, which gives a bound of t.
// A determinant is also decided on a box where its matrix is proved to have full rank (pose_box.hpp): each parameter of
// a single limb occurs in one row of the matrix, whereas the formula of the determinant multiplies the uncertainties of
// all rows. The determinant then has one sign on the box; because boxes share their faces, it has the same sign on all.
//
// Reference: E. Hansen, G. W. Walster, "Global Optimization Using Interval Analysis", 2nd ed., Marcel Dekker, 2004.
#pragma once

#include "engine/workspace/bounds/violation_search.hpp"

namespace pkm::bounds {

struct DeviationBoxOptions {
  double gap = 0.02;  ///< stop as soon as 1 - certified scale / scale of the smallest violation is at most this
  std::size_t max_boxes = 1000000;
  std::function<bool()> stop = [] { return false; };  ///< returns true to stop the search; called often, by any thread
};

struct DeviationBox {
  double certified = 0;  ///< all constraints are proved for deviations |d_i| <= certified
  /// The known violation of the smallest scale; std::nullopt: none is known up to the largest scale.
  std::optional<Violation> violation;
  std::size_t boxes = 0;  ///< number of boxes examined
  bool stopped = false;
};

/// Finds the largest box of deviations. The certified scale does not depend on the number of threads.
/// @param ranges  ranges of the coordinates, the first axes of the constraints; the remaining axes are deviations
/// @param scale   the largest scale of interest
/// @param known   a violation that is known already
DeviationBox largest_deviation_box(const ParametricConstraints& constraints,
                                   std::span<const std::array<double, 2>> ranges, double scale,
                                   std::optional<Violation> known, const DeviationBoxOptions& options);

}  // namespace pkm::bounds
