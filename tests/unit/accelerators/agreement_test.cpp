// Workspace analyses of the papers' mechanisms: accelerators against the generic engine, for random designs and limits,
// whichever coordinate is fixed and however. PKM_PAPER_DESIGNS: how many designs have their volumes compared for each
// fixed coordinate.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <iostream>

#include "engine/math/statistics.hpp"
#include "tests/unit/accelerators/papers.hpp"

namespace pkm {
namespace {

class ClosedForms : public test::PaperPair {
 protected:
  using Kind = FixedCoordinate::Kind;
  struct Case {
    std::vector<double> design;
    WorkspacePlan plan;
  };

  /// Random designs for every coordinate that surveys hold: beside its middle, or integrated over. Every other one has
  /// limits.
  std::vector<Case> cases(std::size_t designs, std::uint64_t seed) const {
    std::vector<Case> all;
    Stream random(seed, 0, 0, Stream::Use::start);
    const bool any_coordinate = GetParam() == "3crr-r-cru" || GetParam() == "quadrupteron";
    const auto& sweeps = accelerated().info().sweeps;
    for (const Sweep& sweep : std::span(sweeps).first(any_coordinate ? 4 : 1))
      for (const Kind kind : {Kind::value, Kind::integrated}) {
        if (kind == Kind::integrated && any_coordinate) continue;  // no accelerator
        for (std::size_t i = 0; i < designs; ++i) {
          Case one{test::random_design(accelerated().info(), random), test::columns(accelerated().info(), sweep)};
          const int coordinate = sweep.fixed.front();
          const auto [lower, upper] = (*generic().ranges(one.design))[static_cast<std::size_t>(coordinate)];
          one.plan.fixed = {{coordinate, kind, lower + (0.4 + 0.2 * random.u01()) * (upper - lower)}};
          const LimitSpec limits = test::random_limits(accelerated().info(), random);
          if (i % 2 == 1) one.plan.limits = limits;
          all.push_back(one);
        }
      }
    return all;
  }

  std::string words(const Case& one) const { return test::told(accelerated().info(), one.design, one.plan); }
};

/// With derivatives along four directions of all parameters, of which the generic engine now and then has fewer digits.
/// What is less than 1e-7 of the default design's volume, closed forms overlook now and then: they compare finitely
/// many places, too.
TEST_P(ClosedForms, HaveTheSameVolumesAndSlopes) {
  const char* const asked = std::getenv("PKM_PAPER_DESIGNS");
  const std::size_t usual = accelerated().dynamics() && GetParam() != "4ppa-2par" ? 2 : 40,
                    designs = asked ? static_cast<std::size_t>(std::atoi(asked)) : usual;
  Stream random(23, 0, 0, Stream::Use::start);
  WorkspaceResult<Dual4> mine, theirs;
  int compared = 0, rough = 0;
  for (const Case& one : cases(designs, 21)) {
    SCOPED_TRACE(words(one));
    if (one.plan.fixed.front().kind == Kind::integrated) continue;  // files take seconds; cells are compared below
    std::vector<Dual4> moving;
    for (const double p : one.design) {
      moving.emplace_back(p);
      for (int k = 0; k < 4; ++k) moving.back().v[k] = (2 * random.u01() - 1) * p;
    }
    evaluate_once<Dual4>(*prepare_workspace(accelerated(), one.plan, {}), moving, theirs);
    WorkspacePlan unlimited = one.plan;
    unlimited.limits = no_limits(accelerated().info());
    const double volume = theirs.volume.a;
    const double least = 1e-7 * test::survey(accelerated(), test::nominal(accelerated().info()), unlimited).volume;
    evaluate_once<Dual4>(*prepare_workspace(generic(), one.plan, {}), moving, mine);
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
  for (Case& one : cases(accelerated().dynamics() && GetParam() != "4ppa-2par" ? 4 : 60, 22)) {
    SCOPED_TRACE(words(one));
    VoxelOptions voxels{.cells = {9, 8, 11}, .box = Box{}};
    const Sweep& sweep = sweep_of(accelerated().info(), one.plan);
    const auto ranges = *generic().ranges(one.design);
    for (std::size_t axis = 0; axis < 3; ++axis)
      (*voxels.box)[axis] = ranges[static_cast<std::size_t>(sweep.swept[axis])];
    one.plan.method = voxels;
    one.plan.fixed.front().cells = 5;
    FieldRequest request;
    request.fields = {&kConditioning};
    if (accelerated().dynamics()) request.fields.push_back(&kCouplingIndex);
    const WorkspaceResult<double> mine = test::survey(generic(), one.design, one.plan, request),
                                  theirs = test::survey(accelerated(), one.design, one.plan, request);
    EXPECT_NEAR(mine.volume, theirs.volume, 1e-12 * theirs.volume);
    EXPECT_EQ(mine.touches_box, theirs.touches_box);
    for (const PoseQuantity* const quantity : request.fields)
      for (std::size_t i = 0; i < (quantity->per_joint ? 4 : 1); ++i) {
        const auto &here = mine.field(*quantity, i), &there = theirs.field(*quantity, i);
        EXPECT_NEAR(weighted_mean(mine.weight, here), weighted_mean(theirs.weight, there), 1e-9) << quantity->name;
        EXPECT_NEAR(weighted_standard_deviation(mine.weight, here), weighted_standard_deviation(theirs.weight, there),
                    1e-7);
      }
    if (one.plan.fixed.front().kind == Kind::integrated) continue;  // the hybrid's carriage has its stroke in any case
    EXPECT_TRUE(voxel_map(generic(), one.design, one.plan).feasible ==
                voxel_map(accelerated(), one.design, one.plan).feasible);
    EXPECT_EQ(mine.feasible_cells, theirs.feasible_cells);
    cells += theirs.feasible_cells;
  }
  EXPECT_GT(cells, 100);
}

/// At nodes of their own: as near as their rules come to the integrals.
TEST_P(ClosedForms, HaveTheSameSamples) {
  int compared = 0;
  for (Case& one : cases(1, 24)) {
    if (one.plan.fixed.front().kind == Kind::integrated) continue;  // seconds
    SCOPED_TRACE(words(one));
    one.plan.method = ColumnOptions{.nodes = {12, 12}};
    for (const PoseQuantity* const quantity : {&kConditioning, &kCouplingIndex}) {
      if (quantity->needs_inertia() && !accelerated().dynamics()) continue;
      const WorkspaceResult<double> mine = test::survey(generic(), one.design, one.plan, {.fields = {quantity}}),
                                    theirs = test::survey(accelerated(), one.design, one.plan, {.fields = {quantity}});
      ASSERT_GT(theirs.volume, 0);
      for (std::size_t i = 0; i < (quantity->per_joint ? 4 : 1); ++i, ++compared) {
        const auto &here = mine.field(*quantity, i), &there = theirs.field(*quantity, i);
        EXPECT_NEAR(weighted_mean(mine.weight, here), weighted_mean(theirs.weight, there), 4e-3) << quantity->name;
        EXPECT_NEAR(weighted_standard_deviation(mine.weight, here), weighted_standard_deviation(theirs.weight, there),
                    5e-3);
      }
    }
  }
  EXPECT_GE(compared, accelerated().dynamics() ? 5 : 1);
}

INSTANTIATE_TEST_SUITE_P(All, ClosedForms, test::kPapers, [](const auto& name) { return test::test_name(name.param); });

}  // namespace
}  // namespace pkm
