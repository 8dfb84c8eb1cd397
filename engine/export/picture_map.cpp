#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/core/formatted.hpp"
#include "engine/export/contour_labels.hpp"
#include "engine/export/csv_table.hpp"
#include "engine/export/field_map.hpp"
#include "engine/export/picture.hpp"
#include "engine/export/plot_frame.hpp"
#include "engine/export/simplify_line.hpp"
#include "engine/export/stroke_font.hpp"

namespace pkm {
namespace {

using Anchor = Picture::Anchor;

constexpr double kTolerance = 0.05;  // maximum deviation of simplified lines [pixel]
constexpr double kLetterUnit = 1.5;  // number of pixels per unit of the stroke font, for the widths of labels
constexpr double kRight = 150;       // width of the space for the colour bar [pixel]
// Colour bar: its distance from the frame, its width, and the height of the arrows at its ends [pixel].
constexpr double kBarGap = 24, kBarWidth = 18, kBarArrow = 14;
constexpr Colour kUndefined = {0xc8, 0xc8, 0xc8}, kBarFrame = {0x22, 0x22, 0x22};

/// Converts the values of a field to the unit of the labels: degrees, mm or um.
/// @return this unit; "1" for mixed units
std::string convert_to_display_unit(const std::string& unit, std::vector<double>& values) {
  double largest = 0, factor = 1;
  for (const double value : values)
    if (std::isfinite(value)) largest = std::max(largest, std::fabs(value));
  std::string name = unit == "mixed" ? "1" : unit;
  if (unit == "rad") name = "deg", factor = 180 / std::numbers::pi;
  if (unit == "m") name = largest < 1e-3 ? "um" : "mm", factor = largest < 1e-3 ? 1e6 : 1e3;
  for (double& value : values) value *= factor;
  return name;
}

/// The range of a field with four digits; an end that is a small fraction of the range is written as 0.
std::string range_text(const ContourLevels& levels, const std::string& unit) {
  const auto text = [&](double end) {
    const bool is_small = std::fabs(end) < 5e-5 * (levels.maximum - levels.minimum);
    return formatted("%.4g", is_small ? 0 : end) + (unit == "1" ? "" : " " + unit);
  };
  return "from " + text(levels.minimum) + " to " + text(levels.maximum);
}

SliceOutline::Loop rectangle(double left, double top, double right, double bottom) {
  return {{left, top}, {right, top}, {right, bottom}, {left, bottom}};
}

/// Colours of the bands between consecutive thresholds.
class Bands {
 public:
  explicit Bands(const ContourLevels& levels) : last_(static_cast<double>(levels.thresholds().size())) {}
  /// The colour of a band.
  /// @param k  number of thresholds below the band
  Colour colour(std::size_t k) const { return scale_colour(last_ > 0 ? static_cast<double>(k) / last_ : 0.5); }
  /// The mean colour of the bands below and above threshold number k.
  Colour at_threshold(std::size_t k) const { return scale_colour((static_cast<double>(k) + 0.5) / last_); }

