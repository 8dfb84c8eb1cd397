#include "engine/export/picture.hpp"
#include "engine/export/raster_image.hpp"
#include "engine/export/stroke_font.hpp"

namespace pkm {
namespace {

constexpr double kDots = 2;                           // per pixel
constexpr double kFontScale = 1.5;                    // pixels per unit of the stroke font
constexpr double kHalfWidth = 0.5, kHalfBold = 0.85;  // half line widths, of normal and of bold lines [pixel]

constexpr RasterImage::Colour kGrid = {0xdd, 0xdd, 0xdd}, kFill = {0x4a, 0x7f, 0xb5}, kOutline = {0x1f, 0x4e, 0x79},
                              kFrame = {0x22, 0x22, 0x22}, kText = {0, 0, 0};

void draw_text(const Picture::Text& text, RasterImage& image) {
  const TextStrokes letters = text_strokes(text.content);
  const double length = kFontScale * letters.width;
  const double offset = text.anchor == Picture::Anchor::begin ? 0
                        : text.anchor == Picture::Anchor::end ? length
                                                              : length / 2;
  const auto to_pixels = [&](double x, double y) -> std::array<double, 2> {
    const double along = kFontScale * x - offset, below = kFontScale * y;
    return text.vertical ? std::array{text.x + below, text.y - along} : std::array{text.x + along, text.y + below};
  };
  for (const auto& [x1, y1, x2, y2] : letters.strokes) {
    const auto a = to_pixels(x1, y1), b = to_pixels(x2, y2);
    image.draw_line(kDots * a[0], kDots * a[1], kDots * b[0], kDots * b[1],
                    kDots * (text.bold ? kHalfBold : kHalfWidth), kText);
  }
}

}  // namespace

std::string png_file(const Picture& picture) {
  RasterImage image(kDots * picture.width, kDots * picture.height);
  const auto line = [&image](double x1, double y1, double x2, double y2, const RasterImage::Colour& colour) {
    image.draw_line(kDots * x1, kDots * y1, kDots * x2, kDots * y2, kDots * kHalfWidth, colour);
  };
  for (const auto& [x1, y1, x2, y2] : picture.grid) line(x1, y1, x2, y2, kGrid);
  for (const Picture::Text& text : picture.texts) draw_text(text, image);
  std::vector<SliceOutline::Loop> loops = picture.outline;
  for (SliceOutline::Loop& loop : loops)
    for (auto& point : loop) point = {kDots * point[0], kDots * point[1]};
  constexpr double kOpacity = 0.45;
  image.fill_polygons(loops, kFill, kOpacity);
  for (const SliceOutline::Loop& loop : picture.outline)
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const auto &a = loop[k], &b = loop[(k + 1) % loop.size()];
      line(a[0], a[1], b[0], b[1], kOutline);
    }
  const auto [left, top, width, height] = picture.frame;
  line(left, top, left + width, top, kFrame);
  line(left, top + height, left + width, top + height, kFrame);
  line(left, top, left, top + height, kFrame);
  line(left + width, top, left + width, top + height, kFrame);
  return image.png();
}

}  // namespace pkm
