// Letters as strokes, for pictures of dots: a few straight lines each, so that they may have any size and way.
#pragma once

#include <array>
#include <string_view>
#include <vector>

namespace pkm {

/// A line of text from (0, 0) to the right, y downwards, in units of which capitals are six high.
struct LetterStrokes {
  std::vector<std::array<double, 4>> strokes;  ///< x1, y1, x2, y2; a point where both ends are the same
  double width = 0;
};

/// Characters other than those of ASCII are drawn as question marks.
LetterStrokes strokes_of(std::string_view text);

}  // namespace pkm
