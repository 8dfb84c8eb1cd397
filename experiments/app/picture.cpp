#include "experiments/app/picture.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/app/print.hpp"

namespace pkm {
namespace {

/// How an axis is drawn: in mm or degrees.
struct Scale {
  std::string title;
  double unit = 1;  ///< of what is written, in SI
  double lower = 0, upper = 0;
  double pixel = 0, length = 0;  ///< where it begins, and how long it is, < 0 upwards

  double at(double value) const { return pixel + length * (value - lower) / (upper - lower); }
  /// Four to ten round numbers between the ends, in the unit written.
  std::vector<double> ticks() const {
    const double span = (upper - lower) / unit, power = std::pow(10, std::floor(std::log10(span / 5)));
    const double step = power * (span / power >= 20 ? 5 : span / power >= 8 ? 2 : 1);
    std::vector<double> values;
    for (double k = std::ceil(lower / unit / step); k * step <= upper / unit; ++k) values.push_back(k * step + 0.0);
    return values;
  }
};

/// What is feasible and a tenth more; the whole axis where nothing is.
Scale scale_of(const Section& section, std::size_t i) {
  const WorkspaceAxis& axis = section.axes[i];
  const bool turns = axis.unit == "rad";
  double least = axis.upper, greatest = axis.lower;
  for (const Section::Loop& loop : section.loops)
    for (const auto& point : loop) {
      least = std::min(least, point[i]);
      greatest = std::max(greatest, point[i]);
    }
  const double more = 0.1 * (greatest - least);
  Scale scale{axis.name + (turns ? " [deg]" : " [mm]"), turns ? std::numbers::pi / 180 : 1e-3, axis.lower, axis.upper};
  if (more > 0) scale.lower = least - more, scale.upper = greatest + more;
  return scale;
}

}  // namespace

Picture picture_of(const Section& section, const std::vector<std::string>& lines) {
  using Anchor = Picture::Anchor;
  constexpr double kLeft = 90, kRight = 30, kBelow = 64, kLine = 20, kLongest = 560;
  const double above = 24 + kLine * static_cast<double>(lines.size());
  Scale across = scale_of(section, 0), up = scale_of(section, 1);
  double width = kLongest, height = 0.75 * kLongest;
  if (section.axes[0].unit == section.axes[1].unit) {  // undistorted, unless it is very thin
    const double wide = across.upper - across.lower, high = up.upper - up.lower, most = std::max(wide, high);
    width = std::max(kLongest * wide / most, 160.0);
    height = std::max(kLongest * high / most, 160.0);
  }
  across.pixel = kLeft, across.length = width;
  up.pixel = above + height, up.length = -height;

  Picture picture{.width = kLeft + width + kRight, .height = above + height + kBelow};
  for (std::size_t k = 0; k < lines.size(); ++k)
    picture.texts.push_back({kLeft, 24 + kLine * static_cast<double>(k), lines[k], Anchor::begin, k == 0});
  for (const double tick : across.ticks()) {
    const double x = across.at(tick * across.unit);
    picture.grid.push_back({x, up.pixel, x, above});
    picture.texts.push_back({x, up.pixel + 18, formatted("%.6g", tick), Anchor::middle});
  }
  for (const double tick : up.ticks()) {
    const double y = up.at(tick * up.unit);
    picture.grid.push_back({kLeft, y, kLeft + width, y});
    picture.texts.push_back({kLeft - 8, y + 4, formatted("%.6g", tick), Anchor::end});
  }
  for (const Section::Loop& loop : section.loops) {
    Section::Loop& drawn = picture.section.emplace_back();
    for (const auto& point : loop) drawn.push_back({across.at(point[0]), up.at(point[1])});
  }
  picture.frame = {kLeft, above, width, height};
  picture.texts.push_back({kLeft + width / 2, up.pixel + 44, across.title, Anchor::middle});
  picture.texts.push_back({24, above + height / 2, up.title, Anchor::middle, false, true});
  return picture;
}

}  // namespace pkm
