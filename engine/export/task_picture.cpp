#include "engine/export/task_picture.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/core/catalogue.hpp"
#include "engine/core/error.hpp"
#include "engine/core/formatted.hpp"
#include "engine/export/plot_frame.hpp"
#include "engine/export/simplify_line.hpp"

namespace pkm {
namespace {

// The colour-blind safe palette of Okabe and Ito (2008), in the order of the series of the report.
constexpr Colour kRobotColours[] = {{0x00, 0x72, 0xb2}, {0xd5, 0x5e, 0x00}, {0x00, 0x9e, 0x73}, {0xcc, 0x79, 0xa7},
                                    {0xe6, 0x9f, 0x00}, {0x56, 0xb4, 0xe9}, {0x7f, 0x7f, 0x7f}};
constexpr Colour kRegion = {0x22, 0x22, 0x22}, kWhite = {0xff, 0xff, 0xff};

// Distances and sizes [pixel]: spaces to the left of a frame, above it for its title, below it for labels, and to the
// right of it; height of a line of text; sizes of frames.
constexpr double kLeftOf = 90, kAbove = 30, kBelow = 56, kRightOf = 24, kTextLine = 20;
constexpr double kFrameWidth = 360, kMaxFrameHeight = 420, kMinFrame = 120, kCurvesHeight = 190;

Colour robot_colour(std::size_t robot) { return kRobotColours[robot % std::size(kRobotColours)]; }

double si_of_display_unit(const std::string& unit) { return 1 / in_display_unit(1, unit).first; }

/// A slice of the workspaces: two axes of the comparison, and the axis that is cut; std::nullopt if there are two axes.
struct View {
  std::size_t across, up;
  std::optional<std::size_t> cut;
};

class ComparisonDrawing {
 public:
  explicit ComparisonDrawing(const TaskComparison& comparison) : comparison_(comparison) {
    for (const View& view : views())
      for (const ComparedRobot& robot : comparison.robots) outlines_.push_back(outline_of(robot, view));
    ranges_ = find_ranges();
  }

  Picture drawn() {
    draw_head();
    draw_views();
    for (const std::string& motion : motions()) draw_motion(motion);
    picture_.width = right_;
    picture_.height = top_;
    return std::move(picture_);
  }

 private:
  using Anchor = Picture::Anchor;
  using Range = std::array<double, 2>;

  /// Index of the coordinate of a robot that belongs to an axis of the comparison; std::nullopt if the robot lacks it.
  std::optional<std::size_t> coordinate(const ComparedRobot& robot, std::size_t axis) const {
    const auto& coordinates = robot.mechanism->info().coordinates;
    const AxisInfo* const found = find_named(coordinates, comparison_.axes[axis].name);
    return found ? std::optional(static_cast<std::size_t>(found - coordinates.data())) : std::nullopt;
  }

  /// The range of each axis to be drawn: it contains all outlines, regions and motions, and a margin of 5 %.
  std::vector<Range> find_ranges() const {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    std::vector<Range> ranges(comparison_.axes.size(), {kInfinity, -kInfinity});
    const auto include = [&ranges](std::size_t axis, double value) {
      if (!std::isfinite(value)) return;
      ranges[axis] = {std::fmin(ranges[axis][0], value), std::fmax(ranges[axis][1], value)};
    };
    for (std::size_t axis = 0; axis < ranges.size(); ++axis) {
      for (const TaskBox& box : comparison_.boxes)
        for (const double end : box.ranges[axis]) include(axis, end);
      for (const ComparedRobot& robot : comparison_.robots)
        for (const TaskMotion& motion : robot.motions)
          for (const auto& at : motion.path) include(axis, at[axis]);
    }
    for (std::size_t v = 0; v < views().size(); ++v)
      for (std::size_t r = 0; r < comparison_.robots.size(); ++r)
        for (const SliceOutline::Loop& loop : outline(v, r))
          for (const PlanePoint& point : loop) {
            include(views()[v].across, point[0]);
            include(views()[v].up, point[1]);
          }
    for (auto& [lower, upper] : ranges) {
      if (!(upper > lower)) lower = std::isfinite(lower) ? lower - 1 : -1, upper = lower + 2;
      const double margin = 0.05 * (upper - lower);
      lower -= margin;
      upper += margin;
    }
    return ranges;
  }

