// A vector font of straight strokes for texts in raster images, which can be scaled and rotated.
#pragma once

#include <array>
#include <string_view>
#include <vector>

namespace pkm {

/// The strokes of a line of text. Its baseline begins at (0, 0) and runs along x; y points downwards. Capital letters
/// are 6 units high.
struct TextStrokes {
  std::vector<std::array<double, 4>> strokes;  ///< x1, y1, x2, y2 of each stroke; a dot if both ends coincide
  double width = 0;
};

/// Converts a text to strokes. Characters outside of ASCII become question marks.
TextStrokes text_strokes(std::string_view text);

}  // namespace pkm
