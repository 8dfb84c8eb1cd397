// Finds the largest solid in the workspace of a design: search on a voxel grid, and evaluation of the refined solid.
#include "engine/workspace/largest_solid.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "engine/core/catalogue.hpp"
#include "engine/core/error.hpp"
#include "engine/geometry/pose_product.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "engine/workspace/solid_margins.hpp"
#include "engine/workspace/solid_refinement.hpp"
#include "engine/workspace/visualisation_plan.hpp"
#include "engine/workspace/workspace_fields.hpp"

namespace pkm {
namespace {

constexpr std::int64_t kCellsOfSearch = 40;                               // number of cells along each axis, for plans
                                                                          // of columns
constexpr int kCoarseDensity = 2, kSampleDensity = 4, kFinalDensity = 6;  // number of sample intervals along a radius

/// Determinant of the Jacobian G of a pose; NaN if it is undefined.
double determinant_of(const PoseReport& report) {
  return report.det_G.value_or(std::numeric_limits<double>::quiet_NaN());
}

}  // namespace

LargestSolidFinder::LargestSolidFinder(const Mechanism& mechanism, const WorkspacePlan& plan, SolidSpec spec,
                                       bool is_regular, std::vector<ReportMargin> reported)
    : mechanism_(mechanism),
      plan_(plan),
      spec_(std::move(spec)),
      is_regular_(is_regular),
      reported_(std::move(reported)),
      sweep_(sweep_of(mechanism.info(), plan)),
      coarse_samples_(spec_.shape.samples(kCoarseDensity)),
      samples_(spec_.shape.samples(kSampleDensity)),
      dense_samples_(spec_.shape.samples(kFinalDensity)) {
  const MechanismInfo& info = mechanism.info();
  if (!find_ordered_margins(mechanism))
    throw std::invalid_argument("mechanism " + info.name + " has no formulas of the margins of poses");
  for (const FixedCoordinate& fixed : plan.fixed)
    if (fixed.kind == FixedCoordinate::Kind::integrated)
      throw std::invalid_argument("the workspace integrates over " +
                                  info.coordinates[static_cast<std::size_t>(fixed.coordinate)].name +
                                  "; expected one value, or a list of values, in all of which the " +
                                  spec_.shape.name() + " has to be reachable");
  plan_.limits = workspace_limits(info, plan.limits);
  voxels_ =
      prepare_voxel_map(mechanism, visualisation_plan(info, plan_, {kCellsOfSearch, kCellsOfSearch, kCellsOfSearch}));
  if (mechanism.voxels() && info.joints.size() == info.coordinates.size())
    sides_ = mechanism.voxels()->prepare_sides(plan_, "");
}

std::vector<std::string> LargestSolidFinder::dimension_names() const {
  std::vector<std::string> axes;
  for (const int coordinate : sweep_.swept)
    axes.push_back(mechanism_.info().coordinates[static_cast<std::size_t>(coordinate)].name);
  return spec_.shape.dimension_names(axes);
}

std::vector<Pose<double>> LargestSolidFinder::orientations(std::span<const double> parameters) const {
  std::vector<Pose<double>> poses = {Pose<double>(mechanism_.info().coordinates.size())};
  for (const int coordinate : sweep_.fixed) {
    const FixedCoordinate how = how_fixed(plan_, coordinate);
    const std::vector<double> values = how.kind == FixedCoordinate::Kind::listed
                                           ? how.values
                                           : std::vector{fixed_value(mechanism_, parameters, plan_, coordinate)};
    poses = with_each(poses, coordinate, values);
  }
  return poses;
}

std::vector<PoseSolid> LargestSolidFinder::pose_solids(std::span<const double> parameters, const Solid& solid) const {
  std::vector<PoseSolid> all;
  for (const Pose<double>& fixed : orientations(parameters)) {
    PoseSolid made;
    for (const double value : fixed) made.ranges.push_back({value, value});
    for (std::size_t ball = 0; ball < spec_.shape.balls(); ++ball) {
      std::vector<std::size_t> coordinates;
      for (const std::size_t axis : spec_.shape.axes_of(ball)) {
        coordinates.push_back(static_cast<std::size_t>(sweep_.swept[axis]));
        const double half = solid.dimensions[ball] / 2;
        made.ranges[coordinates.back()] = {solid.centre[axis] - half, solid.centre[axis] + half};
      }
      if (coordinates.size() > 1) made.balls.push_back(coordinates);
    }
    all.push_back(std::move(made));
  }
  return all;
}

std::vector<std::int8_t> LargestSolidFinder::determinant_signs(std::span<const double> parameters,
                                                               std::span<const Pose<double>> poses,
                                                               const SolidMargins& margins) const {
  const auto sign_at = [&](const Pose<double>& pose) {
    const double determinant = determinant_of(margins.report(pose));
    return static_cast<std::int8_t>(determinant > 0 ? 1 : determinant < 0 ? -1 : 0);
  };
  std::vector<std::int8_t> signs(poses.size());
  if (!sides_) {
    std::ranges::transform(poses, signs.begin(), sign_at);
    return signs;
  }
  Scratch scratch;
  sides_->start(parameters, scratch);
  sides_->find(poses, true, scratch, signs);
  std::ranges::replace(signs, PoseSides::kSingular, std::int8_t{0});
  // det J is det G / det Jq up to its sign, and det Jq has one sign in a working mode.
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const std::int8_t sign = signs[i] == 0 ? std::int8_t{0} : sign_at(poses[i]);
    if (sign == 0) continue;
    if (sign != signs[i])
      for (std::int8_t& each : signs) each = static_cast<std::int8_t>(-each);
    break;
  }
  return signs;
}

