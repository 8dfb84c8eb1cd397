// [[obstacle]] of studies: interpretation, invalid definitions, drawings, effect on the workspace.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include <fstream>
#include <sstream>

#include "tests/cli/study_program.hpp"

namespace pkm::testing {
namespace {

using ::testing::HasSubstr;

const std::string kTable = R"([[obstacle]]
name = "table"
shape = "box"
centre = [0, 0, "-700 mm"]
size = ["1 m", "1 m", "100 mm"]
)";
const std::string kBall = R"([[obstacle]]
name = "lamp"
shape = "sphere"
centre = ["150 mm", 0, "-450 mm"]
radius = "40 mm"
)";
const std::string kClearance = "[[constraint]]\ntype = \"clearance\"\nmin = \"5 mm\"\n";

std::string study(const std::string& mechanism, const std::string& tables) {
  return "[mechanism]\n" + mechanism + R"(
[variables]
r = { min = 0.04, max = 0.06 }
[workspace]
method = "voxels"
cells = { x = 12, y = 12, z = 12 }
[[objective]]
type = "workspace-volume"
[[stage]]
optimiser = "sweep"
points = 3
)" + tables;
}
const std::string kDeltaFile = "file = \"" PKM_EXPERIMENTS "/mechanisms/rotary-delta.toml\"";

class Obstacle : public StudyProgram {
 protected:
  void write(const std::string& name, const std::string& text) const { std::ofstream(path(name)) << text; }
  std::string refusal(const std::string& text) {
    write("s.toml", text);
    EXPECT_EQ(run({"check", "s.toml"}), 2) << output_;
    return output_;
  }
};

TEST_F(Obstacle, IsListedByCheck) {
  write("s.toml", study(kDeltaFile, kTable + kBall + kClearance));
  ASSERT_EQ(run({"check", "s.toml"}), 0) << output_;
  EXPECT_THAT(output_, HasSubstr("obstacles, from which all moving links keep the clearance\n"
                                 "  table  box     centre (0, 0, -0.7) m      sizes (1, 1, 0.1) m\n"
                                 "  lamp   sphere  centre (0.15, 0, -0.45) m  radius 0.04 m\n"));
  ASSERT_EQ(run({"check", "s.toml", "--json"}), 0) << output_;
  const auto printed = nlohmann::json::parse(output_)["obstacles"];
  ASSERT_EQ(printed.size(), 2u);
  EXPECT_EQ(printed[0]["name"], "table");
  EXPECT_EQ(printed[0]["size"], nlohmann::json({1.0, 1.0, 0.1}));
  EXPECT_EQ(printed[1]["radius"], 0.04);
  write("s.toml", study(kDeltaFile, kTable));
  ASSERT_EQ(run({"check", "s.toml"}), 0) << output_;
  EXPECT_THAT(output_,
              HasSubstr("warning: the obstacles do not restrict the workspace, because no clearance is required; "
                        "add a [[constraint]] with type = \"clearance\""));
}

TEST_F(Obstacle, IsNamedInTheReasonOfAnInfeasiblePose) {
  write("s.toml", study(kDeltaFile, kTable + kBall + kClearance));
  ASSERT_EQ(run({"pose", "s.toml", "--at", "x=0.15,y=0,z=-0.45"}), 0) << output_;
  EXPECT_THAT(output_, HasSubstr("clearance_min is violated: "));
  EXPECT_THAT(output_, HasSubstr(" and lamp overlap"));
  write("s.toml", study(kDeltaFile, kTable + kClearance));
  ASSERT_EQ(run({"pose", "s.toml", "--at", "x=0,y=0,z=-0.64", "--json"}), 0) << output_;
  // the capsules of the arms have a radius of 6 mm, and the top of the table is at z = -0.65 m
  EXPECT_NEAR(nlohmann::json::parse(output_)["angles"]["clearance"].get<double>(), 0.01 - 0.006, 1e-12);
}

