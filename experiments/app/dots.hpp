// A picture of dots, drawn by how much of each dot a shape covers, and its file. Debian's libraries that draw (cairo)
// would ask for X11 and for the fonts of a machine; what is drawn here is one filled area, lines and a few letters.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace pkm {

/// White to begin with. Places are in dots from the upper left corner.
class Dots {
 public:
  using Colour = std::array<double, 3>;  ///< red, green, blue, to 255
  using Loop = std::vector<std::array<double, 2>>;

  Dots(double width, double height);

  /// A line with round ends, or a round point, `half` to either side.
  void draw(double x1, double y1, double x2, double y2, double half, const Colour& colour);
  /// What lies within an odd number of closed loops.
  void fill(const std::vector<Loop>& loops, const Colour& colour, double opacity);

  /// The file, as PNG.
  std::string png() const;

 private:
  void blend(std::size_t x, std::size_t y, const Colour& colour, double share);

  std::size_t width_, height_;
  std::vector<std::uint8_t> values_;  ///< red, green, blue; row by row
};

}  // namespace pkm
