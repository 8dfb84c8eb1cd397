#include "engine/export/picture.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/core/formatted.hpp"

namespace pkm {
namespace {

/// Maps a coordinate of the slice to pixels; labelled in mm or degrees.
struct PlotAxis {
  std::string title;
  double unit = 1;               ///< SI value of the unit of the labels
  double lower = 0, upper = 0;   ///< range [SI]
  double pixel = 0, length = 0;  ///< position of `lower`, and signed length up to `upper`, in pixels

  double to_pixels(double value) const { return pixel + length * (value - lower) / (upper - lower); }
  /// Four to ten round numbers within the range, in the unit of the labels.
  std::vector<double> ticks() const {
    const double span = (upper - lower) / unit, power = std::pow(10, std::floor(std::log10(span / 5)));
    const double step = power * (span / power >= 20 ? 5 : span / power >= 8 ? 2 : 1);
    std::vector<double> values;
    for (double k = std::ceil(lower / unit / step); k * step <= upper / unit; ++k) values.push_back(k * step + 0.0);
    return values;
  }
};

/// The range is the extent of the outline plus a margin of 10 %; the whole axis if nothing is feasible.
PlotAxis plot_axis(const SliceOutline& outline, std::size_t i) {
  const WorkspaceAxis& axis = outline.axes[i];
  const bool angle = axis.unit == "rad";
  double min = axis.upper, max = axis.lower;
  for (const SliceOutline::Loop& loop : outline.loops)
    for (const auto& point : loop) {
      min = std::min(min, point[i]);
      max = std::max(max, point[i]);
    }
  const double margin = 0.1 * (max - min);
  PlotAxis plot{axis.name + (angle ? " [deg]" : " [mm]"), angle ? std::numbers::pi / 180 : 1e-3, axis.lower,
                axis.upper};
  if (margin > 0) plot.lower = min - margin, plot.upper = max + margin;
  return plot;
}

}  // namespace

Picture draw_slice(const SliceOutline& outline, const std::vector<std::string>& lines) {
  using Anchor = Picture::Anchor;
  constexpr double kLeft = 90, kRight = 30, kBelow = 64, kLine = 20, kMaxLength = 560, kMinLength = 160;  // pixels
  const double above = 24 + kLine * static_cast<double>(lines.size());
  PlotAxis across = plot_axis(outline, 0), up = plot_axis(outline, 1);
  double width = kMaxLength, height = 0.75 * kMaxLength;
  if (outline.axes[0].unit == outline.axes[1].unit) {  // same scale on both axes, unless the drawing becomes too thin
    const double wide = across.upper - across.lower, high = up.upper - up.lower, longer = std::max(wide, high);
    width = std::max(kMaxLength * wide / longer, kMinLength);
    height = std::max(kMaxLength * high / longer, kMinLength);
  }
  across.pixel = kLeft, across.length = width;
  up.pixel = above + height, up.length = -height;

  Picture picture{.width = kLeft + width + kRight, .height = above + height + kBelow};
  for (std::size_t k = 0; k < lines.size(); ++k)
    picture.texts.push_back({kLeft, 24 + kLine * static_cast<double>(k), lines[k], Anchor::begin, k == 0});
  for (const double tick : across.ticks()) {
    const double x = across.to_pixels(tick * across.unit);
    picture.grid.push_back({x, up.pixel, x, above});
    picture.texts.push_back({x, up.pixel + 18, formatted("%.6g", tick), Anchor::middle});
  }
  for (const double tick : up.ticks()) {
    const double y = up.to_pixels(tick * up.unit);
    picture.grid.push_back({kLeft, y, kLeft + width, y});
    picture.texts.push_back({kLeft - 8, y + 4, formatted("%.6g", tick), Anchor::end});
  }
  for (const SliceOutline::Loop& loop : outline.loops) {
    SliceOutline::Loop& drawn = picture.outline.emplace_back();
    for (const auto& point : loop) drawn.push_back({across.to_pixels(point[0]), up.to_pixels(point[1])});
  }
  picture.frame = {kLeft, above, width, height};
  picture.texts.push_back({kLeft + width / 2, up.pixel + 44, across.title, Anchor::middle});
  picture.texts.push_back({24, above + height / 2, up.title, Anchor::middle, false, true});
  return picture;
}

}  // namespace pkm
