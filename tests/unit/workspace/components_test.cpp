// Connected components of workspaces, beside areas in closed form and an independent flood fill.
#include "engine/workspace/components.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <numbers>
#include <set>

#include "engine/core/error.hpp"
#include "engine/core/team.hpp"
#include "engine/math/random.hpp"
#include "engine/workspace/pose_quantities.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "tests/unit/contracts/mechanism_fixtures.hpp"
#include "tests/unit/workspace/connectivity.hpp"

namespace pkm {
namespace {

/// Voxels in the box of the mechanism file.
WorkspacePlan cells_of(const MechanismInfo& info, const std::array<std::int64_t, 3>& cells) {
  return {.method = VoxelOptions{.cells = cells}, .limits = no_limits(info)};
}

ConnectedComponents components_of(const Mechanism& mechanism, const std::vector<double>& design,
                                  const WorkspacePlan& plan, Crossing crossing = Crossing::forbidden) {
  Scratch scratch;
  return ComponentFinder(mechanism, plan, "", crossing).find(design, voxel_map(mechanism, design, plan), scratch);
}

// reference: areas of the circular sectors in closed form
TEST(Components, OfTwoTelescopesHaveTheReferenceAreas) {
  struct {
    double a, b, d, area;
    std::size_t components, across;
  } const known[] = {{1, 1.8, 1.5, 1.440827656219, 2, 2}, {.5, 1.8, 1.5, 3.619396585115, 2, 1}};
  for (const auto& [a, b, d, area, components, across] : known) {
    const auto mechanism = test::two_telescopes(a, b, d);
    const std::vector<double> design = test::nominal(mechanism->info());
    const WorkspacePlan plan = cells_of(mechanism->info(), {400, 400, 1});
    ConnectedComponents found = components_of(*mechanism, design, plan),
                        crossing = components_of(*mechanism, design, plan, Crossing::allowed);
    for (ConnectedComponents* const each : {&found, &crossing})  // single cells at the cusps of the boundary
      std::erase_if(each->all, [](const WorkspaceComponent& component) { return component.cells < 4; });
    ASSERT_EQ(found.all.size(), components);
    EXPECT_EQ(crossing.all.size(), across);
    EXPECT_NE(found.all[0].side, found.all[1].side);
    const double cell = 2 * b / 400 * (2 * b / 400);
    for (const WorkspaceComponent& each : found.all)
      EXPECT_NEAR(static_cast<double>(each.cells) * cell, area / 2, 2e-3);

    WorkspacePlan upper = plan;
    upper.home = {0.1, 1.2, 0};
    const WorkspaceResult<double> counted = test::survey(*mechanism, design, upper, {.fields = {&kConditioning}});
    EXPECT_EQ(counted.feasible_cells, found.all[0].cells);
    EXPECT_EQ(counted.weight.size(), static_cast<std::size_t>(counted.feasible_cells));
    EXPECT_EQ(counted.field(kConditioning).size(), counted.weight.size());
    EXPECT_TRUE(counted.pose.empty());
    const WorkspaceResult<double> with_poses = test::survey(*mechanism, design, upper, {.poses = true});
    EXPECT_EQ(with_poses.pose.size(), static_cast<std::size_t>(with_poses.feasible_cells));
    for (const Pose<double>& pose : with_poses.pose) EXPECT_GT(pose[1], 0);
  }
}

// reference: the law of cosines for the length of a leg
TEST(Components, OfRotationsHaveTheReferenceAngles) {
  const auto mechanism = read_mechanism_toml(test::symmetric_3_rpr("\"phi\""), "3-rpr.toml");
  const std::vector<double> design = test::nominal(mechanism->info());
  const WorkspacePlan plan = cells_of(mechanism->info(), {36000, 1, 1});
  const ConnectedComponents found = components_of(*mechanism, design, plan);
  ASSERT_EQ(found.all.size(), 2U);
  for (const WorkspaceComponent& each : found.all)
    EXPECT_NEAR(static_cast<double>(each.cells) * 0.01, 101.536959 - 28.457998, 0.021);
}

/// A table that rotates about z, where a formula is >= 0.
std::shared_ptr<const Mechanism> turntable(const std::string& formula) {
  return read_mechanism_toml(
      "[mechanism]\nname = \"turntable\"\n[parameters]\nr = { default = 1, min = 0, max = 2, unit = \"m\", meaning = "
      "\"radius\" }\n[platform]\ncoordinates = { phi = \"about z\" }\n[survey]\n"
      "box = { phi = [\"-pi\", \"pi\"] }\n[[limb]]\nname = \"a\"\ndrive = \"formula\"\njoint = \"phi\"\n"
      "unit = \"rad\"\n[[margin]]\nname = \"within its range\"\nformula = \"" +
          formula + "\"\n",
      "turntable.toml");
}

TEST(Components, GoOnBeyondAFullTurn) {
  const auto mechanism = turntable("0.5 - cos(phi)");
  WorkspacePlan plan = cells_of(mechanism->info(), {360, 1, 1});
  EXPECT_EQ(components_of(*mechanism, {1}, plan).all.size(), 1U);
  std::get<VoxelOptions>(plan.method).box = Box{{{-3, 3}, {0, 1}, {0, 1}}};
  EXPECT_EQ(components_of(*mechanism, {1}, plan).all.size(), 2U);
}

TEST(Components, ArePathsAndProofs) {
  const auto separation = [](const Mechanism& mechanism, const Pose<double>& from, const Pose<double>& to) {
    return mechanism.bounds()->separate(test::nominal(mechanism.info()), cells_of(mechanism.info(), {1, 1, 1}), "",
                                        from, to, {.max_boxes = 20000});
  };
  using Kind = Separation::Kind;
  EXPECT_EQ(separation(*turntable("cos(2*phi) - 0.5"), {0.1}, {3.1}).kind, Kind::boxes);
  EXPECT_EQ(separation(*turntable("cos(2*phi) - 0.5"), {3.1}, {-3.1}).kind, Kind::undecided);
  EXPECT_EQ(separation(*turntable("0.5 - cos(phi)"), {2}, {-2}).detail,
            "boxes that are feasible everywhere connect the poses");
  const auto apart = test::two_telescopes(1, 1.8, 1.5);
  EXPECT_EQ(separation(*apart, {0, 1.2}, {0, -1.2}).kind, Kind::signs);
  EXPECT_EQ(separation(*apart, {0, 1.2}, {0.2, 1.2}).kind, Kind::undecided);
  EXPECT_EQ(separation(*apart, {0, 1.2}, {0, 99}).kind, Kind::undecided);

  const auto legs = read_mechanism_toml(test::symmetric_3_rpr("\"x\", \"y\", \"phi\""), "3-rpr.toml");
  const double rotation = std::numbers::pi / 3;
  EXPECT_NE(separation(*legs, {0, 0, rotation}, {0, 0, -rotation}).kind, Kind::undecided);
  const std::vector<double> design = test::nominal(legs->info());
  const WorkspacePlan plan = cells_of(legs->info(), {20, 20, 60});
  Scratch scratch;
  const ComponentFinder finder(*legs, plan, "");
  const VoxelMap map = voxel_map(*legs, design, plan);
  const ConnectedComponents found = finder.find(design, map, scratch);
  const ComponentFinder::Path path = finder.path(design, map, found, {0, 0, 0.7}, {0.02, -0.03, 1.4}, scratch);
  EXPECT_EQ(path.cells.front()[2], 0.7);
  EXPECT_EQ(path.cells.back()[2], 1.4);
  EXPECT_LE(path.corners.size(), path.cells.size());
  EXPECT_THROW(finder.path(design, map, found, {0, 0, rotation}, {0, 0, -rotation}, scratch), DesignError);
}

TEST(Components, OfADesignWithoutAFeasibleHomePoseAreFailures) {
  const auto mechanism = test::two_telescopes(1, 1.8, 1.5);
  const std::vector<double> design = test::nominal(mechanism->info());
  WorkspacePlan plan = cells_of(mechanism->info(), {50, 50, 1});
  const auto failure = [&](double x, double y) -> std::string {
    plan.home = {x, y, 0};
    try {
      test::survey(*mechanism, design, plan, {});
    } catch (const DesignError& reason) {
      return reason.what();
    }
    return "";
  };
  EXPECT_EQ(failure(0, 1.2), "");
  EXPECT_EQ(failure(0, 0.2).find("the home pose x = 0 m, y = 0.2 m is infeasible: "), 0U) << failure(0, 0.2);
  const auto wide = test::two_telescopes(.5, 1.8, 1.5);
  plan.limits = no_limits(wide->info());
  plan.home = {0, 0, 0};
  EXPECT_THROW(test::survey(*wide, test::nominal(wide->info()), plan, {}), DesignError);  // singular
}

TEST(Components, AreNoneOfIntegratedCoordinates) {
  const Mechanism& planar = *test::described("3-rpr");
  WorkspacePlan integrated = cells_of(planar.info(), {20, 20, 1});
  integrated.swept = {0, 1};
  integrated.fixed = {{.coordinate = 2, .kind = FixedCoordinate::Kind::integrated, .cells = 4}};
  integrated.home = {0.5, 0.3, 0};
  EXPECT_THROW(prepare_workspace(planar, integrated, {}), std::invalid_argument);
}

/// The order in which faces are tested, and the batches, do not matter: every face is tested by itself here.
TEST(Components, AreThoseOfAllFaces) {
  for (const std::string name : {"3-rrr", "3-rpr", "orthoglide", "five-bar"}) {
    const Mechanism& mechanism = *test::described(name);
    const std::vector<double> design = test::nominal(mechanism.info());
    const WorkspacePlan plan = test::voxels(mechanism.info(), 20);
    const VoxelMap map = voxel_map(mechanism, design, plan);
    const ConnectedComponents found = components_of(mechanism, design, plan);
    const auto sides = mechanism.voxels()->prepare_sides(plan, "");
    Scratch scratch;
    sides->start(design, scratch);
    const auto side_of_pose = [&](const Pose<double>& pose, bool feasible) {
      std::int8_t side = 0;
      sides->find({&pose, 1}, feasible, scratch, {&side, 1});
      return side;
    };
    const Sweep& sweep = sweep_of(mechanism.info(), plan);
    const std::array<std::int64_t, 3> stride = {map.cells[1] * map.cells[2], map.cells[2], 1};
    const auto pose_at = [&](std::int64_t cell, std::size_t face_axis) {
      Pose<double> pose(mechanism.info().coordinates.size());
      for (const int c : sweep.fixed) pose[static_cast<std::size_t>(c)] = fixed_value(mechanism, design, plan, c);
      for (std::size_t axis = 0; axis < sweep.swept.size(); ++axis) {
        const double step = (map.upper[axis] - map.lower[axis]) / static_cast<double>(map.cells[axis]);
        const auto k = static_cast<double>(cell / stride[axis] % map.cells[axis]);
        pose[static_cast<std::size_t>(sweep.swept[axis])] =
            map.lower[axis] + (k + (axis == face_axis ? 1 : 0.5)) * step;
      }
      return pose;
    };
    std::vector<std::size_t> parent(map.feasible.size());
    for (std::size_t i = 0; i < parent.size(); ++i) parent[i] = i;
    const auto root = [&](std::size_t i) {
      while (parent[i] != i) i = parent[i];
      return i;
    };
    std::size_t components =
        static_cast<std::size_t>(std::ranges::count_if(found.label, [](std::uint32_t label) { return label > 0; }));
    for (std::int64_t cell = 0; cell < std::ssize(map.feasible); ++cell)
      for (std::size_t axis = 0; axis < sweep.swept.size(); ++axis) {
        const std::int64_t next = cell + stride[axis];
        if (cell / stride[axis] % map.cells[axis] + 1 == map.cells[axis]) continue;
        if (map.feasible[static_cast<std::size_t>(cell)] == 0 || map.feasible[static_cast<std::size_t>(next)] == 0)
          continue;
        const std::int8_t side = side_of_pose(pose_at(cell, 3), true);
        if (side == PoseSides::kSingular || side != side_of_pose(pose_at(next, 3), true) ||
            side != side_of_pose(pose_at(cell, axis), false))
          continue;
        const std::size_t first = root(static_cast<std::size_t>(cell)), second = root(static_cast<std::size_t>(next));
        components -= first != second;
        parent[second] = first;
        EXPECT_EQ(found.label[first], found.label[second]) << name;
      }
    EXPECT_EQ(components, found.all.size()) << name;
  }
}

/// Symmetric images: accelerators may store one pose for several cells.
TEST(Components, OfAcceleratedMechanismsCountTheSameCells) {
  for (const MechanismEntry& entry : all_mechanisms()) {
    const auto mechanism = entry.get();
    const std::string name = entry.name();
    const MechanismInfo& info = mechanism->info();
    const std::vector<double> design = test::nominal(info);
    WorkspacePlan plan = test::voxels(info, 12);
    const ConnectedComponents found = components_of(*mechanism, design, plan);
    ASSERT_FALSE(found.all.empty()) << name;
    const VoxelMap map = voxel_map(*mechanism, design, plan);
    const VoxelGrid grid(map);
    std::size_t rest = found.all[0].first;
    std::array<double, 3> home{};
    for (std::size_t axis = 3; axis-- > 0; rest /= static_cast<std::size_t>(grid.cells[axis]))
      home[axis] = grid.centre(axis, static_cast<std::int64_t>(rest % static_cast<std::size_t>(grid.cells[axis])));
    plan.home = home;
    const WorkspaceResult<double> counted = test::survey(*mechanism, design, plan, {});
    const WorkspaceResult<double> sampled = test::survey(*mechanism, design, plan, {.fields = {&kConditioning}});
    EXPECT_EQ(counted.feasible_cells, found.all[0].cells) << name;
    EXPECT_EQ(sampled.feasible_cells, counted.feasible_cells) << name;
    EXPECT_EQ(sampled.weight.size(), static_cast<std::size_t>(counted.feasible_cells)) << name;
  }
}

// ---- an independent flood fill ----

/// Breadth-first search over cells whose centres are feasible and have the same signs of det G and det Jq, by
/// Mechanism::inspect(), which shares neither the batches nor the test of faces.
class FloodFill {
 public:
  std::vector<int> label;           ///< by cell: from 0; -1: none
  std::vector<std::int64_t> cells;  ///< by component

