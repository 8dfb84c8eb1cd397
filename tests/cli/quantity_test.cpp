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

std::string contents_of(const std::string& file) {
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
  const auto found = pkmopt({"workspace", kExample, "--cells", "12", "--csv", csv, "--json", "--largest-box", "--least",
                             "transmission=0.9", "--vtk", folder.path() + "/w.vtkhdf"});
  ASSERT_EQ(found.exit_code, 0) << found.err;
  const json fields = found.json()["fields"];
  EXPECT_EQ(fields["transmission"]["unit"], "1");
  EXPECT_EQ(fields["pressure_angle"]["unit"], "rad");
  EXPECT_LE(fields["pressure_angle"]["greatest"], kLimit);
  EXPECT_NEAR(fields["transmission"]["least"].get<double>(),
              std::cos(fields["pressure_angle"]["greatest"].get<double>()), 1e-12);
  EXPECT_FALSE(found.json()["largest"]["box"].is_null());
  EXPECT_THAT(contents_of(csv), HasSubstr(",sine_squared,transmission,pressure_angle [rad],"));
  EXPECT_THAT(contents_of(folder.path() + "/w.vtkhdf"), HasSubstr("pressure_angle"));

  const auto plain = pkmopt({"workspace", kExample, "--cells", "12"});
  EXPECT_THAT(plain.out, HasSubstr("largest angle between a rod and its slide"));
  EXPECT_THAT(plain.out, HasSubstr(" deg")) << "people read degrees";
  const auto wrong = pkmopt({"workspace", kExample, "--cells", "4", "--largest-box", "--least", "transmision=0.9"});
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
  EXPECT_THAT(contents_of(csv), HasSubstr(",sine_squared,transmission,pressure_angle"));
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

/// Runs a study of experiments/mechanisms/quantities.
/// @return `evaluate --json` of the best design
json best_of(const std::string& study, const std::string& file) {
  const auto found =
      pkmopt({"run", PKM_EXPERIMENTS "/mechanisms/quantities/" + study + ".toml", "-o", file, "--quiet"});
  EXPECT_EQ(found.exit_code, 0) << found.err;
  json best = pkmopt({"evaluate", "--from", file, "--json"}).json();
  EXPECT_TRUE(best["feasible"].get<bool>()) << study;
  return best;
}

// At the centre, x = y = 0, a rod has the slope s to the horizontal, and J^-1 maps errors of 10 um with the worst
// signs,
// +, -, -, to 10 um * 4/3 s across and 10 um / 3 along z. The maximum over the workspace is near the centre.
TEST(Quantity, ExampleOfAccuracyReachesTheBound) {
  const StudyFolder folder;
  const std::string file = folder.path() + "/s.h5";
  const json best = best_of("linear-delta-accuracy", file);
  const double R = best["parameters"]["R"].get<double>(), l = best["parameters"]["l"].get<double>();
  EXPECT_NEAR(l, 0.8, 1e-9);
  const double cosine = (R - 0.06) / l, slope = std::sqrt(1 - cosine * cosine) / cosine;
  const json centre = pkmopt({"pose", "--from", file, "--at", "x=0,y=0,z=-0.3", "--json"}).json()["quantities"];
  EXPECT_NEAR(centre["accuracy"].get<double>(), 1e-5 * std::hypot(4.0 / 3 * slope, 1.0 / 3), 1e-14);
  EXPECT_GT(best["objectives"]["workspace-volume"].get<double>(), 0.1169);
  const json fields = pkmopt({"workspace", "--from", file, "--cells", "20", "--json"}).json()["fields"];
  EXPECT_NEAR(fields["accuracy"]["greatest"].get<double>(), 20e-6, 0.1e-6);
}

// SLSQP ends at 229855.979400 N/m, too.
TEST(Quantity, ExampleOfStiffnessEndsInAnOptimum) {
  const StudyFolder folder;
  const std::string file = folder.path() + "/s.h5";
  const json best = best_of("stiff-delta", file);
  EXPECT_NEAR(best["objectives"]["mean-stiffness"].get<double>(), 229855.9794, 1);
  EXPECT_NEAR(best["constraints"]["effective_mass-mean"].get<double>(), 0, 1e-6);
  EXPECT_GT(best["outputs"]["natural_frequency-min"].get<double>(), 100);
}

TEST(Quantity, ExampleOfTransmissionImprovesByGradients) {
  const StudyFolder folder;
  const json best = best_of("rotary-delta-gradient", folder.path() + "/s.h5");
  EXPECT_GT(best["objectives"]["ratio"].get<double>(), 1.002 * 0.05955956942) << "of the genetic algorithm's design";
}

TEST(Quantity, MessagesExplainWhatIsMissing) {
  const StudyFolder folder;
  const auto check = [&](const std::string& workspace, const std::string& tables = "") {
    return pkmopt({"check", folder.write("s.toml", "[mechanism]\nfile = \"" PKM_EXPERIMENTS
                                                   "/mechanisms/rotary-delta.toml\"\n[variables]\n"
                                                   "R = { min = 0.1, max = 0.3 }\n[workspace]\n" +
                                                       workspace + tables +
                                                       "[[objective]]\ntype = \"workspace-volume\"\n"
                                                       "[[stage]]\noptimiser = \"ga\"\n")})
        .err;
  };
  const std::string voxels = "method = \"voxels\"\ncells = { x = 4, y = 4, z = 4 }\n";
  EXPECT_THAT(check(voxels + "limits = { natural_frequency = { min = \"10 Hz\" } }\n"),
              HasSubstr("s.toml:8: workspace.limits.natural_frequency.min: quantity 'natural_frequency' is undefined "
                        "for mechanism rotary-delta: no limb has `drive_stiffness`"));
  EXPECT_THAT(check(voxels + "limits = { stifness = { min = 1 } }\n"), HasSubstr("did you mean 'stiffness'?"));
  EXPECT_THAT(check(voxels, "[accuracy]\n"), HasSubstr("s.toml:8: accuracy: the table is empty; expected joint_error"));
  EXPECT_THAT(check("nodes = { x = 4, y = 4, z = 4 }\n"),
              HasSubstr("workspace.nodes.z: columns run along z, which has no nodes; expected x, y"));
  const auto map = pkmopt({"workspace", PKM_EXPERIMENTS "/mechanisms/rotary-delta.toml", "--cut", "y=0", "--field",
                           "accuracy", "-o", folder.path() + "/map.svg"});
  EXPECT_EQ(map.exit_code, 2);
  EXPECT_THAT(map.err,
              HasSubstr("--field: 'accuracy' is undefined for mechanism rotary-delta: there is no [accuracy]"));
}

}  // namespace
}  // namespace pkm::testing
