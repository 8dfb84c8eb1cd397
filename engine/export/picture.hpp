// Vector drawing of a planar workspace slice, from which the SVG and the PNG file are rendered.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "engine/export/slice_outline.hpp"

namespace pkm {

/// Coordinates are pixels from the upper left corner. Drawing order: grid and texts, outline, frame.
struct Picture {
  enum class Anchor { begin, middle, end };
  struct Text {
    double x, y;  ///< position of the anchor, on the baseline
    std::string content;
    Anchor anchor = Anchor::begin;
    bool bold = false, vertical = false;  ///< vertical: reads from bottom to top
  };
  struct Line {
    double x1, y1, x2, y2;
  };

  double width = 0, height = 0;
  std::vector<Text> texts;
  std::vector<Line> grid;
  std::vector<SliceOutline::Loop> outline;  ///< closed, filled by the even-odd rule
  std::array<double, 4> frame{};            ///< left, top, width, height
};

/// Draws a slice with axes labelled in mm or degrees.
/// @param lines  text above the drawing, the title first
Picture draw_slice(const SliceOutline& outline, const std::vector<std::string>& lines);

/// Contents of an SVG file.
std::string svg_file(const Picture& picture);

/// Contents of a PNG file, with two dots per pixel in both directions for printing.
std::string png_file(const Picture& picture);

}  // namespace pkm
