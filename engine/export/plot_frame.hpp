// The frame of a picture: axes with ticks and titles, grid lines, and the text above.
#pragma once

#include "engine/export/picture.hpp"

namespace pkm {

/// Maps a coordinate of the slice to pixels; labelled in mm or degrees.
struct PlotAxis {
  std::string title;
  double unit = 1;               ///< SI value of the unit of the labels
  double lower = 0, upper = 0;   ///< range [SI]
  double pixel = 0, length = 0;  ///< position of `lower`, and signed distance from it to `upper` [pixel]

  double to_pixels(double value) const { return pixel + length * (value - lower) / (upper - lower); }
  /// Four to ten round numbers within the range, in the unit of the labels.
  std::vector<double> ticks() const;
};

struct PlotFrame {
  Picture picture;  ///< without areas, lines and outline
  PlotAxis across, up;

  std::vector<PlanePoint> to_pixels(const std::vector<PlanePoint>& points) const;
  std::vector<SliceOutline::Loop> to_pixels(const std::vector<SliceOutline::Loop>& loops) const;
};

/// @param lines  text above, the title first; long lines are wrapped
/// @param right  width of the space to the right of the frame [pixel]
PlotFrame plot_frame(const SliceOutline& outline, const std::vector<std::string>& lines, double right);

}  // namespace pkm
