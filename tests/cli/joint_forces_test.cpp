// Joint forces of `pkmopt trajectory` and `pkmopt dynamics` (--reactions, --joint), and errors of these options.
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/run_program.hpp"
#include "tests/cli/study_folder.hpp"

namespace pkm::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

const std::string kFiles = PKM_EXPERIMENTS "/mechanisms/";
const std::vector<std::string> kCycle = {"trajectory", kFiles + "motors/rotary-delta.toml", "--motion", "cycle"};

ProgramResult along(std::vector<std::string> words, const std::vector<std::string>& more, const std::string& folder) {
  words.insert(words.end(), more.begin(), more.end());
  return pkmopt(words, folder);
}

double length(const json& vector) {
  double square = 0;
  for (const json& component : vector) square += component.get<double>() * component.get<double>();
  return std::sqrt(square);
}

TEST(CliJointForces, SummaryAgreesWithSamplesAndSingleStates) {
  const StudyFolder folder;
  const json found = along(kCycle, {"--reactions", "--samples", "33", "--json"}, folder.path()).json();
  const json& printed = found["summary"]["reactions"];
  EXPECT_EQ(printed.size(), 3 * 5u) << "a crank's pivot and both ends of two rods, of each arm";
  for (const auto& [name, joint] : printed.items()) {
    double peak = 0, time = 0, square = 0;
    for (const json& sample : found["samples"]) {
      const double force = length(sample["reactions"][name]["force"]);
      square += force * force / 33;
      if (force <= peak * (1 + 1e-12)) continue;  // the way back repeats the same forces
      peak = force;
      time = sample["time"];
    }
    EXPECT_NEAR(joint["peak_force"].get<double>(), peak, 2e-12 * peak) << name;
    EXPECT_NEAR(joint["rms_force"].get<double>(), std::sqrt(square), 1e-12 * peak) << name;
    EXPECT_EQ(joint["peak_force_time"], time) << name;
  }
  const json& sample = found["samples"][10];
  const auto list = [&sample](const char* key) {
    std::string text;
    for (const auto& [name, value] : sample[key].items()) text += (text.empty() ? "" : ",") + name + "=" + value.dump();
    return text;
  };
  const json single =
      pkmopt({"dynamics", kFiles + "rotary-delta.toml", "--at=" + list("pose"), "--velocity=" + list("velocity"),
              "--acceleration=" + list("acceleration"), "--joint=arm1.A,arm2.C 1", "--json"})
          .json()["reactions"]["joints"];
  ASSERT_EQ(single.size(), 2u);
  for (const auto& [name, joint] : single.items())
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(joint["force"][k].get<double>(), sample["reactions"][name]["force"][k].get<double>(), 1e-9);
}

TEST(CliJointForces, SelectedJointsAsTextAndAsATable) {
  const StudyFolder folder;
  const auto printed =
      along(kCycle, {"--joint", "arm1.A", "--joint", "arm3.B 2", "--samples", "5", "-o", "f.csv"}, folder.path());
  ASSERT_EQ(printed.exit_code, 0) << printed.err;
  EXPECT_THAT(printed.out, HasSubstr("\nmagnitudes of the forces (N) and moments (N m) in the joints\n"));
  EXPECT_THAT(printed.out, HasSubstr("\n  arm1.A    crank of arm1  "));
  EXPECT_THAT(printed.out, ::testing::Not(HasSubstr("arm2.A")));
  std::ifstream table(folder.path() + "/f.csv");
  std::string line;
  for (int row = 0; std::getline(table, line); ++row) {
    if (row == 0)
      EXPECT_THAT(line, ::testing::EndsWith(",arm1.A_Fx,arm1.A_Fy,arm1.A_Fz,arm1.A_Mx,arm1.A_My,arm1.A_Mz,arm3.B 2_Fx,"
                                            "arm3.B 2_Fy,arm3.B 2_Fz,arm3.B 2_Mx,arm3.B 2_My,arm3.B 2_Mz"));
    else
      EXPECT_THAT(line, ::testing::EndsWith(",0,0,0")) << "a ball joint carries no couple";
  }
}

TEST(CliJointForces, UndeterminedComponentsAreReported) {
  const StudyFolder folder;
  folder.write("m.toml", "type = \"oscillation\"\nx = 0\ny = 0\nphi = 0.2\namplitude = 0.01\nperiod = 1\n");
  const std::vector<std::string> words = {"trajectory", kFiles + "3-rrr.toml", "--motion", "m.toml", "--samples", "5"};
  const auto printed = along(words, {"--reactions", "-o", "f.csv"}, folder.path());
  ASSERT_EQ(printed.exit_code, 0) << printed.err;
  EXPECT_THAT(printed.out, HasSubstr(" (z undetermined)  "));
  EXPECT_THAT(printed.out, HasSubstr(" (x, y undetermined)  "));
  const json found = along(words, {"--reactions", "--json"}, folder.path()).json();
  for (const auto& [name, joint] : found["summary"]["reactions"].items())
    EXPECT_EQ(joint["undetermined_force"], json({"z"})) << name;
  EXPECT_TRUE(found["samples"][0]["reactions"].begin().value()["force"][2].is_null());
}

