// Search boxes of mechanism files without [survey] box: they contain the workspace, and are hardly larger.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "engine/core/error.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "engine/workspace/voxel_grid.hpp"
#include "tests/unit/contracts/mechanism_fixtures.hpp"
#include "tests/unit/generic/files.hpp"

namespace pkm::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// All mechanism files of the project and of users.
std::vector<std::string> robot_files() {
  std::vector<std::string> all;
  for (const std::string& folder : {kMechanismFolder, std::string(PKM_TEST_DATA "/robots/")})
    for (const auto& entry : fs::recursive_directory_iterator(folder))
      if (entry.path().extension() == ".toml" && text_of_file(entry.path()).find("\n[platform]") != std::string::npos)
        all.push_back(entry.path());
  std::ranges::sort(all);
  return all;
}

std::string without_box(const std::string& text) {
  static const std::regex line("(^|\n)box *= *\\{[^\n]*\\}(?=\n)"), table("\\[survey\\.box\\]\n([^\\[\n][^\n]*\n)*");
  return std::regex_replace(std::regex_replace(text, line, "$1"), table, "");
}

/// Cells of the default sweep in a box; without one, in the default box of the design.
WorkspacePlan cells_in(const Mechanism& mechanism, const std::optional<Box>& box, std::int64_t count) {
  VoxelOptions options{.cells = {1, 1, 1}, .box = box};
  const Sweep& sweep = mechanism.info().sweeps.front();
  for (std::size_t axis = 0; axis < sweep.swept.size(); ++axis) options.cells[axis] = count;
  return {.method = options, .swept = sweep.swept, .fixed = {}, .limits = no_limits(mechanism.info())};
}

/// Range of the feasible cells along each axis; std::nullopt if there are none.
std::optional<Box> extent_of(const VoxelMap& map) {
  const VoxelGrid grid(map);
  std::optional<Box> extent;
  Cell cell;
  for (cell[0] = 0; cell[0] < grid.cells[0]; ++cell[0])
    for (cell[1] = 0; cell[1] < grid.cells[1]; ++cell[1])
      for (cell[2] = 0; cell[2] < grid.cells[2]; ++cell[2]) {
        if (!map.feasible[grid.index(cell)]) continue;
        if (!extent) extent.emplace().fill({1e300, -1e300});
        for (std::size_t i = 0; i < 3; ++i) {
          const double centre = grid.centre(i, cell[i]);
          (*extent)[i] = {std::fmin((*extent)[i][0], centre - grid.step[i] / 2),
                          std::fmax((*extent)[i][1], centre + grid.step[i] / 2)};
        }
      }
  return extent;
}

TEST(ContractedBox, ContainsTheWorkspaceAndIsHardlyLarger) {
  // Cables without limits of their lengths hang down as far as one likes; the planes of the Exechon's legs rotate with
  // the platform, so that intervals do not decide their lengths.
  const std::vector<std::string> unbounded = {"cogiro", "ipanema", "eight-cables", "exechon"};
  // Intervals do not decide the twist of the platform of the 3-PRS in a full rotation, and few poses of the
  // parallelograms of H4 and Par4 near the axes of their cranks. Krawczyk's test does not decide large boxes of the
  // 3-PRC, so that its box is that of the reach of its limbs.
  const std::vector<std::string> loose = {"3-prc", "3-prs", "3-prs-solved", "h4", "par4"};
  for (const std::string& file : robot_files()) {
    SCOPED_TRACE(file);
    const std::string name = fs::path(file).stem(), text = text_of_file(file);
    if (name == "3-prs-across") continue;  // an invalid file
    const auto mechanism = read_mechanism_toml(without_box(text), file);
    const MechanismInfo& info = mechanism->info();
    const std::vector<double> design = nominal(info);
    if (contains(unbounded, name)) {
      EXPECT_THROW(voxel_map(*mechanism, design, cells_in(*mechanism, {}, 2)), DesignError);
      continue;
    }
    const VoxelMap map = voxel_map(*mechanism, design, cells_in(*mechanism, {}, 40));
    const auto extent = extent_of(map);
    ASSERT_TRUE(extent);
    Box wide;
    wide.fill({0, 1});
    for (std::size_t axis = 0; axis < info.sweeps.front().swept.size(); ++axis) {
      const AxisInfo& coordinate = info.coordinates[static_cast<std::size_t>(info.sweeps.front().swept[axis])];
      SCOPED_TRACE(coordinate.name);
      const double width = map.upper[axis] - map.lower[axis];
      EXPECT_LE(width, (contains(loose, name) ? 4.1 : 1.5) * ((*extent)[axis][1] - (*extent)[axis][0]));
      wide[axis] = {map.lower[axis] - 1.03 * width, map.upper[axis] + 0.97 * width};
      if (coordinate.turns()) wide[axis] = {std::fmax(wide[axis][0], -kPi), std::fmin(wide[axis][1], kPi)};
    }
    const auto outside = extent_of(voxel_map(*mechanism, design, cells_in(*mechanism, wide, 40)));
    ASSERT_TRUE(outside);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double half = (wide[axis][1] - wide[axis][0]) / 80;  // the centres of cells are feasible, not their ends
      EXPECT_GE((*outside)[axis][0] + half, map.lower[axis]);
      EXPECT_LE((*outside)[axis][1] - half, map.upper[axis]);
    }
  }
}

