// Golden data of the 4PPa-2PaR and the numbers of its paper, computed on the command line.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/cli/crr_cru_golden.hpp"
#include "tests/cli/run_program.hpp"
#include "tests/cli/study_folder.hpp"

namespace pkm::testing {
namespace {

using nlohmann::json;

constexpr double kRoundoff = 1e-13;
constexpr double kPi = 3.14159265358979323846;

const json& four_ppa_golden() {
  static const json data = json::parse(std::ifstream(PKM_TEST_DATA "/4ppa-2par.json"));
  return data;
}

std::string four_ppa_design(const json& design) {
  return assignments({"a", "b", "l_u", "l_d", "d", "L0"},
                     {design["a"], design["b"], design["lu"], design["ld"], design["d"], design["L0"]});
}

json pose_json(const std::string& at, const std::string& mode, const std::string& set) {
  const auto result = pkmopt({"pose", "4ppa-2par", "--at", at, "--mode", mode, "--set", set, "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return result.json();
}

/// Distance (maximum norm) of `pose` [x, y, z, theta] from the nearest of `poses`.
double distance_to_nearest(const json& poses, const json& pose) {
  double minimum = 1e9;
  for (const auto& found : poses)
    minimum = std::min(minimum, std::max({std::fabs(found["x"].get<double>() - pose[0].get<double>()),
                                          std::fabs(found["y"].get<double>() - pose[1].get<double>()),
                                          std::fabs(found["z"].get<double>() - pose[2].get<double>()),
                                          std::fabs(found["theta"].get<double>() - pose[3].get<double>())}));
  return minimum;
}

TEST(CliGolden, PoseAndForwardOfEveryCase) {
  for (const auto& entry : four_ppa_golden()["kinematics"]) {
    SCOPED_TRACE(entry["design"].dump());
    const auto word = [](int mode) { return std::string(mode == 1 ? "lower" : "upper"); };
    const std::string set = four_ppa_design(entry["design"]);
    const json pose = pose_json(assignments({"x", "y", "z", "theta"}, entry["pose"]),
                                word(entry["modes"][0]) + "," + word(entry["modes"][1]), set);
    const char* const joints[4] = {"q1", "q2", "q3", "q4"};
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(pose["joints"][joints[i]], entry["q"][i], kRoundoff);
      for (std::size_t j = 0; j < 4; ++j) {
        const double jq = entry["Jq"][i][j];
        // Of the joints, from which sqrt(l_u^2 - h^2) loses digits where the bars are nearly parallel to the rail.
        EXPECT_NEAR(pose["Jq"][i][j], jq, 2 * kRoundoff * (1 + std::fabs(jq)));
        EXPECT_NEAR(pose["G"][i][j], entry["G"][i][j], kRoundoff);
        double product = 0;  // Jq J = G
        for (std::size_t k = 0; k < 4; ++k) product += pose["Jq"][i][k].get<double>() * pose["J"][k][j].get<double>();
        EXPECT_NEAR(product, entry["G"][i][j], 1e-10);
      }
    }
    EXPECT_NEAR(pose["det_Jq"].get<double>() / entry["det_Jq"].get<double>(), 1, 1e-12);
    EXPECT_NEAR(pose["det_G"], entry["det_G"], kRoundoff);
    EXPECT_NEAR(pose["angles"]["alpha_1"], entry["alpha"][0], kRoundoff);
    EXPECT_NEAR(pose["angles"]["beta_2"], entry["beta"][1], kRoundoff);

    const auto forward = pkmopt({"forward", "4ppa-2par", "--joints", assignments({"q1", "q2", "q3", "q4"}, entry["q"]),
                                 "--set", set, "--json"});
    EXPECT_EQ(forward.exit_code, 0);
    const json poses = forward.json()["poses"];
    EXPECT_EQ(poses.size(), entry["fk_all"].size());
    for (const auto& expected : entry["fk_all"]) EXPECT_LT(distance_to_nearest(poses, expected), 1e-12) << expected;
  }
}

TEST(CliGolden, VolumesOfEveryCase) {
  const StudyFolder folder;
  for (const auto& entry : four_ppa_golden()["workspace"]) {
    SCOPED_TRACE(entry["design"].dump());
    std::ostringstream workspace;
    workspace << "y = " << entry["y"].dump() << "\nlimits = {";
    for (const auto& [name, value] : entry["limits"].items())
      workspace << (name == "alpha_min" ? " " : ", ") << name << " = " << value.dump();
    const auto evaluate = [&](const std::string& method) {
      const auto file = folder.write("s.toml", study_with("[workspace]\n" + method + "\n" + workspace.str() + " }"));
      const auto result = pkmopt({"evaluate", file, "--set", four_ppa_design(entry["design"]), "--json"});
      EXPECT_EQ(result.exit_code, 0) << result.err;
      return result.json()["workspace"];
    };
    const json exact = evaluate("method = \"columns\"");
    EXPECT_EQ(exact["method"], "columns");
    EXPECT_EQ(exact["unit"], "m^2 rad");
    EXPECT_NEAR(exact["volume"].get<double>() / entry["volume_exact"].get<double>(), 1, 1e-8);
    const json& grid = entry["voxel"][0];
    const json voxels = evaluate("method = \"voxels\"\ncells = { x = " + grid["cells"][0].dump() +
                                 ", z = " + grid["cells"][1].dump() + ", theta = " + grid["cells"][2].dump() + " }");
    EXPECT_EQ(voxels["method"], "voxels");
    EXPECT_EQ(voxels["feasible_cells"], grid["feasible"]);
    EXPECT_NEAR(voxels["cell_volume"].get<double>() / grid["cell_volume"].get<double>(), 1, kRoundoff);
    EXPECT_NEAR(voxels["volume"].get<double>() / grid["volume"].get<double>(), 1, kRoundoff);
  }
}

// The paper's original and optimal design (table 8): exact volumes, and feasible cells of the paper's grid.
TEST(CliPaper, TwoDesigns) {
  const StudyFolder folder;
  const auto voxels = folder.write("voxels.toml", study_with("[workspace]\nmethod = \"voxels\""));
  struct Row {
    const char* set;
    double volume, ratio;
    int cells;
  };
  for (const Row& row : {Row{"a=0.2,b=0.8,l_u=0.6,l_d=0.55", 0.550157374606, 0.1903484036, 12412},
                         Row{"a=0.3,b=1,l_u=0.7,l_d=0.7", 0.851292176055, 0.1935533684, 12564}}) {
    const json exact = pkmopt({"evaluate", "4ppa-2par", "--set", row.set, "--json"}).json();
    EXPECT_NEAR(exact["workspace"]["volume"], row.volume, 1e-10);
    EXPECT_NEAR(exact["objectives"]["workspace-volume"], row.volume, 1e-10);
    EXPECT_NEAR(exact["objectives"]["workspace-ratio"], row.ratio, 1e-10);
    const json counted = pkmopt({"evaluate", voxels, "--set", row.set, "--json"}).json()["workspace"];
    EXPECT_EQ(counted["feasible_cells"], row.cells);
    EXPECT_EQ(counted["cells"], 32 * 34 * 60);
  }
}

// Volumes of the same two designs under the clearance of an example study.
TEST(CliPaper, TwoDesignsUnderAClearance) {
  const std::string study = PKM_EXPERIMENTS "/4ppa-2par/clearance.toml";
  struct Row {
    const char* set;
    double volume;
  };
  for (const Row& row : {Row{"a=0.2,b=0.8,l_u=0.6,l_d=0.55", 0.536505}, Row{"a=0.3,b=1,l_u=0.7,l_d=0.7", 0.835146}}) {
    const json limited = pkmopt({"evaluate", study, "--set", row.set, "--json"}).json();
    EXPECT_NEAR(limited["workspace"]["volume"], row.volume, 5e-7);
    EXPECT_LT(limited["workspace"]["relative_error"], 1e-8);
  }
}

// Table 2, rows with C_j below the rails; the paper prints 4 digits.
TEST(CliPaper, TableTwo) {
  struct Row {
    std::string at, mode;
    std::array<double, 4> q;
  };
  for (const Row& row : {Row{"x=0.40,y=1.25,z=-0.20,theta=0", "lower,lower", {0.8129, 1.6871, 0.8129, 1.6871}},
                         Row{"x=0.40,y=1.25,z=-0.20,theta=0", "upper,lower", {0.9355, 1.5645, 0.8129, 1.6871}},
                         Row{"x=0.40,y=1.25,z=-0.20,theta=0", "lower,upper", {0.8129, 1.6871, 0.9355, 1.5645}},
                         Row{"x=0.40,y=1.25,z=-0.20,theta=0", "upper,upper", {0.9355, 1.5645, 0.9355, 1.5645}},
                         Row{"x=0.25,y=0.85,z=-0.80,theta=30deg", "lower,lower", {0.2131, 1.3869, 0.4154, 1.3846}},
                         Row{"x=0.50,y=1.50,z=-0.15,theta=60 deg", "upper,upper", {0.9035, 1.9233, 1.2402, 1.9330}}}) {
    const json joints = pose_json(row.at, row.mode, "d=150mm")["joints"];
    const char* const names[4] = {"q1", "q2", "q3", "q4"};
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(joints[names[i]], row.q[i], 5.1e-5) << row.at;
  }
}

// Table 3: its joint values have 4 digits, so the poses agree only to that accuracy.
TEST(CliPaper, TableThree) {
  const auto poses = [](const std::string& joints) {
    return pkmopt({"forward", "4ppa-2par", "--joints", joints, "--json"}).json()["poses"];
  };
  constexpr double kPrinted = 1.5e-4;
  const json first = poses("q1=0.9355,q2=1.5645,q3=0.9355,q4=1.5645");
  EXPECT_EQ(first.size(), 4U);
  EXPECT_LT(distance_to_nearest(first, {0.4, 1.25, -0.2000, 0}), kPrinted);
  EXPECT_LT(distance_to_nearest(first, {0.4, 1.25, -1.1219, 0}), kPrinted);
  EXPECT_LT(distance_to_nearest(first, {0.4, 1.25, -0.4318, kPi}), kPrinted);
  EXPECT_LT(distance_to_nearest(first, {0.4, 1.25, -0.8901, kPi}), kPrinted);
  const json second = poses("q1=0.2131,q2=1.3869,q3=0.4154,q4=1.3846");
  EXPECT_LT(distance_to_nearest(second, {0.5501, 0.85, 0.0214, 0.5236}), kPrinted);
  EXPECT_LT(distance_to_nearest(second, {0.2499, 0.85, -0.8000, 0.5236}), kPrinted);
  EXPECT_LT(distance_to_nearest(second, {0.4526, 0.85, -0.1660, 2.6180}), kPrinted);
  EXPECT_LT(distance_to_nearest(second, {0.3475, 0.85, -0.6125, 2.6180}), kPrinted);
  const json third = poses("q1=0.9035,q2=1.9233,q3=1.2402,q4=1.9330");
  EXPECT_LT(distance_to_nearest(third, {0.5000, 1.5, -0.1500, 1.0471}), kPrinted);
  EXPECT_LT(distance_to_nearest(third, {0.3424, 1.5, -0.8516, 2.0944}), kPrinted);
}

}  // namespace
}  // namespace pkm::testing
