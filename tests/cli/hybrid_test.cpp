// The hybrid robot on the command line: golden poses, auxiliary chain, forward kinematics with rates, the paper's
// motion.
#include <algorithm>
#include <cmath>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/crr_cru_golden.hpp"
#include "tests/cli/run_program.hpp"
#include "tests/cli/study_folder.hpp"

namespace pkm::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::StartsWith;

const char* const kName = "2t1r-p-hybrid";
const std::vector<std::string> kCoordinates = {"x", "y", "z", "beta"}, kJoints = {"s1", "s2", "s3", "s4"};

const json& hybrid_golden() {
  static const json data = json::parse(std::ifstream(PKM_TEST_DATA "/2t1r-p-hybrid.json"));
  return data;
}

const json& design_fields(const json& entry) {
  return entry.contains("design_inline") ? entry["design_inline"]
                                         : hybrid_golden()["designs"][entry["design"].get<int>()];
}

/// The design of a golden case as "a=0.1,...,s_min_1=-0.15,...".
std::string hybrid_design(const json& entry) {
  const json& fields = design_fields(entry);
  std::string text;
  const auto add = [&](const std::string& name, const json& value) {
    text += (text.empty() ? "" : ",") + name + "=" + value.dump();
  };
  for (const auto& [name, value] : fields.items()) {
    if (!value.is_array()) add(name, value);
    for (std::size_t i = 0; value.is_array() && i < value.size(); ++i)
      add(name + "_" + std::to_string(i + 1), value[i]);
  }
  return text;
}

/// Expects null where the golden data has null, otherwise a number close to the golden one.
void expect_near(const json& found, const json& expected, const std::string& what) {
  if (expected.is_null()) {
    EXPECT_TRUE(found.is_null()) << what;
    return;
  }
  ASSERT_TRUE(found.is_number()) << what << ": " << found.dump();
  EXPECT_NEAR(found.get<double>(), expected.get<double>(), 1e-11 * (1 + std::fabs(expected.get<double>()))) << what;
}

/// @param target  the mechanism, or a study of it
ProgramResult pose(const json& entry, std::vector<std::string> more, const std::string& target = kName) {
  std::vector<std::string> command = {
      "pose", target, "--at", assignments(kCoordinates, entry["X"]), "--set", hybrid_design(entry), "--json"};
  command.insert(command.end(), more.begin(), more.end());
  return pkmopt(command);
}

/// What the report has for a golden margin other than a clearance: reach relative to the square of the link's length,
/// stroke as the minimum of the two ends of a joint's range, the others alike.
double golden_margin(const json& found, const json& entry, const std::string& name) {
  const std::string number(1, name.back());
  if (name.substr(0, 5) == "reach") {
    const double length = design_fields(entry)["L" + number];
    return found["n" + number + " exists"].get<double>() / (length * length);
  }
  if (name.substr(0, 6) == "stroke") return std::min(found["s" + number + " min"], found["s" + number + " max"]);
  return found[name];
}

