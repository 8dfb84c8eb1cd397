// Vectors in the formulas of mechanism files: the same robot described by vectors and by their elements, points of
// limbs, predefined names, and refusals.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/config/mechanism_file.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/math/random.hpp"
#include "tests/unit/config/report_at.hpp"

namespace pkm {
namespace {

using ::testing::HasSubstr;

/// A plate on four cables, with the margins of wrench closure n_1 n_i >= 0. @param let  defines n1 to n4
std::string cables(const std::string& let) {
  std::string text = R"toml([mechanism]
name = "cables"
[parameters]
W = { default = "1 m", min = "10 mm", max = "4 m" }
H = { default = "0.8 m", min = "10 mm", max = "4 m" }
w = { default = "100 mm", min = 0, max = "2 m" }
h = { default = "80 mm", min = 0, max = "2 m" }
[platform]
coordinates = { x = "along x", y = "along y", phi = "about z" }
[survey]
box = { x = ["-W", "W"], y = ["-H", "H"], phi = ["-90 deg", "90 deg"] }
[let]
)toml" + let;
  const char* const at[] = {"\"W\", \"H\"", "\"-W\", \"H\"", "\"-W\", \"-H\"", "\"W\", \"-H\""};
  const char* const on[] = {"\"w\", \"-h\"", "\"-w\", \"-h\"", "\"-w\", \"h\"", "\"w\", \"h\""};
  for (int i = 0; i < 4; ++i)
    text += "[[limb]]\nname = \"cable" + std::to_string(i + 1) + "\"\ndrive = \"telescope\"\nbase = [" + at[i] +
            ", 0]\nplatform = [" + on[i] + ", 0]\n";
  for (const char* i : {"2", "3", "4"})
    text += std::string("[[margin]]\nname = \"tension ") + i + "\"\nformula = \"n1*n" + i + "\"\nunit = \"m^8\"\n";
  return text;
}

const std::string kByElements = R"toml(c = "cos(phi)"
s = "sin(phi)"
b1x = "w*c + h*s"
b1y = "w*s - h*c"
d1x = "W - x - b1x"
d1y = "H - y - b1y"
m1 = "b1x*d1y - b1y*d1x"
b2x = "-w*c + h*s"
b2y = "-w*s - h*c"
d2x = "-W - x - b2x"
d2y = "H - y - b2y"
m2 = "b2x*d2y - b2y*d2x"
b3x = "-w*c - h*s"
b3y = "-w*s + h*c"
d3x = "-W - x - b3x"
d3y = "-H - y - b3y"
m3 = "b3x*d3y - b3y*d3x"
b4x = "w*c - h*s"
b4y = "w*s + h*c"
d4x = "W - x - b4x"
d4y = "-H - y - b4y"
m4 = "b4x*d4y - b4y*d4x"
n1 = "(d2x*(d3y*m4 - d4y*m3) - d3x*(d2y*m4 - d4y*m2) + d4x*(d2y*m3 - d3y*m2))"
n2 = "-(d1x*(d3y*m4 - d4y*m3) - d3x*(d1y*m4 - d4y*m1) + d4x*(d1y*m3 - d3y*m1))"
n3 = "(d1x*(d2y*m4 - d4y*m2) - d2x*(d1y*m4 - d4y*m1) + d4x*(d1y*m2 - d2y*m1))"
n4 = "-(d1x*(d2y*m3 - d3y*m2) - d2x*(d1y*m3 - d3y*m1) + d3x*(d1y*m2 - d2y*m1))"
)toml";

// w_i is the wrench of a unit tension per unit length of cable i: its force, and its moment about the plate's origin.
const std::string kByVectors = R"toml(f1 = "[ W,  H, 0] - point(platform, [ w, -h, 0])"
f2 = "[-W,  H, 0] - point(platform, [-w, -h, 0])"
f3 = "[-W, -H, 0] - point(platform, [-w,  h, 0])"
f4 = "[ W, -H, 0] - point(platform, [ w,  h, 0])"
w1 = "f1 + [0, 0, cross(R*[ w, -h, 0], f1).z]"
w2 = "f2 + [0, 0, cross(R*[-w, -h, 0], f2).z]"
w3 = "f3 + [0, 0, cross(R*[-w,  h, 0], f3).z]"
w4 = "f4 + [0, 0, cross(R*[ w,  h, 0], f4).z]"
n1 = "det(w2, w3, w4)"
n2 = "-det(w1, w3, w4)"
n3 = "det(w1, w2, w4)"
n4 = "-det(w1, w2, w3)"
)toml";

