#include <cmath>
#include <numbers>

#include "engine/export/picture.hpp"
#include "engine/export/raster_image.hpp"
#include "engine/export/stroke_font.hpp"

namespace pkm {
namespace {

constexpr double kDots = 2;         // dots of the PNG file per pixel of the picture, horizontally and vertically
constexpr double kFontScale = 1.5;  // number of pixels per unit of the stroke font
constexpr double kHalfWidth = 0.5, kHalfBold = 0.85;  // half the width of normal lines, and of bold lines [pixel]
constexpr double kHalfBorder = 2.0;                   // half the width of the border of letters that have one [pixel]

constexpr RasterImage::Colour kGrid = {0xdd, 0xdd, 0xdd}, kFill = {0x4a, 0x7f, 0xb5}, kOutline = {0x1f, 0x4e, 0x79},
                              kFrame = {0x22, 0x22, 0x22};

void draw_text(const Picture::Text& text, RasterImage& image) {
  const TextStrokes letters = text_strokes(text.content);
  const double length = kFontScale * letters.width;
  const double offset = text.anchor == Picture::Anchor::begin ? 0
                        : text.anchor == Picture::Anchor::end ? length
                                                              : length / 2;
  const double turn = text.angle * std::numbers::pi / 180, right = std::cos(turn), up = std::sin(turn);
  const auto to_dots = [&](double x, double y) -> std::array<double, 2> {
    const double along = kFontScale * x - offset, below = kFontScale * y;
    return {kDots * (text.x + right * along + up * below), kDots * (text.y - up * along + right * below)};
  };
  const auto draw = [&](double half_width, const RasterImage::Colour& colour) {
    for (const auto& [x1, y1, x2, y2] : letters.strokes) {
      const auto a = to_dots(x1, y1), b = to_dots(x2, y2);
      image.draw_line(a[0], a[1], b[0], b[1], kDots * half_width, colour);
    }
  };
  if (text.background) draw(kHalfBorder, *text.background);
  draw(text.bold ? kHalfBold : kHalfWidth, text.colour);
}

std::vector<SliceOutline::Loop> in_dots(std::vector<SliceOutline::Loop> loops) {
  for (SliceOutline::Loop& loop : loops)
    for (auto& point : loop) point = {kDots * point[0], kDots * point[1]};
  return loops;
}

}  // namespace

std::string png_file(const Picture& picture) {
  RasterImage image(kDots * picture.width, kDots * picture.height);
  const auto line = [&image](double x1, double y1, double x2, double y2, const RasterImage::Colour& colour,
                             double width = 1) {
    image.draw_line(kDots * x1, kDots * y1, kDots * x2, kDots * y2, kDots * kHalfWidth * width, colour);
  };
  for (const auto& [x1, y1, x2, y2] : picture.grid) line(x1, y1, x2, y2, kGrid);
  for (const Picture::Area& area : picture.areas) image.fill_polygons(in_dots(area.loops), area.colour, area.opacity);
  for (const Picture::Polyline& polyline : picture.lines)
    for (std::size_t k = 0; k + 1 < polyline.points.size(); ++k) {
      const auto &a = polyline.points[k], &b = polyline.points[k + 1];
      line(a[0], a[1], b[0], b[1], polyline.colour, polyline.width);
    }
  constexpr double kOpacity = 0.45;
  if (picture.outline_is_filled) image.fill_polygons(in_dots(picture.outline), kFill, kOpacity);
  for (const SliceOutline::Loop& loop : picture.outline)
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const auto &a = loop[k], &b = loop[(k + 1) % loop.size()];
      line(a[0], a[1], b[0], b[1], kOutline);
    }
  for (const Picture::Text& text : picture.texts) draw_text(text, image);
  for (const auto& [left, top, width, height] : picture.frames) {
    line(left, top, left + width, top, kFrame);
    line(left, top + height, left + width, top + height, kFrame);
    line(left, top, left, top + height, kFrame);
    line(left + width, top, left + width, top + height, kFrame);
  }
  return image.png();
}

}  // namespace pkm
