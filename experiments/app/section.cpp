#include "experiments/app/section.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "engine/core/printable.hpp"
#include "engine/core/team.hpp"
#include "experiments/app/print.hpp"

namespace pkm {
namespace {

using Point = std::array<double, 2>;

constexpr std::size_t kSteps = 240;  // between nodes, along each axis
constexpr int kHalvings = 20;

/// Nodes of the grid, and around them a ring of others at the same places, which are outside: outlines close there.
class Nodes {
 public:
  static constexpr std::size_t kAcross = kSteps + 3;

  Nodes(const WorkspaceFields& workspace, const PoseMargin& margin)
      : workspace_(workspace), margin_(margin), inside_(kAcross * kAcross) {
    share_pieces(kSteps + 1, [&](std::size_t row, std::size_t end) {
      for (; row < end; ++row)
        for (std::size_t i = 1; i <= kSteps + 1; ++i) inside_[node(i, row + 1)] = feasible(place(i, row + 1));
    });
  }

  static std::size_t node(std::size_t i, std::size_t j) { return j * kAcross + i; }
  bool inside(std::size_t node) const { return inside_[node] != 0; }
  Point place(std::size_t node) const { return place(node % kAcross, node / kAcross); }
  bool feasible(const Point& at) const {
    std::vector<double> scratch;
    return margin_(workspace_.pose({at[0], at[1], 0}), scratch) >= 0;
  }

  /// Where the margin changes its sign between two nodes.
  Point crossing(std::size_t a, std::size_t b) const {
    Point in = place(inside(a) ? a : b), out = place(inside(a) ? b : a);
    for (int k = 0; k < kHalvings && in != out; ++k) {
      const Point middle = {(in[0] + out[0]) / 2, (in[1] + out[1]) / 2};
      (feasible(middle) ? in : out) = middle;
    }
    return in;
  }

 private:
  Point place(std::size_t i, std::size_t j) const {
    const auto along = [](const WorkspaceAxis& axis, std::size_t k) {
      const double share = static_cast<double>(std::clamp<std::size_t>(k, 1, kSteps + 1) - 1) / kSteps;
      return axis.lower + share * (axis.upper - axis.lower);
    };
    return {along(workspace_.axes[0], i), along(workspace_.axes[1], j)};
  }

  const WorkspaceFields& workspace_;
  const PoseMargin& margin_;
  std::vector<char> inside_;
};

/// Two neighbouring nodes, the lower number first.
using Edge = std::pair<std::size_t, std::size_t>;

/// The outline's steps from edge to edge of the squares, what is feasible being on the left.
std::map<Edge, Edge> steps_of(const Nodes& nodes) {
  std::map<Edge, Edge> steps;
  for (std::size_t j = 0; j + 1 < Nodes::kAcross; ++j)
    for (std::size_t i = 0; i + 1 < Nodes::kAcross; ++i) {
      const std::array corners = {Nodes::node(i, j), Nodes::node(i + 1, j), Nodes::node(i + 1, j + 1),
                                  Nodes::node(i, j + 1)};  // counter-clockwise
      const auto edge = [&](std::size_t k) -> Edge { return std::minmax(corners[k % 4], corners[(k + 1) % 4]); };
      std::vector<std::size_t> ways_in, ways_out;  // of who walks around the square
      for (std::size_t k = 0; k < 4; ++k) {
        const bool before = nodes.inside(corners[k]), after = nodes.inside(corners[(k + 1) % 4]);
        if (!before && after) ways_in.push_back(k);
        if (before && !after) ways_out.push_back(k);
      }
      bool joined = false;  // two opposite corners, through the middle
      if (ways_in.size() == 2) {
        const Point a = nodes.place(corners[0]), b = nodes.place(corners[2]);
        joined = nodes.feasible({(a[0] + b[0]) / 2, (a[1] + b[1]) / 2});
      }
      for (const std::size_t out : ways_out) {
        // The way in that came last before this way out belongs to the same corner, the other one to that opposite.
        const bool other = ways_in.size() == 2 && ((out + 4 - ways_in[0]) % 4 == 1) == joined;
        steps[edge(out)] = edge(ways_in[other ? 1 : 0]);
      }
    }
  return steps;
}

/// Twice the area that a loop goes around counter-clockwise.
double twice_area(const Section::Loop& loop) {
  double sum = 0;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Point &a = loop[k], &b = loop[(k + 1) % loop.size()];
    sum += (a[0] - loop[0][0]) * (b[1] - loop[0][1]) - (b[0] - loop[0][0]) * (a[1] - loop[0][1]);
  }
  return sum;
}

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
    for (const Point& point : loop) {
      least = std::min(least, point[i]);
      greatest = std::max(greatest, point[i]);
    }
  const double more = 0.1 * (greatest - least);
  Scale scale{axis.name + (turns ? " [deg]" : " [mm]"), turns ? std::numbers::pi / 180 : 1e-3, axis.lower, axis.upper};
  if (more > 0) scale.lower = least - more, scale.upper = greatest + more;
  return scale;
}