TEST(ContractedBox, FollowsTheDesignAndTheFixedCoordinates) {
  const auto delta = read_mechanism_toml(without_box(text_of_mechanism("rotary-delta")), "delta.toml");
  std::vector<double> design = nominal(delta->info());
  const auto height = [&](const std::vector<double>& of) {
    const VoxelMap map = voxel_map(*delta, of, cells_in(*delta, {}, 2));
    return map.upper[2] - map.lower[2];
  };
  const double whole = height(design);
  for (std::size_t i = 0; i < design.size(); ++i)
    if (delta->info().parameters[i].unit == "m") design[i] /= 2;
  EXPECT_NEAR(height(design), whole / 2, 0.03 * whole);

  const auto gough = read_mechanism_toml(without_box(text_of_mechanism("gough")), "gough.toml");
  WorkspacePlan plan = cells_in(*gough, {}, 2);
  const VoxelMap level = voxel_map(*gough, nominal(gough->info()), plan);
  plan.fixed = {{.coordinate = 4, .kind = FixedCoordinate::Kind::value, .value = 0.3}};
  const VoxelMap tilted = voxel_map(*gough, nominal(gough->info()), plan);
  EXPECT_NE(level.upper[0], tilted.upper[0]);
}

/// The volume is that of a file with a box, and so are its derivatives, because the box contains the whole workspace.
TEST(ContractedBox, DoesNotChangeExactVolumes) {
  for (const char* const name : {"rotary-delta", "gough", "3-rpr"}) {
    SCOPED_TRACE(name);
    const std::string text = text_of_mechanism(name);
    const auto with = read_mechanism_toml(text, "with.toml"),
               without = read_mechanism_toml(without_box(text), "no.toml");
    const auto volume = [](const Mechanism& mechanism) {
      std::vector<Dual4> design;
      for (const double value : nominal(mechanism.info())) design.emplace_back(value);
      for (int k = 0; k < 4; ++k) design[static_cast<std::size_t>(k)].v[k] = 1;
      const auto evaluator = prepare_workspace(mechanism, columns(mechanism.info()), {});
      WorkspaceResult<Dual4> result;
      evaluate_once<Dual4>(*evaluator, design, result);
      return result.volume;
    };
    const Dual4 expected = volume(*with), found = volume(*without);
    EXPECT_NEAR(found.a, expected.a, 1e-6 * expected.a);
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(found.v[k], expected.v[k], 1e-4 * std::fabs(expected.v[k]) + 1e-9) << k;
  }
}

TEST(ContractedBox, UnboundedCoordinatesAreNamed) {
  const auto cogiro =
      read_mechanism_toml(without_box(text_of_file(kMechanismFolder + "cables/cogiro.toml")), "cogiro.toml");
  const WorkspacePlan plan = cells_in(*cogiro, {}, 2);
  try {
    voxel_map(*cogiro, nominal(cogiro->info()), plan);
    ADD_FAILURE();
  } catch (const DesignError& error) {
    EXPECT_THAT(error.what(), HasSubstr("its limbs do not bound it; give [survey] box = { "));
    EXPECT_THAT(error.what(), HasSubstr("`range`"));
  }
}

}  // namespace
}  // namespace pkm::test