  PlotAxis plot_axis_of(std::size_t axis) const {
    const AxisInfo& info = comparison_.axes[axis];
    const std::string unit = in_display_unit(0, info.unit).second;
    return {info.name + " [" + unit + "]", si_of_display_unit(info.unit), ranges_[axis][0], ranges_[axis][1]};
  }

  void add_text(double x, double y, const std::string& text, bool is_bold = false) {
    picture_.texts.push_back({x, y, text, Anchor::begin, is_bold});
  }

  /// Draws the name of the task, and for each robot its colour, its name and whether it can perform the task.
  void draw_head() {
    add_text(kRightOf, 28, comparison_.task, true);
    top_ = 28;
    for (std::size_t r = 0; r < comparison_.robots.size(); ++r) {
      top_ += kTextLine;
      picture_.lines.push_back({{{kRightOf, top_ - 4}, {kRightOf + 22, top_ - 4}}, robot_colour(r), 4});
      const ComparedRobot& robot = comparison_.robots[r];
      add_text(kRightOf + 32, top_,
               robot.name + (robot.has_requirements() ? ", does the task: " + robot.verdict() : ""));
    }
    right_ = kLeftOf + kFrameWidth + kRightOf;
  }

  std::vector<View> views() const {
    if (comparison_.axes.size() == 3) return {{0, 2, 1}, {0, 1, 2}};
    if (comparison_.axes.size() == 2) return {{0, 1, {}}};
    return {};
  }

  void draw_views() {
    double left = kLeftOf, lowest = top_;
    const double top = top_ + kAbove + 16;
    const bool is_to_scale = std::ranges::all_of(
        comparison_.axes, [&](const AxisInfo& axis) { return axis.unit == comparison_.axes.front().unit; });
    double scale = std::numeric_limits<double>::infinity();
    for (const View& view : views())
      scale = std::min({scale, kFrameWidth / length(view.across), kMaxFrameHeight / length(view.up)});
    for (std::size_t v = 0; v < views().size(); ++v) {
      const View view = views()[v];
      PlotAxis across = plot_axis_of(view.across), up = plot_axis_of(view.up);
      const double width = is_to_scale ? std::max(kMinFrame, scale * length(view.across)) : kFrameWidth;
      const double height = is_to_scale ? std::max(kMinFrame, scale * length(view.up)) : kFrameWidth;
      across.pixel = left;
      across.length = width;
      up.pixel = top + height;
      up.length = -height;
      draw_view(v, across, up);
      left += kFrameWidth + kLeftOf + kRightOf;
      lowest = std::fmax(lowest, up.pixel + kBelow);
      right_ = std::fmax(right_, left - kLeftOf);
    }
    top_ = lowest;
  }

  double length(std::size_t axis) const { return ranges_[axis][1] - ranges_[axis][0]; }

  /// Outline of the workspace of robot r in view v.
  const std::vector<SliceOutline::Loop>& outline(std::size_t v, std::size_t r) const {
    return outlines_[v * comparison_.robots.size() + r];
  }

