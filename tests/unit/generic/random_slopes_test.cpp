// Derivatives of volumes by columns against differences, for random mechanism files. PKM_RANDOM_SLOPES: the number of
// designs; PKM_RANDOM_SLOPES_FIRST: the number of the first one, to repeat a finding.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <optional>
#include <sstream>

#include "engine/core/stop.hpp"
#include "tests/unit/contracts/mechanism_fixtures.hpp"
#include "tests/unit/generic/random_mechanism.hpp"

namespace pkm {
namespace {

unsigned asked(const char* variable, unsigned otherwise) {
  const char* const value = std::getenv(variable);
  return value ? static_cast<unsigned>(std::atoi(value)) : otherwise;
}

/// The volume of one mechanism by one plan.
class Volume {
 public:
  Volume(const Mechanism& mechanism, const WorkspacePlan& plan) : evaluator_(prepare_workspace(mechanism, plan, {})) {}

  double operator()(const std::vector<double>& design) {
    evaluator_->evaluate(design, scratch_, survey_);
    return survey_.volume;
  }
  double error() const { return survey_.error; }            ///< of the last volume, relative
  double error_of_sloped() const { return sloped_.error; }  ///< of the last one with slopes
  std::vector<double> slopes(const std::vector<double>& design) {
    std::vector<double> all;
    for (std::size_t first = 0; first < design.size(); first += 4) {
      const std::size_t count = std::min<std::size_t>(4, design.size() - first);
      std::vector<Dual4> moving(design.begin(), design.end());
      for (std::size_t i = 0; i < count; ++i) moving[first + i].v[static_cast<int>(i)] = 1;
      evaluator_->gradients()->evaluate(moving, scratch_, sloped_);
      for (std::size_t i = 0; i < count; ++i) all.push_back(sloped_.volume.v[static_cast<int>(i)]);
    }
    return all;
  }

 private:
  std::unique_ptr<const WorkspaceEvaluator> evaluator_;
  Scratch scratch_;
  WorkspaceResult<double> survey_;
  WorkspaceResult<Dual4> sloped_;
};

/// Ends a computation with Stopped after a number of calls of check_stop(): unlike time, they are the same on every
/// machine.
class CostLimit {
 public:
  explicit CostLimit(long most) : left_(most), scope_([this] { return --left_ < 0; }) {}

