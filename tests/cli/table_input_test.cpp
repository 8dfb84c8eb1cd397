// `pkmopt evaluate --designs` and `pkmopt pose --poses`: rows of a table, compared with single designs and poses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "tests/cli/run_program.hpp"
#include "tests/cli/study_folder.hpp"

namespace pkm::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

const std::string kDelta = PKM_EXPERIMENTS "/mechanisms/rotary-delta.toml";
const std::string kPaper = PKM_EXPERIMENTS "/4ppa-2par/paper-problem.toml";

std::vector<json> lines_of(const std::string& out) {
  std::vector<json> lines;
  std::istringstream text(out);
  for (std::string line; std::getline(text, line);) lines.push_back(json::parse(line));
  return lines;
}

TEST(CliTables, DesignsHaveTheValuesOfSingleOnes) {
  const StudyFolder folder;
  const std::string file = folder.write("designs.csv", "a,b [mm],remark\n0.3,800,\"one, of two\"\n250 mm,1000,\n");
  const ProgramResult done = pkmopt({"evaluate", kPaper, "--designs", file, "--json"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.err, HasSubstr("columns that are not read: remark"));
  const std::vector<json> lines = lines_of(done.out);
  ASSERT_EQ(lines.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    const json one = pkmopt({"evaluate", kPaper, "--set", i == 0 ? "a=0.3,b=0.8" : "a=0.25,b=1", "--json"}).json();
    EXPECT_EQ(lines[i]["objectives"], one["objectives"]);
    EXPECT_EQ(lines[i]["outputs"], one["outputs"]);
    EXPECT_EQ(lines[i]["status"], "feasible");
  }
}

TEST(CliTables, ResultsGoIntoAFile) {
  const StudyFolder folder;
  const std::string file = folder.write("designs.csv",
                                        "\xEF\xBB\xBF"
                                        "a,b\r\n0.3,0.8\r\n-1,1\r\n"),
                    results = folder.path() + "/results.csv";
  const ProgramResult done = pkmopt({"evaluate", kPaper, "--designs", file, "-o", results});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("1 of 2 designs are feasible"));
  std::ifstream written(results);
  std::string head, first, second;
  std::getline(written, head);
  std::getline(written, first);
  std::getline(written, second);
  EXPECT_EQ(head, "a [m],b [m],status,objective workspace-ratio [rad],output workspace-volume [m^2 rad],reason");
  EXPECT_THAT(first, HasSubstr("0.3,0.8,feasible,0.21"));
  EXPECT_EQ(second, "-1,1,failed,,,a = -1 is outside the model's range 0.001 to 100 m");
  EXPECT_THAT(pkmopt({"evaluate", kPaper, "--designs", file, "-o", results}).err, HasSubstr("exists already"));
  EXPECT_THAT(pkmopt({"evaluate", kPaper, "--designs", file, "-o", file, "--force"}).err, HasSubstr(file));
}

TEST(CliTables, PosesHaveTheValuesOfSingleOnes) {
  const StudyFolder folder;
  const std::string file = folder.write("poses.csv", "z [mm],x,y\n-400,0.05,0.02\n-4000,0,0\n");
  const ProgramResult done = pkmopt({"pose", kDelta, "--poses", file, "--json"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const std::vector<json> lines = lines_of(done.out);
  ASSERT_EQ(lines.size(), 2u);
  const json one = pkmopt({"pose", kDelta, "--at", "x=0.05,y=0.02,z=-0.4", "--json"}).json();
  for (const char* key : {"joints", "conditioning", "margins", "feasible"}) EXPECT_EQ(lines[0][key], one[key]) << key;
  EXPECT_EQ(lines[0]["quantities"]["lti"], one["indices"]["lti"]);
  EXPECT_EQ(lines[1]["assembles"], false);
  EXPECT_TRUE(lines[1]["joints"]["arm1"].is_null());
  EXPECT_THAT(std::string(lines[1]["reason"]), HasSubstr("cannot reach"));
  const ProgramResult table = pkmopt({"pose", kDelta, "--poses", file});
  EXPECT_THAT(table.out, HasSubstr("x [m],y [m],z [m],assembles,feasible,arm1 [rad]"));
}

TEST(CliTables, AreCheckedWhereTheyAreRead) {
  const StudyFolder folder;
  const auto complaint = [&](const std::string& text, std::vector<std::string> more = {}) {
    const std::string file = folder.write("t.csv", text);
    more.insert(more.begin(), {"pose", kDelta, "--poses", file});
    const ProgramResult done = pkmopt(more);
    EXPECT_EQ(done.exit_code, 2) << text;
    return done.err;
  };
  EXPECT_THAT(complaint(""), HasSubstr("t.csv:1: found an empty file; expected a line with the columns x, y, z"));
  EXPECT_THAT(complaint("x,y,zz\n0,0,0\n"), HasSubstr("t.csv:1: found no column z (but zz); expected the columns"));
  EXPECT_THAT(complaint("x,y,z\n"), HasSubstr("t.csv:2: found no rows"));
  EXPECT_THAT(complaint("x,y,z\n\n0,0\n"), HasSubstr("t.csv:3: found 2 cells; expected 3"));
  EXPECT_THAT(complaint("x,y,z\n0,0,k\n"), HasSubstr("t.csv:2: z: found 'k'; expected a number"));
  EXPECT_THAT(complaint("x,y,z [kg]\n0,0,1\n"), HasSubstr("t.csv:1: z: found the unit 'kg'"));
  EXPECT_THAT(complaint("x,y,z,x\n0,0,1,1\n"), HasSubstr("a second column"));
  EXPECT_THAT(complaint("x,y,z\n0,0,\"1\n"), HasSubstr("an unclosed quotation mark"));
  EXPECT_THAT(complaint("x,y,z\n0,0,-0.4\n", {"--stiffness"}), HasSubstr("--stiffness"));
  EXPECT_THAT(complaint("x,y,z\n0,0,-0.4\n", {"--at", "x=0,y=0,z=0"}), HasSubstr("--at"));
  const std::string designs = folder.write("designs.csv", "a\n0.3\n");
  for (const std::vector<std::string>& option :
       {std::vector<std::string>{"--sensitivity"}, {"--tolerance", "1mm"}, {"--certified", "0.1"}}) {
    std::vector<std::string> arguments = {"evaluate", kPaper, "--designs", designs};
    arguments.insert(arguments.end(), option.begin(), option.end());
    const ProgramResult done = pkmopt(arguments);
    EXPECT_EQ(done.exit_code, 2);
    EXPECT_THAT(done.err, HasSubstr(option.front()));
  }
  EXPECT_THAT(pkmopt({"pose", kDelta}).err, HasSubstr("--poses"));
  EXPECT_THAT(pkmopt({"evaluate", kPaper, "-o", "x.csv"}).err, HasSubstr("expected --designs with a table"));
}

}  // namespace
}  // namespace pkm::testing
