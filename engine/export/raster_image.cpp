#include "engine/export/raster_image.hpp"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace pkm {
namespace {

constexpr int kScanLinesPerPixel = 4;  // number of scan lines per pixel row, over which coverage is averaged

double centre(std::size_t pixel) { return static_cast<double>(pixel) + 0.5; }

/// The pixels between two coordinates, clipped to [0, size]: index of the first one, and index after the last one.
std::pair<std::size_t, std::size_t> pixel_range(double from, double to, std::size_t size) {
  const double end = static_cast<double>(size);
  return {static_cast<std::size_t>(std::clamp(from, 0.0, end)), static_cast<std::size_t>(std::clamp(to, 0.0, end))};
}

/// Finds the abscissas at which the polygons cross the horizontal line at y, in increasing order.
void find_crossings(const std::vector<RasterImage::Polygon>& polygons, double y, std::vector<double>& crossings) {
  crossings.clear();
  for (const RasterImage::Polygon& polygon : polygons)
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const auto &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
      if ((a[1] <= y) != (b[1] <= y)) crossings.push_back(a[0] + (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]));
    }
  std::ranges::sort(crossings);
}

/// Adds to each pixel of a row the fraction of its width that lies between two abscissas.
void add_coverage(double from, double to, std::vector<double>& covered) {
  const auto [first, end] = pixel_range(std::floor(from), std::ceil(to), covered.size());
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

/// A chunk of a PNG file: length, type, content and checksum.
std::string chunk(const std::string& kind, const std::string& content) {
  const std::string checked = kind + content;
  const auto sum = crc32(0, reinterpret_cast<const Bytef*>(checked.data()), static_cast<uInt>(checked.size()));
  return big_endian(static_cast<std::uint32_t>(content.size())) + checked + big_endian(static_cast<std::uint32_t>(sum));
}

std::string deflated(const std::string& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string text(size, '\0');
  if (compress(reinterpret_cast<Bytef*>(text.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
               bytes.size()) != Z_OK)
    throw std::runtime_error("the picture cannot be compressed");
  text.resize(size);
  return text;
}

}  // namespace

RasterImage::RasterImage(double width, double height)
    : width_(static_cast<std::size_t>(std::lround(width))),
      height_(static_cast<std::size_t>(std::lround(height))),
      values_(3 * width_ * height_, 0xff) {}

void RasterImage::draw_line(double x1, double y1, double x2, double y2, double half_width, const Colour& colour) {
  const double reach = half_width + 1, along_x = x2 - x1, along_y = y2 - y1,
               square = along_x * along_x + along_y * along_y;
  const auto [left, right] = pixel_range(std::min(x1, x2) - reach, std::max(x1, x2) + reach, width_);
  const auto [top, bottom] = pixel_range(std::min(y1, y2) - reach, std::max(y1, y2) + reach, height_);
  for (std::size_t y = top; y < bottom; ++y)
    for (std::size_t x = left; x < right; ++x) {
      const double from_x = centre(x) - x1, from_y = centre(y) - y1;
      const double share = square > 0 ? std::clamp((from_x * along_x + from_y * along_y) / square, 0.0, 1.0) : 0;
      const double distance = std::hypot(from_x - share * along_x, from_y - share * along_y);
      blend(x, y, colour, std::clamp(half_width + 0.5 - distance, 0.0, 1.0));
    }
}

void RasterImage::fill_polygons(const std::vector<Polygon>& polygons, const Colour& colour, double opacity) {
  std::vector<double> covered(width_), crossings;
  for (std::size_t y = 0; y < height_; ++y) {
    std::ranges::fill(covered, 0.0);
    for (int line = 0; line < kScanLinesPerPixel; ++line) {
      find_crossings(polygons, static_cast<double>(y) + (line + 0.5) / kScanLinesPerPixel, crossings);
      for (std::size_t k = 0; k + 1 < crossings.size(); k += 2) add_coverage(crossings[k], crossings[k + 1], covered);
    }
    for (std::size_t x = 0; x < width_; ++x)
      if (covered[x] > 0) blend(x, y, colour, opacity * covered[x] / kScanLinesPerPixel);
  }
}

void RasterImage::blend(std::size_t x, std::size_t y, const Colour& colour, double share) {
  for (std::size_t c = 0; c < 3; ++c) {
    std::uint8_t& value = values_[3 * (y * width_ + x) + c];
    value = static_cast<std::uint8_t>(std::lround(value + share * (colour[c] - value)));
  }
}

std::string RasterImage::png() const {
  std::string rows;
  for (std::size_t y = 0; y < height_; ++y) {
    rows += '\0';  // filter type of the row: 0, i.e. no filter
    rows.append(reinterpret_cast<const char*>(&values_[3 * width_ * y]), 3 * width_);
  }
  const std::string format = {8, 2, 0, 0, 0};  // format of the pixels: 8 bits per sample, RGB
  return "\x89PNG\r\n\x1a\n" +
         chunk("IHDR", big_endian(static_cast<std::uint32_t>(width_)) +
                           big_endian(static_cast<std::uint32_t>(height_)) + format) +
         chunk("IDAT", deflated(rows)) + chunk("IEND", "");
}

}  // namespace pkm
