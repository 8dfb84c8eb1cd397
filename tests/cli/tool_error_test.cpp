// `pkmopt pose --joint-error`: first-order tool errors, compared with forward kinematics of perturbed joints.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/cli/run_program.hpp"

namespace pkm::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

/// Maximum difference of each coordinate and maximum translation over all signs of the joint errors, by forward
/// kinematics.
std::pair<json, double> by_forward(const std::string& mechanism, const std::string& at, const json& pose,
                                   double error) {
  json worst = json::object();
  double longest = 0;
  const auto& joints = pose["joints"];
  for (unsigned corner = 0; corner < 1u << joints.size(); ++corner) {
    std::string moved;
    unsigned j = 0;
    for (const auto& [name, value] : joints.items()) {
      char text[80];
      std::snprintf(text, sizeof text, "%s%s=%.17g", j > 0 ? "," : "", name.c_str(),
                    double(value) + ((corner >> j & 1) ? error : -error));
      moved += text;
      ++j;
    }
    const json found = pkmopt({"forward", mechanism, "--joints", moved, "--near", at, "--json"}).json()["poses"][0];
    double square = 0;
    for (const auto& [name, value] : pose["pose"].items()) {
      const double difference = std::fabs(double(found[name]) - double(value));
      worst[name] = std::fmax(worst.value(name, 0.0), difference);
      if (name != "theta" && name != "phi") square += difference * difference;
    }
    longest = std::fmax(longest, std::sqrt(square));
  }
  return {worst, longest};
}

TEST(CliToolError, AgreesWithForwardKinematics) {
  const std::pair<std::string, std::string> cases[] = {
      {"4ppa-2par", "x=0.25,y=0.85,z=-0.8,theta=30deg"},
      {PKM_EXPERIMENTS "/mechanisms/3-rpr.toml", "x=0.5,y=0.3,phi=0.1"}};
  for (const auto& [mechanism, at] : cases) {
    const json pose = pkmopt({"pose", mechanism, "--at", at, "--joint-error", "1um", "--json"}).json();
    const auto [worst, longest] = by_forward(mechanism, at, pose, 1e-6);
    const json& error = pose["tool_error"];
    for (const auto& [name, value] : worst.items())
      EXPECT_NEAR(error["coordinates"][name], value, 1e-3 * double(value)) << mechanism << ' ' << name;
    EXPECT_NEAR(error["translation"], longest, 1e-3 * longest) << mechanism;
    EXPECT_GT(longest, 5e-7);
  }
}

TEST(CliToolError, JointErrorsByName) {
  const auto pose = [](const std::string& error) {
    return pkmopt({"pose", "4ppa-2par", "--at", "x=0.25,y=0.85,z=-0.8,theta=30deg", "--joint-error", error, "--json"})
        .json();
  };
  const json one = pose("q1=10um,q3=20um");
  EXPECT_EQ(one["joint_error"]["q2"], 0);
  EXPECT_EQ(one["joint_error"]["q3"], 2e-5);
  EXPECT_LT(one["tool_error"]["translation"], pose("20um")["tool_error"]["translation"]);
}

TEST(CliToolError, IsPrintedInMicrometresAndDegrees) {
  const auto printed =
      pkmopt({"pose", "4ppa-2par", "--at", "x=0.25,y=0.85,z=-0.8,theta=30deg", "--joint-error", "10um"});
  EXPECT_THAT(printed.out, HasSubstr(" 32.37 um\n"));
  EXPECT_THAT(printed.out, HasSubstr(" deg\n  translation  "));
  const auto refused = pkmopt({"pose", "4ppa-2par", "--at", "x=0.25,y=0.85,z=-0.8,theta=0", "--joint-error", "10deg"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("--joint-error: found 10deg; expected a number in m"));
}

}  // namespace
}  // namespace pkm::testing
