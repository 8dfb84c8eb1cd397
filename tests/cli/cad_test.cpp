// `pkmopt pose --stl` and `--dxf`: export of a mechanism's links at one pose for CAD programs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <numbers>
#include <sstream>

#include "engine/config/built_in_mechanisms.hpp"
#include "tests/cli/run_program.hpp"
#include "tests/cli/study_folder.hpp"

namespace pkm::testing {
namespace {

using ::testing::HasSubstr;

const std::vector<std::string> kPoseCommand = {"pose", "4ppa-2par", "--at", "x=0.25,y=0.85,z=-0.8,theta=30deg"};

std::vector<PlacedLink> links() {
  const auto mechanism = all_mechanisms().front();
  std::vector<double> nominal;
  for (const Parameter& p : mechanism->info().parameters) nominal.push_back(p.nominal);
  Pose<double> pose(4);
  for (std::size_t i = 0; i < 4; ++i) pose[i] = std::array{0.25, 0.85, -0.8, std::numbers::pi / 6}[i];
  return mechanism->links()->place(nominal, pose, mechanism->info().modes.front());
}

double length(const Segment<double>& axis) {
  const auto vector = difference(axis.to, axis.from);
  return std::sqrt(dot(vector, vector));
}

class CliCad : public ::testing::Test {
 protected:
  /// Runs `pkmopt pose` with an option that writes a file; the bytes of this file.
  std::string written(const std::string& option, const std::string& name) const {
    auto words = kPoseCommand;
    words.insert(words.end(), {option, name});
    const auto result = pkmopt(words, folder_.path());
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.out, ::testing::EndsWith("\nwrote " + name + "\n"));
    std::ifstream in(folder_.path() + "/" + name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  }
  StudyFolder folder_;
};

TEST_F(CliCad, StlSurfaceEnclosesTheVolumeOfTheLinks) {
  double expected = 0;
  for (const PlacedLink& link : links()) {
    const double r = link.body.radius;
    expected += std::numbers::pi * r * r * (length(link.body.axis) + 4 * r / 3);
  }
  const std::string bytes = written("--stl", "links.stl");
  std::uint32_t count = 0;
  std::memcpy(&count, &bytes[80], 4);
  ASSERT_EQ(bytes.size(), 84 + 50 * count);
  double volume = 0;
  for (std::size_t k = 0; k < count; ++k) {
    std::array<float, 12> facet;  // its normal, then its vertices
    std::memcpy(facet.data(), &bytes[84 + 50 * k], 48);
    const auto vertex = [&facet](std::size_t i) {
      return Point3<double>{facet[3 * i + 3], facet[3 * i + 4], facet[3 * i + 5]};
    };
    volume += dot(vertex(0), cross(vertex(1), vertex(2))) / 6;
  }
  EXPECT_LT(volume, expected);  // the vertices lie on the exact surface
  EXPECT_GT(volume, 0.97 * expected);
}

TEST_F(CliCad, DxfHasTheLinkAxesOnOneLayerPerPart) {
  std::istringstream dxf(written("-o", "links.dxf"));
  std::vector<std::pair<int, std::string>> groups;
  for (std::string code, value; std::getline(dxf, code) && std::getline(dxf, value);)
    groups.emplace_back(std::stoi(code), value);
  ASSERT_FALSE(groups.empty());
  EXPECT_EQ(groups.back(), std::pair(0, std::string("EOF")));
  std::size_t drawn = 0;
  const auto all = links();
  for (std::size_t k = 0; k < groups.size(); ++k) {
    if (groups[k] != std::pair(0, std::string("LINE")) && groups[k] != std::pair(0, std::string("POINT"))) continue;
    const PlacedLink& link = all.at(drawn++);
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(groups[k + 2 + static_cast<std::size_t>(i)].first, 10 + 10 * i);
      EXPECT_NEAR(std::stod(groups[k + 2 + static_cast<std::size_t>(i)].second),
                  link.body.axis.from[static_cast<std::size_t>(i)], 1e-11);
    }
    EXPECT_EQ(groups[k + 1].first, 8);
    EXPECT_EQ(groups[k + 1].second.find(' '), std::string::npos);
  }
  EXPECT_EQ(drawn, all.size());
}

TEST_F(CliCad, NoFileForAPoseThatDoesNotAssemble) {
  const auto result =
      pkmopt({"pose", "4ppa-2par", "--at", "x=0.25,y=0.85,z=-3,theta=0", "--stl", "links.stl"}, folder_.path());
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("does not assemble"));
  EXPECT_FALSE(std::ifstream(folder_.path() + "/links.stl").good());
}

TEST_F(CliCad, WithoutAModelForSimulationOnlyUrdfWithFixedJointsIsWritten) {
  const std::string hybrid = "x=0.02,y=0,z=0.2,beta=0.1";
  const auto urdf = pkmopt({"pose", "2t1r-p-hybrid", "--at", hybrid, "--urdf", "links.urdf"}, folder_.path());
  EXPECT_EQ(urdf.exit_code, 0);
  EXPECT_THAT(urdf.out, HasSubstr("wrote links.urdf\nIts joints are fixed, because the mechanism has no model for "
                                  "simulation: limb limbA has drive = \"formula\", so its links are unknown\n"));
  EXPECT_FALSE(std::ifstream(folder_.path() + "/links.yaml").good());
  const auto sdf = pkmopt({"pose", "2t1r-p-hybrid", "--at", hybrid, "--sdf", "links.sdf"}, folder_.path());
  EXPECT_EQ(sdf.exit_code, 2);
  EXPECT_THAT(sdf.err, HasSubstr("--sdf: mechanism 2t1r-p-hybrid has no model for simulation: limb limbA has drive"));
}

TEST_F(CliCad, FilesOfAModelAreNotOverwritten) {
  const std::vector<std::string> command = {"pose",   "3crr-r-cru", "--at", "x=0.2,y=0.17,z=0.22,phi=0.3",
                                            "--urdf", "links.urdf"};
  folder_.write("links.yaml", "mine");
  const auto refused = pkmopt(command, folder_.path());
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, HasSubstr("links.yaml exists already"));
  EXPECT_FALSE(std::ifstream(folder_.path() + "/links.urdf").good());
}

}  // namespace
}  // namespace pkm::testing
