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
  /// Round numbers from the lower to the upper end of the scale; a single value if the field is constant.
  std::vector<double> values;
  /// open_below, open_above: true if the field has values below the lower end or above the upper end of the scale.
  bool open_below = false, open_above = false;
  double minimum = 0, maximum = 0;  ///< smallest and largest value of the field

  /// Those levels that separate two colours, ascending.
  std::vector<double> thresholds() const;
};

/// Chooses 7 to 18 intervals whose width is 1, 2 or 5 times a power of ten. The scale is open at an end if the
/// outermost 2 % of the values extend farther than all others together, for example near a pole of the field.
/// @return no levels if no value is finite
ContourLevels contour_levels(std::span<const double> values);

/// The region in which a field is at or above a threshold.
struct FieldRegion {
  std::vector<SliceOutline::Loop> loops;  ///< closed polygons that bound the region, oriented as in SliceOutline
  /// Those parts of the boundary that are contour lines. A closed line repeats its first point.
  std::vector<std::vector<PlanePoint>> contours;
  double area = 0;  ///< area of the region, in the product of the units of both axes
};

struct FieldMap {
  FieldRegion defined;    ///< region in which the field is defined; it has no contour lines
  FieldRegion undefined;  ///< region of the mesh in which the field is undefined; it has no contour lines
  /// One region for each threshold, ascending; each region contains those of all higher thresholds.
  std::vector<FieldRegion> regions;
};

/// Computes the regions and contour lines of a field.
/// @param values  value of the field at each vertex of the mesh
FieldMap map_field(const SliceMesh& mesh, std::span<const double> values, std::span<const double> thresholds);

}  // namespace pkm
