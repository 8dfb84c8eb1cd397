// Exact volumes of mechanism files against certified bounds and against voxels, an independent quadrature: random
// designs, sweeps, limits and fixed values. Environment variables of the campaign: PKM_BOUNDED_DESIGNS is the number of
// designs of each mechanism, with bounds of a relative gap of 1e-2 or of 200 000 boxes (or PKM_BOUNDED_BOXES)
// and with voxels of 64 cells along each of three coordinates; PKM_BOUNDED_FIRST is the number of the first design, to
// repeat a finding.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <ctime>
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

  /// Random designs, one in six of each kind: as they are; some parameters nominal, so that round numbers meet; thin
  /// ranges of joints; equal lengths; lengths that are sums or differences of others; lengths far from the usual ones.
  std::vector<double> design(unsigned kind, Stream& random) const {
    std::vector<double> design = test::random_design(info(), random);
    const auto& parameters = info().parameters;
    const auto any_length = [&] {
      std::vector<std::size_t> lengths;
      for (std::size_t i = 0; i < parameters.size(); ++i)
        if (parameters[i].unit == "m") lengths.push_back(i);
      return lengths[random.below(lengths.size())];
    };
    switch (kind) {
      case 1:
        for (std::size_t i = 0; i < design.size(); ++i)
          if (random.chance(0.5)) design[i] = parameters[i].nominal;
        break;
      case 2:
        for (std::size_t i = 0; i < design.size(); ++i)
          if (const std::optional<std::size_t> upper = upper_end(i)) {
            const double width = std::pow(10, -1 - 3 * random.u01());
            if (random.chance(0.7)) design[*upper] = design[i] + width * std::fabs(design[*upper] - design[i]);
          }
        break;
      case 3:
        for (int n = 0; n < 2; ++n) design[any_length()] = design[any_length()];
        break;
      case 4:
        design[any_length()] = std::fabs(design[any_length()] + (random.chance(0.5) ? 1 : -1) * design[any_length()]);
        break;
      case 5:
        for (std::size_t i = 0; i < design.size(); ++i)
          if (parameters[i].unit == "m") design[i] *= std::pow(4, 2 * random.u01() - 1);
        break;
      default:
        break;
    }
    for (std::size_t i = 0; i < design.size(); ++i)
      design[i] = std::clamp(design[i], parameters[i].lower, parameters[i].upper);
    return design;
  }
  /// The parameter that is the upper end of a range, of which parameter i is the lower one: rmin and rmax.
  std::optional<std::size_t> upper_end(std::size_t i) const {
    std::string name = info().parameters[i].name;
    const std::size_t at = name.find("min");
    if (at == std::string::npos) return {};
    name.replace(at, 3, "max");
    const auto found = std::ranges::find(info().parameters, name, &Parameter::name);
    if (found == info().parameters.end()) return {};
    return static_cast<std::size_t>(found - info().parameters.begin());
  }

  /// Thresholds of limits: random, or round numbers, which meet those of designs.
  LimitSpec limits(bool round, Stream& random) const {
    LimitSpec limits = test::random_limits(info(), random);
    for (std::optional<double>& given : limits.given)
      if (given && round) given = std::round(*given * 20) / 20;
    return limits;
  }

  /// Beside the middle of what is fixed.
  void hold(const std::vector<double>& design, WorkspacePlan& plan, Stream& random) const {
    for (FixedCoordinate& fixed : plan.fixed)
      fixed = {fixed.coordinate, FixedCoordinate::Kind::value,
               *file().default_value(design, fixed.coordinate) + 0.3 * (2 * random.u01() - 1)};
  }
};

/// Volume by voxels, with an absolute error from the spread of six grids.
struct VoxelVolume {
  double value = 0, error = 0;
};

/// @param cells  number of cells along each of three coordinates; fewer coordinates have more
VoxelVolume volume_by_voxels(const Mechanism& mechanism, const std::vector<double>& design, WorkspacePlan plan,
                             double cells) {
  constexpr int kGrids = 6;
  const std::size_t axes = plan.swept.size();
  const double along = std::pow(cells, 3.0 / static_cast<double>(axes));
  double sum = 0, least = INFINITY, greatest = 0, cell = 0;
  for (int grid = 0; grid < kGrids; ++grid) {
    VoxelOptions voxels;
    for (std::size_t axis = 0; axis < axes; ++axis)
      voxels.cells[axis] = std::lround(along * (1 + 0.03 * grid)) + static_cast<int>(axis) * (grid % 2 + 1);
    plan.method = voxels;
    const WorkspaceResult<double> found = test::survey(mechanism, design, plan);
    sum += found.volume / kGrids;
    least = std::min(least, found.volume);
    greatest = std::max(greatest, found.volume);
    cell = found.cell_volume;
  }
  if (least == 0) return {sum, INFINITY};  // the grids miss workspaces thinner than a cell
  // Three times the spread of six values is at least ten times the standard deviation of their mean, as a rule. Where
  // all grids agree, the spread says little.
  return {sum, 3 * (greatest - least) + 10 * cell + 1e-3 * sum};
}

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