  FloodFill(const Mechanism& mechanism, const std::vector<double>& design, const WorkspacePlan& plan,
            const VoxelGrid& grid)
      : grid_(grid) {
    const MechanismInfo& info = mechanism.info();
    const Sweep& sweep = sweep_of(info, plan);
    Pose<double> pose(info.coordinates.size());
    for (const int c : sweep.fixed) pose[static_cast<std::size_t>(c)] = fixed_value(mechanism, design, plan, c);
    std::vector<int> sign(static_cast<std::size_t>(grid.count()), 0);
    for (std::size_t cell = 0; cell < sign.size(); ++cell) {
      for (std::size_t axis = 0; axis < sweep.swept.size(); ++axis)
        pose[static_cast<std::size_t>(sweep.swept[axis])] = grid.centre(axis, index(cell, axis));
      const PoseReport report = mechanism.inspect(design, pose, info.modes.front(), plan.limits);
      if (report.feasible) sign[cell] = (*report.det_G > 0) == (*report.det_Jq > 0) ? 1 : -1;
    }
    label.assign(sign.size(), -1);
    std::vector<std::size_t> wave;
    for (std::size_t start = 0; start < sign.size(); ++start) {
      if (sign[start] == 0 || label[start] >= 0) continue;
      wave = {start};
      label[start] = static_cast<int>(cells.size());
      for (std::size_t i = 0; i < wave.size(); ++i)
        for_neighbours(wave[i], [&](std::size_t other) {
          if (sign[other] != sign[start] || label[other] >= 0) return;
          label[other] = label[start];
          wave.push_back(other);
        });
      cells.push_back(static_cast<std::int64_t>(wave.size()));
    }
  }

