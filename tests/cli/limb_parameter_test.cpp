// Parameters of a single limb, such as "arm2.l_b", in mechanism files, in studies and on the command line.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "engine/core/catalogue.hpp"
#include "tests/cli/study_program.hpp"

namespace pkm::testing {
namespace {

using ::testing::HasSubstr;

const std::string kDelta = PKM_EXPERIMENTS "/mechanisms/rotary-delta.toml";

class LimbParameter : public StudyProgram {
 protected:
  nlohmann::json pose(const std::string& set, const std::string& file = kDelta) {
    std::vector<std::string> arguments = {"pose", file, "--at", "x=0.02,y=0.03,z=-0.45", "--json"};
    if (!set.empty()) arguments.insert(arguments.end(), {"--set", set});
    EXPECT_EQ(run(arguments), 0) << output_;
    return nlohmann::json::parse(output_)["joints"];
  }
  std::string study(const std::string& more) const {
    return "[mechanism]\nfile = \"" + kDelta + "\"\n" + more +
           "[workspace]\nmethod = \"voxels\"\ncells = { x = 8, y = 8, z = 8 }\n[[objective]]\ntype = "
           "\"workspace-volume\"\n"
           "[[stage]]\noptimiser = \"sweep\"\npoints = 3\n";
  }
};

TEST_F(LimbParameter, ChangesOnlyItsLimb) {
  const auto usual = pose(""), all = pose("l_b=0.52"), one = pose("arm2.l_b=0.52");
  EXPECT_EQ(one["arm1"], usual["arm1"]);
  EXPECT_EQ(one["arm2"], all["arm2"]);
  EXPECT_EQ(one["arm3"], usual["arm3"]);
  EXPECT_NE(one["arm2"], usual["arm2"]);
  EXPECT_EQ(pose("l_b=0.52,arm2.l_b=500mm"), pose("arm1.l_b=0.52,arm3.l_b=0.52"));
}

TEST_F(LimbParameter, AppliesToFormulasOfLet) {
  std::ifstream file(kDelta);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  const auto change = [&text](const std::string& from, const std::string& to) {
    ASSERT_NE(text.find(from), std::string::npos) << from;
    text.replace(text.find(from), from.size(), to);
  };
  change("rod      = \"l_b\"", "rod      = \"twice/2\"");
  change("[[limb]]", "[let]\ntwice = \"2*l_b\"\n[[limb]]");
  std::ofstream(path("let.toml")) << text;
  EXPECT_EQ(pose("arm2.l_b=0.52", "let.toml"), pose("arm2.l_b=0.52"));
  // The mechanism file can declare such a parameter itself, with a dotted or a quoted key.
  change("[platform]", "arm2.l_b = { default = \"520 mm\" }\n\"arm3.l_b\" = { max = \"3 m\" }\n[platform]");
  std::ofstream(path("own.toml")) << text;
  EXPECT_EQ(pose("", "own.toml"), pose("arm2.l_b=0.52"));
}

TEST_F(LimbParameter, DefaultsToTheParameterOfAllLimbs) {
  std::ofstream(path("study.toml")) << study(
      "parameters = { l_b = 0.52, arm1.l_b = 0.51 }\n[variables]\n\"arm2.l_b\" = { min = 0.4, max = 0.6 }\n"
      "arm3.l_a = { min = 0.1, max = 0.3 }\n[baseline]\nl_b = 0.53\n");
  ASSERT_EQ(run({"run", "study.toml", "--quiet"}), 0) << output_;
  const StudyContents contents = read("study.h5");
  const auto parameter = [&](const std::string& name) { return *find_named(contents.problem.parameters, name); };
  EXPECT_EQ(parameter("arm1.l_b").value, 0.51);
  EXPECT_EQ(parameter("arm2.l_b").variable, 0);
  EXPECT_EQ(parameter("arm3.l_a").variable, 1);
  const std::vector<double>& baseline = contents.final->baseline->parameters;
  EXPECT_EQ(baseline[static_cast<std::size_t>(find_named(contents.problem.parameters, "arm2.l_b") -
                                              contents.problem.parameters.data())],
            0.53);
  std::ofstream(path("formula.toml")) << study(
      "[variables]\narm2.l_b = { min = 0.4, max = 0.6 }\n[[output]]\ntype = \"expression\"\nname = \"rod\"\nexpression "
      "= \"l_b\"\n"
      "[[constraint]]\ntype = \"linear\"\ncoefficients = { \"arm2.l_b\" = 1 }\nbound = 0.55\n");
  EXPECT_EQ(run({"check", "formula.toml"}), 0) << output_;
  EXPECT_EQ(run({"show", "study.h5"}), 0) << output_;
  EXPECT_EQ(run({"evaluate", "--from", "study.h5", "--set", "arm2.l_a=0.21"}), 0) << output_;
  EXPECT_EQ(run({"resume", "study.h5", "--quiet"}), 0) << output_;
  ASSERT_EQ(run({"run", "study.toml", "--set", "arm3.l_b=0.5", "-o", "set.h5", "--quiet"}), 0) << output_;
  EXPECT_EQ(find_named(read("set.h5").problem.parameters, "arm3.l_b")->value, 0.5);
}

TEST_F(LimbParameter, UnknownNamesAreRejected) {
  const std::pair<std::string, std::string> cases[] = {
      {"arm4.l_b", "found the unknown limb 'arm4' of arm4.l_b; expected one of arm1, arm2, arm3; did you mean 'arm1'?"},
      {"arm2.l_c",
       "found the unknown parameter 'l_c' of arm2.l_c; expected one of R, r, l_a, l_b, q_min, q_max; did you mean "
       "'l_a'?"},
  };
  for (const auto& [name, sentence] : cases) {
    EXPECT_EQ(run({"pose", kDelta, "--at", "x=0,y=0,z=-0.4", "--set", name + "=0.5"}), 2);
    EXPECT_THAT(output_, HasSubstr("--set: " + sentence));
    std::ofstream(path("wrong.toml")) << study("[variables]\n" + name + " = { min = 0.4, max = 0.6 }\n");
    EXPECT_EQ(run({"check", "wrong.toml"}), 2);
    EXPECT_THAT(output_, HasSubstr("wrong.toml:4: variables." + name + ": " + sentence));
  }
  std::ofstream(path("wrong.toml")) << study(
      "[variables]\narm2.l_b = { min = 0.4, max = 0.6 }\n\"arm2.l_b\" = { min = 0.4, max = 0.6 }\n");
  EXPECT_EQ(run({"check", "wrong.toml"}), 2);
  EXPECT_THAT(output_, HasSubstr("variables.arm2.l_b: the parameter is there already"));
  std::ofstream(path("wrong.toml")) << study("[variables]\n\"a.b\" = { c = { min = 0.4 } }\n");
  EXPECT_EQ(run({"check", "wrong.toml"}), 2);
  EXPECT_THAT(output_, HasSubstr("variables.a.b: found the unknown parameter 'b' of a.b"));
  std::ofstream(path("wrong.toml")) << study("[variables]\nl_bb = { min = 0.4, max = 0.6 }\n");
  EXPECT_EQ(run({"check", "wrong.toml"}), 2);
  EXPECT_THAT(output_, HasSubstr("wrong.toml:4: variables.l_bb: found an unknown parameter; expected one of R, r, "));
}

}  // namespace
}  // namespace pkm::testing
