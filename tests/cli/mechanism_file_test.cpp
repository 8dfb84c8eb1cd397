// Mechanism files on the command line: `pkmopt new` creates one, and commands accept it instead of a mechanism's name.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "engine/config/built_in_mechanisms.hpp"
#include "engine/storage/study_file.hpp"
#include "tests/cli/run_program.hpp"
#include "tests/cli/study_folder.hpp"

namespace pkm::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

std::string text_of(const std::string& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// Lines that are neither empty nor comments.
std::int64_t lines_without_comments(const std::string& text) {
  std::istringstream lines(text);
  std::int64_t count = 0;
  for (std::string line; std::getline(lines, line);) count += !line.empty() && line[0] != '#';
  return count;
}

/// A folder with delta.toml, and a short study of it.
class MechanismFile : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(run({"new", "mechanism", "my-delta", "-o", "delta.toml"}).err, "");
    const auto study = run({"new", "study", "delta.toml"});
    ASSERT_EQ(study.err, "");
    // Whether the study uses columns and a gradient stage depends on the time of an evaluation.
    std::string text = study.out.substr(0, study.out.find("\n[[stage]]")) +
                       "\n[[stage]]\noptimiser = \"ga\"\npopulation = 6\ngenerations = 2\n";
    const std::size_t method = text.find("\nmethod = ");
    text.replace(method, text.find("\n\n", method) - method, "\nmethod = \"voxels\"\ncells = { x = 6, y = 6, z = 6 }");
    folder_.write("study.toml", text);
  }
  ProgramResult run(const std::vector<std::string>& arguments) const { return pkmopt(arguments, folder_.path()); }
  std::string path(const std::string& name) const { return folder_.path() + "/" + name; }

  StudyFolder folder_;
};

TEST_F(MechanismFile, NewFilesAreShortAndValid) {
  EXPECT_LE(std::ranges::count(text_of(path("delta.toml")), '\n'), 45);
  EXPECT_THAT(text_of(path("delta.toml")), HasSubstr("\nname   = \"my-delta\"\n"));
  EXPECT_THAT(run({"new", "mechanism"}).out, HasSubstr("\nname   = \"rotary-delta\"\n"));
  EXPECT_EQ(run({"check", "delta.toml"}).exit_code, 0);
  std::vector<std::string> mechanisms = {"delta.toml", "./delta.toml"};
  for (const auto& mechanism : all_mechanisms()) mechanisms.push_back(mechanism.name());
  for (const std::string& mechanism : mechanisms) {
    SCOPED_TRACE(mechanism);
    const auto written = run({"new", "study", mechanism, "--output", "new.toml", "--force"});
    EXPECT_EQ(written.err, "");
    EXPECT_EQ(written.out, "wrote new.toml\nnext: pkmopt run new.toml\n");
    EXPECT_LE(lines_without_comments(text_of(path("new.toml"))), 26);
    const auto checked = run({"check", "new.toml", "--json"});
    EXPECT_EQ(checked.exit_code, 0) << checked.err;
    EXPECT_EQ(checked.json()["warnings"].size(), 0u);
    EXPECT_GT(checked.json()["probe"]["feasible"], 0);
  }
}

/// A study with its examples of constraints in use.
std::string with_examples(const std::string& text) {
  const auto begin = text.find("# Examples of constraints");
  if (begin == std::string::npos) return text;
  std::istringstream lines(text.substr(text.find('\n', begin)));
  std::string used = text.substr(0, begin);
  for (std::string line; std::getline(lines, line);) used += (line.starts_with("# ") ? line.substr(2) : line) + '\n';
  return used;
}

