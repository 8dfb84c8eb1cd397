// Positions of the labels on contour lines.
#pragma once

#include <optional>
#include <vector>

#include "engine/export/slice_mesh.hpp"

namespace pkm {

/// The place of a label on a line: centre [pixel] and direction [deg, counter-clockwise, between -90 and 90] of the
/// text, and the two parts of the line that the label does not cover.
struct LabelPlace {
  PlanePoint at;
  double angle;
  std::vector<PlanePoint> before, after;
};

/// Chooses a place for a label: the position closest to the middle of the line at which the line is nearly straight
/// over the length of the label, and other labels and the outline are far enough away.
/// @param line     points of the line [pixel], y downwards
/// @param length   length of the label [pixel]
/// @param labels   centres of the other labels [pixel]
/// @param outline  closely spaced points of the outline [pixel]
/// @return std::nullopt if there is no such position
std::optional<LabelPlace> place_label(const std::vector<PlanePoint>& line, double length,
                                      const std::vector<PlanePoint>& labels, const std::vector<PlanePoint>& outline);

}  // namespace pkm
