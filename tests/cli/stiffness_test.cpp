// `pkmopt pose --stiffness`: compliance, stiffness, natural frequencies and deflection, against published and
// independently computed values; and the exact error of --joint-error.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/run_program.hpp"
#include "tests/cli/study_folder.hpp"

namespace pkm::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

/// Three slides along x, y, z with rods of 310.6 mm that have universal joints: a 3-PUU translator like the Orthoglide.
std::string translator() {
  std::string text = R"([mechanism]
name = "3-puu"
[parameters]
L = { default = "310.6 mm", min = "0.1 m", max = "1 m" }
[platform]
coordinates = { x = "along x", y = "along y", z = "along z" }
mass = "3 kg"
[survey]
box = { x = ["-L", "L"], y = ["-L", "L"], z = ["-L", "L"] }
)";
  const char* const directions[] = {"[1, 0, 0]", "[0, 1, 0]", "[0, 0, 1]"};
  for (int i = 0; i < 3; ++i)
    text += "[[limb]]\nname = \"limb" + std::to_string(i + 1) + "\"\ndrive = \"slider\"\nbase = [0, 0, 0]\n" +
            "direction = " + directions[i] + "\nuniversal = " + directions[(i + 1) % 3] +
            "\nrod = \"L\"\nplatform = [0, 0, 0]\nbranch = \"+\"\ndrive_stiffness = 5e6\n"
            "rod_section = { outer = \"20 mm\", young = \"70 GPa\", shear = \"26 GPa\" }\n";
  return text;
}

TEST(CliStiffness, OfATranslatorWithUniversalJoints) {
  const StudyFolder folder;
  const std::string file = folder.write("3-puu.toml", translator());
  const auto at = [&](const std::string& pose) {
    return pkmopt({"pose", file, "--at", pose, "--stiffness", "--wrench", "Fx=100N", "--json"}).json()["stiffness"];
  };
  const json centre = at("x=0,y=0,z=0");
  EXPECT_EQ(centre["carried_wrenches"], 6);
  EXPECT_NEAR(centre["translation"].get<double>(), 4670194.062, 1e-3);
  EXPECT_NEAR(centre["rotation"].get<double>(), 1314.897118, 1e-6);
  EXPECT_NEAR(centre["deflection"][0].get<double>(), 21.412386e-6, 1e-12);
  EXPECT_EQ(centre["deflection"][1], 0);
  ASSERT_EQ(centre["natural_frequencies"].size(), 3U);
  for (const double frequency : centre["natural_frequencies"]) EXPECT_NEAR(frequency, 198.576096, 1e-6);
  const json corner = at("x=-126.8019193mm,y=-126.8019193mm,z=-126.8019193mm");  // -L/sqrt(6)
  EXPECT_NEAR(corner["matrix"][0][0].get<double>(), 6781628.944, 2e-1);
  EXPECT_NEAR(corner["matrix"][0][1].get<double>(), 5651357.453, 2e-1);
  EXPECT_NEAR(corner["deflection"][0].get<double>(), 60.826094e-6, 1e-11);
  const auto printed = pkmopt({"pose", file, "--at", "x=0,y=0,z=0", "--stiffness", "--wrench", "Fx=100N"});
  EXPECT_THAT(printed.out, HasSubstr(" 21.41 um"));
}

/// `pose --stiffness` of a mechanism file.
json stiffness_of(const std::string& file, const std::string& at) {
  return pkmopt({"pose", file, "--at", at, "--stiffness", "--json"}).json()["stiffness"];
}

void expect_frequencies(const json& found, const std::vector<double>& expected) {
  ASSERT_EQ(found.size(), expected.size()) << found;
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(found[i].get<double>(), expected[i], 1e-6) << i;
}