 private:
  std::atomic<long> left_;
  StopScope scope_;
};

enum class Diagnosis { equal, kink, rough, wrong };

/// Compares a derivative with central differences of steps that shrink, extrapolated, two of which agree. Where the
/// derivatives from below and from above differ, the volume has a kink there. Where nothing agrees, it is rough.
/// @param scale  what differences are relative to
Diagnosis compare(Volume& volume, const std::vector<double>& design, std::size_t parameter, double slope, double scale,
                  double& found) {
  constexpr double kAgree = 3e-7, kExact = 1e-6, kKink = 3e-6;
  const double at = volume(design), unit = std::max(std::fabs(design[parameter]), 0.05);
  const auto moved = [&](double by) {
    std::vector<double> other = design;
    other[parameter] += by;
    return volume(other);
  };
  std::optional<double> before;
  bool agrees = false;
  double left = 0, right = 0;
  for (const double share : {1e-3, 2e-4, 4e-5, 8e-6}) {
    const double h = share * unit;
    const double low = moved(-h), high = moved(h), near_low = moved(-h / 2), near_high = moved(h / 2);
    found = (8 * (near_high - near_low) - (high - low)) / (6 * h);
    left = (3 * at - 4 * near_low + low) / h;
    right = (4 * near_high - high - 3 * at) / h;
    agrees = before && std::fabs(found - *before) <= kAgree * scale;
    if (agrees && std::fabs(found - slope) <= kExact * scale) return Diagnosis::equal;
    if (agrees) break;
    before = found;
  }
  if (std::fabs(left - right) > kKink * scale) {
    // the slope of one side is one of the derivatives that there are
    return Diagnosis::kink;
  }
  return agrees ? Diagnosis::wrong : Diagnosis::rough;
}

TEST(RandomSlopes, EqualDifferencesForRandomMechanisms) {
  const unsigned designs = asked("PKM_RANDOM_SLOPES", 100), first = asked("PKM_RANDOM_SLOPES_FIRST", 0);
  const bool is_campaign = std::getenv("PKM_RANDOM_SLOPES") != nullptr;
  unsigned compared = 0, lengthy = 0, empty = 0, refused = 0, slopes = 0, kinks = 0, rough = 0, wrong = 0, vague = 0;
  const long most_checks = is_campaign ? 100'000 : 1000;  // of one volume
  std::map<std::string, unsigned> reasons;
  for (unsigned k = first; compared < designs && k < first + 40 * designs; ++k) {
    Stream random(33, 0, k, Stream::Use::start);
    const std::string text = test::RandomMechanism(random, random.chance(is_campaign ? 0.2 : 0.04)).text();
    std::shared_ptr<const Mechanism> mechanism;
    std::optional<Volume> volume;
    double measure = 0;
    std::vector<double> design;
    std::string held_at;
    try {
      mechanism = read_mechanism_toml(text, "random.toml");
      WorkspacePlan plan = test::columns(mechanism->info(), {.tolerance = 1e-8});
      for (FixedCoordinate& fixed : plan.fixed) {
        const double at = 0.1 * (random.u01() - 0.5);
        const std::string& name = mechanism->info().coordinates[static_cast<std::size_t>(fixed.coordinate)].name;
        if (name == "z") continue;  // in its middle, which moves with the design
        if (plan.fixed.size() == 1 && mechanism->info().coordinates.size() == 3 && random.chance(0.5))
          fixed.kind = FixedCoordinate::Kind::integrated;
        else
          fixed = {fixed.coordinate, FixedCoordinate::Kind::value, at};
        held_at += ", " + name + (fixed.value == at ? " = " + std::to_string(at) : " integrated");
      }
      design = test::nominal(mechanism->info());
      const CostLimit limit(most_checks);
      volume.emplace(*mechanism, plan);
      measure = (*volume)(design);
    } catch (const Stopped&) {
      ++lengthy;
      continue;
    } catch (const std::exception& problem) {
      ++refused;
      ++reasons[problem.what()];
      continue;
    }
    SCOPED_TRACE("design " + std::to_string(k) + held_at + "\n" + text);
    if (!(measure > 1e-6)) {
      ++empty;
      continue;
    }
    const std::vector<double> exact = volume->slopes(design);
    // The one with slopes looks closer at ends of parts.
    if (const double error = std::max(volume->error(), volume->error_of_sloped()); !(error < 2e-8)) {
      ++vague;
      if (is_campaign) std::cout << "design " << k << ": error estimate " << error << '\n';
      continue;
    }
    ++compared;
    double scale = 0.1 * measure;
    for (const double slope : exact) scale = std::max(scale, std::fabs(slope));
    for (std::size_t i = 0; i < exact.size(); ++i) {
      double found = 0;
      const Diagnosis verdict = compare(*volume, design, i, exact[i], scale, found);
      ++slopes;
      kinks += verdict == Diagnosis::kink;
      rough += verdict == Diagnosis::rough;
      wrong += verdict == Diagnosis::wrong;
      const std::string& name = mechanism->info().parameters[i].name;
      if (verdict == Diagnosis::kink && is_campaign) std::cout << "design " << k << ": kink by " << name << '\n';
      EXPECT_NE(verdict, Diagnosis::wrong) << name << ": " << exact[i] << ", by differences " << found;
    }
    if (is_campaign)
      std::cerr << '\r' << compared << " of " << designs << " designs, now " << k << ", " << wrong << " slopes wrong   "
                << std::flush;
  }
  std::cout << compared << " designs, " << slopes << " derivatives: " << wrong << " wrong, " << kinks << " at kinks, "
            << rough << " where differences do not agree; " << empty << " without a workspace, " << vague
            << " whose error estimate misses the tolerance, " << lengthy << " that take too long, " << refused
            << " refused\n";
  if (is_campaign)
    for (const auto& [reason, count] : reasons) std::cout << count << ": " << reason << '\n';
  EXPECT_EQ(compared, designs);
  EXPECT_LE(kinks + rough, slopes / 20);
}

/// The angle of a rod with its upright slide does not depend on z, but its formula contains z.
TEST(RandomSlopes, ContainTheTermsOfConstraintsThatAreConstantAlongColumns) {
  std::ostringstream text;
  text << std::ifstream(PKM_TEST_DATA "/mechanisms/linear-delta-joint-angle.toml").rdbuf();
  const auto mechanism = read_mechanism_toml(text.str(), "linear-delta-joint-angle.toml");
  const MechanismInfo& info = mechanism->info();
  Volume volume(*mechanism, test::columns(info));
  const std::vector<double> design = test::nominal(info), slopes = volume.slopes(design);
  const auto slope = [&](const std::string& name) {
    return slopes[static_cast<std::size_t>(std::ranges::find(info.parameters, name, &Parameter::name) -
                                           info.parameters.begin())];
  };
  EXPECT_NEAR(slope("R"), -0.34121, 1e-5);  // central differences of volumes
  EXPECT_NEAR(slope("r"), 0.34121, 1e-5);
  EXPECT_NEAR(slope("l"), 0.22212, 1e-5);
}

constexpr const char* kCranks = R"(
[mechanism]
name = "cranks"
[parameters]
w = { default = "0.47497 m", min = "0.0001 m", max = "10 m" }
h = { default = "0.38345 m", min = "0.0001 m", max = "10 m" }
R = { default = "0.35423 m", min = "0.0001 m", max = "10 m" }
r = { default = "0.11818 m", min = "0.0001 m", max = "10 m" }
limb2_a_l = { default = "0.2198 m", min = "0.0001 m", max = "10 m" }
limb2_b_l = { default = "0.61691 m", min = "0.0001 m", max = "10 m" }
limb2_low = { default = "-1.4788 rad", min = "-20 rad", max = "10 rad" }
limb2_high = { default = "1.3204 rad", min = "-20 rad", max = "10 rad" }
limb3_a = { default = "0.035935 m", min = "-10 m", max = "10 m" }
limb3_a_l = { default = "0.37202 m", min = "0.0001 m", max = "10 m" }
limb3_b_l = { default = "0.72956 m", min = "0.0001 m", max = "10 m" }
[platform]
coordinates = { x = "along x", y = "along y", z = "along z" }
characteristic_radius = "0.1 m"
[survey]
sweep = ["x", "z"]
box = { x = ["-w", "w"], y = ["-w", "w"], z = ["h - 0.4*w", "h + 0.4*w"] }
[[limb]]
name = "limb1"
base = ["-0.0075317*R", "-0.99997*R", "0"]
platform = ["-0.0075317*r", "-0.99997*r", 0]
drive = "telescope"
[[limb]]
name = "limb2"
base = ["-0.60697*R", "-0.79473*R", "0"]
platform = ["-0.60697*r", "-0.79473*r", 0]
drive = "crank"
crank = "limb2_a_l"
rod = "limb2_b_l"
branch = "+"
axis = [0.79473, -0.60697, 0]
zero = [-0.60697, -0.79473, 0]
range = ["limb2_low", "limb2_high"]
[[limb]]
name = "limb3"
base = ["0.085645*R", "0.99633*R", "limb3_a"]
platform = ["0.085645*r", "0.99633*r", 0]
drive = "crank"
crank = "limb3_a_l"
rod = "limb3_b_l"
branch = "+"
axis = [-0.99633, 0.085645, 0]
zero = [0.085645, 0.99633, 0]
)";

double central_difference(Volume& volume, std::vector<double> design, std::size_t parameter) {
  const double at = design[parameter], h = 2e-5;
  const auto moved = [&](double by) {
    design[parameter] = at + by;
    return volume(design);
  };
  return (8 * (moved(h / 2) - moved(-h / 2)) - (moved(h) - moved(-h))) / (6 * h);
}

/// A stretched crank ends slices like a root: derivatives lack what a slice measures where the break is taken
/// to be. Found by the random mechanisms.
TEST(RandomSlopes, BreaksOfLinesAreKnownWellEnough) {
  const auto mechanism = read_mechanism_toml(kCranks, "cranks.toml");
  Volume volume(*mechanism, test::columns(mechanism->info(), {.tolerance = 1e-10}));
  std::vector<double> design = test::nominal(mechanism->info());
  constexpr std::size_t kRadius = 2;
  for (const double radius : {0.32, 0.33, 0.34, 0.35, 0.36, 0.37}) {
    design[kRadius] = radius;
    EXPECT_NEAR(volume.slopes(design)[kRadius], central_difference(volume, design, kRadius), 1e-9) << radius;
  }
}

/// At y = 0.05 m such a root begins 1e-9 of the range beyond the end of the slices: the volume hardly notices, its
/// derivative by R was off by 4e-5. Found by the random mechanisms.
TEST(RandomSlopes, RootsThatBeginJustOutsideAPartCount) {
  const auto mechanism = read_mechanism_toml(kCranks, "cranks.toml");
  WorkspacePlan plan = test::columns(mechanism->info(), {.tolerance = 1e-8});
  plan.fixed.at(0) = {plan.fixed.at(0).coordinate, FixedCoordinate::Kind::value, 0.05};
  Volume volume(*mechanism, plan);
  const std::vector<double> design = test::nominal(mechanism->info()), slopes = volume.slopes(design);
  for (std::size_t i = 0; i < design.size(); ++i)
    EXPECT_NEAR(slopes[i], central_difference(volume, design, i), 2e-7) << mechanism->info().parameters[i].name;
}

/// Beyond x = -m the margin bounds y in place of the box: the number of parts stays, the area jumps. Without a break
/// there, the derivative by m was 0. Found by the random mechanisms.
TEST(RandomSlopes, AreaJumpsWhereAnotherConditionBoundsAPart) {
  const auto mechanism = read_mechanism_toml(R"toml(
[mechanism]
name = "jump"
[parameters]
w = { default = "0.39119 m", min = "0.0001 m", max = "10 m" }
h = { default = "0.5069 m", min = "0.0001 m", max = "10 m" }
R = { default = "0.30792 m", min = "0.0001 m", max = "10 m" }
r = { default = "0.053924 m", min = "0.0001 m", max = "10 m" }
crank = { default = "0.22797 m", min = "0.0001 m", max = "10 m" }
rod = { default = "0.48358 m", min = "0.0001 m", max = "10 m" }
m = { default = "0.1 m", min = "-10 m", max = "10 m" }
[platform]
coordinates = { x = "along x", y = "along y", z = "along z" }
characteristic_radius = "0.1 m"
[survey]
sweep = ["y", "x", "z"]
box = { x = ["-w", "w"], y = ["-w", "w"], z = ["h - 0.4*w", "h + 0.4*w"] }
[[limb]]
name = "arm"
copies = { number = 3, about = "z" }
base = ["0.98007*R", "0.19867*R", 0]
platform = ["0.98007*r", "0.19867*r", 0]
drive = "crank"
crank = "crank"
rod = "rod"
branch = "+"
axis = [-0.19867, 0.98007, 0]
zero = [0.98007, 0.19867, 0]
range = [-1.2739, 0.674]
[[margin]]
name = "corner"
formula = "max(x + m, y - 0.05)"
unit = "m"
)toml",
                                             "jump.toml");
  Volume volume(*mechanism, test::columns(mechanism->info(), {.tolerance = 1e-8}));
  std::vector<double> design = test::nominal(mechanism->info());
  constexpr std::size_t kCorner = 6;
  for (const double m : {0.05, 0.1, 0.15}) {  // at 0.15 m, near the end of the workspace, the area jumps by 2e-5 m^2
    design[kCorner] = m;
    volume(design);
    EXPECT_LT(volume.error(), 2e-8) << "a jump that a margin explains is nothing overlooked";
    EXPECT_NEAR(volume.slopes(design)[kCorner], central_difference(volume, design, kCorner), 1e-8) << m;
  }
}

}  // namespace
}  // namespace pkm
