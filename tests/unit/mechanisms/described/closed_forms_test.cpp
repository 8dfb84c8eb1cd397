// Surveys of the papers' mechanisms: the closed forms of the built-in ones against the engine for any mechanism on
// their files, for random designs and limits, whichever coordinate is held and however. PKM_PAPER_DESIGNS: how many
// designs have their volumes compared for each held coordinate.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <iostream>

#include "engine/math/statistics.hpp"
#include "tests/unit/mechanisms/described/papers.hpp"

namespace pkm {
namespace {

class ClosedForms : public test::PaperPair {
 protected:
  using Kind = HeldCoordinate::Kind;
  struct Case {
    std::vector<double> design;
    SurveyPlan own, file;
  };

  /// Random designs for every coordinate that surveys hold: beside its middle, or integrated over. Every other one has
  /// limits.
  std::vector<Case> cases(std::size_t designs, std::uint64_t seed) const {
    std::vector<Case> all;
    Stream random(seed, 0, 0, Stream::Use::start);
    for (const Sweep& sweep : own().info().sweeps)
      for (const Kind kind : {Kind::value, Kind::integrated}) {
        if (kind == Kind::integrated && !sweep.integrates) continue;
        for (std::size_t i = 0; i < designs; ++i) {
          Case one{test::random_design(own().info(), random), test::columns(own().info(), sweep), {}};
          const int coordinate = sweep.held.front();
          const auto [lower, upper] = (*file().ranges(of_file(one.design)))[static_cast<std::size_t>(coordinate)];
          one.own.held = {{coordinate, kind, lower + (0.4 + 0.2 * random.u01()) * (upper - lower)}};
          const LimitSpec limits = test::random_limits(own().info(), random);
          if (i % 2 == 1) one.own.limits = limits;
          one.file = one.own;
          one.file.limits = of_file(one.own.limits);
          all.push_back(one);
        }
      }
    return all;
  }

