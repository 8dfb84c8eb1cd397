// Workspaces that lie between the places where exact columns of files are looked at first.
#include <gtest/gtest.h>

#include "tests/unit/accelerators/papers.hpp"

namespace pkm {
namespace {

const Mechanism& file() { return *test::described("4ppa-2par"); }

WorkspacePlan over_x_y_z() {
  for (const Sweep& sweep : file().info().sweeps)
    if (sweep.swept == std::vector{0, 1, 2}) return test::columns(file().info(), sweep);
  throw std::logic_error("no sweep of x, y, z");
}

/// Rails that are nearly too far apart leave a plate between them, of 6 % to 0.6 % of the default design's volume and
/// narrower than what lies between places over the whole range of x; over a part of it they are near enough.
TEST(Slivers, OfOneCoordinateAreFound) {
  const WorkspacePlan plan = over_x_y_z();
  for (const double b : {1.28, 1.29, 1.298}) {
    SCOPED_TRACE(b);
    const std::vector<double> plate = test::design_with(file().info(), {{"b", b}});
    const Box ranges = {{{b / 2 - 0.05, b / 2 + 0.05}, {0, 2.5}, {-1.3, -0.15}}};
    WorkspacePlan near = plan;
    near.method = ColumnOptions{.box = ranges};
    const WorkspaceResult<double> found = test::survey(file(), plate, plan), known = test::survey(file(), plate, near);
    EXPECT_GT(known.volume, 1e-3);
    EXPECT_NEAR(found.volume / known.volume, 1, 1e-9);
    EXPECT_LT(found.error, 1e-9);
  }
}

TEST(Slivers, ThatAreNoneAreKnownToBeEmpty) {
  const WorkspacePlan plan = over_x_y_z();
  const WorkspaceResult<double> none = test::survey(file(), test::design_with(file().info(), {{"b", 1.31}}), plan);
  EXPECT_EQ(none.volume, 0);
  EXPECT_EQ(none.error, 0);
  // rods that just meet: nothing is feasible, but for rounding, which is told
  const WorkspaceResult<double> touching = test::survey(file(), test::design_with(file().info(), {{"b", 1.3}}), plan);
  EXPECT_EQ(touching.volume, 0);
  EXPECT_EQ(touching.error, 1);
}

/// Two that are mirrored: where one was met the other was not.
TEST(Slivers, ComeInPairs) {
  const Mechanism& own =
      **std::ranges::find_if(all_mechanisms(), [](const auto& m) { return m.name() == "4ppa-2par"; });
  const nlohmann::json given = {{"a", 0.29710194724233574},   {"b", 0.52894902633984631}, {"l_u", 0.88508452757584388},
                                {"l_d", 0.86644234746446269}, {"d", 0.10830526500872935}, {"L0", 3.6}};
  const nlohmann::json limits = {
      {"beta_min", 0.23651650267154137}, {"sin_par_min", 0.15489858746281404}, {"cos_theta_min", 0.34351769545015187}};
  const auto survey = [&](const Mechanism& mechanism) {
    WorkspacePlan plan = test::columns(mechanism.info());
    plan.limits = test::limits_with(mechanism.info(), limits);
    plan.fixed = {{1, FixedCoordinate::Kind::value, 1.52}};
    return test::survey(mechanism, test::design_with(mechanism.info(), given), plan);
  };
  const WorkspaceResult<double> mine = survey(file()), theirs = survey(own);
  EXPECT_GT(theirs.volume, 1e-3);
  EXPECT_NEAR(mine.volume / theirs.volume, 1, 1e-9);
}

/// Three that are small and far apart, in a box 500 000 times as large as they are together: two were met at first.
TEST(Slivers, HaveOthersBesideThem) {
  const Mechanism& gough = *test::described("gough");
  const std::vector<double> design = test::design_with(
      gough.info(), {{"R", 1.1109118008988916}, {"a_b", 0.15183758923947538}, {"a_p", 0.87266462599716477}});
  WorkspacePlan plan;
  for (const Sweep& sweep : gough.info().sweeps)
    if (sweep.swept == std::vector{0, 3, 5}) plan = test::columns(gough.info(), sweep);
  ASSERT_FALSE(plan.fixed.empty());
  const WorkspaceResult<double> whole = test::survey(gough, design, plan);
  EXPECT_LT(whole.error, 1e-8);
  double sum = 0, off = 1e-8 * whole.volume;
  for (const auto& alpha : {std::array{-kPi / 2, -1.0}, {-1.0, 1.0}, {1.0, kPi / 2}}) {
    WorkspacePlan part = plan;
    part.method = ColumnOptions{.box = Box{{{-1.8, 1.8}, alpha, {-kPi, kPi}}}};
    const WorkspaceResult<double> found = test::survey(gough, design, part);
    EXPECT_GT(found.volume, 3e-5);
    EXPECT_LT(found.error, 1e-2);
    sum += found.volume;
    off += found.error * found.volume;
  }
  EXPECT_NEAR(whole.volume, sum, off);
}

}  // namespace
}  // namespace pkm
