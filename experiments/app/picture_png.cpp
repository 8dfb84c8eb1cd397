#include "experiments/app/dots.hpp"
#include "experiments/app/letters.hpp"
#include "experiments/app/picture.hpp"

namespace pkm {
namespace {

constexpr double kDots = 2;                  // a pixel
constexpr double kLetter = 1.5;              // pixels of a letter's unit
constexpr double kThin = 0.5, kBold = 0.85;  // half the width of lines [pixel]

constexpr Dots::Colour kGrid = {0xdd, 0xdd, 0xdd}, kFill = {0x4a, 0x7f, 0xb5}, kOutline = {0x1f, 0x4e, 0x79},
                       kFrame = {0x22, 0x22, 0x22}, kText = {0, 0, 0};

void write(const Picture::Text& text, Dots& dots) {
  const LetterStrokes letters = strokes_of(text.words);
  const double length = kLetter * letters.width;
  const double before = text.anchor == Picture::Anchor::begin ? 0
                        : text.anchor == Picture::Anchor::end ? length
                                                              : length / 2;
  const auto place = [&](double x, double y) -> std::array<double, 2> {
    const double along = kLetter * x - before, below = kLetter * y;
    return text.upwards ? std::array{text.x + below, text.y - along} : std::array{text.x + along, text.y + below};
  };
  for (const auto& [x1, y1, x2, y2] : letters.strokes) {
    const auto a = place(x1, y1), b = place(x2, y2);
    dots.draw(kDots * a[0], kDots * a[1], kDots * b[0], kDots * b[1], kDots * (text.bold ? kBold : kThin), kText);
  }
}

}  // namespace

std::string png_file(const Picture& picture) {
  Dots dots(kDots * picture.width, kDots * picture.height);
  const auto line = [&dots](double x1, double y1, double x2, double y2, const Dots::Colour& colour) {
    dots.draw(kDots * x1, kDots * y1, kDots * x2, kDots * y2, kDots * kThin, colour);
  };
  for (const auto& [x1, y1, x2, y2] : picture.grid) line(x1, y1, x2, y2, kGrid);
  for (const Picture::Text& text : picture.texts) write(text, dots);
  std::vector<Section::Loop> loops = picture.section;
  for (Section::Loop& loop : loops)
    for (auto& point : loop) point = {kDots * point[0], kDots * point[1]};
  constexpr double kOpacity = 0.45;
  dots.fill(loops, kFill, kOpacity);
  for (const Section::Loop& loop : picture.section)
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const auto &a = loop[k], &b = loop[(k + 1) % loop.size()];
      line(a[0], a[1], b[0], b[1], kOutline);
    }
  const auto [left, top, width, height] = picture.frame;
  line(left, top, left + width, top, kFrame);
  line(left, top + height, left + width, top + height, kFrame);
  line(left, top, left, top + height, kFrame);
  line(left + width, top, left + width, top + height, kFrame);
  return dots.png();
}

}  // namespace pkm