TEST(CliHybrid, MarginsOfGoldenPoses) {
  const StudyFolder folder;
  const std::string links_must_not_overlap =
      folder.write("study.toml",
                   "[mechanism]\ntype = \"2t1r-p-hybrid\"\n[variables]\na = { min = 0.09, max = 0.11 }\n"
                   "[[objective]]\ntype = \"workspace-volume\"\n[[constraint]]\ntype = \"clearance\"\nmin = 0\n"
                   "[[stage]]\noptimiser = \"ga\"\npopulation = 4\ngenerations = 1\n"
                   "[workspace]\nmethod = \"voxels\"\ncells = { x = 4, z = 4, beta = 4 }\n");
  const std::vector<std::string> names = hybrid_golden()["margin_names"];
  int feasible_ones = 0;
  for (std::size_t i = 0; i < hybrid_golden()["feasibility"].size(); i += 2) {
    const json& entry = hybrid_golden()["feasibility"][i];
    SCOPED_TRACE(entry.dump());
    const auto result = pose(entry, {"--mode", mode_text(entry["wm"]), "--branch", entry["sb"] > 0 ? "+" : "-"},
                             links_must_not_overlap);
    const json found = result.json();
    const bool assembles = !entry["margins"].back().is_null();
    EXPECT_EQ(result.exit_code, assembles ? 0 : 1) << result.err;
    EXPECT_EQ(found["assembles"], assembles);
    EXPECT_EQ(found["feasible"], entry["feasible"]);
    EXPECT_EQ(found["reason"].is_null(), entry["feasible"]);
    feasible_ones += found["feasible"] == true;
    json clearance;  // the golden data have one for each pair of links
    for (std::size_t k = 0; k < names.size(); ++k) {
      const json& expected = entry["margins"][k];
      if (expected.is_null())
        EXPECT_FALSE(assembles) << names[k];
      else if (names[k].substr(0, 4) == "cap_")
        clearance = clearance.is_null() ? expected : std::min(clearance, expected);
      else
        expect_near(golden_margin(found["margins"], entry, names[k]), expected, names[k]);
    }
    EXPECT_EQ(clearance.is_null(), !assembles);
    if (assembles) expect_near(found["margins"]["clearance_min"], clearance, "clearance");
  }
  EXPECT_GT(feasible_ones, 3);
}

TEST(CliHybrid, InfluenceCoefficientsInBothDirections) {
  for (std::size_t i = 0; i < hybrid_golden()["jac"].size(); i += 3) {
    const json& entry = hybrid_golden()["jac"][i];
    SCOPED_TRACE(entry.dump());
    const std::string mode = mode_text(entry["wm"]);
    const json found = pose(entry, {"--mode", mode, "--velocity", assignments(kCoordinates, entry["V"]),
                                    "--acceleration", assignments(kCoordinates, entry["A"])})
                           .json();
    for (std::size_t r = 0; r < 4; ++r) {
      expect_near(found["joints"][kJoints[r]], entry["q"][r], "q");
      expect_near(found["joint_speeds"][r], entry["qd"][r], "qd");
      expect_near(found["joint_accelerations"][r], entry["qdd"][r], "qdd");
      for (std::size_t c = 0; c < 4; ++c) {
        expect_near(found["J"][r][c], entry["G_inv"][r][c], "J");
        for (std::size_t k = 0; k < 4; ++k) expect_near(found["H"][r][c][k], entry["H_inv"][r][c][k], "H");
      }
    }
    const auto forward = pkmopt({"forward", kName, "--set", hybrid_design(entry), "--joints",
                                 assignments(kJoints, entry["q"]), "--speeds", assignments(kJoints, entry["qd"]),
                                 "--accelerations", assignments(kJoints, entry["qdd"]), "--json"});
    ASSERT_EQ(forward.exit_code, 0) << forward.err;
    const json solutions = forward.json()["poses"];
    int own = 0;
    for (const json& solution : solutions) {
      if (std::fabs(solution["z"].get<double>() - entry["X"][2].get<double>()) > 1e-9 ||
          std::fabs(solution["beta"].get<double>() - entry["X"][3].get<double>()) > 1e-9)
        continue;
      ++own;
      EXPECT_EQ(solution["working_mode"], mode);
      for (std::size_t k = 0; k < 4; ++k) {
        expect_near(solution["velocity"][kCoordinates[k]], entry["V"][k], "V");
        EXPECT_NEAR(solution["acceleration"][kCoordinates[k]].get<double>(), entry["A"][k].get<double>(), 1e-8);
      }
    }
    EXPECT_EQ(own, 1);
  }
}

