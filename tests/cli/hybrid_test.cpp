// The hybrid robot through the command line: golden poses, the auxiliary chain, forward motion, the paper's motion.
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

/// "a=0.1,...,s_min_1=-0.15,..." of the design that an entry refers to.
std::string hybrid_design(const json& entry) {
  const json& fields =
      entry.contains("design_inline") ? entry["design_inline"] : hybrid_golden()["designs"][entry["design"].get<int>()];
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

/// Nulls where the golden data has them, numbers near its own elsewhere.
void expect_near(const json& found, const json& expected, const std::string& what) {
  if (expected.is_null()) {
    EXPECT_TRUE(found.is_null()) << what;
    return;
  }
  ASSERT_TRUE(found.is_number()) << what << ": " << found.dump();
  EXPECT_NEAR(found.get<double>(), expected.get<double>(), 1e-11 * (1 + std::fabs(expected.get<double>()))) << what;
}

ProgramResult pose(const json& entry, std::vector<std::string> more) {
  std::vector<std::string> command = {
      "pose", kName, "--at", assignments(kCoordinates, entry["X"]), "--set", hybrid_design(entry), "--json"};
  command.insert(command.end(), more.begin(), more.end());
  return pkmopt(command);
}

TEST(CliHybrid, MarginsOfGoldenPoses) {
  const std::vector<std::string> names = hybrid_golden()["margin_names"];
  for (std::size_t i = 0; i < hybrid_golden()["feasibility"].size(); i += 2) {
    const json& entry = hybrid_golden()["feasibility"][i];
    SCOPED_TRACE(entry.dump());
    const auto result = pose(entry, {"--mode", mode_text(entry["wm"]), "--branch", entry["sb"] > 0 ? "+" : "-"});
    const json found = result.json();
    const bool assembles = !entry["margins"].back().is_null();
    EXPECT_EQ(result.exit_code, assembles ? 0 : 1) << result.err;
    EXPECT_EQ(found["assembles"], assembles);
    EXPECT_EQ(found["feasible"], entry["feasible"]);
    EXPECT_EQ(found["reason"].is_null(), entry["feasible"]);
    ASSERT_EQ(found["margins"].size(), names.size());
    for (std::size_t k = 0; k < names.size(); ++k)
      expect_near(found["margins"][names[k]], entry["margins"][k], names[k]);
  }
}

TEST(CliHybrid, InfluenceCoefficientsBothWays) {
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
  for (std::size_t i = 0; i < hybrid_golden()["aux"].size(); i += 3) {
    const json& entry = hybrid_golden()["aux"][i];
    SCOPED_TRACE(entry.dump());
    const std::string rate = ",theta=" + entry["thd"].dump(), change = ",theta=" + entry["thdd"].dump();
    const std::vector<std::string> motion = {"--theta",        entry["theta"].dump(),
                                             "--velocity",     assignments(kCoordinates, entry["V"]) + rate,
                                             "--acceleration", assignments(kCoordinates, entry["A"]) + change};
    const json found = pose(entry, motion).json();
    expect_near(found["angles"]["gamma"], entry["gamma"], "gamma");
    expect_near(found["chain"]["gamma_speed"], entry["gd"], "gamma'");
    expect_near(found["chain"]["gamma_acceleration"], entry["gdd"], "gamma''");
    EXPECT_EQ(found["chain"]["reason"].is_null(), !entry["gamma"].is_null());
    for (std::size_t k = 0; k < 3 && !entry["gamma"].is_null(); ++k) {
      expect_near(found["chain"]["omega"][k], entry["omega"][k], "omega");
      expect_near(found["chain"]["alpha"][k], entry["alpha"][k], "alpha");
    }
    const json phased = pose(entry, {"--theta", entry["theta"].dump(), "--zeta", entry["zeta"].dump()}).json();
    expect_near(phased["angles"]["gamma"], entry["gamma_zeta"], "gamma at zeta");
    if (entry["gamma"].is_null()) continue;
    const json back = pose(entry, {"--gamma", entry["gamma"].dump()}).json();
    expect_near(back["chain"]["theta"], entry["theta_back"], "theta");
    expect_near(back["angles"]["gamma"], entry["gamma"], "gamma there and back");
  }
}

TEST(CliHybrid, ForwardTellsItsStatus) {
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
      EXPECT_EQ(pose["velocity"].is_null(), flags != 0) << "singular where roots meet";
    }
  }
}

