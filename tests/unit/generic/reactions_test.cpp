// Forces in the joints of described mechanisms: those of the papers' as built in, drives' forces by virtual work, whole
// weight on the base, legs and pairs of rods without masses solved by hand, and what is said where a file does not say
// enough.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <regex>

#include "engine/core/error.hpp"
#include "engine/math/eigen_solvers.hpp"
#include "engine/math/random.hpp"
#include "tests/unit/accelerators/crr_cru/golden.hpp"
#include "tests/unit/contracts/mechanism_fixtures.hpp"
#include "tests/unit/generic/files.hpp"

namespace pkm {
namespace {

using ::testing::HasSubstr;
using Vec = std::array<double, 3>;

std::vector<std::string> with_reactions() {
  std::vector<std::string> names = {"4ppa-2par"};
  for (const std::string& name : test::mechanism_files())
    if (test::described(name)->reactions()) names.push_back(name);
  return names;
}

class Random {
 public:
  explicit Random(std::uint64_t seed) : stream_(seed, 0, 0, Stream::Use::start) {}
  AxisVector<double> some(std::size_t n, double scale) {
    AxisVector<double> v(n);
    for (double& x : v) x = scale * (2 * stream_.u01() - 1);
    return v;
  }

 private:
  Stream stream_;
};

struct State {
  MotionState<double> motion;
  AxisVector<double> acceleration;
  Wrench<double> wrench;
};
/// Moving at poses about the usual one.
std::vector<State> states(const Mechanism& mechanism, int count) {
  const Pose<double> usual = test::reference_pose(mechanism);
  Random random(71);
  const std::size_t n = usual.size();
  std::vector<State> all;
  for (int k = 0; k < count; ++k) {
    const AxisVector<double> wrench = random.some(6, 20);
    State state{{usual, random.some(n, 1)}, random.some(n, 8), {}};
    const AxisVector<double> moved = random.some(n, 0.02);
    for (std::size_t i = 0; i < n; ++i) state.motion.pose[i] += moved[i];
    for (std::size_t i = 0; i < 6; ++i) state.wrench[i] = wrench[i];
    all.push_back(state);
  }
  return all;
}

Reactions reactions_at(const Mechanism& mechanism, const State& state) {
  return mechanism.reactions()->find(test::nominal(mechanism.info()), mechanism.info().modes.front(), state.motion,
                                     state.acceleration, state.wrench);
}
const JointReaction& joint(const Reactions& reactions, const std::string& name) {
  for (const JointReaction& each : reactions.joints)
    if (each.name == name) return each;
  throw std::logic_error("no joint " + name);
}
Vec force(const Reactions& reactions, const std::string& name) {
  Vec f;
  for (std::size_t k = 0; k < 3; ++k) f[k] = joint(reactions, name).force[k].value();
  return f;
}
double size(const Vec& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

TEST(DescribedReactions, TheirDrivesAreThoseOfVirtualWork) {
  const std::vector<std::string> names = with_reactions();
  EXPECT_THAT(names, ::testing::IsSupersetOf({"3-rrr", "gough", "linear-delta", "orthoglide", "rotary-delta"}));
  for (const std::string& name : names) {
    const Mechanism& mechanism = *test::described(name);
    for (const State& state : states(mechanism, 50)) {
      SCOPED_TRACE(name);
      PoseDynamics<double> d;
      mechanism.dynamics()->equations(std::span<const double>(test::nominal(mechanism.info())),
                                      mechanism.info().modes.front(), {&state.motion, 1}, {&d, 1});
      if (!d.assembles) continue;
      Wrench<double> wrench = state.wrench;
      if (name == "3-rrr") wrench = {};  // forces out of its plane do no work
      const AxisVector<double> tau = drive_forces(d, state.acceleration, wrench);
      const Reactions found = reactions_at(mechanism, {state.motion, state.acceleration, wrench});
      ASSERT_EQ(found.reason, "");
      double largest = 0;
      for (const double force : tau) largest = std::fmax(largest, std::fabs(force));
      for (std::size_t i = 0; i < tau.size(); ++i) EXPECT_NEAR(found.drive_forces[i], tau[i], 1e-9 * largest);
    }
  }
}

TEST(DescribedReactions, TheBaseCarriesTheWholeWeight) {
  const auto weight_on = [](const std::string& name, const std::string& at_base) {
    const Mechanism& mechanism = *test::described(name);
    const Pose<double> pose = test::reference_pose(mechanism);
    const AxisVector<double> none(pose.size());
    const Reactions found = reactions_at(mechanism, {{pose, none}, none, {}});
    Vec sum{};
    for (const JointReaction& each : found.joints)
      if (std::regex_match(each.name, std::regex(at_base)))
        for (std::size_t k = 0; k < 3; ++k) sum[k] += each.force[k].value();
    EXPECT_NEAR(sum[0], 0, 1e-9);
    EXPECT_NEAR(sum[1], 0, 1e-9);
    return sum[2] / kGravity;
  };
  EXPECT_NEAR(weight_on("gough", ".*[.]A"), 40 + 6 * (12 + 6), 1e-9);
  const double crank = 2700 * kPi / 4 * (0.03 * 0.03 - 0.026 * 0.026) * 0.2;
  EXPECT_NEAR(weight_on("rotary-delta", ".*[.]A"), 0.25 + 3 * (crank + 0.12 * 0.5), 1e-9);
}

std::shared_ptr<const Mechanism> rewritten(const std::string& name, const std::string& pattern, const std::string& by) {
  const std::string text = test::text_of_mechanism(name), now = std::regex_replace(text, std::regex(pattern), by);
  EXPECT_NE(text, now) << pattern;
  return read_mechanism_toml(now, name + ".toml");
}

TEST(DescribedReactions, LegsWithoutMassCarryTheirDrivesForceAlone) {
  const auto mechanism = rewritten("gough", "\n(cylinder|piston)_[a-z]+ += [^\n]*", "");
  for (const State& state : states(*mechanism, 20)) {
    const Reactions found = reactions_at(*mechanism, state);
    ASSERT_EQ(found.reason, "");
    double largest = 0;
    for (const double drive : found.drive_forces) largest = std::fmax(largest, std::fabs(drive));
    for (std::size_t i = 0; i < 6; ++i) {
      const std::string leg = (i < 3 ? "left" : "right") + std::to_string(i % 3 + 1);
      const Vec at_base = force(found, leg + ".A"), at_platform = force(found, leg + ".B");
      for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(at_base[k], -at_platform[k], 1e-10 * largest);
      EXPECT_NEAR(size(at_base), std::fabs(found.drive_forces[i]), 1e-10 * largest);
      for (const char* point : {".A", ".slide", ".B"})
        for (const auto& couple : joint(found, leg + point).couple) EXPECT_NEAR(couple.value(), 0, 1e-9 * largest);
    }
  }
}

TEST(DescribedReactions, RodsOfAPairHoldThePlatformsTurn) {
  // Without masses of the rods their forces are along them, so that six forces balance the platform's six equations.
  const auto mechanism = rewritten("rotary-delta", "\nrod_mass_per_length [^\n]*", "");
  const std::vector<double> design = test::nominal(mechanism->info());
  for (const State& state : states(*mechanism, 20)) {
    const Reactions found = reactions_at(*mechanism, state);
    ASSERT_EQ(found.reason, "");
    // rods from the drawing: from the crank's end to the platform, and 30 mm along the crank's axis to either side
    Eigen::Matrix<double, 6, 6> A;
    const auto links = mechanism->links()->place(design, state.motion.pose, mechanism->info().modes.front());
    int column = 0;
    std::vector<std::string> names;
    for (const PlacedLink& link : links) {
      if (!link.name.starts_with("rod of arm")) continue;
      const std::string arm = link.name.substr(7);
      const double turn = 2 * kPi * (arm.back() - '1') / 3;
      const Eigen::Vector3d axis(-std::sin(turn), std::cos(turn), 0);
      const Eigen::Vector3d from(link.body.axis.from.data()), to(link.body.axis.to.data());
      for (const int side : {-1, 1}) {
        const Eigen::Vector3d u = (to - from).normalized(),
                              at = to + side * 0.03 * axis - Eigen::Vector3d(state.motion.pose.begin());
        A.col(column++) << u, at.cross(u);
        names.push_back(arm + ".B " + std::to_string(side < 0 ? 1 : 2));
      }
    }
    ASSERT_EQ(column, 6);
    Eigen::Matrix<double, 6, 1> b;
    for (int k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(k);
      b[k] = 0.25 * state.acceleration[i] - state.wrench[i] + (k == 2 ? 0.25 * kGravity : 0);
      b[3 + k] = -state.wrench[3 + i];
    }
    const Eigen::Matrix<double, 6, 1> along = Eigen::MatrixXd(A).lu().solve(b);
    for (int k = 0; k < 6; ++k) {
      const Vec on_rod = force(found, names[static_cast<std::size_t>(k)]);
      for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(-on_rod[static_cast<std::size_t>(axis)], along[k] * A(axis, k),
                    1e-9 * along.lpNorm<Eigen::Infinity>());
    }
  }
}

TEST(DescribedReactions, WhatAPlaneHoldsTwiceIsUndetermined) {
  const Mechanism& mechanism = *test::described("3-rrr");
  State state = states(mechanism, 1)[0];
  state.wrench = {};
  const Reactions found = reactions_at(mechanism, state);
  ASSERT_EQ(found.reason, "");
  EXPECT_EQ(found.rank, found.equations);
  EXPECT_GT(found.unknowns, found.equations);
  for (const JointReaction& each : found.joints) {
    EXPECT_TRUE(each.force[0] && each.force[1]) << each.name;
    EXPECT_FALSE(each.force[2] || each.couple[0] || each.couple[1]) << each.name;
    EXPECT_TRUE(each.couple[2]) << each.name;
  }
}

TEST(DescribedReactions, FilesThatDoNotSayEnoughGetASentence) {
  const auto why = [](const Mechanism& mechanism) {
    EXPECT_EQ(mechanism.reactions(), nullptr);
    return mechanism.why_no_reactions();
  };
  EXPECT_EQ(why(*test::described("2t1r-p-hybrid")), "limb limbA has drive = \"formula\", so its links are unknown");
  EXPECT_THAT(
      why(*test::described("par4")),
      HasSubstr("limb arm1 ends at `end`, but the body there is unknown; give end_on = \"platform\" or the name"));
  EXPECT_EQ(why(*rewritten("rotary-delta", "\npair [^\n]*", "")),
            "the joints of the file constrain its bodies too little: 39 unknown joint forces in 42 equations; "
            "give `pair` for rods in pairs, and `across` for limbs with parallel revolute joints");
  EXPECT_EQ(why(*rewritten("gough", "\n[a-z_]*(mass|centre|inertia) +=[^\n]*", "")),
            "the mechanism file has no masses");
  EXPECT_EQ(why(*rewritten("3crr-r-cru", "\\[\\[joint\\]\\](.|\n)*$", "")),
            "the joints of the file constrain its bodies too little: 59 unknown joint forces in 60 equations; "
            "give `pair` for rods in pairs, and `across` for limbs with parallel revolute joints");
  EXPECT_EQ(
      why(*rewritten("quadrupteron", "(mass   = \"m_p\"\n)rotation = \"platform\"", "$1")),
      "the body payload has no joint; add a [[joint]], or make it part of the platform with rotation = \"platform\"");
  EXPECT_THAT(why(*rewritten("quadrupteron", "end_on     = \"platform\"", "end_on     = \"platfrom\"")),
              HasSubstr("ends on 'platfrom', which is neither the platform nor a body; did you mean 'platform'?"));
}

TEST(DescribedReactions, JointsThatCannotBeAreRefused) {
  const auto message = [](const std::string& from, const std::string& to) {
    try {
      rewritten("rotary-delta", from, to);
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
    return std::string("it is accepted");
  };
  EXPECT_THAT(message("\\[\\[design\\]\\]",
                      "[[joint]]\nname = \"j\"\nbodies = [\"platform\", \"platform\"]\nat = [\"x\", \"y\", \"z\"]\n"
                      "about = [0, 0, 1]\n[[design]]"),
              HasSubstr("joint[1].bodies[2]: found \"platform\"; expected a body other than the first"));
  EXPECT_THAT(message("\\[\\[design\\]\\]",
                      "[[joint]]\nname = \"j\"\nbodies = [\"base\", \"platform\"]\nat = [\"x\", \"y\", \"z\"]\n"
                      "about = [0, 0, 1]\n[[design]]"),
              HasSubstr("joint[1].bodies[1]: found \"base\"; expected a body; the base may be the second one"));
  EXPECT_THAT(message("spacing = \"60 mm\"", "spacing = 0"),
              HasSubstr("limb[1].pair.spacing: found 0; expected a number > 0 m"));
}

TEST(DescribedReactions, JointsOfFormulasAreDrives) {
  const auto message = [](const std::string& from, const std::string& to) {
    try {
      return rewritten("4ppa-2par", from, to)->why_no_reactions();
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
  };
  EXPECT_EQ(test::described("4ppa-2par")->why_no_reactions(), "");
  EXPECT_THAT(message("drive  = \"q2\"\n", "drive  = \"q1\"\n"),
              HasSubstr("joint[6].drive: another joint has the drive q1 already"));
  EXPECT_THAT(message("drive  = \"q2\"\n", "drive  = \"q5\"\n"),
              HasSubstr("found \"q5\"; expected one of q1, q2, q3, q4"));
  EXPECT_THAT(message("drive  = \"q2\"\n", ""),
              HasSubstr("joint[6].along: a joint with `along`, a slide, needs `drive`"));
  EXPECT_THAT(message("along  = ([^\n]*\ndrive  = \"q2\"\n)", "about  = $1"),
              HasSubstr("joint[6].drive: the joint q2 has the unit m, so give `along` instead of `about`"));
  EXPECT_THAT(message("(along  = [^\n]*\ndrive  = \"q2\"\n)", "about = [1, 0, 0]\n$1"),
              HasSubstr("joint[6].along: give either `about` or `along`, not both"));
  EXPECT_EQ(message("\\[\\[joint\\]\\]\nname   = \"s2\"[^\\[]*\\[[^\\[]*\\[[^\\[]*\\[[^\\[]*drive  = \"q2\"\n", ""),
            "limb sliders has drive = \"formula\", so its links are unknown: no [[joint]] has drive = \"q2\"");
}

}  // namespace
}  // namespace pkm
