// Vector drawing of planar workspace slices and curves, from which the SVG and the PNG file are rendered.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/export/colour_scale.hpp"
#include "engine/export/slice_outline.hpp"

namespace pkm {

/// A vector drawing. Coordinates are pixels from the upper left corner, y downwards. Drawing order: grid, areas, lines,
/// outline, texts, frames.
struct Picture {
  enum class Anchor { begin, middle, end };
  struct Text {
    double x, y;  ///< position of the anchor of the text, on its baseline [pixel]
    std::string content;
    Anchor anchor = Anchor::begin;
    bool bold = false;
    double angle = 0;           ///< angle of the baseline, counter-clockwise [deg]
    Colour colour = {0, 0, 0};  ///< colour of the letters
    /// Colour of a border around the letters; std::nullopt: no border.
    std::optional<Colour> background = std::nullopt;
  };
  struct Line {
    double x1, y1, x2, y2;
  };
  struct Area {
    std::vector<SliceOutline::Loop> loops;  ///< closed polygons, which are filled by the even-odd rule
    Colour colour;
    double opacity = 1;  ///< opacity of the fill, from 0 (transparent) to 1
  };
  struct Polyline {
    std::vector<PlanePoint> points;
    Colour colour;
    double width = 1;  ///< width of the line [pixel]
  };

  double width = 0, height = 0;
  std::vector<Text> texts;
  std::vector<Line> grid;
  std::vector<Area> areas;
  std::vector<Polyline> lines;
  std::vector<SliceOutline::Loop> outline;  ///< closed polygons of the outline of the slice
  bool outline_is_filled = true;            ///< true: the outline is filled in one colour, by the even-odd rule
  /// Frames of plots: position of the left and upper edge, width and height [pixel].
  std::vector<std::array<double, 4>> frames = {};
};

/// Draws a slice with axes labelled in mm or degrees.
/// @param lines  text above the drawing, the title first
Picture draw_slice(const SliceOutline& outline, const std::vector<std::string>& lines);

/// Draws a field on a slice as filled contours, with labelled contour lines and a colour bar. Labels are in degrees for
/// angles, and in mm or, if all lengths are below 1 mm, in um for lengths. Areas in which the field is undefined are
/// grey.
/// @param field  field with one value for each vertex of the mesh
/// @param lines  text above the drawing, the title first; meaning and range of the field are appended
Picture draw_map(const SliceMesh& mesh, const WorkspaceField& field, std::vector<std::string> lines);

/// Text of an SVG file of the picture.
std::string svg_file(const Picture& picture);

/// Bytes of a PNG file of the picture. For printing, the file has twice the width and height of the picture in pixels.
std::string png_file(const Picture& picture);

}  // namespace pkm
