// Kinematics and studies of (3CRR/R)&CRU and the Quadrupteron on the command line.
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
using ::testing::Not;

/// The design of a golden case as "l_11=...,...".
std::string crr_cru_design(const json& entry) {
  const json& p = entry.contains("params") ? entry["params"] : crr_cru_golden()["nominal"];
  std::string text = assignments({"r", "h", "l", "L", "rho_min", "rho_max"},
                                 {p["r"], p["h"], p["l"], p["L"], p["rho_min"], p["rho_max"]}) +
                     "," + assignments({"beta_1", "beta_2", "beta_3"}, p["beta"]);
  return text + "," + assignments({"l_11", "l_21", "l_31", "l_41"}, p["l1"]) + "," +
         assignments({"l_12", "l_22", "l_32", "l_42"}, p["l2"]);
}

TEST(CliCrrCru, PoseAndForwardOfGoldenCases) {
  for (std::size_t i = 0; i < crr_cru_golden()["cases"].size(); i += 3) {
    const json& entry = crr_cru_golden()["cases"][i];
    SCOPED_TRACE(entry["id"].dump());
    const std::string set = crr_cru_design(entry);
    const std::string mode = mode_text(entry["sigma"]);
    const auto result = pkmopt({"pose", entry["mechanism"], "--at", assignments({"x", "y", "z", "phi"}, entry["X"]),
                                "--mode", mode, "--set", set, "--json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const json pose = result.json();
    EXPECT_EQ(pose["mode"], mode);
    for (std::size_t k = 0; k < 4; ++k) {
      const std::string n = std::to_string(k + 1);
      EXPECT_NEAR(pose["joints"]["rho" + n], entry["q"][k].get<double>(), 1e-12);
      EXPECT_NEAR(pose["angles"]["theta_" + n + "1"], entry["theta1"][k].get<double>(), 1e-12);
      EXPECT_NEAR(pose["angles"]["theta_" + n + "2"], entry["theta2"][k].get<double>(), 1e-12);
      for (std::size_t j = 0; j < 4; ++j) EXPECT_NEAR(pose["J"][k][j], entry["J"][k][j].get<double>(), 1e-12);
    }
    EXPECT_NEAR(pose["angles"]["det_J"], entry["det_J"].get<double>(), 1e-12);
    EXPECT_NEAR(pose["indices"]["kappa_p"], entry["parallel_index"].get<double>(), 1e-12);
    EXPECT_EQ(pose["Jq"], json::parse("[[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]"));

    const json found = pkmopt({"forward", entry["mechanism"], "--joints",
                               assignments({"rho1", "rho2", "rho3", "rho4"}, entry["q"]), "--set", set, "--json"})
                           .json();
    ASSERT_EQ(found["poses"].size(), 2u);
    const json& own = found["poses"][entry["parallel_index"] > 0 ? 0 : 1];
    const char* const names[4] = {"x", "y", "z", "phi"};
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(own[names[k]], entry["X"][k].get<double>(), 1e-11);
  }
}

TEST(CliCrrCru, PrintsOnlyValuesThatExist) {
  const auto text = pkmopt({"pose", "quadrupteron", "--at", "x=0.2,y=0.17,z=0.22,phi=0.3"});
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_THAT(text.out, HasSubstr("  mode       -,-,+,-\n"));
  EXPECT_THAT(text.out, HasSubstr("\nJ = Jq^-1 G, where qdot = J V\n"));
  EXPECT_THAT(text.out, HasSubstr("  kappa_p"));
  EXPECT_THAT(text.out, Not(HasSubstr("inputs, and quantities of the motion")));

  const auto far = pkmopt({"pose", "quadrupteron", "--at", "x=0.2,y=0.17,z=1.22,phi=0.3", "--json"});
  EXPECT_EQ(far.exit_code, 1);
  EXPECT_EQ(far.json()["assembles"], false);
  for (const char* key : {"J", "Jq", "G", "H", "T", "det_Jq", "joint_speeds", "conditioning"})
    EXPECT_TRUE(far.json()[key].is_null()) << key;
  EXPECT_LT(far.json()["margins"]["limb1 reaches"], 0);
  EXPECT_TRUE(far.json()["margins"]["s_min"].is_null());
  EXPECT_GT(far.json()["margins"]["c_min"], 0) << "of the yaw alone";

  const json info = pkmopt({"list", "mechanisms", "3crr-r-cru", "--json"}).json();
  EXPECT_EQ(info["modes"].size(), 16u);
  EXPECT_EQ(info["default_mode"], "-,-,+,-");
  EXPECT_EQ(info["fixed"], json::array({"phi"}));
  EXPECT_EQ(info["columns_along"], "z");
  const json& others = info["other_sweeps"];
  EXPECT_EQ(others.size(), 13u) << "every set of coordinates but the default one and all four";
  for (const json& sweep : others) {
    EXPECT_EQ(sweep["fixed"].size() + sweep["swept"].size(), 4u);
    EXPECT_THAT(sweep["swept"], ::testing::Contains(sweep["columns_along"]));
  }
  EXPECT_EQ(others[2]["fixed"], json::array({"x"}));
  EXPECT_EQ(others[2]["columns_along"], "z");
  EXPECT_THAT(pkmopt({"list", "mechanisms", "3crr-r-cru"}).out, HasSubstr("other_sweeps"));
}

TEST(CliCrrCru, StudyFixesTheCoordinateThatItNames) {
  const StudyFolder folder;
  const auto study = [&](const std::string& workspace) {
    return folder.write("s.toml",
                        "[mechanism]\ntype = \"quadrupteron\"\n[variables]\nr = { min = 0.03, max = 0.05 }\n"
                        "[[objective]]\ntype = \"workspace-volume\"\n[[stage]]\noptimiser = \"ga\"\n"
                        "population = 4\ngenerations = 1\n[workspace]\n" +
                            workspace);
  };
  const json at_phi = pkmopt({"evaluate", study("phi = \"20 deg\""), "--json"}).json();
  EXPECT_EQ(at_phi["workspace"]["unit"], "m^3");
  const json at_z = pkmopt({"evaluate", study("z = \"220 mm\""), "--json"}).json();
  EXPECT_EQ(at_z["workspace"]["unit"], "m^2 rad");
  const json voxels =
      pkmopt({"evaluate", study("z = \"220 mm\"\nmethod = \"voxels\"\ncells = { x = 80, y = 80, phi = 80 }"), "--json"})
          .json();
  EXPECT_NEAR(voxels["workspace"]["volume"].get<double>() / at_z["workspace"]["volume"].get<double>(), 1, 0.01);
  const json check = pkmopt({"check", study("z = \"220 mm\""), "--json"}).json();
  EXPECT_EQ(check["workspace"]["z"], 0.22);
  EXPECT_FALSE(check["workspace"].contains("phi"));
  const auto run = pkmopt({"run", study("z = \"220 mm\""), "--output", folder.path() + "/s.h5", "--quiet"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
}

}  // namespace
}  // namespace pkm::testing