TEST_F(MechanismFile, ANewStudyHasExamplesOfConstraintsThatAreValidTogether) {
  const std::string robots = PKM_EXPERIMENTS "/mechanisms/";
  const struct {
    std::string mechanism, method;
    std::vector<std::string> constraints;
  } cases[] = {
      {"delta.toml", "columns", {"rods longer than cranks", "task-workspace", "motion", "linear", "expression"}},
      {"4ppa-2par", "columns", {"interference", "singularity-margin", "rail-length", "workspace-shape"}},
      {robots + "five-bar.toml", "columns", {"task-workspace", "motion", "linear"}},
      {robots + "frames/3-prs.toml", "voxels", {"task-workspace", "motion"}}};
  for (const auto& [mechanism, method, constraints] : cases) {
    SCOPED_TRACE(mechanism);
    ASSERT_EQ(run({"new", "study", mechanism, "-o", "new.toml", "--force"}).err, "");
    const std::string text = text_of(path("new.toml"));
    EXPECT_THAT(text, HasSubstr("\nmethod = \"" + method + "\"\n"));
    EXPECT_THAT(text, HasSubstr("\n[baseline]"));
    folder_.write("used.toml", with_examples(text));
    const auto checked = run({"check", "used.toml", "--json"});
    ASSERT_NE(checked.exit_code, 2) << checked.err;
    std::vector<std::string> types;
    const auto study = checked.json();
    for (const auto& constraint : study["constraints"]) types.push_back(constraint["type"]);
    for (const std::string& constraint : constraints) EXPECT_THAT(types, ::testing::Contains(constraint));
  }
  ASSERT_EQ(run({"new", "study", robots + "five-bar.toml", "-o", "new.toml", "--force"}).err, "");
  const auto found = run({"run", "new.toml", "--json", "-q"});
  EXPECT_EQ(found.exit_code, 0) << found.err;
  EXPECT_EQ(found.json()["stages"].size(), 2u);
  EXPECT_GT(found.json()["best"]["objectives"]["workspace-ratio"],
            found.json()["baseline"]["objectives"]["workspace-ratio"]);
}

TEST_F(MechanismFile, AStudyRefersToItRelativeToItsOwnFolder) {
  std::filesystem::create_directory(path("studies"));
  EXPECT_EQ(run({"new", "study", "delta.toml", "-o", "studies/s.toml"}).err, "");
  EXPECT_THAT(text_of(path("studies/s.toml")), HasSubstr("file = \"../delta.toml\""));
  const auto checked = run({"check", "studies/s.toml", "--json"});
  EXPECT_EQ(checked.json()["mechanism"], "my-delta");
  EXPECT_EQ(checked.json()["mechanism_file"], "studies/../delta.toml");
}

TEST_F(MechanismFile, ReplacesAMechanismName) {
  std::filesystem::copy(path("delta.toml"), path("delta"));
  for (const std::string file : {"delta.toml", "./delta.toml", "delta"}) {
    SCOPED_TRACE(file);
    const auto pose = run({"pose", file, "--at", "x=0,y=0,z=-450mm", "--json"});
    EXPECT_EQ(pose.exit_code, 0) << pose.err;
    EXPECT_EQ(pose.json()["mechanism"], "my-delta");
    EXPECT_EQ(pose.json()["feasible"], true);
    EXPECT_EQ(run({"evaluate", file, "--set", "l_b=0.6", "--json"}).json()["parameters"]["l_b"], 0.6);
    const auto entry = run({"list", file, "--json"}).json();
    EXPECT_EQ(entry["name"], "my-delta");
    EXPECT_EQ(entry["parameters"][3]["name"], "l_b");
    EXPECT_EQ(run({"list", "mechanisms", file, "--json"}).json(), entry);
    EXPECT_EQ(run({"check", file, "--json"}).json(), entry);
    EXPECT_THAT(run({"list", file}).out, HasSubstr("my-delta"));
    EXPECT_THAT(run({"check", file}).out, HasSubstr("my-delta"));
  }
  EXPECT_GT(run({"workspace", "delta.toml", "--cells", "x=8,y=8,z=8", "--json"}).json()["feasible_cells"], 0);
}

