// Slices of a workspace, their drawings, and boxes that give only some of the ranges.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/cli/run_program.hpp"
#include "tests/cli/study_folder.hpp"

namespace pkm::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class CliSlice : public ::testing::Test {
 protected:
  json workspace(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "workspace");
    arguments.insert(arguments.end(), {"--json", "--force"});
    const auto result = pkmopt(arguments, folder_.path());
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.json();
  }
  std::string refusal(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "workspace");
    const auto result = pkmopt(arguments, folder_.path());
    EXPECT_EQ(result.exit_code, 2);
    return result.err;
  }
  std::string text(const std::string& name) const {
    std::ifstream in(folder_.path() + "/" + name);
    return std::string(std::istreambuf_iterator<char>(in), {});
  }

  StudyFolder folder_;
};

TEST_F(CliSlice, OutlineAreaEqualsCellCount) {
  const json cut = workspace({"4ppa-2par", "--cut", "theta=20deg", "--cells", "200", "-o", "f.svg"});
  EXPECT_EQ(cut["unit"], "m^2");
  EXPECT_EQ(cut["axes"].size(), 2u);
  EXPECT_NEAR(cut["area"], cut["volume"], 5e-3 * double(cut["volume"]));
  EXPECT_GT(cut["area"], 0.1);
  // 1988 of 9200 cells of 1 cm^2, in a layer of 0.2 deg around the slice
  EXPECT_NEAR(cut["area"], 0.1988, 1e-3);
}

TEST_F(CliSlice, BoxWithinTheWorkspaceIsDrawnCompletely) {
  const json box = workspace({"4ppa-2par", "--cut", "theta=0", "--box", "x=0.35:0.45,z=-0.9..-0.8", "-o", "f.svg"});
  EXPECT_EQ(box["feasible_cells"], box["cells"]);
  EXPECT_NEAR(box["area"], 0.01, 1e-12);
  EXPECT_NEAR(box["volume"], 0.01, 1e-12);
  EXPECT_TRUE(box["touches_box"]);
}

TEST_F(CliSlice, SliceAreasIntegrateToTheVolume) {
  double sum = 0;
  const int slices = 24;
  for (int k = 0; k < slices; ++k) {
    const double degrees = -90 + (k + 0.5) * 180 / slices;
    sum += double(workspace({"4ppa-2par", "--cut", "theta=" + std::to_string(degrees) + "deg", "-o", "f.svg"})["area"]);
  }
  EXPECT_NEAR(sum * 3.14159265358979 / slices, 0.550157374606, 2e-3);  // the exact volume
}

TEST_F(CliSlice, PlanarWorkspaceNeedsNoCut) {
  const json five_bar = workspace({PKM_EXPERIMENTS "/mechanisms/five-bar.toml", "--cells", "300", "-o", "f.svg"});
  EXPECT_NEAR(five_bar["area"], five_bar["volume"], 5e-3 * double(five_bar["volume"]));
}

TEST_F(CliSlice, PictureHasAxesUnitsAndArea) {
  folder_.write("s.toml", "[study]\nname = \"a<b & c\"\n" + study_with(""));
  const json cut = workspace({"s.toml", "--cut", "theta=20°", "--svg", "f.svg", "--cells", "12"});
  EXPECT_EQ(cut["files"], json::array({"f.svg"}));
  const std::string svg = text("f.svg");
  EXPECT_THAT(svg, ::testing::StartsWith("<svg xmlns="));
  EXPECT_THAT(svg, ::testing::EndsWith("</svg>\n"));
  for (const char* const part : {">x [mm]<", ">z [mm]<", "theta = 20 deg", "y = 1250 mm", ">area 0.1", " m^2<",
                                 "a&lt;b &amp; c", ">400<", "class=\"outline\""})
    EXPECT_THAT(svg, HasSubstr(part));
  workspace({"s.toml", "--cut", "x=400mm", "--svg", "f.svg", "--cells", "12"});
  EXPECT_THAT(text("f.svg"), HasSubstr(">theta [deg]<"));
}