/// Drives of 1000 N m/rad and 1 kg at the tool; the frequencies were computed by an independent program.
TEST(CliStiffness, FrequenciesOfAFiveBar) {
  const StudyFolder folder;
  const std::string file = folder.write("five-bar.toml", R"([mechanism]
name = "five-bar"
[parameters]
d = { default = "137.5 mm", min = 0, max = "1 m" }
[platform]
coordinates = { x = "along x", y = "along y" }
mass = "1 kg"
[[limb]]
name = "left"
drive = "crank"
base = ["-d", 0, 0]
axis = [0, 0, 1]
zero = [1, 0, 0]
across = [0, 0, 1]
crank = "230 mm"
rod = "230 mm"
platform = [0, 0, 0]
branch = "+"
drive_stiffness = 1000
[[limb]]
name = "right"
drive = "crank"
base = ["d", 0, 0]
axis = [0, 0, 1]
zero = [1, 0, 0]
across = [0, 0, 1]
crank = "230 mm"
rod = "230 mm"
platform = [0, 0, 0]
branch = "-"
drive_stiffness = 1000
)");
  expect_frequencies(stiffness_of(file, "x=0,y=0.3")["natural_frequencies"], {11.204621774, 28.860869760});
}

/// Six legs along edges of a cube, 1e6 N/m each: 2 k I, and k a^2 [[1, .5, .5], ..] for rotations about the centre.
TEST(CliStiffness, OfACubicHexapod) {
  const StudyFolder folder;
  std::string text = R"([mechanism]
name = "cube"
[parameters]
a = { default = "300 mm", min = "0.1 m", max = "1 m" }
[platform]
coordinates = { x = "along x", y = "along y", z = "along z", alpha = "about x", beta = "about y", gamma = "about z" }
characteristic_length = "a"
mass = "10 kg"
inertia = [0.2, 0.2, 0.2]
)";
  const char* const legs[][2] = {{"--+", "+-+"}, {"-+-", "-++"}, {"+--", "++-"},
                                 {"-+-", "++-"}, {"+--", "+-+"}, {"--+", "-++"}};
  const auto point = [](const std::string& signs) {
    std::string list = "[";
    for (const char sign : signs) list += std::string(list.size() > 1 ? ", " : "") + '"' + sign + "a/2\"";
    return list + "]";
  };
  for (const auto& leg : legs)
    text += "[[limb]]\nname = \"leg" + std::to_string(&leg - legs + 1) +
            "\"\ndrive = \"telescope\"\nbase = " + point(leg[0]) + "\nplatform = " + point(leg[1]) +
            "\ndrive_stiffness = 1e6\n";
  const json found = stiffness_of(folder.write("cube.toml", text), "x=0,y=0,z=0,alpha=0,beta=0,gamma=0");
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      EXPECT_NEAR(found["matrix"][i][j].get<double>(),
                  i / 3 != j / 3 ? 0
                  : i < 3        ? (i == j ? 2e6 : 0)
                                 : 9e4 * (i == j ? 1 : .5),
                  1e-3);
  expect_frequencies(found["natural_frequencies"], {71.176254, 71.176254, 71.176254, 75.493818, 75.493818, 150.987636});
}

