// Boxes, cylinders and spheres with axes parallel to the coordinates (rectangles and circles in the plane), as
// Cartesian products of balls: a box is a product of intervals, a cylinder one of a disc and an interval.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace pkm {

enum class SolidKind { box, cylinder, sphere };

/// A point of the unit solid (the product of unit balls), by coordinate axis, each component in [-1, 1].
using UnitPoint = std::array<double, 3>;

/// Sample points of the unit solid, in the interior and on the boundary (vertices and rims included), and for each
/// point the indices of its neighbours.
struct SolidSamples {
  std::vector<UnitPoint> points;
  std::vector<std::vector<std::size_t>> neighbours;
};

/// A kind of solid over two or three axes.
class SolidShape {
 public:
  /// @param axes           number of axes, 2 or 3; a cylinder needs 3
  /// @param cylinder_axis  axis along which a cylinder extends
  SolidShape(SolidKind kind, std::size_t axes, std::size_t cylinder_axis = 2);

  std::size_t axes() const { return ball_of_axis_.size(); }
  /// Number of balls of which the solid is the product. Each has one dimension: the edges of a box by axis, diameter
  /// and height of a cylinder, or the diameter of a sphere.
  std::size_t balls() const { return axes_of_ball_.size(); }
  std::size_t ball_of(std::size_t axis) const { return ball_of_axis_[axis]; }
  const std::vector<std::size_t>& axes_of(std::size_t ball) const { return axes_of_ball_[ball]; }
  /// Names of the dimensions: "x", "y" and "z" for a box over these axes, otherwise "diameter" and "height".
  std::vector<std::string> dimension_names(const std::vector<std::string>& axis_names) const;
  /// "box", "rectangle", "cylinder", "sphere" or "circle".
  std::string name() const;
  /// Volume [product of the units of the axes]; the area if there are two axes. @param dimensions  one per ball
  double volume(const std::vector<double>& dimensions) const;

  /// @param density  number of sample intervals along a radius
  SolidSamples samples(int density) const;

 private:
  SolidKind kind_;
  std::vector<std::size_t> ball_of_axis_;
  std::vector<std::vector<std::size_t>> axes_of_ball_;
};

/// A solid with a given position and size.
struct Solid {
  std::array<double, 3> centre{};  ///< coordinates of the centre, by axis
  std::vector<double> dimensions;  ///< edge length or diameter of each ball

  /// The point of this solid that corresponds to a point of the unit solid.
  std::array<double, 3> at(const SolidShape& shape, const UnitPoint& unit) const {
    std::array<double, 3> point = centre;
    for (std::size_t i = 0; i < shape.axes(); ++i) point[i] += dimensions[shape.ball_of(i)] / 2 * unit[i];
    return point;
  }
};

}  // namespace pkm