  void draw_view(std::size_t v, const PlotAxis& across, const PlotAxis& up) {
    const View view = views()[v];
    draw_axes(across, up, picture_);
    std::string title = "workspaces";
    if (view.cut) {
      const AxisInfo& axis = comparison_.axes[*view.cut];
      const auto [value, unit] = in_display_unit(comparison_.middle[*view.cut], axis.unit);
      title += " at " + axis.name + " = " + formatted("%.4g", value) + " " + unit;
    }
    add_text(across.pixel, up.pixel + up.length - 12, title, true);
    const auto to_pixel = [&](double x, double y) -> PlanePoint { return {across.to_pixels(x), up.to_pixels(y)}; };
    for (std::size_t r = 0; r < comparison_.robots.size(); ++r) {
      std::vector<SliceOutline::Loop> loops = outline(v, r);
      for (SliceOutline::Loop& loop : loops)
        for (PlanePoint& point : loop) point = to_pixel(point[0], point[1]);
      constexpr double kTolerance = 0.05, kOpacity = 0.1, kWidth = 2;
      loops = simplify_loops(std::move(loops), kTolerance);
      if (loops.empty()) continue;
      picture_.areas.push_back({loops, robot_colour(r), kOpacity});
      for (SliceOutline::Loop& loop : loops) {
        loop.push_back(loop.front());
        picture_.lines.push_back({std::move(loop), robot_colour(r), kWidth});
      }
    }
    for (const TaskBox& box : comparison_.boxes) {
      if (view.cut && !(box.ranges[*view.cut][0] <= comparison_.middle[*view.cut] &&
                        comparison_.middle[*view.cut] <= box.ranges[*view.cut][1]))
        continue;
      const Range x = limited(box.ranges[view.across], view.across), y = limited(box.ranges[view.up], view.up);
      std::vector<PlanePoint> corners;
      for (const auto& [i, j] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}, {0, 0}})
        corners.push_back(to_pixel(x[static_cast<std::size_t>(i)], y[static_cast<std::size_t>(j)]));
      const PlanePoint upper_left = corners[3];
      picture_.lines.push_back({std::move(corners), kRegion, 1.5});
      picture_.texts.push_back({upper_left[0], upper_left[1] - 4, box.name, Anchor::begin, false, 0, kRegion, kWhite});
    }
    // The path of a motion is drawn for the first robot that has both axes of the slice.
    for (const std::string& name : motions())
      for (const ComparedRobot& robot : comparison_.robots) {
        const TaskMotion* const motion = find_named(robot.motions, name);
        if (!motion || motion->path.empty() || std::isnan(motion->path.front()[view.across]) ||
            std::isnan(motion->path.front()[view.up]))
          continue;
        std::vector<PlanePoint> path;
        for (const auto& at : motion->path) path.push_back(to_pixel(at[view.across], at[view.up]));
        picture_.lines.push_back({std::move(path), kRegion, 1});
        break;
      }
  }

  /// The part of an infinite range that is drawn.
  Range limited(const Range& range, std::size_t axis) const {
    return {std::fmax(range[0], ranges_[axis][0]), std::fmin(range[1], ranges_[axis][1])};
  }

  /// Outline of a slice of a robot's workspace, in the frame of the task; empty if the robot lacks one of the axes.
  std::vector<SliceOutline::Loop> outline_of(const ComparedRobot& robot, const View& view) const {
    const auto across = coordinate(robot, view.across), up = coordinate(robot, view.up);
    if (!robot.workspace || !across || !up) return {};
    WorkspaceFields slice;
    slice.mechanism = robot.workspace->mechanism;
    slice.fixed = robot.workspace->fixed;
    for (const std::size_t swept : {*across, *up})
      for (const WorkspaceAxis& axis : robot.workspace->axes)
        if (axis.coordinate == static_cast<int>(swept)) slice.axes.push_back(axis);
    for (WorkspaceAxis axis : robot.workspace->axes) {
      const auto own = static_cast<std::size_t>(axis.coordinate);
      if (own == *across || own == *up) continue;
      axis.lower = axis.upper = comparison_.middle[*view.cut] - robot.origin[own];
      slice.fixed.push_back(axis);
    }
    const PoseMargin margin(*robot.mechanism, robot.parameters, robot.limits);
    std::vector<SliceOutline::Loop> loops = trace_outline(slice_mesh(slice, margin)).loops;
    for (SliceOutline::Loop& loop : loops)
      for (PlanePoint& point : loop) point = {point[0] + robot.origin[*across], point[1] + robot.origin[*up]};
    return loops;
  }