  std::int64_t index(std::size_t cell, std::size_t axis) const {
    for (std::size_t k = 3; k-- > axis + 1;) cell /= static_cast<std::size_t>(grid_.cells[k]);
    return static_cast<std::int64_t>(cell % static_cast<std::size_t>(grid_.cells[axis]));
  }
  template <class Visit>
  void for_neighbours(std::size_t cell, const Visit& visit) const {
    Cell at = {index(cell, 0), index(cell, 1), index(cell, 2)};
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const int step : {-1, 1}) {
        at[axis] += step;
        if (at[axis] >= 0 && at[axis] < grid_.cells[axis]) visit(grid_.index(at));
        at[axis] -= step;
      }
  }
  /// Labels after all cells with a neighbour outside of their component, also a diagonal one, are removed: necks of up
  /// to two cells are cut.
  std::vector<int> eroded() const {
    std::vector<bool> kept(label.size());
    for (std::size_t cell = 0; cell < label.size(); ++cell) {
      bool inner = label[cell] >= 0;
      Cell at{};
      const Cell middle = {index(cell, 0), index(cell, 1), index(cell, 2)};
      const auto from = [&](std::size_t axis) { return std::max<std::int64_t>(middle[axis] - 1, 0); };
      const auto to = [&](std::size_t axis) { return std::min(middle[axis] + 1, grid_.cells[axis] - 1); };
      for (at[0] = from(0); at[0] <= to(0); ++at[0])
        for (at[1] = from(1); at[1] <= to(1); ++at[1])
          for (at[2] = from(2); at[2] <= to(2); ++at[2]) inner = inner && label[grid_.index(at)] == label[cell];
      kept[cell] = inner;
    }
    std::vector<int> result(label.size(), -1);
    std::vector<std::size_t> wave;
    int count = 0;
    for (std::size_t start = 0; start < label.size(); ++start) {
      if (!kept[start] || result[start] >= 0) continue;
      wave = {start};
      result[start] = count++;
      for (std::size_t i = 0; i < wave.size(); ++i)
        for_neighbours(wave[i], [&](std::size_t other) {
          if (!kept[other] || result[other] >= 0) return;
          result[other] = result[start];
          wave.push_back(other);
        });
    }
    return result;
  }