/// A planar crank and rod that moves a point, with more tables.
std::string crank(const std::string& more, const std::string& platform = "", const std::string& let = "") {
  return R"toml([mechanism]
name = "crank"
[parameters]
R = { default = "0.5 m", min = "10 mm", max = "4 m", meaning = "crank" }
l = { default = "0.8 m", min = "10 mm", max = "4 m", meaning = "rod" }
[platform]
coordinates = { x = "along x", y = "along y", phi = "about z" }
)toml" + platform +
         "\n[survey]\nbox = { x = [-1, 1], y = [-1, 1], phi = [-1, 1] }\n[let]\n" + let + R"toml(
[[limb]]
name = "arm"
copies = { number = 3, about = "z" }
drive = "crank"
base = ["[0.9, 0, 0].x", 0, 0]
platform = "[0.1, 0, 0]"
axis = "[0, 0, 1]"
zero = [1, 0, 0]
across = [0, 0, 1]
crank = "R"
rod = "l"
branch = "+"
radius = "5 mm"
)toml" + more;
}

std::shared_ptr<const Mechanism> read_file(const std::string& text) { return read_mechanism_toml(text, "m.toml"); }

std::string refusal_of_file(const std::string& text) {
  try {
    read_file(text);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "it is accepted";
}

std::vector<double> default_design(const Mechanism& mechanism) {
  std::vector<double> design;
  for (const Parameter& p : mechanism.info().parameters) design.push_back(p.nominal);
  return design;
}

double value_named(const NamedValues& values, const std::string& name) {
  for (const auto& [each, value] : values)
    if (each == name) return value;
  ADD_FAILURE() << "no " << name;
  return 0;
}

TEST(MechanismVectors, DescribeTheSameRobotAsTheirElements) {
  const auto scalars = read_file(cables(kByElements)), vectors = read_file(cables(kByVectors));
  Stream random(1, 0, 0, Stream::Use::start);
  for (int k = 0; k < 50; ++k) {
    const Pose<double> pose = {1.6 * random.u01() - 0.8, 1.2 * random.u01() - 0.6, 3 * random.u01() - 1.5};
    const PoseReport one = report_at(*scalars, pose), other = report_at(*vectors, pose);
    ASSERT_TRUE(one.joints && other.joints);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR((*one.joints)[i], (*other.joints)[i], 1e-14);
    ASSERT_EQ(one.margins.size(), other.margins.size());
    for (std::size_t i = 0; i < one.margins.size(); ++i) {
      EXPECT_EQ(one.margins[i].first, other.margins[i].first);
      EXPECT_NEAR(one.margins[i].second, other.margins[i].second, 1e-12);
    }
  }
}

TEST(MechanismVectors, HaveThePointsOfLimbs) {
  const auto mechanism = read_file(crank(R"toml(
[[quantity]]
name = "length"
formula = "norm(arm2.C - arm2.A)"
unit = "m"
[[quantity]]
name = "knee"
formula = "angle(arm2.C - arm2.A, arm2.B - arm2.C)"
unit = "rad"
[[quantity]]
name = "across"
formula = "dot(platform.R*[0, 1, 0], unit(arm1.B - arm1.C))"
[[link]]
name = "antenna"
from = "arm3.C"
to = "arm3.C + [0, 0, l/10]"
radius = "1 mm"
)toml"));
  const Pose<double> pose = {0.05, -0.1, 0.3};
  const PoseReport found = report_at(*mechanism, pose);
  EXPECT_NEAR(value_named(found.angles, "length"), 0.5, 1e-15);
  // the law of cosines in the triangle A C B
  const double c = std::cos(0.3 + 2 * kPi / 3), s = std::sin(0.3 + 2 * kPi / 3);
  const double dx = 0.05 + 0.1 * c - 0.9 * -0.5, dy = -0.1 + 0.1 * s - 0.9 * std::sqrt(0.75);
  const double cosine = (0.25 + 0.64 - dx * dx - dy * dy) / (2 * 0.5 * 0.8);
  EXPECT_NEAR(value_named(found.angles, "knee"), kPi - std::acos(cosine), 1e-14);
  EXPECT_LE(std::fabs(value_named(found.indices, "across")), 1);
}

TEST(MechanismVectors, PlatformFollowsItsOrigin) {
  const std::string quantity = "[[quantity]]\nname = \"tip_x\"\nformula = \"tip.x\"\nunit = \"m\"\n";
  const auto mechanism = read_file(
      crank(quantity, "origin = \"[x + lift, y, 0]\"", "lift = \"R/10\"\ntip = \"point(platform, [l, 0, 0])\""));
  EXPECT_NEAR(value_named(report_at(*mechanism, {0.05, -0.1, 0.3}).angles, "tip_x"), 0.05 + 0.05 + 0.8 * std::cos(0.3),
              1e-15);
  EXPECT_THAT(refusal_of_file(crank(quantity, "origin = \"[x + lift, y, 0]\"",
                                    "tip = \"point(platform, [l, 0, 0])\"\nlift = \"R/10\"")),
              HasSubstr("m.toml:8: platform.origin: the formula \"[x + lift, y, 0]\" has the unknown name 'lift'"));
}

TEST(MechanismVectors, PredefinedNamesGiveWayToThoseOfTheFile) {
  const auto mechanism = read_file(
      crank("[[quantity]]\nname = \"q\"\nformula = \"R + platform\"\nunit = \"m\"\n", "", "platform = \"l\""));
  EXPECT_NEAR(
      value_named(quantities_of_design(*mechanism, default_design(*mechanism), no_limits(mechanism->info())), "q"), 1.3,
      1e-15);
}

TEST(MechanismVectors, OfWrongKindsAreRefused) {
  EXPECT_THAT(refusal_of_file(crank("[[margin]]\nname = \"m\"\nformula = \"arm1.B\"\n")),
              HasSubstr("found a vector, the value of this formula; expected a scalar"));
  EXPECT_THAT(refusal_of_file(crank("[[link]]\nname = \"m\"\nfrom = \"l\"\nto = [0, 0, 0]\nradius = 0\n")),
              HasSubstr("found a scalar, the value of this formula; expected three numbers or formulas [x, y, z], or a "
                        "formula whose value is a vector"));
  EXPECT_THAT(
      refusal_of_file(crank("[[link]]\nname = \"m\"\nfrom = \"arm1.D\"\nto = [0, 0, 0]\nradius = 0\n")),
      HasSubstr("has the unknown name 'arm1.D' at character 1; expected one of arm1.A, arm1.B, arm1.C, arm1.S"));
  // In [let] no point of a limb is known yet.
  const auto refused_let = [](const std::string& value) {
    return refusal_of_file(crank("", "", "v = \"" + value + "\"\n"));
  };
  EXPECT_THAT(refused_let("arm1.C"),
              HasSubstr("has the unknown name 'arm1.C' at character 1; expected one of R, l, x, y, phi, platform, pi"));
  EXPECT_THAT(refused_let("platfrm.origin"), HasSubstr(", platform, pi; did you mean 'platform'?"));
  EXPECT_THAT(refused_let("platform.orign"),
              HasSubstr("has the unknown name 'platform.orign' at character 1; the parts of a vector are x, y and z, "
                        "those of a frame origin and R; did you mean 'origin'?"));
  EXPECT_THAT(refusal_of_file(crank("[[margin]]\nname = \"m\"\nformula = \"arm1.B + l\"\n")),
              HasSubstr("has a '+' at character 8 between a vector and a scalar"));
  EXPECT_THAT(refusal_of_file(crank("", "", "v = \"[x, y, 0]\"\n[[design]]\nname = \"d\"\nformula = \"v.x\"\n")),
              HasSubstr("a formula of parameters only, which does not depend on 'x'"));
}

}  // namespace
}  // namespace pkm