  /// Names of the motions, in the order of the task.
  std::vector<std::string> motions() const { return names_of(comparison_.robots.front().motions); }

  /// Draws the loads along a motion over time, in two columns of panels; all panels have the same time axis.
  void draw_motion(const std::string& name) {
    struct Curve {
      std::size_t robot;
      double duration;
      const TaskCurve* curve;
    };
    // The curves of each panel, in which the curves of all robots have the same name.
    std::vector<std::vector<Curve>> panels;
    double duration = 0;
    for (std::size_t r = 0; r < comparison_.robots.size(); ++r) {
      const TaskMotion* const motion = find_named(comparison_.robots[r].motions, name);
      if (!motion) continue;
      for (const TaskCurve& curve : motion->curves) {
        duration = std::fmax(duration, motion->duration);
        auto panel = std::ranges::find(panels, curve.name, [](const auto& each) { return each.front().curve->name; });
        if (panel == panels.end()) panel = panels.insert(panel, std::vector<Curve>());
        panel->push_back({r, motion->duration, &curve});
      }
    }
    const double step = kFrameWidth + kLeftOf + kRightOf;
    for (std::size_t k = 0; k < panels.size(); ++k) {
      const bool is_right = k % 2 == 1;
      if (!is_right) top_ += kAbove + 8;
      double lower = 0, upper = 0;
      for (const Curve& each : panels[k])
        for (const double value : each.curve->values) {
          lower = std::fmin(lower, value);
          upper = std::fmax(upper, value);
        }
      if (!(upper > lower)) upper = lower + 1;
      const TaskCurve& first = *panels[k].front().curve;
      PlotAxis across{"time [s]", 1, 0, duration, kLeftOf + (is_right ? step : 0), kFrameWidth};
      PlotAxis up{"[" + first.unit + "]",
                  1,
                  lower - (lower < 0 ? 0.05 * (upper - lower) : 0),
                  upper + 0.05 * (upper - lower),
                  top_ + kCurvesHeight,
                  -kCurvesHeight};
      draw_axes(across, up, picture_);
      add_text(across.pixel, top_ - 12, name + ": " + first.name, true);
      for (const Curve& each : panels[k]) {
        const std::vector<double>& values = each.curve->values;
        std::vector<PlanePoint> points;
        // Draws the part of a curve up to here. Called at the end of the curve, and where its values are undefined, so
        // that it has a gap there.
        const auto end_line = [&] {
          if (points.size() > 1) picture_.lines.push_back({points, robot_colour(each.robot), 1.8});
          points.clear();
        };
        for (std::size_t i = 0; i < values.size(); ++i) {
          if (std::isnan(values[i])) {
            end_line();
            continue;
          }
          const double time = each.duration * static_cast<double>(i) / static_cast<double>(values.size() - 1);
          points.push_back({across.to_pixels(time), up.to_pixels(values[i])});
        }
        end_line();
      }
      right_ = std::fmax(right_, across.pixel + kFrameWidth + kRightOf);
      if (is_right || k + 1 == panels.size()) top_ += kCurvesHeight + kBelow;
    }
  }

  const TaskComparison& comparison_;
  std::vector<std::vector<SliceOutline::Loop>> outlines_;  ///< outlines of the workspaces, by view, then by robot
  std::vector<Range> ranges_;                              ///< drawn range of each axis
  Picture picture_;
  /// top_: y below everything that has been drawn; right_: x of the right end of the drawing [pixel].
  double top_ = 0, right_ = 0;
};

}  // namespace

Picture draw_comparison(const TaskComparison& comparison) { return ComparisonDrawing(comparison).drawn(); }

}  // namespace pkm
