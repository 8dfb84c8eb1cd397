// Positions of the labels on contour lines.
#pragma once

#include <optional>
#include <vector>

#include "engine/export/slice_mesh.hpp"

namespace pkm {

/// A label on a line: centre [pixel] and direction [deg, counter-clockwise, between -90 and 90] of the text, and the
/// two remaining parts of the line, without the part that the label covers.
struct LabelPlace {
  PlanePoint at;
  double angle;
  std::vector<PlanePoint> before, after;
};

/// Chooses the position closest to the middle of the line at which the line is nearly straight over the length of the
/// label, and other labels and the outline are far enough away. @return std::nullopt if there is none
/// @param line     [pixel], y downwards
/// @param length   length of the label [pixel]
/// @param labels   centres of other labels
/// @param outline  closely spaced points of the outline
std::optional<LabelPlace> place_label(const std::vector<PlanePoint>& line, double length,
                                      const std::vector<PlanePoint>& labels, const std::vector<PlanePoint>& outline);

}  // namespace pkm