TEST(CliHybrid, AuxiliaryChain) {
  int turning = 0, stuck = 0;
  for (std::size_t i = 2; i < hybrid_golden()["aux"].size(); i += 3) {
    const json& entry = hybrid_golden()["aux"][i];
    SCOPED_TRACE(entry.dump());
    const std::string theta = "theta=" + entry["theta"].dump(), rate = ",theta=" + entry["thd"].dump(),
                      change = ",theta=" + entry["thdd"].dump();
    const auto quantities = [&](const std::string& inputs) -> json {
      return pose(entry, {"--input", inputs, "--velocity", assignments(kCoordinates, entry["V"]) + rate,
                          "--acceleration", assignments(kCoordinates, entry["A"]) + change})
          .json()["quantities"];
    };
    const json found = quantities(theta);
    expect_near(found["gamma"], entry["gamma"], "gamma");
    expect_near(found["gamma_speed"], entry["gd"], "gamma'");
    expect_near(found["gamma_acceleration"], entry["gdd"], "gamma''");
    for (std::size_t k = 0; k < 3; ++k) {
      const json none;
      const bool turns = !entry["gamma"].is_null();
      expect_near(found[std::string("omega_") + "xyz"[k]], turns ? entry["omega"][k] : none, "omega");
      expect_near(found[std::string("alpha_") + "xyz"[k]], turns ? entry["alpha"][k] : none, "alpha");
    }
    expect_near(quantities(theta + ",zeta=" + entry["zeta"].dump())["gamma"], entry["gamma_zeta"], "gamma at zeta");
    const json gamma = entry["gamma"].is_null() ? json(1.0) : entry["gamma"];
    const json back = quantities("gamma_wanted=" + gamma.dump())["theta_for_gamma"];
    expect_near(back, entry["theta_back"], "theta");
    (back.is_null() ? stuck : turning) += 1;
    if (!back.is_null()) expect_near(quantities("theta=" + back.dump())["gamma"], gamma, "gamma there and back");
  }
  EXPECT_GT(turning, 5);
  EXPECT_GT(stuck, 0);
}

TEST(CliHybrid, ForwardReportsItsStatus) {
  for (const json& entry : hybrid_golden()["fk"]) {
    SCOPED_TRACE(entry.dump());
    const auto result = pkmopt({"forward", kName, "--set", hybrid_design(entry), "--joints",
                                assignments(kJoints, entry["q"]), "--speeds", "s1=0.1", "--json"});
    EXPECT_EQ(result.exit_code, entry["status"] == "OK" ? 0 : 1);
    const json found = result.json();
    EXPECT_EQ(found["status"], entry["status"]);
    EXPECT_EQ(found["reason"].is_null(), entry["status"] == "OK");
    ASSERT_EQ(found["poses"].size(), entry["solutions"].size());
    for (std::size_t k = 0; k < entry["solutions"].size(); ++k) {
      const json &pose = found["poses"][k], &expected = entry["solutions"][k];
      const auto sign = [&](int i) { return std::string(expected["am"][i] > 0 ? "+" : "-"); };
      EXPECT_EQ(pose["mode"], sign(0) + "," + sign(1));
      for (std::size_t c = 0; c < 4; ++c)
        EXPECT_NEAR(pose[kCoordinates[c]].get<double>(), expected["X"][c].get<double>(), 1e-6);
      const int flags = expected["flags"];
      EXPECT_EQ(pose["double_roots"].size(), static_cast<std::size_t>((flags & 1) + (flags >> 1)));
      EXPECT_EQ(pose["velocity"].is_null(), flags != 0) << "double roots are singular";
    }
  }
}

