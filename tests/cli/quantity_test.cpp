// Quantities that are formulas in the commands: fields of workspaces, minimum field values, tables of poses and
// motions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "tests/cli/run_program.hpp"
#include "tests/cli/study_folder.hpp"

namespace pkm::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

const std::string kExample = PKM_EXPERIMENTS "/mechanisms/quantities/orthoglide.toml";
const double kLimit = std::acos(-1) / 4;  // largest pressure angle that the study allows
const std::string kPose = "--at=x=0.02,y=-0.03,z=0.01";

std::string text_of(const std::string& file) {
  std::ifstream in(file);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

/// sqrt(L^2 - a^2 - b^2)/L for the worst two of three coordinates.
double transmission(double x, double y, double z) {
  constexpr double kRod = 0.31;
  return std::sqrt(kRod * kRod - x * x - y * y - z * z +
                   std::pow(std::fmin(std::fabs(x), std::fmin(std::fabs(y), std::fabs(z))), 2)) /
         kRod;
}

TEST(Quantity, IsAFieldOfTheWorkspace) {
  const StudyFolder folder;
  const std::string csv = folder.path() + "/w.csv";
  const auto found = pkmopt({"workspace", kExample, "--cells", "12", "--csv", csv, "--json", "--cube", "--least",
                             "transmission=0.9", "--vtk", folder.path() + "/w.vtkhdf"});
  ASSERT_EQ(found.exit_code, 0) << found.err;
  const json fields = found.json()["fields"];
  EXPECT_EQ(fields["transmission"]["unit"], "1");
  EXPECT_EQ(fields["pressure_angle"]["unit"], "rad");
  EXPECT_LE(fields["pressure_angle"]["greatest"], kLimit);
  EXPECT_NEAR(fields["transmission"]["least"].get<double>(),
              std::cos(fields["pressure_angle"]["greatest"].get<double>()), 1e-12);
  EXPECT_FALSE(found.json()["cube"].is_null());
  EXPECT_THAT(text_of(csv), HasSubstr(",sine_squared,transmission,pressure_angle [rad],"));
  EXPECT_THAT(text_of(folder.path() + "/w.vtkhdf"), HasSubstr("pressure_angle"));

  const auto plain = pkmopt({"workspace", kExample, "--cells", "12"});
  EXPECT_THAT(plain.out, HasSubstr("largest angle between a rod and its slide"));
  EXPECT_THAT(plain.out, HasSubstr("deg)")) << "people read degrees";
  const auto wrong = pkmopt({"workspace", kExample, "--cells", "4", "--cube", "--least", "transmision=0.9"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("did you mean 'transmission'?"));
}

TEST(Quantity, IsPrintedWithPosesAndMotions) {
  const json pose = pkmopt({"pose", kExample, kPose, "--json"}).json();
  EXPECT_NEAR(pose["quantities"]["transmission"].get<double>(), transmission(0.02, -0.03, 0.01), 1e-12);
  EXPECT_NEAR(pose["margins"]["sine_squared_max"].get<double>(), 0.5 - pose["quantities"]["sine_squared"].get<double>(),
              1e-12);
  const auto far = pkmopt({"pose", kExample, "--at=x=0,y=0.1,z=-0.2", "--set", "q_min=0"});
  EXPECT_THAT(far.out, HasSubstr("sine_squared_max is violated"));

  const StudyFolder folder;
  const std::string motion = folder.write(
      "m.toml", "type = \"points\"\npoints = [{ x = 0, y = 0, z = 0 }, { x = \"50 mm\" }]\ntime = \"1 s\"\n");
  const std::string csv = folder.path() + "/t.csv";
  const auto found = pkmopt({"trajectory", kExample, "--motion", motion, "--samples", "3", "--csv", csv});
  ASSERT_EQ(found.exit_code, 0) << found.err;
  EXPECT_THAT(text_of(csv), HasSubstr(",sine_squared,transmission,pressure_angle"));
}

TEST(Quantity, LimitsAreThresholdsOfTheCommandLine) {
  const auto volume = [](const std::string& limit) {
    const auto found = pkmopt({"evaluate", kExample, "--limit", limit, "--json"});
    EXPECT_EQ(found.exit_code, 0) << found.err;
    return found.json()["workspace"]["volume"].get<double>();
  };
  EXPECT_LT(volume("sine_squared_max=0.25"), volume("sine_squared_max=0.4"));
  EXPECT_THAT(pkmopt({"check", kExample}).out, HasSubstr("sine_squared_max"));
  EXPECT_THAT(pkmopt({"list", "objectives", "quantity"}).out, HasSubstr("statistic"));
}

TEST(Quantity, ExampleFindsTheLargestWorkspace) {
  const StudyFolder folder;
  const std::string file = folder.path() + "/s.h5";
  const auto found = pkmopt({"run", kExample, "-o", file, "--quiet"});
  ASSERT_EQ(found.exit_code, 0) << found.err;
  const json best = pkmopt({"evaluate", "--from", file, "--json"}).json();
  EXPECT_TRUE(best["feasible"].get<bool>());
  EXPECT_GT(best["objectives"]["workspace-volume"].get<double>(), 0);
  EXPECT_GE(best["constraints"]["transmission-mean"].get<double>(), -1e-9);
  EXPECT_LE(best["outputs"]["pressure_angle-p95"].get<double>(), kLimit);
  const json fields = pkmopt({"workspace", "--from", file, "--cells", "20", "--json"}).json()["fields"];
  EXPECT_LE(fields["pressure_angle"]["greatest"].get<double>(), kLimit);
}

}  // namespace
}  // namespace pkm::testing