TEST_F(MechanismFile, ForwardWithNearFindsTheClosestAssemblyMode) {
  for (const std::string mechanism : {"delta.toml", "4ppa-2par"}) {
    const bool file = mechanism == "delta.toml";
    const std::string at = file ? "x=0.05,y=-0.03,z=-0.45" : "x=0.4,y=1.25,z=-0.9,theta=0.4";
    const auto pose = run({"pose", mechanism, "--at", at, "--json"}).json();
    std::string joints;
    for (const auto& [name, value] : pose["joints"].items())
      joints += (joints.empty() ? "" : ",") + name + "=" + value.dump();
    const auto near = [&](const std::string& from) {
      const auto found = run({"forward", mechanism, "--joints", joints, "--near", from, "--json"});
      EXPECT_EQ(found.exit_code, 0) << found.err;
      EXPECT_EQ(found.json()["poses"].size(), 1u) << found.out;
      return found.json()["poses"][0];
    };
    const auto next = near(file ? "x=0,y=0,z=-0.4" : "x=0.5,y=1,z=-1,theta=0.2");
    EXPECT_NEAR(next["z"], file ? -0.45 : -0.9, 1e-9);
    EXPECT_GT(near(file ? "x=0,y=0,z=0.4" : "x=0.5,y=1,z=1,theta=0.2")["z"], file ? 0.1 : -0.89);
  }
}

TEST_F(MechanismFile, ForwardReportsWhetherItsListIsComplete) {
  const auto of_file = [&](const std::vector<std::string>& more) {
    std::vector<std::string> command = {"forward", "delta.toml", "--joints", "arm1=0.4,arm2=0.4,arm3=0.4"};
    command.insert(command.end(), more.begin(), more.end());
    return run(command);
  };
  EXPECT_THAT(of_file({}).out, HasSubstr("\n  complete   no, found by Newton's method from poses in the search box"));
  EXPECT_EQ(of_file({"--json"}).json()["complete"], false);
  EXPECT_THAT(of_file({"--near", "x=0,y=0,z=-0.4"}).out,
              HasSubstr("complete   no, found by Newton's method from the pose"));
  const std::vector<std::string> closed = {"forward", "4ppa-2par", "--joints",
                                           "q1=0.2131,q2=1.3869,q3=0.4154,q4=1.3846"};
  EXPECT_THAT(run(closed).out, HasSubstr("complete   no, closed form: every isolated pose; --all lists"));
  std::vector<std::string> all = closed;
  all.push_back("--all");
  EXPECT_THAT(run(all).out, HasSubstr("complete   yes, closed form: every isolated pose\n"));
  all.push_back("--json");
  EXPECT_EQ(run(all).json()["complete"], true);
  EXPECT_EQ(run(all).json()["guarantee"], "closed form: every isolated pose");
}

TEST_F(MechanismFile, PoseNamesRowsAndColumnsOfItsJacobians) {
  const std::string at = "x=0.1,y=0,z=1.2,alpha=0.2,beta=0.3,gamma=0.1",
                    gough = PKM_EXPERIMENTS "/mechanisms/gough.toml";
  const auto pose = run({"pose", gough, "--at", at, "--json"}).json();
  EXPECT_EQ(pose["J_rows"], (std::vector<std::string>{"left1", "left2", "left3", "right1", "right2", "right3"}));
  EXPECT_EQ(pose["J_columns"], (std::vector<std::string>{"x", "y", "z", "alpha", "beta", "gamma"}));
  EXPECT_EQ(pose["J_columns_are"], "coordinate rates");
  EXPECT_EQ(pose["J_twist_rows"], pose["J_rows"]);
  EXPECT_EQ(pose["J_twist_columns"], (std::vector<std::string>{"vx", "vy", "vz", "wx", "wy", "wz"}));
  EXPECT_EQ(pose["J_twist_columns_are"], "twist");
  EXPECT_EQ(pose["T_rows"], pose["J_twist_columns"]);
  for (std::size_t i = 0; i < 6; ++i)  // J = J_twist T
    for (std::size_t j = 0; j < 6; ++j) {
      double sum = 0;
      for (std::size_t k = 0; k < 6; ++k) sum += double(pose["J_twist"][i][k]) * double(pose["T"][k][j]);
      EXPECT_NEAR(pose["J"][i][j], sum, 1e-14);
    }
  EXPECT_THAT(run({"pose", gough, "--at", at}).out, HasSubstr("\nJ_twist, where qdot = J_twist [vx vy vz wx wy wz]\n"));
  const auto built_in = run({"pose", "4ppa-2par", "--at", "x=0.25,y=0.85,z=-0.8,theta=30deg", "--json"}).json();
  EXPECT_EQ(built_in["J_columns"], (std::vector<std::string>{"x", "y", "z", "theta"}));
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(built_in["J_twist"][i][5], built_in["J"][i][3]);
  EXPECT_THAT(run({"pose", "4ppa-2par", "--at", "x=0.25,y=0.85,z=-0.8,theta=30deg"}).out, Not(HasSubstr("J_twist")));
}