SolidMargins LargestSolidFinder::margins(std::span<const double> parameters, double determinant) const {
  std::vector<ReportMargin> reported = reported_;
  if (determinant != 0)
    reported.push_back({"det G = 0, a parallel singularity",
                        [determinant](const PoseReport& report) { return determinant * determinant_of(report); }});
  return {mechanism_, parameters, plan_.limits, sweep_.swept, orientations(parameters), spec_.shape, reported};
}

LargestSolid LargestSolidFinder::find(std::span<const double> parameters) const {
  constexpr std::size_t kRemembered = 8;
  {
    const std::lock_guard lock(memory_->mutex);
    for (const auto& [design, solid] : memory_->solids)
      if (std::ranges::equal(design, parameters)) return solid;
  }
  const VoxelMap map = voxels_->map(parameters);
  LargestSolid found = find(parameters, map, false);
  if (is_regular_ && !found.is_regular) found = find(parameters, map, true);
  const std::lock_guard lock(memory_->mutex);
  memory_->solids.emplace_back(std::vector(parameters.begin(), parameters.end()), found);
  if (memory_->solids.size() > kRemembered) memory_->solids.pop_front();
  return found;
}

LargestSolid LargestSolidFinder::find(std::span<const double> parameters, const VoxelMap& map, bool is_regular) const {
  SolidRefinement::Faces faces;
  for (std::size_t axis = 0; axis < 3; ++axis) faces[axis] = {map.lower[axis], map.upper[axis]};
  const VoxelGrid grid(map);
  SolidMargins tests = margins(parameters, 0);
  const std::size_t count = tests.orientations().size();
  LargestSolid none;
  none.solid.dimensions.assign(spec_.shape.balls(), 0.0);

  // First, search on the voxel grid. Use the cells that are feasible in all orientations and, if required, whose
  // determinants have one sign.
  std::vector<std::uint8_t> good = map.feasible;
  std::vector<std::size_t> cells;
  std::vector<Pose<double>> poses;  // poses at the centres of these cells
  Cell cell;
  for (cell[0] = 0; cell[0] < grid.cells[0]; ++cell[0])
    for (cell[1] = 0; cell[1] < grid.cells[1]; ++cell[1])
      for (cell[2] = 0; cell[2] < grid.cells[2]; ++cell[2]) {
        const std::size_t at = grid.index(cell);
        std::array<double, 3> point{};
        for (std::size_t axis = 0; axis < 3; ++axis) point[axis] = grid.centre(axis, cell[axis]);
        if (good[at] && (count > 1 || !reported_.empty())) good[at] = tests.is_feasible(point);
        if (!good[at] || !is_regular) continue;
        cells.push_back(at);
        poses.push_back(tests.pose(point, 0));
      }
  const std::vector<std::int8_t> determinants = determinant_signs(parameters, poses, tests);
  std::optional<Solid> start;
  double sign = 0;
  for (const double side : is_regular ? std::vector{1.0, -1.0} : std::vector{0.0}) {
    std::vector<std::uint8_t> on_side = good;
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (!(side * determinants[i] > 0)) on_side[cells[i]] = 0;
    const auto solid = largest_solid_on_grid(grid, on_side, spec_);
    if (!solid || (start && spec_.shape.volume(solid->dimensions) <= spec_.shape.volume(start->dimensions))) continue;
    start = solid;
    sign = side;
  }
  if (!start) return none;
  if (is_regular) {
    const double size = std::fabs(determinant_of(tests.report(tests.pose(start->centre, 0))));
    if (size > 0) sign /= size;
  }

  // Then refine the solid with the constraints themselves, first with few samples.
  SolidMargins constraints = margins(parameters, sign);
  SolidRefinement refinement(spec_, faces, constraints, *start);
  const SolidRefinement::Iterate coarse = refinement.run(coarse_samples_);
  SolidRefinement::Iterate last = refinement.run(samples_, &coarse);
  LargestSolid found;
  found.solid = refinement.finish(last, dense_samples_);
  found.volume = spec_.shape.volume(found.solid.dimensions);
  if (!(found.volume > 0)) return none;
  found.residual = refinement.residual();
  found.determinant = sign;
  found.samples = dense_samples_.points.size() * count;
  const std::vector<std::string> names = constraints.names();
  for (std::size_t k = 0; k < last.points.size(); ++k) {
    const CriticalPoint& point = last.points[k];
    const double multiplier = last.multipliers[static_cast<Eigen::Index>(k)];
    // kTouches: maximum distance of a contact from the boundary, in units of the size; kActive: minimum multiplier of
    // an active constraint
    constexpr double kTouches = 1e-9, kActive = 1e-6;
    if (point.norm == 0 || (std::fabs(point.distance) > kTouches * refinement.unit() && multiplier < kActive)) continue;
    Contact contact{.pose = constraints.pose(refinement.solid(last.x).at(spec_.shape, point.unit), point.orientation),
                    .multiplier = multiplier < kActive ? 0 : multiplier / (refinement.unit() * point.norm),
                    .margin = point.margin,
                    .unit = point.unit};
    if (point.margin != SolidRefinement::kBoxFace) {
      contact.constraint = names[point.margin];
    } else {
      const auto axis = static_cast<std::size_t>(std::ranges::find_if(point.unit, [](double u) { return u != 0; }) -
                                                 point.unit.begin());
      contact.constraint = "box, " + mechanism_.info().coordinates[static_cast<std::size_t>(sweep_.swept[axis])].name +
                           (point.unit[axis] > 0 ? " max" : " min");
    }
    found.contacts.push_back(std::move(contact));
  }
  if (sign == 0) {
    for (std::size_t k = 0; k < count; ++k) {
      poses.clear();
      for (const UnitPoint& unit : samples_.points) poses.push_back(tests.pose(found.solid.at(spec_.shape, unit), k));
      const std::vector<std::int8_t> signs = determinant_signs(parameters, poses, tests);
      if (std::ranges::count(signs, 1) > 0 && std::ranges::count(signs, -1) > 0) found.is_regular = false;
    }
  }
  return found;
}

