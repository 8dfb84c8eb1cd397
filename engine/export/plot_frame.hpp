// The frame of a picture: axes with ticks and titles, grid lines, and the text above.
#pragma once

#include "engine/export/picture.hpp"

namespace pkm {

/// An axis of a plot, which maps a quantity to pixels.
struct PlotAxis {
  std::string title;
  double unit = 1;              ///< SI value of the unit in which the axis is labelled
  double lower = 0, upper = 0;  ///< range of the quantity, in SI
  /// Pixel position of `lower`, and signed distance from there to the position of `upper` [pixel].
  double pixel = 0, length = 0;

  double to_pixels(double value) const { return pixel + length * (value - lower) / (upper - lower); }
  /// Values at which the axis is labelled: four to ten round numbers within the range, in the unit of the labels.
  std::vector<double> ticks() const;
};

/// Draws a frame with ticks, labels, grid lines and titles. Labels that would be too close to each other are omitted.
void draw_axes(const PlotAxis& across, const PlotAxis& up, Picture& picture);

struct PlotFrame {
  Picture picture;  ///< the drawing of the frame, without areas, lines and outline
  PlotAxis across, up;

  std::vector<PlanePoint> to_pixels(const std::vector<PlanePoint>& points) const;
  std::vector<SliceOutline::Loop> to_pixels(const std::vector<SliceOutline::Loop>& loops) const;
};

/// Draws the frame of a plot.
/// @param lines  text above the frame, the title first; long lines are wrapped
/// @param right  width of the space to the right of the frame [pixel]
PlotFrame plot_frame(const SliceOutline& outline, const std::vector<std::string>& lines, double right);

}  // namespace pkm