TEST(CliStiffness, SaysWhichWrenchesAreNotCarried) {
  const StudyFolder folder;
  std::string text = translator();
  for (std::size_t at = text.find("universal"); at != std::string::npos; at = text.find("universal"))
    text.erase(at, text.find('\n', at) - at + 1);
  const std::string file = folder.write("balls.toml", text);
  const auto printed = pkmopt({"pose", file, "--at", "x=0,y=0,z=0", "--stiffness"});
  EXPECT_THAT(printed.out, HasSubstr("the joints carry only 3 of 6 independent wrenches"));
  EXPECT_THAT(printed.out, HasSubstr("4670 N/mm"));
  EXPECT_THAT(printed.out, HasSubstr("no direction is supported"));
  const auto refused = pkmopt({"pose", file, "--at", "x=0,y=0,z=0", "--stiffness", "--wrench", "Mx=1"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("does not carry every wrench"));
}

TEST(CliStiffness, IsRefusedForRigidMechanisms) {
  const auto refused =
      pkmopt({"pose", PKM_EXPERIMENTS "/mechanisms/rotary-delta.toml", "--at", "x=0,y=0,z=-0.5", "--stiffness"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("has no elasticity"));
}

/// The dimensions of a public five-bar; the poses of all four extreme joint errors were computed independently.
TEST(CliToolError, IsExactAtTheWorstCorner) {
  const auto error = [](const std::string& at) {
    return pkmopt({"pose", PKM_EXPERIMENTS "/mechanisms/five-bar.toml", "--set", "d=137.5mm,l_a=230mm,l_b=230mm",
                   "--at", at, "--joint-error", "0.01deg", "--exact-error", "--json"})
        .json()["tool_error"];
  };
  const json near = error("x=0,y=0.3"), far = error("x=0,y=0.25"), beside = error("x=0.1,y=0.3");
  EXPECT_NEAR(near["translation"].get<double>(), .11087032e-3, 1e-11);
  EXPECT_NEAR(near["worst_corner"]["translation"].get<double>(), .11093631e-3, 1e-11);
  EXPECT_NEAR(far["worst_corner"]["translation"].get<double>(), .23672869e-3, 1e-11);
  EXPECT_NEAR(beside["worst_corner"]["translation"].get<double>(), .0878738e-3, 1e-10);
}

TEST(CliWorkspace, HasTheAccuracyForJointErrorsOfAnOption) {
  const StudyFolder folder;
  const std::string delta = PKM_EXPERIMENTS "/mechanisms/rotary-delta.toml";
  const auto drawn = pkmopt({"workspace", delta, "--cut", "y=0", "--field", "accuracy", "--joint-error", "0.01deg",
                             "--cells", "20", "-o", folder.path() + "/map.svg"});
  EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
  EXPECT_TRUE(std::filesystem::exists(folder.path() + "/map.svg"));
  const auto refused =
      pkmopt({"workspace", delta, "--cut", "y=0", "--field", "accuracy", "-o", folder.path() + "/map.png"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("there is no [accuracy]"));
  const auto wrong = pkmopt({"workspace", delta, "--joint-error", "10um"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("--joint-error: found 10um; expected a number in rad"));
  const auto unknown = pkmopt({"workspace", delta, "--joint-error", "arm4=1mrad"});
  EXPECT_THAT(unknown.err, HasSubstr("did you mean 'arm"));
}

/// The errors of the poses of all extreme joint errors; the values at (0, 300 mm) are those of the test above.
TEST(CliWorkspace, DrawsTheExactErrorOfAPlane) {
  const StudyFolder folder;
  const auto run = [&](const std::string& field, const std::string& file) {
    return pkmopt({"workspace", PKM_EXPERIMENTS "/mechanisms/five-bar.toml", "--set", "d=137.5mm,l_a=230mm,l_b=230mm",
                   "--box", "x=-0.01:0.01,y=0.29:0.31", "--cells", "1", "--joint-error", "0.01deg", "--field", field,
                   "-o", folder.path() + "/" + file, "--json"});
  };
  const json fields = run("accuracy,accuracy_exact", "map.svg").json()["fields"];
  EXPECT_NEAR(fields["accuracy"]["least"].get<double>(), .11087032e-3, 1e-11);
  EXPECT_NEAR(fields["accuracy_exact"]["least"].get<double>(), .11093631e-3, 1e-11);
  EXPECT_TRUE(std::filesystem::exists(folder.path() + "/map-accuracy_exact.svg"));
  EXPECT_FALSE(run("accuracy", "plain.svg").json()["fields"].contains("accuracy_exact"));
  EXPECT_THAT(run("accuracy_exakt", "wrong.svg").err, HasSubstr("did you mean 'accuracy_exact'?"));
}

}  // namespace
}  // namespace pkm::testing
