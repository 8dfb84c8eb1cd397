#include "engine/export/picture.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/core/formatted.hpp"
#include "engine/export/plot_frame.hpp"
#include "engine/export/stroke_font.hpp"

namespace pkm {
namespace {

/// Axis i of the plot. Its range is the extent of the outline plus a margin of 10 % or, if nothing is feasible, the
/// whole range of the workspace axis.
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

/// Divides a text at blanks into lines that are at most `width` pixels wide.
std::vector<std::string> wrapped(const std::string& text, double width) {
  // Number of pixels per unit of the stroke font, with which an average letter is as wide as in a font of 13 pixels.
  constexpr double kUnit = 1.35;
  std::vector<std::string> lines = {""};
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, end - at),
                      longer = lines.back() + (lines.back().empty() ? "" : " ") + word;
    if (lines.back().empty() || kUnit * text_strokes(longer).width <= width)
      lines.back() = longer;
    else
      lines.push_back(word);
    at = end + 1;
  }
  return lines;
}

}  // namespace

std::vector<double> PlotAxis::ticks() const {
  const double span = (upper - lower) / unit, power = std::pow(10, std::floor(std::log10(span / 5)));
  const double step = power * (span / power >= 20 ? 5 : span / power >= 8 ? 2 : 1);
  std::vector<double> values;
  for (double k = std::ceil(lower / unit / step); k * step <= upper / unit; ++k) values.push_back(k * step + 0.0);
  return values;
}

std::vector<PlanePoint> PlotFrame::to_pixels(const std::vector<PlanePoint>& points) const {
  std::vector<PlanePoint> drawn;
  for (const PlanePoint& point : points) drawn.push_back({across.to_pixels(point[0]), up.to_pixels(point[1])});
  return drawn;
}

std::vector<SliceOutline::Loop> PlotFrame::to_pixels(const std::vector<SliceOutline::Loop>& loops) const {
  std::vector<SliceOutline::Loop> drawn;
  for (const SliceOutline::Loop& loop : loops) drawn.push_back(to_pixels(loop));
  return drawn;
}

void draw_axes(const PlotAxis& across, const PlotAxis& up, Picture& picture) {
  using Anchor = Picture::Anchor;
  constexpr double kMinAcross = 48, kMinUp = 20;  // minimum distance of labels [pixel]
  const double left = across.pixel, right = left + across.length, bottom = up.pixel, top = bottom + up.length;
  const auto is_labelled = [](const PlotAxis& axis, const std::vector<double>& ticks, std::size_t k, double distance) {
    if (ticks.size() < 2) return true;
    const double spacing = std::fabs(axis.to_pixels(ticks[1] * axis.unit) - axis.to_pixels(ticks[0] * axis.unit));
    const double number = std::round(ticks[k] / (ticks[1] - ticks[0]));
    return std::fmod(number, std::ceil(distance / spacing)) == 0;
  };
  const std::vector<double> across_ticks = across.ticks(), up_ticks = up.ticks();
  for (std::size_t k = 0; k < across_ticks.size(); ++k) {
    const double x = across.to_pixels(across_ticks[k] * across.unit);
    picture.grid.push_back({x, bottom, x, top});
    if (is_labelled(across, across_ticks, k, kMinAcross))
      picture.texts.push_back({x, bottom + 18, formatted("%.6g", across_ticks[k]), Anchor::middle});
  }
  for (std::size_t k = 0; k < up_ticks.size(); ++k) {
    const double y = up.to_pixels(up_ticks[k] * up.unit);
    picture.grid.push_back({left, y, right, y});
    if (is_labelled(up, up_ticks, k, kMinUp))
      picture.texts.push_back({left - 8, y + 4, formatted("%.6g", up_ticks[k]), Anchor::end});
  }
  picture.frames.push_back({left, top, across.length, -up.length});
  picture.texts.push_back({(left + right) / 2, bottom + 44, across.title, Anchor::middle});
  picture.texts.push_back({left - 66, (top + bottom) / 2, up.title, Anchor::middle, false, 90});
}

PlotFrame plot_frame(const SliceOutline& outline, const std::vector<std::string>& lines, double right) {
  using Anchor = Picture::Anchor;
  // Space to the left of the frame and below it, height of a text line, and limits of the frame and the text width
  // [pixel].
  constexpr double kLeft = 90, kBelow = 64, kLine = 20, kMaxLength = 560, kMinLength = 160, kMinText = 460;
  PlotAxis across = plot_axis(outline, 0), up = plot_axis(outline, 1);
  double width = kMaxLength, height = 0.75 * kMaxLength;
  // Both axes have the same scale, unless the drawing would become too thin.
  if (outline.axes[0].unit == outline.axes[1].unit) {
    const double wide = across.upper - across.lower, high = up.upper - up.lower, longer = std::max(wide, high);
    width = std::max(kMaxLength * wide / longer, kMinLength);
    height = std::max(kMaxLength * high / longer, kMinLength);
  }
  const double text_width = std::max(width + right - 16, kMinText);
  std::vector<Picture::Text> head;
  for (const std::string& text : lines)
    for (const std::string& line : wrapped(text, text_width))
      head.push_back(
          {kLeft, 24 + kLine * static_cast<double>(head.size()), line, Anchor::begin, &text == &lines.front()});
  const double above = 24 + kLine * static_cast<double>(head.size());
  across.pixel = kLeft, across.length = width;
  up.pixel = above + height, up.length = -height;

  Picture picture{.width = kLeft + std::max(width + right, kMinText + 16), .height = above + height + kBelow};
  picture.texts = std::move(head);
  draw_axes(across, up, picture);
  return {std::move(picture), across, up};
}

Picture draw_slice(const SliceOutline& outline, const std::vector<std::string>& lines) {
  constexpr double kRight = 30;  // space to the right of the frame [pixel]
  PlotFrame plot = plot_frame(outline, lines, kRight);
  plot.picture.outline = plot.to_pixels(outline.loops);
  return plot.picture;
}

}  // namespace pkm
