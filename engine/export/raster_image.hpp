// An RGB raster image with anti-aliased lines and filled polygons, and its PNG encoding. Pixels are blended by the
// fraction of their area that a shape covers. A drawing library such as cairo would add dependencies on X11 and
// installed fonts, while only a filled area, lines and short texts are drawn.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/export/colour_scale.hpp"

namespace pkm {

/// A raster image, initially white. Coordinates are in pixels, x to the right and y downwards from the upper left
/// corner.
class RasterImage {
 public:
  using Colour = pkm::Colour;
  using Polygon = std::vector<std::array<double, 2>>;

  /// Makes a white image. Both sizes are rounded to whole pixels.
  RasterImage(double width, double height);

  /// Draws a line of width 2 * `half_width` with round ends, or a disc if both ends coincide.
  void draw_line(double x1, double y1, double x2, double y2, double half_width, const Colour& colour);
  /// Fills closed polygons by the even-odd rule.
  /// @param opacity  from 0 (transparent) to 1
  void fill_polygons(const std::vector<Polygon>& polygons, const Colour& colour, double opacity);

  /// The image as the bytes of a PNG file.
  std::string png() const;

 private:
  /// Mixes a colour into one pixel.
  /// @param share  weight of the colour, from 0 to 1
  void blend(std::size_t x, std::size_t y, const Colour& colour, double share);

  std::size_t width_, height_;
  std::vector<std::uint8_t> values_;  ///< red, green and blue of each pixel, row by row
};

}  // namespace pkm