 private:
  double last_;
};

void draw_regions(const FieldMap& map, const Bands& bands, const std::vector<double>& thresholds, PlotFrame& plot) {
  Picture& picture = plot.picture;
  const auto area = [&](const FieldRegion& region, const Colour& colour) {
    if (!region.loops.empty())
      picture.areas.push_back({simplify_loops(plot.to_pixels(region.loops), kTolerance), colour});
  };
  area(map.undefined, kUndefined);
  area(map.defined, bands.colour(0));
  std::vector<PlanePoint> labels, outline;
  for (const SliceOutline::Loop& loop : picture.outline) outline.insert(outline.end(), loop.begin(), loop.end());
  for (std::size_t k = 0; k < map.regions.size(); ++k) {
    area(map.regions[k], bands.colour(k + 1));
    const Colour background = bands.at_threshold(k), ink = text_colour_on(background);
    const std::string label = formatted("%.6g", thresholds[k]);
    const double length = kLetterUnit * text_strokes(label).width;
    for (const std::vector<PlanePoint>& contour : map.regions[k].contours) {
      const std::vector<PlanePoint> line = plot.to_pixels(contour);
      const auto draw = [&](const std::vector<PlanePoint>& part) {
        picture.lines.push_back({simplify_line(part, kTolerance), ink});
      };
      const auto place = place_label(line, length, labels, outline);
      if (!place) {
        draw(line);
        continue;
      }
      draw(place->before);
      draw(place->after);
      labels.push_back(place->at);
      // Distance of the text's baseline below the middle of a digit [pixel].
      const double turn = place->angle * std::numbers::pi / 180, below = 4;
      picture.texts.push_back({place->at[0] + below * std::sin(turn), place->at[1] + below * std::cos(turn), label,
                               Anchor::middle, false, place->angle, ink, background});
    }
  }
}

/// Draws the colour bar of a map.
/// @param title  name and unit of the field
void draw_colour_bar(const ContourLevels& levels, const Bands& bands, const std::string& title, bool has_undefined,
                     Picture& picture) {
  const auto& [frame_left, frame_top, frame_width, frame_height] = picture.frames.front();
  const double left = frame_left + frame_width + kBarGap, right = left + kBarWidth;
  const double below = has_undefined ? 30 : 0;  // height of the legend for undefined values [pixel]
  double top = frame_top, bottom = top + frame_height - below;
  const double text = right + 8;
  if (has_undefined) {
    const double lower = top + frame_height, upper = lower - 14;
    picture.areas.push_back({{rectangle(left, upper, right, lower)}, kUndefined});
    picture.texts.push_back({text, lower - 3, "undefined"});
  }
  const std::vector<double>& values = levels.values;
  if (values.empty()) return;
  double widest = 0;
  for (const double value : values)
    widest = std::max(widest, kLetterUnit * text_strokes(formatted("%.6g", value)).width);
  picture.texts.push_back({text + widest + 20, (top + bottom) / 2, title, Anchor::middle, false, 90});
  picture.width = std::max(picture.width, text + widest + 36);
  const double middle = (left + right) / 2, high = top, low = bottom;
  if (levels.open_above) top += kBarArrow;
  if (levels.open_below) bottom -= kBarArrow;
  const auto y_of = [&](std::size_t k) {
    if (values.size() == 1) return (top + bottom) / 2;
    return bottom + (top - bottom) * static_cast<double>(k) / static_cast<double>(values.size() - 1);
  };
  std::size_t band = 0;
  if (levels.open_below)
    picture.areas.push_back({{{{left, bottom}, {middle, low}, {right, bottom}}}, bands.colour(band++)});
  if (values.size() == 1) picture.areas.push_back({{rectangle(left, top, right, bottom)}, bands.colour(0)});
  for (std::size_t k = 0; k + 1 < values.size(); ++k)
    picture.areas.push_back({{rectangle(left, y_of(k + 1), right, y_of(k))}, bands.colour(band++)});
  if (levels.open_above) picture.areas.push_back({{{{left, top}, {right, top}, {middle, high}}}, bands.colour(band)});
  picture.lines.push_back({{{left, bottom},
                            {middle, levels.open_below ? low : bottom},
                            {right, bottom},
                            {right, top},
                            {middle, levels.open_above ? high : top},
                            {left, top},
                            {left, bottom}},
                           kBarFrame});
  const double spacing = values.size() > 1 ? y_of(0) - y_of(1) : 1, kMinSpacing = 17;
  const auto stride = static_cast<std::size_t>(std::max(1.0, std::ceil(kMinSpacing / spacing)));
  for (std::size_t k = 0; k < values.size(); k += stride) {
    picture.lines.push_back({{{right, y_of(k)}, {right + 4, y_of(k)}}, kBarFrame});
    picture.texts.push_back({text, y_of(k) + 4, formatted("%.6g", values[k])});
  }
}

}  // namespace

Picture draw_map(const SliceMesh& mesh, const WorkspaceField& field, std::vector<std::string> lines) {
  std::vector<double> values = field.values;
  const std::string unit = convert_to_display_unit(field.unit, values);
  const ContourLevels levels = contour_levels(values);
  const std::vector<double> thresholds = levels.thresholds();
  const FieldMap map = map_field(mesh, values, thresholds);
  const SliceOutline outline = trace_outline(mesh);
  lines.push_back(field.name + ": " + field.meaning);
  lines.push_back(mesh.points.empty()     ? "no feasible pose"
                  : levels.values.empty() ? "undefined at all feasible poses"
                                          : range_text(levels, unit));
  PlotFrame plot = plot_frame(outline, lines, kRight);
  const Bands bands(levels);
  plot.picture.outline = plot.to_pixels(outline.loops);
  draw_regions(map, bands, thresholds, plot);
  plot.picture.outline_is_filled = false;
  draw_colour_bar(levels, bands, column_header(field.name, unit), !map.undefined.loops.empty(), plot.picture);
  return plot.picture;
}

}  // namespace pkm