TEST_F(MechanismFile, AStudyResumesAndIsShownWithoutTheFile) {
  ASSERT_EQ(run({"run", "study.toml", "--output", "s.h5", "--quiet"}).err, "");
  const std::string text = text_of(path("delta.toml"));
  const StudyContents stored = read_study(path("s.h5"));
  ASSERT_TRUE(stored.description);
  EXPECT_EQ(stored.description->text, text);
  EXPECT_EQ(stored.description->file_name, "delta.toml");

  const auto evaluate = [this] { return run({"evaluate", "--from", "s.h5"}).out; };
  const std::string evaluated = evaluate();
  folder_.write("delta.toml", "not TOML");  // the stored text is used, not the file
  EXPECT_EQ(evaluate(), evaluated);
  std::filesystem::remove(path("delta.toml"));
  EXPECT_EQ(evaluate(), evaluated);
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"show", "s.h5"},
                                                    {"export", "s.h5", "--csv", "tables"},
                                                    {"workspace", "--from", "s.h5"},
                                                    {"resume", "s.h5", "--generations", "4", "--quiet"}}) {
    const auto result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << arguments[0];
    EXPECT_EQ(result.err, "") << arguments[0];
  }
  EXPECT_EQ(read_study(path("s.h5")).stages[0].generations.size(), 5u);
  EXPECT_EQ(run({"run", "study.toml", "--output", "s.h5", "--resume"}).err,
            "pkmopt: delta.toml: found no readable file (No such file or directory); expected the mechanism in TOML "
            "that study.toml:3 names\n");

  folder_.write("delta.toml", text);
  EXPECT_EQ(run({"run", "study.toml", "--output", "s.h5", "--resume", "--quiet"}).err, "");
  folder_.write("delta.toml", text + "# changed\n");
  const auto changed = run({"run", "study.toml", "--output", "s.h5", "--resume", "--quiet"});
  EXPECT_EQ(changed.exit_code, 1);
  EXPECT_EQ(
      changed.err,
      "pkmopt: s.h5 holds a study whose mechanism file differs from delta.toml; continue it with 'pkmopt resume s.h5', "
      "or overwrite it with --force\n");
}

TEST_F(MechanismFile, IsNotOverwrittenByOutputs) {
  const std::string text = text_of(path("delta.toml"));
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"run", "study.toml", "--output", "delta.toml", "--force"},
        {"run", "study.toml", "--output", "./delta.toml", "--seeds", "2", "--force"},
        {"workspace", "study.toml", "--csv", "delta.toml", "--force"},
        {"workspace", "delta.toml", "--csv", "./delta.toml", "--force"},
        {"new", "study", "delta.toml", "-o", "delta.toml", "--force"}}) {
    const auto result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments[0];
    EXPECT_THAT(result.err, HasSubstr("delta.toml: is read by this command, so it is not overwritten")) << arguments[0];
  }
  const auto unforced = run({"new", "mechanism", "-o", "delta.toml"});
  EXPECT_EQ(unforced.exit_code, 1);
  EXPECT_EQ(unforced.err, "pkmopt: delta.toml exists already; overwrite it with --force\n");
  EXPECT_EQ(text_of(path("delta.toml")), text);
}