 private:
  VoxelGrid grid_;
};

/// How components of a grid differ from those of the flood fill at twice the resolution.
struct Comparison {
  int components = 0, matched = 0;
  int specks = 0;  ///< small or narrow components without a counterpart
  int necks = 0;   ///< parts that are connected in one grid only, through a neck of up to one coarse cell
  int gaps = 0;    ///< parts that are connected in one grid only, across a gap of up to one coarse cell
  int unexplained = 0;
  std::string detail;  ///< of the last one that is unexplained
};

Comparison compare(const Mechanism& mechanism, const std::vector<double>& design, WorkspacePlan plan) {
  Comparison result;
  const std::size_t axes = sweep_of(mechanism.info(), plan).swept.size();
  const std::int64_t fine_per_coarse = axes == 3 ? 8 : 4,
                     kSpeck = fine_per_coarse * fine_per_coarse;  // two coarse cells along each axis
  const VoxelMap map = voxel_map(mechanism, design, plan);
  const Box box = {{{map.lower[0], map.upper[0]}, {map.lower[1], map.upper[1]}, {map.lower[2], map.upper[2]}}};
  const VoxelGrid coarse_grid(map);
  std::array<std::int64_t, 3> twice = coarse_grid.cells;
  for (std::size_t axis = 0; axis < axes; ++axis) twice[axis] *= 2;
  const VoxelGrid fine_grid(twice, box);
  const ConnectedComponents coarse = components_of(mechanism, design, plan);
  const FloodFill fine(mechanism, design, plan, fine_grid);

  // Pairs of components that overlap.
  std::map<std::pair<int, int>, std::vector<std::size_t>> overlap;  // coarse, fine: fine cells
  std::vector<std::int64_t> feasible_parts(coarse.label.size());    // of a coarse cell
  for (std::size_t cell = 0; cell < fine.label.size(); ++cell) {
    Cell at{};
    for (std::size_t axis = 0; axis < 3; ++axis) at[axis] = fine.index(cell, axis) / (axis < axes ? 2 : 1);
    const int in = static_cast<int>(coarse.label[coarse_grid.index(at)]) - 1;
    feasible_parts[coarse_grid.index(at)] += fine.label[cell] >= 0;
    if (in >= 0 && fine.label[cell] >= 0) overlap[{in, fine.label[cell]}].push_back(cell);
  }
  // Few cells of a coarse component may lie beyond a curved singularity: an overlap counts if it is half of a
  // component.
  std::vector<std::vector<int>> fine_of(coarse.all.size()), coarse_of(fine.cells.size());
  for (const auto& [pair, cells] : overlap) {
    const auto count = static_cast<std::int64_t>(cells.size());
    const auto [c, f] = pair;
    if (2 * count < std::min(coarse.all[static_cast<std::size_t>(c)].cells * fine_per_coarse,
                             fine.cells[static_cast<std::size_t>(f)]))
      continue;
    fine_of[static_cast<std::size_t>(c)].push_back(f);
    coarse_of[static_cast<std::size_t>(f)].push_back(c);
  }
  const std::vector<int> eroded = fine.eroded();
  for (std::size_t f = 0; f < fine.cells.size(); ++f) {
    ++result.components;
    const auto& parts = coarse_of[f];
    if (parts.size() == 1 && fine_of[static_cast<std::size_t>(parts[0])].size() == 1) {
      ++result.matched;
    } else if (fine.cells[f] <= kSpeck) {
      ++result.specks;
    } else if (parts.empty()) {
      // narrower than a coarse cell everywhere
      bool has_inner_cells = false;
      for (std::size_t cell = 0; cell < eroded.size(); ++cell)
        has_inner_cells = has_inner_cells || (fine.label[cell] == static_cast<int>(f) && eroded[cell] >= 0);
      ++(has_inner_cells ? result.unexplained : result.specks);
      if (has_inner_cells) result.detail = std::to_string(fine.cells[f]) + " fine cells without a coarse component";
    } else if (parts.size() > 1) {
      // If the neck is at most one coarse cell wide, erosion separates the parts, up to a tenth of the cells: the two
      // grids need not be cut at the same place.
      std::map<int, std::map<int, std::int64_t>> cells_of_label;  // by eroded label and part
      for (const int c : parts)
        for (const std::size_t cell : overlap[{c, static_cast<int>(f)}])
          if (eroded[cell] >= 0) ++cells_of_label[eroded[cell]][c];
      const bool is_cut = std::ranges::all_of(cells_of_label, [](const auto& each) {
        std::int64_t all = 0, largest = 0;
        for (const auto& [part, count] : each.second) {
          all += count;
          largest = std::max(largest, count);
        }
        return 10 * largest >= 9 * all;
      });
      ++(is_cut ? result.necks : result.unexplained);
      if (!is_cut) result.detail = std::to_string(parts.size()) + " coarse components in one fine one";
    } else {
      // One coarse component covers several fine ones: they are at most two fine cells apart.
      ++result.gaps;
    }
  }
  for (std::size_t c = 0; c < coarse.all.size(); ++c)
    if (fine_of[c].empty()) {
      bool has_whole_cells = false;  // else it is narrower than a coarse cell everywhere
      for (std::size_t cell = 0; cell < coarse.label.size(); ++cell)
        has_whole_cells = has_whole_cells || (coarse.label[cell] == c + 1 && feasible_parts[cell] == fine_per_coarse);
      const bool is_explained = coarse.all[c].cells * fine_per_coarse <= kSpeck || !has_whole_cells;
      ++(is_explained ? result.specks : result.unexplained);
      if (!is_explained) result.detail = std::to_string(coarse.all[c].cells) + " coarse cells without a fine component";
    }
  return result;
}

/// PKM_COMPONENT_DESIGNS: number of random designs (tests/campaigns/run.sh: 200).
TEST(Components, OfRandomDesignsAgreeWithAnIndependentFloodFill) {
  const char* const given = std::getenv("PKM_COMPONENT_DESIGNS");
  const std::size_t count = given ? std::strtoul(given, nullptr, 10) : 6;
  const std::vector<std::pair<std::string, std::vector<int>>> robots = {
      {"five-bar", {0, 1}},      {"3-rpr", {0, 1}},           {"3-rrr", {0, 1}},
      {"orthoglide", {0, 1, 2}}, {"linear-delta", {0, 1, 2}}, {"rotary-delta", {0, 1, 2}}};
  Comparison sum;
  std::size_t designs = 0, agree = 0;
  for (std::uint64_t seed = 0; designs < count; ++seed) {
    const auto& [name, swept] = robots[designs % robots.size()];
    const Mechanism& mechanism = *test::described(name);
    const MechanismInfo& info = mechanism.info();
    Stream random(seed, 0, 0, Stream::Use::start);
    std::vector<double> design;
    for (const Parameter& p : info.parameters)
      design.push_back(std::clamp(p.nominal * (0.5 + random.u01()), p.lower, p.upper));
    if (mechanism.refuse(design)) continue;
    WorkspacePlan plan = swept.size() == 3 ? cells_of(info, {14, 14, 14}) : cells_of(info, {40, 40, 1});
    plan.swept = swept;
    Comparison found;
    try {
      found = compare(mechanism, design, plan);
    } catch (const DesignError&) {
      continue;
    }
    ++designs;
    agree += found.necks + found.gaps + found.unexplained == 0;
    EXPECT_EQ(found.unexplained, 0) << name << ", seed " << seed << ": " << found.detail;
    sum.components += found.components;
    sum.matched += found.matched;
    sum.specks += found.specks;
    sum.necks += found.necks;
    sum.gaps += found.gaps;
    sum.unexplained += found.unexplained;
  }
  std::printf(
      "%zu designs, %zu with the same components except specks; %d components, %d the same, %d specks, %d necks, "
      "%d gaps, %d unexplained\n",
      designs, agree, sum.components, sum.matched, sum.specks, sum.necks, sum.gaps, sum.unexplained);
  EXPECT_GE(agree, designs / 2);
}

TEST(Components, DoNotDependOnThreads) {
  const Mechanism& delta = *test::described("rotary-delta");
  const std::vector<double> design = test::nominal(delta.info());
  WorkspacePlan plan = test::voxels(delta.info(), 24);
  plan.home = {0, 0, -0.5};
  const WorkspaceResult<double> serial = test::survey(delta, design, plan, {.fields = {&kConditioning}});
  with_team(2, [&] {
    const WorkspaceResult<double> parallel = test::survey(delta, design, plan, {.fields = {&kConditioning}});
    EXPECT_EQ(parallel.feasible_cells, serial.feasible_cells);
    EXPECT_EQ(parallel.field(kConditioning), serial.field(kConditioning));
  });
}

}  // namespace
}  // namespace pkm
