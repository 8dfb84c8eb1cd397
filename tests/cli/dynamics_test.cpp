// `pkmopt dynamics` and `pkmopt coupling`.
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

const std::vector<std::string> kPoseNames = {"x", "y", "z", "phi"};

/// The joint that the golden data call "a2", "b2", "c2" (slide, between the rods, at the platform) of limb 2; "t1" is
/// the platforms' joint.
std::string joint_of(const std::string& golden_name) {
  const std::string limb = "limb" + golden_name.substr(1) + ".";
  switch (golden_name[0]) {
    case 'a':
      return limb + "S";
    case 'b':
      return limb + "C";
    case 'c':
      return limb + "B";
    default:
      return golden_name;
  }
}

TEST(CliDynamics, MatchesGoldenCasesWithReactions) {
  int cases = 0;
  for (const json& entry : crr_cru_golden()["cases"]) {
    if (entry.contains("params")) continue;
    if (++cases > 6) break;
    SCOPED_TRACE(entry["id"].dump());
    const std::string mode = mode_text(entry["sigma"]);
    const auto result =
        pkmopt({"dynamics", entry["mechanism"], "--at", assignments(kPoseNames, entry["X"]), "--velocity",
                assignments(kPoseNames, entry["Xd"]), "--acceleration", assignments(kPoseNames, entry["Xdd"]),
                "--wrench", assignments({"Fx", "Fy", "Fz"}, entry["F"]), "--wrench",
                assignments({"Mx", "My", "Mz"}, entry["M"]), "--mode=" + mode, "--reactions", "--json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const json found = result.json();
    double largest = 1;
    for (const json& tau : entry["tau"]) largest = std::fmax(largest, std::fabs(tau.get<double>()));
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(found["joints"]["rho" + std::to_string(i + 1)], entry["q"][i].get<double>(), 1e-12);
      EXPECT_NEAR(found["tau"][i], entry["tau"][i].get<double>(), 1e-10 * largest);
      EXPECT_NEAR(found["gravity"][i], entry["gravity_q"][i].get<double>(), 1e-10 * largest);
      EXPECT_NEAR(found["coriolis"][i], entry["velocity_q"][i].get<double>(), 1e-10 * largest);
      EXPECT_NEAR(found["power"][i], entry["power"][i].get<double>(), 1e-9 * largest);
      EXPECT_NEAR(found["dci"][i], entry["DCI"][i].get<double>(), 1e-10);
      for (std::size_t j = 0; j < 4; ++j) {
        EXPECT_NEAR(found["Mq"][i][j], entry["M_q"][i][j].get<double>(), 1e-9);
        EXPECT_NEAR(found["J"][i][j], entry["J"][i][j].get<double>(), 1e-12);
      }
    }
    const json& reactions = found["reactions"];
    EXPECT_EQ(reactions["joints"].size(), entry["joint_forces"].size());
    for (const auto& [joint, force] : entry["joint_forces"].items())
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_NEAR(reactions["joints"][joint_of(joint)]["force"][k], force[k].get<double>(), 1e-9 * largest) << joint;
    EXPECT_TRUE(reactions["joints"]["limb2.S"]["couple"][0].is_null()) << "undetermined in both mechanisms";
    EXPECT_EQ(reactions["rank"], entry["mechanism"] == "quadrupteron" ? 54 : 60);
  }
  EXPECT_GT(cases, 3);
}

TEST(CliDynamics, OmittedValuesAreZeroAndMassesCanFollowTheLengths) {
  const std::string at = "x=0.2,y=0.17,z=0.22,phi=0.3";
  const json rest = pkmopt({"dynamics", "3crr-r-cru", "--at", at, "--json"}).json();
  const double expected[] = {0.483640491257, 0.003370122739, 7.930265766777, -0.262452159851};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(rest["tau"][i], expected[i], 1e-11);
    EXPECT_EQ(rest["tau"][i], rest["gravity"][i]);
  }
  const json follow = pkmopt({"dynamics", "3crr-r-cru", "--at", at, "--masses", "geometry", "--json"}).json();
  EXPECT_EQ(follow["masses"], "geometry");
  EXPECT_NEAR(follow["tau"][2], 7.93, 0.2) << "the mass model is fitted to the same rods";
  EXPECT_NE(follow["tau"][2], rest["tau"][2]);
  EXPECT_THAT(pkmopt({"dynamics", "3crr-r-cru", "--at", at}).out, HasSubstr("coupling index"));
}