TEST_F(MechanismFile, InvalidFilesAreRejected) {
  folder_.write("both.toml", "[mechanism]\nfile = \"delta.toml\"\ntype = \"quadrupteron\"\n");
  folder_.write("nul.toml", "[mechanism]\nfile = \"a\\u0000b\"\n");
  folder_.write("folder.toml", "[mechanism]\nfile = \".\"\n");
  folder_.write("large.toml", "[mechanism]\nfile = \"large\"\n");
  folder_.write("large", "");
  std::filesystem::resize_file(path("large"), (std::uintmax_t{16} << 20) + 1);
  const struct {
    std::vector<std::string> arguments;
    std::string sentence;
  } cases[] = {
      {{"run", "delta.toml"},
       "delta.toml: found a mechanism file; expected a study, which refers to this file by [mechanism] "
       "file = \"..\""},
      {{"check", "both.toml"},
       "both.toml:2: mechanism.file: the mechanism is also given by mechanism.type (line 3); it is either built in or "
       "described by a file"},
      {{"check", "nul.toml"},
       "nul.toml:2: mechanism.file: found \"a\\u0000b\"; expected the name of a mechanism's file"},
      {{"evaluate", "folder.toml"}, ".: found a folder; expected the mechanism in TOML that folder.toml:2 names"},
      {{"check", "large.toml"},
       "large: found more than 16 MiB; expected the mechanism in TOML that large.toml:2 names"},
      {{"list", "study.toml"}, "study.toml: found a study; expected a mechanism file"},
      {{"new", "study", "study.toml"}, "study.toml: found a study; expected a mechanism file"},
      {{"new", "study"}, "new study: found no mechanism; expected a mechanism's name or its file"},
      {{"new", "stduy"}, "new: found 'stduy'; expected one of mechanism, study; did you mean 'study'?"},
      {{"new", "mechanism", "../x"},
       "new mechanism: found '../x'; expected a name of at most 60 letters, digits, - and _"},
  };
  for (const auto& [arguments, sentence] : cases) {
    const auto result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << sentence;
    EXPECT_EQ(result.err, "pkmopt: " + sentence + "\n");
  }
  const auto none = run({"new", "study", "dleta"});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_THAT(none.err, StartsWith("pkmopt: found 'dleta', which is neither a mechanism nor a file; expected one of "));
}

/// A volume whose error exceeds it is none.
TEST_F(MechanismFile, WithAnUnknownVolumeIsNotEvaluated) {
  folder_.write("comb.toml", R"toml([mechanism]
name = "comb"
[parameters]
w = { default = "50 mm", min = "1 um", max = "3 m" }
[platform]
coordinates = { x = "along x", y = "along y" }
[survey]
box = { x = [0, 1], y = [0, 1] }
[[limb]]
name = "a"
drive = "formula"
joints = { p = "x", q = "y" }
unit = "m"
[[margin]]
name = "comb"
formula = "sin(2*pi*x/w)"
unit = "1"
)toml");
  EXPECT_EQ(run({"evaluate", "comb.toml"}).exit_code, 0);
  const auto found = run({"evaluate", "comb.toml", "--set", "w=1um"});
  EXPECT_EQ(found.exit_code, 1);
  EXPECT_THAT(found.err, HasSubstr("the volume of the workspace is unknown"));
}

TEST_F(MechanismFile, WhoseColumnsTakeTooLongIsEvaluatedByVoxels) {
  const std::string file = PKM_TEST_DATA "/robots/coaxial-spherical.toml",
                    reason = "mechanism coaxial-spherical has no exact columns that can be computed in seconds";
  const auto found = run({"evaluate", file});
  EXPECT_EQ(found.exit_code, 0) << found.err;
  EXPECT_THAT(found.out, HasSubstr("method          voxels"));
  EXPECT_THAT(found.out, HasSubstr(reason));
  const std::string checked = run({"check", file}).out;
  EXPECT_THAT(checked.substr(checked.find("not available, and why")),
              HasSubstr("exact workspace by columns  " + reason));
  const std::string supported = run({"check", PKM_TEST_DATA "/generic/three-cylinders-by-exponentials.toml"}).out;
  EXPECT_THAT(supported, HasSubstr("exact workspace by columns          workspace.method = \"columns\""))
      << "transcendental constraints that are computed in seconds";
}

TEST_F(MechanismFile, SaysWhetherItsVolumeDependsOnSamples) {
  const auto edges = run({"evaluate", "delta.toml"}), closed = run({"evaluate", "4ppa-2par"}),
             slices = run({"evaluate", PKM_TEST_DATA "/mechanisms/linear-delta-joint-angle.toml"});
  EXPECT_THAT(edges.out, HasSubstr(", certified to 1e-08"));
  EXPECT_THAT(closed.out, HasSubstr(", estimated"));
  EXPECT_THAT(slices.out, HasSubstr(", as far as sampled"));
}

}  // namespace
}  // namespace pkm::testing