TEST_F(Obstacle, IsDrawnInFilesOfLinks) {
  write("s.toml", study(kDeltaFile, kTable + kBall + kClearance));
  ASSERT_EQ(run({"pose", "s.toml", "--at", "x=0,y=0,z=-0.45", "-o", "l.dxf", "-o", "l.stl"}), 0) << output_;
  ASSERT_EQ(run({"pose", kDeltaFile.substr(8, kDeltaFile.size() - 9), "--at", "x=0,y=0,z=-0.45", "-o", "b.dxf", "-o",
                 "b.stl"}),
            0)
      << output_;
  const auto bytes = [&](const std::string& name) {
    std::ifstream file(path(name), std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  const auto count = [&](const std::string& text, const std::string& what) {
    std::size_t found = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
    return found;
  };
  EXPECT_EQ(count(bytes("l.dxf"), "\nLINE\n8\nobstacle\n"), 12u) << "the edges of the table";
  EXPECT_EQ(count(bytes("l.dxf"), "\nPOINT\n8\nobstacle\n"), 1u) << "the centre of the lamp";
  EXPECT_EQ(count(bytes("b.dxf"), "obstacle"), 0u);
  const auto triangles = [&](const std::string& name) { return (bytes(name).size() - 84) / 50; };
  EXPECT_GT(triangles("l.stl"), triangles("b.stl") + 12 + 200);
}

TEST_F(Obstacle, ReducesTheWorkspaceAndIsPartOfTheStudy) {
  write("free.toml", study(kDeltaFile, kClearance));
  write("s.toml", study(kDeltaFile, kTable + kBall + kClearance));
  ASSERT_EQ(run({"run", "free.toml", "--quiet"}), 0) << output_;
  ASSERT_EQ(run({"run", "s.toml", "--quiet"}), 0) << output_;
  const double all = read("free.h5").final->best->objectives[0], left = read("s.h5").final->best->objectives[0];
  EXPECT_GT(all, 0);
  EXPECT_LT(left, all);
  EXPECT_THAT(read("s.h5").toml, HasSubstr("[[obstacle]]\nname = \"table\""));
  write("s.toml", study(kDeltaFile, kTable + kClearance));
  EXPECT_EQ(run({"run", "s.toml", "--resume", "--quiet"}), 1) << output_;
  EXPECT_THAT(output_, HasSubstr("s.h5 holds a study whose text differs from s.toml"));
  ASSERT_EQ(run({"report", "s.h5"}), 0) << output_;
}

TEST_F(Obstacle, BestDesignOfTheExampleAvoidsIt) {
  const std::string example = PKM_EXPERIMENTS "/mechanisms/obstacles/rotary-delta.toml";
  ASSERT_EQ(run({"run", example, "-o", "s.h5", "--quiet"}), 0) << output_;
  EXPECT_GT(read("s.h5").final->best->objectives[0], 0.065);
  ASSERT_EQ(run({"trajectory", "--from", "s.h5", "--motion", "cycle"}), 0) << output_;
  EXPECT_EQ(run({"trajectory", example, "--set", "l_a=0.4,l_b=0.775", "--motion", "cycle"}), 1);
  EXPECT_THAT(output_, HasSubstr("clearance_min is violated: rod of arm3 and wall overlap"));
}

TEST_F(Obstacle, InvalidDefinitionsAreRefused) {
  const auto changed = [](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  const auto wrong = [&](const std::string& obstacle) { return refusal(study(kDeltaFile, obstacle + kClearance)); };
  EXPECT_THAT(wrong(changed(kTable, "\"1 m\", \"1 m\"", "\"1 m\", \"-1 m\"")),
              HasSubstr("obstacle[1].size[2]: found \"-1 m\"; expected a number > 0 m"));
  EXPECT_THAT(wrong(changed(kTable, "\"box\"", "\"cube\"")),
              HasSubstr("obstacle[1].shape: found \"cube\"; expected one of box, sphere, capsule"));
  EXPECT_THAT(
      wrong(changed(kTable, "[\"1 m\", ", "[")),
      HasSubstr("obstacle[1].size: found [\"1 m\", \"100 mm\"]; expected the sizes [along x, along y, along z]"));
  EXPECT_THAT(wrong(changed(kBall, "radius = \"40 mm\"\n", "")), HasSubstr("expected the radius"));
  EXPECT_THAT(wrong(changed(kBall, "radius", "size")), HasSubstr("obstacle[1].size: found an unknown key"));
  EXPECT_THAT(wrong(kBall + kBall), HasSubstr("there is already a [[obstacle]] called 'lamp'"));
  std::ostringstream bare;
  std::ifstream orthoglide(PKM_EXPERIMENTS "/mechanisms/orthoglide.toml");
  for (std::string line; std::getline(orthoglide, line);)
    if (!line.starts_with("radius")) bare << line << '\n';
  write("bare.toml", bare.str());
  EXPECT_THAT(refusal(changed(study("file = \"bare.toml\"", kBall), "r = { min = 0.04, max = 0.06 }",
                              "L = { min = 0.4, max = 0.6 }")),
              HasSubstr("has none that could collide with them"));
  EXPECT_THAT(refusal(changed(study(kDeltaFile, kBall + kClearance),
                              "method = \"voxels\"\ncells = { x = 12, y = 12, z = 12 }", "method = \"columns\"")),
              HasSubstr("rotary-delta has no exact columns"));
}

}  // namespace
}  // namespace pkm::testing