Dual4 LargestSolidFinder::volume(std::span<const Dual4> parameters, const LargestSolid& found) const {
  Dual4 result(found.volume);
  std::vector<double> values;
  for (const Dual4& parameter : parameters) values.push_back(parameter.a);
  SolidMargins constraints = margins(values, found.determinant);
  for (const Contact& contact : found.contacts) {
    if (contact.multiplier == 0) continue;
    const double factor = found.volume * contact.multiplier;
    if (contact.margin != SolidRefinement::kBoxFace) {
      const Dual4 margin = constraints.by_parameters(parameters, contact.margin, contact.pose);
      for (int k = 0; k < 4; ++k) result.v[k] += factor * margin.v[k];
      continue;
    }
    // The contact is on a face of the search box, which depends on the design unless the plan fixes the box.
    const std::optional<Box>& fixed = plan_.box();
    if (fixed) continue;
    const auto axis = static_cast<std::size_t>(std::ranges::find_if(contact.unit, [](double u) { return u != 0; }) -
                                               contact.unit.begin());
    double size = 0;
    for (const double value : values) size = std::max(size, std::fabs(value));
    const double step = 1e-6 * size;
    for (int k = 0; k < 4; ++k) {
      const auto face = [&](double steps) {
        std::vector<double> moved = values;
        for (std::size_t i = 0; i < moved.size(); ++i) moved[i] += steps * step * parameters[i].v[k];
        const VoxelMap map = voxels_->map(moved);
        return contact.unit[axis] > 0 ? map.upper[axis] : -map.lower[axis];
      };
      result.v[k] += factor * (face(1) - face(-1)) / (2 * step);
    }
  }
  return result;
}

}  // namespace pkm
