// Exact volumes of mechanisms from files against bounds that rounding cannot make wrong: random designs, sweeps, limits
// and fixed values. PKM_BOUNDED_DESIGNS: how many designs of each mechanism, to a gap of 2e-2 or the bounds of 200 000
// boxes; PKM_BOUNDED_FIRST: the number of the first one, to see a finding again.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <iostream>

#include "tests/unit/contracts/catalogue_problem.hpp"

namespace pkm {
namespace {

class BoundedColumns : public ::testing::TestWithParam<std::string> {
 protected:
  const Mechanism& file() const { return *test::described(GetParam()); }
  const MechanismInfo& info() const { return file().info(); }

  /// The usual sweep, and others.
  std::vector<WorkspacePlan> plans() const {
    constexpr std::size_t kOthers = 8;
    std::vector<WorkspacePlan> all;
    for (std::size_t i = 0; i < info().sweeps.size() && i <= kOthers; ++i)
      all.push_back(test::columns(info(), info().sweeps[i]));
    return all;
  }

  /// Half of the designs have round numbers, which meet each other.
  std::vector<double> design(bool round, Stream& random) const {
    std::vector<double> design = test::random_design(info(), random);
    for (std::size_t i = 0; i < design.size(); ++i)
      if (random.chance(0.5) && round) design[i] = info().parameters[i].nominal;
    return design;
  }

  /// Beside the middle of what is fixed.
  void hold(const std::vector<double>& design, WorkspacePlan& plan, Stream& random) const {
    for (FixedCoordinate& fixed : plan.fixed)
      fixed = {fixed.coordinate, FixedCoordinate::Kind::value,
               *file().default_value(design, fixed.coordinate) + 0.3 * (2 * random.u01() - 1)};
  }
};

TEST_P(BoundedColumns, LieWithinTheBounds) {
  const char* const asked = std::getenv("PKM_BOUNDED_DESIGNS");
  const unsigned designs = asked ? static_cast<unsigned>(std::atoi(asked)) : 25;
  const std::vector<WorkspacePlan> all = plans();
  unsigned compared = 0, wrong = 0, vague = 0, wide = 0;
  const auto start = std::chrono::steady_clock::now();
  const auto tell = [&] {
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    std::cerr << '\r' << GetParam() << ": " << compared << " of " << designs << " designs, " << wrong << " outside, "
              << wide << " wide, " << std::lround(seconds.count()) << " s   " << std::flush;
  };
  const char* const begin = std::getenv("PKM_BOUNDED_FIRST");
  const unsigned first = begin ? static_cast<unsigned>(std::atoi(begin)) : 0;
  for (unsigned k = first; compared < designs && k < first + 40 * designs; ++k) {
    Stream random(19, 0, k, Stream::Use::start);
    WorkspacePlan plan = all[k % 2 == 0 ? 0 : random.below(all.size())];
    const std::vector<double> p = design(k % 4 >= 2, random);
    if (k % 3 > 0) plan.limits = test::random_limits(info(), random);
    if (k % 3 > 1) hold(p, plan, random);
    if (file().refuse(p)) continue;
    const WorkspaceResult<double> exact = test::survey(file(), p, plan);
    // those without a workspace are quick to bound, and say little
    if (!(exact.volume > 0) && k % 8 > 0) continue;
    SCOPED_TRACE("design " + std::to_string(k) + ": " + test::told(info(), p, plan));
    const VolumeBounds bounds =
        file().bounds()->volume(p, plan, "", {.gap = 0.02, .max_boxes = asked ? 200'000U : 300U});
    const double off = (exact.error + 1e-9) * exact.volume;
    const bool holds = bounds.lower <= exact.volume + off && bounds.upper >= exact.volume - off;
    EXPECT_TRUE(holds) << bounds.lower << ' ' << exact.volume << ' ' << bounds.upper << ", error " << exact.error;
    ++compared;
    wrong += !holds;
    vague += exact.error > 1e-6;
    wide += bounds.gap() > 0.02;
    if (asked) tell();
  }
  if (asked) std::cerr << '\n';
  EXPECT_EQ(compared, designs);
  EXPECT_LE(vague, 1 + designs / 10);
  std::cout << GetParam() << ": " << compared << " volumes of " << all.size() << " sweeps, " << wrong
            << " outside of their bounds; error estimates above 1e-6: " << vague << ", gaps above 2e-2: " << wide
            << '\n';
}

INSTANTIATE_TEST_SUITE_P(All, BoundedColumns,
                         ::testing::Values("3-rpr", "3-rrr", "five-bar", "linear-delta", "orthoglide", "gough",
                                           "4ppa-2par", "3crr-r-cru", "quadrupteron", "2t1r-p-hybrid"),
                         [](const auto& name) { return test::test_name(name.param); });

}  // namespace
}  // namespace pkm
