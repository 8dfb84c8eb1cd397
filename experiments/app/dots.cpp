#include "experiments/app/dots.hpp"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace pkm {
namespace {

constexpr int kLinesOfADot = 4;  // at which an area's width is taken

double centre(std::size_t dot) { return static_cast<double>(dot) + 0.5; }

/// Dots from one place to another, of `all`: the first, and that behind the last.
std::pair<std::size_t, std::size_t> dots(double from, double to, std::size_t all) {
  const double most = static_cast<double>(all);
  return {static_cast<std::size_t>(std::clamp(from, 0.0, most)), static_cast<std::size_t>(std::clamp(to, 0.0, most))};
}

/// Where loops cross a line across, from the left.
void cross(const std::vector<Dots::Loop>& loops, double y, std::vector<double>& crossings) {
  crossings.clear();
  for (const Dots::Loop& loop : loops)
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const auto &a = loop[k], &b = loop[(k + 1) % loop.size()];
      if ((a[1] <= y) != (b[1] <= y)) crossings.push_back(a[0] + (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]));
    }
  std::ranges::sort(crossings);
}

/// Adds the share of each dot that lies between two places.
void cover(double from, double to, std::vector<double>& covered) {
  const auto [first, end] = dots(std::floor(from), std::ceil(to), covered.size());
  for (std::size_t x = first; x < end; ++x) {
    const double left = static_cast<double>(x);
    covered[x] += std::max(0.0, std::min(to, left + 1) - std::max(from, left));
  }
}

std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(value >> shift & 0xffU);
  return bytes;
}

std::string chunk(const std::string& kind, const std::string& content) {
  const std::string checked = kind + content;
  const auto sum = crc32(0, reinterpret_cast<const Bytef*>(checked.data()), static_cast<uInt>(checked.size()));
  return big_endian(static_cast<std::uint32_t>(content.size())) + checked + big_endian(static_cast<std::uint32_t>(sum));
}

std::string packed(const std::string& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string text(size, '\0');
  if (compress(reinterpret_cast<Bytef*>(text.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
               bytes.size()) != Z_OK)
    throw std::runtime_error("a picture could not be compressed");
  text.resize(size);
  return text;
}

}  // namespace

Dots::Dots(double width, double height)
    : width_(static_cast<std::size_t>(std::lround(width))),
      height_(static_cast<std::size_t>(std::lround(height))),
      values_(3 * width_ * height_, 0xff) {}

void Dots::draw(double x1, double y1, double x2, double y2, double half, const Colour& colour) {
  const double reach = half + 1, along_x = x2 - x1, along_y = y2 - y1, square = along_x * along_x + along_y * along_y;
  const auto [left, right] = dots(std::min(x1, x2) - reach, std::max(x1, x2) + reach, width_);
  const auto [top, bottom] = dots(std::min(y1, y2) - reach, std::max(y1, y2) + reach, height_);
  for (std::size_t y = top; y < bottom; ++y)
    for (std::size_t x = left; x < right; ++x) {
      const double from_x = centre(x) - x1, from_y = centre(y) - y1;
      const double share = square > 0 ? std::clamp((from_x * along_x + from_y * along_y) / square, 0.0, 1.0) : 0;
      const double distance = std::hypot(from_x - share * along_x, from_y - share * along_y);
      blend(x, y, colour, std::clamp(half + 0.5 - distance, 0.0, 1.0));
    }
}

void Dots::fill(const std::vector<Loop>& loops, const Colour& colour, double opacity) {
  std::vector<double> covered(width_), crossings;
  for (std::size_t y = 0; y < height_; ++y) {
    std::ranges::fill(covered, 0.0);
    for (int line = 0; line < kLinesOfADot; ++line) {
      cross(loops, static_cast<double>(y) + (line + 0.5) / kLinesOfADot, crossings);
      for (std::size_t k = 0; k + 1 < crossings.size(); k += 2) cover(crossings[k], crossings[k + 1], covered);
    }
    for (std::size_t x = 0; x < width_; ++x)
      if (covered[x] > 0) blend(x, y, colour, opacity * covered[x] / kLinesOfADot);
  }
}

void Dots::blend(std::size_t x, std::size_t y, const Colour& colour, double share) {
  for (std::size_t c = 0; c < 3; ++c) {
    std::uint8_t& value = values_[3 * (y * width_ + x) + c];
    value = static_cast<std::uint8_t>(std::lround(value + share * (colour[c] - value)));
  }
}

std::string Dots::png() const {
  std::string rows;
  for (std::size_t y = 0; y < height_; ++y) {
    rows += '\0';  // the row's dots are as they are, not as differences
    rows.append(reinterpret_cast<const char*>(&values_[3 * width_ * y]), 3 * width_);
  }
  const std::string form = {8, 2, 0, 0, 0};  // bits of a colour, three of them
  return "\x89PNG\r\n\x1a\n" +
         chunk("IHDR", big_endian(static_cast<std::uint32_t>(width_)) +
                           big_endian(static_cast<std::uint32_t>(height_)) + form) +
         chunk("IDAT", packed(rows)) + chunk("IEND", "");
}

}  // namespace pkm