TEST_F(CliSlice, MapShowsAFieldWithUnitAndRange) {
  const json one =
      workspace({"4ppa-2par", "--cut", "theta=20deg", "--cells", "12", "--field", "alpha_1", "-o", "f.svg"});
  EXPECT_EQ(one["files"], json::array({"f.svg"}));
  const std::string svg = text("f.svg");
  for (const char* const part :
       {">x [mm]<", ">alpha_1 [deg]<", ">alpha_1: angle of limb 1's upper bars with the rail<",
        ">from 0 deg to 90 deg<", "theta = 20 deg", ">80<", "class=\"area\"", "class=\"line\""})
    EXPECT_THAT(svg, HasSubstr(part));
  EXPECT_LT(svg.size(), 300000u);
}

TEST_F(CliSlice, EachFieldHasItsOwnMap) {
  const std::vector<std::string> maps = {PKM_EXPERIMENTS "/mechanisms/quantities/rotary-delta.toml",
                                         "--cut",
                                         "y=0",
                                         "--cells",
                                         "6",
                                         "--field",
                                         "lti,conditioning",
                                         "--field",
                                         "lti_input",
                                         "-o",
                                         "m.svg",
                                         "-o",
                                         "m.png",
                                         "-o",
                                         "m.csv"};
  EXPECT_EQ(workspace(maps)["files"], json::array({"m.csv", "m-lti.svg", "m-conditioning.svg", "m-lti_input.svg",
                                                   "m-lti.png", "m-conditioning.png", "m-lti_input.png"}));
  EXPECT_THAT(text("m-lti.svg"), HasSubstr(">lti: "));
  EXPECT_THAT(text("m-conditioning.svg"), HasSubstr(">conditioning<"));
  EXPECT_THAT(text("m-lti.png"), ::testing::StartsWith("\x89PNG"));
  EXPECT_THAT(text("m.csv"), HasSubstr(",lti,lti_input"));
  const std::string serial = text("m-lti.svg");
  auto threads = maps;
  threads.insert(threads.end(), {"--threads", "2"});
  workspace(threads);
  EXPECT_EQ(text("m-lti.svg"), serial);
}

TEST_F(CliSlice, MapsOfUnknownFieldsAreRefused) {
  EXPECT_THAT(refusal({"4ppa-2par", "--cut", "theta=0", "--field", "conditionin", "-o", "f.svg"}),
              ::testing::AllOf(::testing::StartsWith("pkmopt: --field: found 'conditionin'; expected one of margin, "
                                                     "conditioning, "),
                               ::testing::EndsWith("; did you mean 'conditioning'?\n")));
  EXPECT_EQ(refusal({"4ppa-2par", "--cut", "theta=0", "--field", "q1,q1", "-o", "f.svg"}),
            "pkmopt: --field: found 'q1' twice; expected each field once\n");
  EXPECT_EQ(refusal({"4ppa-2par", "--cut", "theta=0", "--field", "q1"}),
            "pkmopt: --field: found no file; expected a picture to draw the field in, such as -o map.svg\n");
  EXPECT_EQ(
      refusal({"4ppa-2par", "--cells", "8", "--field", "q1", "-o", "f.svg"}),
      "pkmopt: --svg: found a workspace over x, z, theta; expected a slice of it, such as that of --cut theta=0\n");
  EXPECT_EQ(workspace({"4ppa-2par", "--cells", "8", "--field", "q1", "-o", "f.csv"})["files"], json::array({"f.csv"}));
}