  std::string words(const Case& one) const { return test::told(own().info(), one.design, one.own); }
};

/// With derivatives along four directions of all parameters, of which the generic engine now and then has fewer digits.
/// What is less than 1e-7 of the default design's volume, closed forms overlook now and then: they compare finitely
/// many places, too.
TEST_P(ClosedForms, HaveTheSameVolumesAndSlopes) {
  const char* const asked = std::getenv("PKM_PAPER_DESIGNS");
  const std::size_t usual = own().info().sweeps.size() > 1 ? 2 : 40,
                    designs = asked ? static_cast<std::size_t>(std::atoi(asked)) : usual;
  Stream random(23, 0, 0, Stream::Use::start);
  Survey<Dual4> mine, theirs;
  int compared = 0, rough = 0;
  for (const Case& one : cases(designs, 21)) {
    SCOPED_TRACE(words(one));
    if (one.own.held.front().kind == Kind::integrated) continue;  // files take seconds; cells are compared below
    std::vector<Dual4> moving, of_file;
    for (const double p : one.design) {
      moving.emplace_back(p);
      for (int k = 0; k < 4; ++k) moving.back().v[k] = (2 * random.u01() - 1) * p;
    }
    for (const Parameter& p : file().info().parameters)
      of_file.push_back(moving[static_cast<std::size_t>(find_named(own().info().parameters, p.name) -
                                                        own().info().parameters.data())]);
    survey_once<Dual4>(*prepare_survey(own(), one.own, {}), moving, theirs);
    SurveyPlan unlimited = one.own;
    unlimited.limits = no_limits(own().info());
    const double volume = theirs.volume.a;
    const double least = 1e-7 * test::survey(own(), test::nominal(own().info()), unlimited).volume;
    survey_once<Dual4>(*prepare_survey(file(), one.file, {}), of_file, mine);
    if (volume < least) {
      EXPECT_LT(mine.volume.a, least);
      EXPECT_TRUE(mine.volume.a > 0 || volume == 0 || mine.error >= 1);
      continue;
    }
    const double apart = 1e-7 + mine.error + theirs.error;
    EXPECT_NEAR(mine.volume.a, volume, apart * volume + 1e-12);
    double of_slopes = 0;
    for (int k = 0; k < 4; ++k)
      of_slopes = std::max(of_slopes, std::fabs(mine.volume.v[k] - theirs.volume.v[k]) /
                                          (volume + std::fabs(theirs.volume.v[k]) + 1e-11 / apart));
    EXPECT_LT(of_slopes, 1e-3);
    rough += of_slopes > 10 * apart;
    ++compared;
  }
  EXPECT_GE(compared, 3);
  EXPECT_LE(rough, compared / 30);
  if (asked) std::cerr << GetParam() << ": " << compared << " compared, slopes of " << rough << " have fewer digits\n";
}

TEST_P(ClosedForms, HaveTheSameCells) {
  std::int64_t cells = 0;
  for (Case& one : cases(own().info().sweeps.size() > 1 ? 4 : 60, 22)) {
    SCOPED_TRACE(words(one));
    VoxelOptions voxels{.cells = {9, 8, 11}, .box = Box{}};
    const Sweep& sweep = sweep_of(own().info(), one.own);
    const auto ranges = *file().ranges(of_file(one.design));
    for (std::size_t axis = 0; axis < 3; ++axis)
      (*voxels.box)[axis] = ranges[static_cast<std::size_t>(sweep.swept[axis])];
    for (SurveyPlan* const plan : {&one.own, &one.file}) {
      plan->method = voxels;
      plan->held.front().cells = 5;
    }
    Demand demand;
    if (GetParam() != "2t1r-p-hybrid") demand.fields = {&kConditioning, &kCouplingIndex};
    const Survey<double> mine = test::survey(file(), of_file(one.design), one.file, demand),
                         theirs = test::survey(own(), one.design, one.own, demand);
    EXPECT_NEAR(mine.volume, theirs.volume, 1e-12 * theirs.volume);
    EXPECT_EQ(mine.touches_box, theirs.touches_box);
    for (const PoseQuantity* const quantity : demand.fields)
      for (std::size_t i = 0; i < (quantity->per_joint ? 4 : 1); ++i) {
        const auto &here = mine.of(*quantity, i), &there = theirs.of(*quantity, i);
        EXPECT_NEAR(weighted_mean(mine.weight, here), weighted_mean(theirs.weight, there), 1e-9) << quantity->name;
        EXPECT_NEAR(weighted_deviation(mine.weight, here), weighted_deviation(theirs.weight, there), 1e-7);
      }
    if (one.own.held.front().kind == Kind::integrated) continue;  // the hybrid's carriage has its stroke in any case
    EXPECT_TRUE(voxel_map(file(), of_file(one.design), one.file).feasible ==
                voxel_map(own(), one.design, one.own).feasible);
    EXPECT_EQ(mine.feasible_cells, theirs.feasible_cells);
    cells += theirs.feasible_cells;
  }
  EXPECT_GT(cells, 100);
}

/// At nodes of their own: as near as their rules come to the integrals.
TEST_P(ClosedForms, HaveTheSameSamples) {
  if (!own().dynamics()) GTEST_SKIP() << "its conditioning leaves the carriage out";
  int compared = 0;
  for (Case& one : cases(1, 24)) {
    if (one.own.held.front().kind == Kind::integrated) continue;  // seconds
    SCOPED_TRACE(words(one));
    for (SurveyPlan* const plan : {&one.own, &one.file}) plan->method = ColumnOptions{.nodes = {12, 12}};
    for (const PoseQuantity* const quantity : {&kConditioning, &kCouplingIndex}) {
      const Survey<double> mine = test::survey(file(), of_file(one.design), one.file, {.fields = {quantity}}),
                           theirs = test::survey(own(), one.design, one.own, {.fields = {quantity}});
      ASSERT_GT(theirs.volume, 0);
      for (std::size_t i = 0; i < (quantity->per_joint ? 4 : 1); ++i, ++compared) {
        const auto &here = mine.of(*quantity, i), &there = theirs.of(*quantity, i);
        EXPECT_NEAR(weighted_mean(mine.weight, here), weighted_mean(theirs.weight, there), 4e-3) << quantity->name;
        EXPECT_NEAR(weighted_deviation(mine.weight, here), weighted_deviation(theirs.weight, there), 5e-3);
      }
    }
  }
  EXPECT_GE(compared, 5);
}

INSTANTIATE_TEST_SUITE_P(All, ClosedForms, test::kPapers, [](const auto& name) { return test::test_name(name.param); });

}  // namespace
}  // namespace pkm