TEST(CliJointForces, NoForcesForAMotionBeyondTheReach) {
  const StudyFolder folder;
  folder.write("m.toml",
               "type = \"points\"\ntime = 1\npoints = [{ x = 0.2, y = 0.17, z = 0.22, phi = 0 }, { z = 0.6 }]\n");
  const std::vector<std::string> words = {"trajectory", "3crr-r-cru", "--motion",   "m.toml",
                                          "--samples",  "11",         "--reactions"};
  const auto printed = along(words, {"-o", "f.csv"}, folder.path());
  EXPECT_EQ(printed.exit_code, 1);
  EXPECT_THAT(printed.out, HasSubstr("\nforces in the joints are undefined at t = 0."));
  const json found = along(words, {"--json", "--allow-infeasible"}, folder.path()).json();
  EXPECT_TRUE(found["summary"]["reactions"].is_null());
  EXPECT_TRUE(found["samples"].front()["reactions"].is_object());
  EXPECT_TRUE(found["samples"].back()["reactions"].is_null());
}

TEST(CliJointForces, RodsWithYoungsModulusHaveAReserveAgainstBuckling) {
  const StudyFolder folder;
  std::stringstream file;
  file << std::ifstream(kFiles + "rotary-delta.toml").rdbuf();
  std::string text = file.str();
  const std::string mass = "rod_mass_per_length = \"0.12 kg/m\"";
  text.replace(text.find(mass), mass.size(),
               "rod_section = { density = \"1600 kg/m^3\", outer = \"10 mm\", inner = \"8 mm\", young = \"120 GPa\" }");
  folder.write("tubes.toml", text);
  folder.write("m.toml", "type = \"oscillation\"\nx = 0\ny = 0\nz = -0.5\namplitude = 0.1\nperiod = 1\n");
  const std::vector<std::string> words = {"trajectory", "tubes.toml", "--motion",    "m.toml",     "--samples",
                                          "21",         "--wrench",   "Fz=100,Fx=5", "--reactions"};
  const json found = along(words, {"--json"}, folder.path()).json();
  const json& rods = found["summary"]["rods"];
  ASSERT_EQ(rods.size(), 6u);
  const double buckling =
      std::pow(std::numbers::pi, 3) * 120e9 / 64 * (std::pow(0.01, 4) - std::pow(0.008, 4)) / (0.5 * 0.5);
  for (const auto& [name, rod] : rods.items()) {
    EXPECT_NEAR(rod["buckling_force"].get<double>(), buckling, 1e-9 * buckling);
    EXPECT_NEAR(rod["least_buckling_reserve"].get<double>() * rod["peak_compression"].get<double>(), buckling,
                1e-9 * buckling);
  }
  // The forces at one end of a rod agree with the reaction: ball joints and its own inertia leave little across it.
  const json& sample = found["samples"][3];
  const auto list = [&sample](const char* key) {
    std::string values;
    for (const auto& [axis, value] : sample[key].items())
      values += (values.empty() ? "" : ",") + axis + "=" + value.dump();
    return values;
  };
  const json single =
      pkmopt({"dynamics", "tubes.toml", "--at=" + list("pose"), "--velocity=" + list("velocity"),
              "--acceleration=" + list("acceleration"), "--wrench", "Fz=100,Fx=5", "--reactions", "--json"},
             folder.path())
          .json();
  ASSERT_EQ(single["rods"].size(), 6u);
  for (const auto& [name, rod] : single["rods"].items()) {
    const double axial = rod["axial_force"], area = std::numbers::pi / 4 * (0.01 * 0.01 - 0.008 * 0.008);
    EXPECT_NEAR(rod["stress"].get<double>(), axial / area, 1e-9 * std::fabs(axial / area));
    EXPECT_LE(-axial, rods[name]["peak_compression"].get<double>() * (1 + 1e-9));
    const std::string number = name.substr(4, 1), arm = name.substr(name.size() - 4);  // "rod 1 of arm2"
    const json& joints = single["reactions"]["joints"];
    const double at_ends[] = {length(joints[arm + ".C " + number]["force"]),
                              length(joints[arm + ".B " + number]["force"])};
    EXPECT_LE(std::fabs(axial), std::max(at_ends[0], at_ends[1]) * (1 + 1e-9));
    EXPECT_GE(std::fabs(axial), 0.99 * std::max(at_ends[0], at_ends[1]));
  }
  const auto printed = along(words, {}, folder.path());
  EXPECT_THAT(printed.out, HasSubstr("\nrods: axial forces, stress, and reserve against buckling with pinned ends\n"));
  EXPECT_THAT(along(kCycle, {"--reactions"}, folder.path()).out, ::testing::Not(HasSubstr("rods:")));
}

TEST(CliJointForces, RejectsUnknownJointsAndMechanismsWithoutAModel) {
  const StudyFolder folder;
  const auto unknown = along(kCycle, {"--joint", "arm1.D"}, folder.path());
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, ::testing::StartsWith("pkmopt: --joint: found the unknown name 'arm1.D'; expected one of "
                                                 "arm1.A, arm1.C 1, arm1.B 1, arm1.C 2, arm1.B 2, arm2.A, "));
  EXPECT_THAT(unknown.err, HasSubstr("; did you mean 'arm1.A'?"));
  folder.write("m.toml", "type = \"oscillation\"\nx = 0\ny = 0\nz = -0.7\nphi = 0\namplitude = 0.01\nperiod = 1\n");
  const std::string par4 = PKM_EXPERIMENTS "/mechanisms/par4.toml";
  const auto trajectory = pkmopt({"trajectory", par4, "--motion", "m.toml", "--reactions"}, folder.path());
  const auto single = pkmopt({"dynamics", par4, "--at", "x=0,y=0,z=-0.7,phi=0", "--reactions"});
  EXPECT_EQ(trajectory.exit_code, 2);
  EXPECT_EQ(trajectory.err, single.err);
  EXPECT_THAT(single.err, HasSubstr("mechanism par4 has no model of the forces in its joints: limb arm1"));
}

}  // namespace
}  // namespace pkm::testing