TEST_P(BoundedColumns, LieWithinTheBounds) {
  const char* const asked = std::getenv("PKM_BOUNDED_DESIGNS");
  // sweeps that contain a rotation are integrated by slices, those of Par4 and of the Gough platform in seconds
  const unsigned usual = GetParam() == "par4" ? 5 : GetParam() == "gough" ? 25 : 100;
  const unsigned designs = asked ? static_cast<unsigned>(std::atoi(asked)) : usual;
  const std::vector<WorkspacePlan> all = plans();
  constexpr double kGap = 1e-2;  // relative
  unsigned compared = 0, wrong = 0, vague = 0, wide = 0;
  double by_columns = 0, by_bounds = 0, by_grids = 0;  // CPU times
  const auto start = std::chrono::steady_clock::now();
  const auto tell = [&] {
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    std::cerr << '\r' << GetParam() << ": " << compared << " of " << designs << " designs, " << wrong << " outside, "
              << wide << " wide, " << std::lround(seconds.count()) << " s   " << std::flush;
  };
  const char* const begin = std::getenv("PKM_BOUNDED_FIRST");
  const char* const given_boxes = std::getenv("PKM_BOUNDED_BOXES");
  const unsigned boxes = given_boxes ? static_cast<unsigned>(std::atoi(given_boxes)) : asked ? 200'000U : 300U;
  const unsigned first = begin ? static_cast<unsigned>(std::atoi(begin)) : 0;
  for (unsigned k = first; compared < designs && k < first + 40 * designs; ++k) {
    Stream random(19, 0, k, Stream::Use::start);
    WorkspacePlan plan = all[k % 2 == 0 ? 0 : random.below(all.size())];
    const std::vector<double> p = design(k / 2 % 6, random);
    if (k % 3 > 0) plan.limits = limits(k % 5 == 0, random);
    if (k % 3 > 1) hold(p, plan, random);
    if (file().refuse(p)) continue;
    double last = cpu_seconds();
    const auto spent = [&](double& time) {
      const double now = cpu_seconds();
      time += now - last;
      last = now;
    };
    const WorkspaceResult<double> exact = test::survey(file(), p, plan);
    spent(by_columns);
    // those without a workspace are quick to bound, and say little
    if (!(exact.volume > 0) && k % 8 > 0) continue;
    SCOPED_TRACE("design " + std::to_string(k) + ": " + test::told(info(), p, plan));
    const VolumeBounds bounds = file().bounds()->volume(p, plan, "", {.gap = kGap, .max_boxes = boxes});
    spent(by_bounds);
    const VoxelVolume voxels = volume_by_voxels(file(), p, plan, asked ? 64 : 16);
    spent(by_grids);
    const double off = (exact.error + 1e-9) * exact.volume;
    const bool holds = bounds.lower <= exact.volume + off && bounds.upper >= exact.volume - off &&
                       std::fabs(voxels.value - exact.volume) <= voxels.error + off;
    EXPECT_TRUE(holds) << bounds.lower << ' ' << exact.volume << ' ' << bounds.upper << ", error " << exact.error
                       << "; voxels " << voxels.value << " +- " << voxels.error;
    ++compared;
    wrong += !holds;
    vague += exact.error > 1e-6;
    wide += bounds.gap() > kGap;
    if (asked) tell();
  }
  if (asked) std::cerr << '\n';
  EXPECT_EQ(compared, designs);
  EXPECT_LE(vague, 1 + designs / 4);  // volumes of thin shells
  std::cout << GetParam() << ": " << compared << " volumes of " << all.size() << " sweeps, " << wrong
            << " outside of their bounds; error estimates above 1e-6: " << vague << ", gaps above " << kGap << ": "
            << wide << "; CPU times of columns, bounds and voxels: " << by_columns << ", " << by_bounds << " and "
            << by_grids << " s\n";
}

INSTANTIATE_TEST_SUITE_P(All, BoundedColumns,
                         ::testing::Values("3-rpr", "3-rrr", "five-bar", "linear-delta", "rotary-delta", "orthoglide",
                                           "par4", "gough", "4ppa-2par", "3crr-r-cru", "quadrupteron", "2t1r-p-hybrid"),
                         [](const auto& name) { return test::test_name(name.param); });

}  // namespace
}  // namespace pkm
