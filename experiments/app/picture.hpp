// The picture of a section, once as data: what SVG and PNG draw.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "experiments/app/section.hpp"

namespace pkm {

/// Places are in pixels from the upper left corner. What is filled is drawn over the lines, the frame over both.
struct Picture {
  enum class Anchor { begin, middle, end };
  struct Text {
    double x, y;  ///< of the anchor, on the line that letters stand on
    std::string words;
    Anchor anchor = Anchor::begin;
    bool bold = false, upwards = false;
  };
  struct Line {
    double x1, y1, x2, y2;
  };

  double width = 0, height = 0;
  std::vector<Text> texts;
  std::vector<Line> grid;
  std::vector<Section::Loop> section;  ///< closed; what lies within an odd number of them is filled
  std::array<double, 4> frame{};       ///< left, top, width, height
};

/// Lengths in mm and angles in degrees.
/// @param lines  that stand above it, the title first
Picture picture_of(const Section& section, const std::vector<std::string>& lines);

std::string svg_file(const Picture& picture);

/// Two dots a pixel each way, so that it may be printed.
std::string png_file(const Picture& picture);

}  // namespace pkm