std::string xml_text(const std::string& text) {
  std::string result;
  for (const char c : printable(text))
    result += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  return result;
}

std::string pixels(double value) { return formatted("%.2f", value); }

std::string text_at(double x, double y, const std::string& style, const std::string& words) {
  return "<text x=\"" + pixels(x) + "\" y=\"" + pixels(y) + "\" " + style + ">" + xml_text(words) + "</text>\n";
}

std::string line_between(double x1, double y1, double x2, double y2) {
  return "<path class=\"grid\" d=\"M" + pixels(x1) + " " + pixels(y1) + "L" + pixels(x2) + " " + pixels(y2) + "\"/>\n";
}

}  // namespace

Section section_of(const WorkspaceFields& workspace, const PoseMargin& margin) {
  const Nodes nodes(workspace, margin);
  Section section{{workspace.axes[0], workspace.axes[1]}, {}, 0};
  auto steps = steps_of(nodes);
  while (!steps.empty()) {
    Section::Loop loop;
    for (auto step = steps.begin(); step != steps.end();) {
      const Point point = nodes.crossing(step->first.first, step->first.second);
      if (loop.empty() || loop.back() != point) loop.push_back(point);
      const Edge next = step->second;
      steps.erase(step);
      step = steps.find(next);
    }
    section.area += twice_area(loop) / 2;
    section.loops.push_back(std::move(loop));
  }
  return section;
}

std::string svg_picture(const Section& section, const std::vector<std::string>& lines) {
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

  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + pixels(kLeft + width + kRight) +
                    "\" height=\"" + pixels(above + height + kBelow) +
                    "\" font-family=\"sans-serif\" font-size=\"13\">\n<style>.grid { stroke: #ddd }</style>\n"
                    "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n";
  for (std::size_t k = 0; k < lines.size(); ++k)
    svg += text_at(kLeft, 24 + kLine * static_cast<double>(k), k == 0 ? "font-weight=\"bold\"" : "fill=\"#444\"",
                   lines[k]);
  for (const double tick : across.ticks()) {
    const double x = across.at(tick * across.unit);
    svg += line_between(x, up.pixel, x, above) +
           text_at(x, up.pixel + 18, "text-anchor=\"middle\"", formatted("%.6g", tick));
  }
  for (const double tick : up.ticks()) {
    const double y = up.at(tick * up.unit);
    svg += line_between(kLeft, y, kLeft + width, y) +
           text_at(kLeft - 8, y + 4, "text-anchor=\"end\"", formatted("%.6g", tick));
  }
  svg += "<path class=\"section\" fill=\"#4a7fb5\" fill-opacity=\"0.45\" fill-rule=\"evenodd\" stroke=\"#1f4e79\" d=\"";
  for (const Section::Loop& loop : section.loops) {
    for (std::size_t k = 0; k < loop.size(); ++k)
      svg += (k == 0 ? "M" : "L") + pixels(across.at(loop[k][0])) + " " + pixels(up.at(loop[k][1]));
    svg += "Z";
  }
  svg += "\"/>\n<rect x=\"" + pixels(kLeft) + "\" y=\"" + pixels(above) + "\" width=\"" + pixels(width) +
         "\" height=\"" + pixels(height) + "\" fill=\"none\" stroke=\"#222\"/>\n";
  svg += text_at(kLeft + width / 2, up.pixel + 44, "text-anchor=\"middle\"", across.title);
  const std::string turned = "text-anchor=\"middle\" transform=\"rotate(-90 24 " + pixels(above + height / 2) + ")\"";
  return svg + text_at(24, above + height / 2, turned, up.title) + "</svg>\n";
}

}  // namespace pkm