TEST(CliHybrid, TheMotionOfThePaper) {
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
      expect_near(found["chain"][name], row[key], name);
    expect_near(found["chain"]["omega_y"], row["omega"][1], "omega");
    expect_near(found["chain"]["alpha_z"], row["alpha"][2], "alpha");
  }
  std::ifstream file(folder.path() + "/m.csv");
  std::string header;
  std::getline(file, header);
  EXPECT_THAT(header, HasSubstr("feasible,reason,theta,theta_speed,theta_acceleration,gamma,gamma_speed,"
                                "gamma_acceleration,phi1,phi2,shaft_length,omega_x,omega_y,omega_z,"
                                "alpha_x,alpha_y,alpha_z"));
}

TEST(CliHybrid, InfeasibleSamplesAreMarked) {
  const StudyFolder folder;
  folder.write("m.toml",
               "type = \"points\"\ntime = 1\ntheta = \"2*t\"\n"
               "points = [{ x = 0, y = 0, z = 0.24, beta = 0 }, { x = 0.2 }, { z = 0.5 }]\n");
  const std::vector<std::string> command = {"trajectory", kName, "--motion", "m.toml", "--samples", "21", "--json"};
  const auto result = pkmopt(command, folder.path());
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("(--allow-infeasible takes them)"));
  auto tolerant = command;
  tolerant.push_back("--allow-infeasible");
  EXPECT_EQ(pkmopt(tolerant, folder.path()).exit_code, 0);
  const json samples = result.json()["samples"];
  EXPECT_TRUE(samples.front()["feasible"]);
  EXPECT_THAT(samples[10]["reason"].get<std::string>(), StartsWith("limit "));
  EXPECT_FALSE(samples[10]["speeds"].is_null());
  EXPECT_THAT(samples.back()["reason"].get<std::string>(), StartsWith("limb A: out of reach of its link"));
  EXPECT_TRUE(samples.back()["speeds"].is_null());
}

TEST(CliHybrid, WrongInputIsRefusedInOneSentence) {
  const std::string at = "x=0,y=0,z=0.24,beta=0";
  const std::vector<std::pair<std::vector<std::string>, std::string>> refusals = {
      {{"pose", kName, "--at", at, "--branch", "2"}, "--branch: found '2'; expected one of +, -"},
      {{"pose", kName, "--at", at, "--mode", "+,-,-/-", "--branch", "+"},
       "--branch: the mode +,-,-/- says its branch itself"},
      {{"pose", kName, "--at", at, "--theta", "30 mm"}, "--theta: found 30 mm; expected a number in rad"},
      {{"pose", kName, "--at", at, "--set", "s_min_3=0.2"},
       "--set: s_min_3 = 0.2 m leaves no range below s_max_3 = 0.15 m"},
      {{"pose", "quadrupteron", "--at", "x=0.2,y=0.2,z=0.2,phi=0", "--theta", "1"},
       "--theta: mechanism quadrupteron has no auxiliary chain"},
      {{"pose", "quadrupteron", "--at", "x=0.2,y=0.2,z=0.2,phi=0", "--branch", "-"},
       "--branch: mechanism quadrupteron has one branch only"},
  };
  for (const auto& [command, sentence] : refusals) {
    const auto result = pkmopt(command);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, StartsWith("pkmopt: " + sentence));
    EXPECT_EQ(result.out, "");
  }
}

}  // namespace
}  // namespace pkm::testing