TEST(CliHybrid, MotionOfThePaper) {
  const StudyFolder folder;
  const json& table = hybrid_golden()["motion"];
  const auto result = pkmopt({"trajectory", kName, "--motion", PKM_EXPERIMENTS "/2t1r-p-hybrid/motions/paper.toml",
                              "--samples", std::to_string(table.size()), "--json", "--csv", "m.csv"},
                             folder.path());
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json samples = result.json()["samples"];
  for (std::size_t k = 0; k < table.size(); ++k) {
    const json &found = samples[k], &row = table[k];
    for (std::size_t i = 0; i < 4; ++i) {
      expect_near(found["joints"][kJoints[i]], row["q"][i], "q");
      expect_near(found["speeds"][kJoints[i]], row["qd"][i], "qd");
      expect_near(found["accelerations"][kJoints[i]], row["qdd"][i], "qdd");
    }
    for (const auto& [name, key] : {std::pair{"theta", "theta"},
                                    {"theta_speed", "thd"},
                                    {"gamma", "gamma"},
                                    {"gamma_speed", "gd"},
                                    {"gamma_acceleration", "gdd"}})
      expect_near(found["quantities"][name], row[key], name);
    expect_near(found["quantities"]["omega_y"], row["omega"][1], "omega");
    expect_near(found["quantities"]["alpha_z"], row["alpha"][2], "alpha");
  }
  std::ifstream file(folder.path() + "/m.csv");
  std::string header;
  std::getline(file, header);
  EXPECT_THAT(header, HasSubstr(",feasible,reason,theta,theta_speed,theta_acceleration,zeta,"));
  EXPECT_THAT(header, HasSubstr(",phi1,phi2,shaft_length,aux_ratio_min,aux_ratio_max,gamma,gamma_speed,"
                                "gamma_acceleration,theta_for_gamma,omega_x,omega_y,omega_z,alpha_x,alpha_y,alpha_z"));
}

TEST(CliHybrid, InfeasibleSamplesAreMarked) {
  const StudyFolder folder;
  folder.write("m.toml",
               "type = \"points\"\ntime = 1\ntheta = \"2*t\"\n"
               "points = [{ x = 0, y = 0, z = 0.24, beta = 0 }, { x = 0.2 }, { z = 0.5 }]\n");
  const std::vector<std::string> command = {"trajectory", kName, "--motion", "m.toml", "--samples", "21", "--json"};
  const auto result = pkmopt(command, folder.path());
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("(--allow-infeasible accepts them)"));
  auto tolerant = command;
  tolerant.push_back("--allow-infeasible");
  EXPECT_EQ(pkmopt(tolerant, folder.path()).exit_code, 0);
  const json samples = result.json()["samples"];
  EXPECT_TRUE(samples.front()["feasible"]);
  EXPECT_EQ(samples[10]["reason"], "s1 max is violated");
  EXPECT_FALSE(samples[10]["speeds"].is_null());
  EXPECT_EQ(samples.back()["reason"], "n1 has no real value, so s1 is undefined");
  EXPECT_TRUE(samples.back()["speeds"].is_null());
}

TEST(CliHybrid, RejectsInvalidArguments) {
  const std::string at = "x=0,y=0,z=0.24,beta=0";
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"pose", kName, "--at", at, "--branch", "2"}, "--branch: found '2'; expected one of +, -"},
      {{"pose", kName, "--at", at, "--mode", "+,-,-/-", "--branch", "+"},
       "--branch: the mode +,-,-/- already specifies its branch"},
      {{"pose", kName, "--at", at, "--input", "theta=30 mm"}, "--input: found theta=30 mm; expected a number in rad"},
      {{"pose", kName, "--at", at, "--input", "gamma=1"},
       "--input: found the unknown name 'gamma'; expected one of theta, zeta, gamma_wanted"},
      {{"pose", kName, "--at", at, "--set", "s_min_3=0.2"},
       "--set: the range of joint s3 is empty: from 0.2 m to 0.15 m"},
      {{"pose", "quadrupteron", "--at", "x=0.2,y=0.2,z=0.2,phi=0", "--input", "theta=1"},
       "--input: mechanism quadrupteron has no inputs besides the pose"},
      {{"pose", "quadrupteron", "--at", "x=0.2,y=0.2,z=0.2,phi=0", "--branch", "-"},
       "--branch: mechanism quadrupteron has one branch only"},
  };
  for (const auto& [command, sentence] : cases) {
    const auto result = pkmopt(command);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, StartsWith("pkmopt: " + sentence));
    EXPECT_EQ(result.out, "");
  }
}

}  // namespace
}  // namespace pkm::testing