TEST_F(CliSlice, FixingACoordinateMoreIsASlice) {
  const json fixed = workspace({"4ppa-2par", "--fixed", "y=1.25,theta=20deg", "--cells", "20", "--csv", "fixed.csv"});
  const json cut = workspace({"4ppa-2par", "--cut", "theta=20deg", "--cells", "20", "--csv", "cut.csv"});
  EXPECT_EQ(fixed["volume"], cut["volume"]);
  EXPECT_EQ(fixed["fixed"][1]["name"], "theta");
  EXPECT_EQ(workspace({"4ppa-2par", "--fixed", "theta=20deg", "--cells", "8"})["unit"], "m^3") << "y is swept, too";
  EXPECT_EQ(workspace({"4ppa-2par", "--cells", "8"})["fixed"].size(), 1u);
  EXPECT_EQ(workspace({PKM_EXPERIMENTS "/mechanisms/five-bar.toml", "--cells", "8"})["fixed"], json::array());
  EXPECT_EQ(text("fixed.csv"), text("cut.csv"));
}

TEST_F(CliSlice, BoxKeepsRangesThatItDoesNotName) {
  const json whole = workspace({"4ppa-2par", "--cells", "16"});
  const json part = workspace({"4ppa-2par", "--cells", "16", "--box", "x=0.3:0.5"});
  EXPECT_FALSE(whole["touches_box"]);
  EXPECT_TRUE(part["touches_box"]);
  EXPECT_EQ(part["axes"][0]["lower"], 0.3);
  for (const std::size_t axis : {1u, 2u})
    for (const char* const end : {"lower", "upper"}) EXPECT_EQ(part["axes"][axis][end], whole["axes"][axis][end]);
  folder_.write("s.toml", study_with("[workspace]\nmethod = \"voxels\"\ncells = { x = 8, z = 8, theta = 8 }\n"
                                     "box = { x = [0, 1], z = [-1.2, -0.4], theta = [-1, 1] }\n"));
  const json study = workspace({"s.toml", "--box", "x=0.3:0.5"});
  EXPECT_EQ(study["axes"][0]["upper"], 0.5);
  EXPECT_EQ(study["axes"][1]["lower"], -1.2);
  EXPECT_EQ(study["axes"][2]["upper"], 1);
}

TEST_F(CliSlice, OnlyPlanarWorkspacesAreDrawn) {
  EXPECT_EQ(
      refusal({"4ppa-2par", "--cells", "8", "-o", "f.svg"}),
      "pkmopt: --svg: found a workspace over x, z, theta; expected a slice of it, such as that of --cut theta=0\n");
  EXPECT_EQ(refusal({"4ppa-2par", "--cells", "8", "--cut", "theta=0,x=0.4", "-o", "f.svg"}),
            "pkmopt: --svg: found a workspace over z; expected a workspace over two coordinates\n");
  EXPECT_EQ(refusal({"4ppa-2par", "--cut", "theta=0", "--html", "f.html"}),
            "pkmopt: --html: found a slice of a workspace; expected a full workspace; --svg and --png draw slices\n");
  EXPECT_EQ(
      refusal({"4ppa-2par", "--cut", "y=1"}),
      "pkmopt: --cut: found the coordinate 'y', which is fixed; expected one that is swept, x, z, theta; did you mean "
      "'--fixed y=..'?\n");
}

// The mode is checked before the workspace is evaluated, and the outputs are checked before the mode.
TEST_F(CliSlice, OutputsAreCheckedBeforeTheEvaluation) {
  const auto first_refusal = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--mode", "sideways"});
    return refusal(arguments);
  };
  EXPECT_THAT(first_refusal({"4ppa-2par", "--cut", "theta=0"}), HasSubstr("sideways"));
  EXPECT_EQ(
      first_refusal({"4ppa-2par", "-o", "f.png"}),
      "pkmopt: --png: found a workspace over x, z, theta; expected a slice of it, such as that of --cut theta=0\n");
  EXPECT_EQ(first_refusal({"4ppa-2par", "--cut", "theta=0", "-o", "f.stl"}),
            "pkmopt: --stl: a surface needs three swept coordinates; this workspace sweeps x, z\n");
  EXPECT_THAT(first_refusal({"4ppa-2par", "--largest-box"}), HasSubstr("the workspace is over theta, an angle"));
}

}  // namespace
}  // namespace pkm::testing