TEST(CliDynamics, RejectsInvalidArguments) {
  const std::vector<std::string> head = {"dynamics", "3crr-r-cru", "--at"};
  const std::string at = "x=0.2,y=0.17,z=0.22,phi=0.3";
  const auto message = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = head;
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto result = pkmopt(arguments);
    EXPECT_EQ(result.exit_code, 2);
    return result.err;
  };
  EXPECT_EQ(message({at, "--wrench", "Fq=1"}),
            "pkmopt: --wrench: found the unknown name 'Fq'; expected one of Fx, Fy, Fz, Mx, My, Mz; did you mean "
            "'Fx'?\n");
  EXPECT_EQ(message({at, "--masses", "geometri"}),
            "pkmopt: --masses: found 'geometri'; expected one of table, geometry; did you mean 'geometry'?\n");
  EXPECT_THAT(message({at, "--set", "m_11=-1"}), HasSubstr("--set: found m_11=-1"));
  EXPECT_THAT(message({at, "--masses", "geometry", "--set", "m_11=1"}), HasSubstr("the unknown name 'm_11'"));
  const auto away = pkmopt({"dynamics", "3crr-r-cru", "--at", "x=2,y=0.17,z=0.22,phi=0", "--json"});
  EXPECT_EQ(away.exit_code, 1);
  EXPECT_TRUE(away.json()["Mq"].is_null());
  EXPECT_EQ(
      pkmopt({"dynamics", PKM_EXPERIMENTS "/mechanisms/par4.toml", "--at", "x=0,y=0,z=-0.7,phi=0", "--reactions"}).err,
      "pkmopt: --reactions: mechanism par4 has no model of the forces in its joints: limb arm1 ends at `end`, but "
      "the body there is unknown; give end_on = \"platform\" or the name of a [[body]]\n");
}

TEST(CliCoupling, GoldenStatisticsAndTheirTable) {
  const StudyFolder folder;
  for (const json& entry : crr_cru_golden()["dci_stats"]) {
    if (entry["n"][0] != 7) continue;  // the other cases have limits, which need a study
    const auto range = [&](const char* name, std::size_t k) {
      return std::string(name) + "=" + entry["lo"][k].dump() + ":" + entry["hi"][k].dump();
    };
    const auto result = pkmopt(
        {"coupling", entry["mechanism"], "--box", range("x", 0) + "," + range("y", 1) + "," + range("z", 2), "--cells",
         "x=7,y=7,z=7", "--phi", entry["phi"].dump(), "--csv", folder.path() + "/map.csv", "--force", "--json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const json found = result.json()["statistics"];
    EXPECT_EQ(found["samples"], entry["feasible"]);
    for (std::size_t i = 0; i < 4; ++i)
      for (const char* statistic : {"max", "mean", "std", "p95"})
        EXPECT_NEAR(found[statistic][std::to_string(i + 1)], entry[statistic][i].get<double>(), 1e-9) << statistic;
    std::ifstream map(folder.path() + "/map.csv");
    std::string line;
    std::getline(map, line);
    EXPECT_EQ(line, "x,y,z,phi,dci_1,dci_2,dci_3,dci_4,dci_worst");
    int lines = 0;
    while (std::getline(map, line)) ++lines;
    EXPECT_EQ(lines, entry["feasible"].get<int>());
  }
}

TEST(CliCoupling, SeveralAnglesAndInvalidArguments) {
  const std::string box = "x=0.12:0.2,y=0.12:0.2,z=0.17:0.24";
  const json found =
      pkmopt({"coupling", "quadrupteron", "--box", box, "--cells", "x=4,y=4,z=4", "--phi=-30deg:30deg:3", "--json"})
          .json();
  ASSERT_EQ(found["each"].size(), 3u);
  double mean = 0;
  for (const json& one : found["each"]) mean += one["mean"]["worst"].get<double>() / 3;
  EXPECT_NEAR(found["statistics"]["mean"]["worst"], mean, 1e-12) << "all cells are feasible at each angle";
  EXPECT_EQ(found["each"][1]["phi"], 0.0);
  EXPECT_EQ(pkmopt({"coupling", "quadrupteron", "--box", "x=0.1:0"}).err,
            "pkmopt: --box: found x=0.1:0; expected a range from:to with from < to\n");
  EXPECT_THAT(pkmopt({"coupling", "quadrupteron", "--phi", "0:1:x"}).err, HasSubstr("from:to:count"));
  EXPECT_EQ(pkmopt({"coupling", "4ppa-2par", "--phi", "0"}).err,
            "pkmopt: --phi: phi is not a fixed coordinate; fixed: y\n");
  EXPECT_THAT(pkmopt({"coupling", "quadrupteron", "--cells", "x=1.5,y=2,z=2"}).err, HasSubstr("whole number"));
}

}  // namespace
}  // namespace pkm::testing
