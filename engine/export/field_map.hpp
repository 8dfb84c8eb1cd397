// Filled contours of a field on the mesh of a slice: the regions above a number of levels, and the contour lines.
//
// Each polygon of the mesh is divided into triangles around its centre, whose value is the mean of the values at the
// vertices; the field is linear in each triangle. Regions and lines end exactly at the outline of the mesh. A polygon
// with a vertex at which the value is undefined (not finite) belongs to no region.
#pragma once

#include <span>
#include <vector>

#include "engine/export/slice_outline.hpp"

namespace pkm {

/// Ascending field values at which the colour of a map changes.
struct ContourLevels {
  std::vector<double> values;  ///< round numbers, from the lower to the upper end of the scale; a single value if the
                               ///< field is constant
  bool open_below = false, open_above = false;  ///< whether the field has values beyond the ends
  double minimum = 0, maximum = 0;              ///< extreme values of the field

  /// The levels that separate two colours.
  std::vector<double> thresholds() const;
};

/// Chooses 7 to 18 intervals whose width is 1, 2 or 5 times a power of ten. The scale is open at an end if the
/// outermost 2 % of the values extend farther than all others together, for example near a pole of the field.
/// @return no levels if no value is finite
ContourLevels contour_levels(std::span<const double> values);

/// The region in which the field is at or above a threshold.
struct FieldRegion {
  std::vector<SliceOutline::Loop> loops;          ///< boundary, closed, oriented as in SliceOutline
  std::vector<std::vector<PlanePoint>> contours;  ///< parts of the boundary that are contour lines; a closed line
                                                  ///< repeats its first point
  double area = 0;                                ///< in the product of the axes' units
};

struct FieldMap {
  FieldRegion defined;               ///< where the field is defined; without contour lines
  FieldRegion undefined;             ///< the rest of the mesh; without contour lines
  std::vector<FieldRegion> regions;  ///< for each threshold, ascending; each region contains the following ones
};

/// @param values  one per vertex of the mesh
FieldMap map_field(const SliceMesh& mesh, std::span<const double> values, std::span<const double> thresholds);

}  // namespace pkm
