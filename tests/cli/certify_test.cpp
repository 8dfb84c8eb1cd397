// `pkmopt certify`, and pkmopt-check-proof, which must accept its proofs and reject every modified proof.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "tests/cli/run_program.hpp"
#include "tests/cli/study_folder.hpp"

namespace pkm::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::string kMechanisms = PKM_EXPERIMENTS "/mechanisms/";

class Certify : public ::testing::Test {
 protected:
  ProgramResult run(const std::vector<std::string>& arguments) const { return pkmopt(arguments, folder_.path()); }
  ProgramResult check(const std::string& file) const { return run_program({PKM_CHECKER, file}, folder_.path()); }
  std::string proof_of(const std::string& mechanism, const std::string& gap) const {
    const auto written = run({"certify", mechanism, "--gap", gap, "--proof", "a.proof", "--force"});
    EXPECT_EQ(written.exit_code, 0) << written.err;
    std::ostringstream text;
    text << std::ifstream(folder_.path() + "/a.proof").rdbuf();
    return text.str();
  }

  StudyFolder folder_;
};

TEST_F(Certify, BoundsVolumes) {
  const auto found = run({"certify", kMechanisms + "orthoglide.toml", "--gap", "0.1", "--json"});
  ASSERT_EQ(found.exit_code, 0) << found.err;
  const auto printed = found.json();
  EXPECT_LT(printed["volume"]["lower"], 0.017428);
  EXPECT_GT(printed["volume"]["upper"], 0.017415);
  EXPECT_LE(printed["gap"], 0.1);
  const auto shorter = run({"certify", kMechanisms + "orthoglide.toml", "--gap", "0.1", "--set", "L=300mm", "--json"});
  EXPECT_NE(shorter.json()["volume"], printed["volume"]);
  const auto few = run({"certify", kMechanisms + "orthoglide.toml", "--gap", "0.01", "--boxes", "50"});
  EXPECT_EQ(few.exit_code, 1);
  EXPECT_THAT(few.out, HasSubstr("at least"));
  EXPECT_THAT(few.err, HasSubstr("needs more than 50 boxes"));
}

TEST_F(Certify, RejectsInvalidArguments) {
  EXPECT_THAT(run({"certify", "quadrupteron", "--limit", "clearance_min=5mm"}).err,
              HasSubstr("mechanism quadrupteron has no certified bounds with a clearance limit"));
  EXPECT_THAT(run({"certify", kMechanisms + "orthoglide.toml", "--gap", "0"}).err, HasSubstr("between 0 and 2"));
  EXPECT_THAT(run({"certify", kMechanisms + "orthoglide.toml", "--box", "x=0:1"}).err, HasSubstr("--box"));
}

TEST_F(Certify, BoundsHoldTheExactVolumesOfTheBuiltInMechanisms) {
  for (const char* mechanism : {"4ppa-2par", "3crr-r-cru", "quadrupteron", "2t1r-p-hybrid"}) {
    const auto found = run({"evaluate", mechanism, "--certified", "5e-2", "--json"});
    ASSERT_EQ(found.exit_code, 0) << mechanism << found.err;
    EXPECT_EQ(found.json()["certified"]["holds_volume"], true) << mechanism;
    EXPECT_LE(found.json()["certified"]["gap"], 5e-2) << mechanism;
  }
}

TEST_F(Certify, EvaluateChecksItsVolumeAgainstTheBounds) {
  const auto found = run({"evaluate", kMechanisms + "five-bar.toml", "--certified", "1e-2", "--json"});
  ASSERT_EQ(found.exit_code, 0) << found.err;
  const auto printed = found.json();
  EXPECT_EQ(printed["certified"]["holds_volume"], true);
  EXPECT_LE(printed["certified"]["gap"], 1e-2);
  EXPECT_LE(printed["certified"]["lower"], printed["workspace"]["volume"]);
  EXPECT_GE(printed["certified"]["upper"], printed["workspace"]["volume"]);
  std::ofstream(folder_.path() + "/voxels.toml") << "[mechanism]\nfile = \"" << kMechanisms << R"(five-bar.toml"
[variables]
l_a = { min = "100 mm", max = "300 mm" }
[workspace]
method = "voxels"
[[objective]]
type = "workspace-volume"
[[stage]]
optimiser = "ga"
)";
  EXPECT_THAT(run({"evaluate", "voxels.toml", "--certified", "1e-2"}).err, HasSubstr("whose volume it checks"));
  EXPECT_THAT(run({"evaluate", kMechanisms + "five-bar.toml", "--certified", "2"}).err, HasSubstr("between 0 and 2"));
}

TEST_F(Certify, CertifiesBoxesOfPoses) {
  const std::string file = kMechanisms + "orthoglide.toml";
  const auto inside = run({"certify", file, "--box", "x=-50mm:30mm,y=-50mm:30mm,z=-50mm:30mm", "--json"});
  EXPECT_EQ(inside.exit_code, 0) << inside.err;
  EXPECT_EQ(inside.json()["feasible"]["verdict"], "yes");
  EXPECT_EQ(inside.json()["regular"]["verdict"], "yes");
  const auto across = run({"certify", file, "--box", "x=-0.1:0.12,y=-0.1:0.12,z=-0.1:0.12"});
  EXPECT_EQ(across.exit_code, 1);
  EXPECT_THAT(across.out, HasSubstr("is violated at x = "));
}

/// The largest cylinder of the linear Delta (tests/cli/largest_solid_test.cpp), which touches the boundary of the
/// workspace, and larger and smaller ones.
TEST_F(Certify, CertifiesCylindersAndSpheres) {
  const std::vector<std::string> design = {"certify", kMechanisms + "linear-delta.toml", "--set",
                                           "R=0.26,r=0.06,l=0.5,q_max=0.6", "--json"};
  const auto certified = [&](std::vector<std::string> solid) {
    solid.insert(solid.begin(), design.begin(), design.end());
    return run(solid);
  };
  const std::string diameter = "diameter=" + std::to_string(2 * 0.2586), height = "z=-0.1985:0.0998";
  const auto inside = certified({"--cylinder", "x=0,y=0," + height + "," + diameter});
  EXPECT_EQ(inside.exit_code, 0) << inside.err;
  EXPECT_EQ(inside.json()["feasible"]["verdict"], "yes");
  EXPECT_EQ(inside.json()["regular"]["verdict"], "yes");
  const std::string edge = std::to_string(0.2586);
  const auto box = certified({"--box", "x=-" + edge + ":" + edge + ",y=-" + edge + ":" + edge + "," + height});
  EXPECT_EQ(box.json()["feasible"]["verdict"], "no");  // the corners of the box about the cylinder
  const auto wide = certified({"--cylinder", "x=0,y=0", height, "diameter=0.53"});
  EXPECT_EQ(wide.exit_code, 1);
  const auto pose = wide.json()["feasible"]["pose"];
  EXPECT_LE(std::hypot(double(pose["x"]), double(pose["y"])), 0.265);
  EXPECT_THAT(wide.err, HasSubstr("the cylinder is not feasible everywhere"));
  EXPECT_EQ(certified({"--sphere", "x=0,y=0,z=-0.05,diameter=0.29"}).json()["feasible"]["verdict"], "yes");
  EXPECT_EQ(certified({"--sphere", "x=0,y=0,z=-0.05,diameter=0.6"}).json()["feasible"]["verdict"], "no");

  EXPECT_THAT(certified({"--cylinder", "x=0,y=0,z=0,diameter=0.5"}).err,
              HasSubstr("found 0 ranges; expected one range"));
  EXPECT_THAT(certified({"--sphere", "x=0,y=0,z=0:1,diameter=0.5"}).err,
              HasSubstr("found 1 ranges; expected no range"));
  EXPECT_THAT(certified({"--cylinder", "x=0,y=0,z=0:1"}).err, HasSubstr("found no value for diameter"));
  EXPECT_THAT(certified({"--sphere", "x=0,y=0,z=0,diameter=1", "--box", "x=0:1"}).err,
              HasSubstr("cannot be combined with --box"));
}

TEST_F(Certify, CertifiesMotions) {
  const std::string file = kMechanisms + "orthoglide.toml";
  const auto points = [](const std::string& end) {
    return "type = \"points\"\ntime = 0.5\npoints = [{ x = 0, y = 0, z = 0 }, { x = \"30 mm\", z = " + end + " }]\n";
  };
  folder_.write("inside.toml", points("0.02"));
  folder_.write("leaves.toml", points("0.3"));
  const auto inside = run({"certify", file, "--motion", "inside.toml", "--json"});
  EXPECT_EQ(inside.exit_code, 0) << inside.err;
  EXPECT_EQ(inside.json()["feasible"]["verdict"], "yes");
  EXPECT_EQ(inside.json()["regular"]["verdict"], "yes");
  EXPECT_EQ(inside.json()["duration"], 0.5);
  EXPECT_TRUE(inside.json()["feasible"]["time"].is_null());
  EXPECT_THAT(run({"certify", file, "--motion", "inside.toml"}).out, HasSubstr("everywhere along the motion"));

  const auto leaves = run({"certify", file, "--motion", "leaves.toml", "--json"});
  EXPECT_EQ(leaves.exit_code, 1);
  EXPECT_THAT(leaves.err, HasSubstr("the motion is not feasible everywhere"));
  EXPECT_EQ(leaves.json()["feasible"]["verdict"], "no");
  EXPECT_EQ(leaves.json()["regular"]["verdict"], "not examined");
  const double t = leaves.json()["feasible"]["time"];
  // samples agree: all before the infeasible instant are feasible, those just after it are not
  const auto sampled = run({"trajectory", file, "--motion", "leaves.toml", "--samples", "1001", "--json"}).json();
  for (const auto& sample : sampled["samples"]) {
    const double at = sample["time"];
    const bool feasible = sample["feasible"];
    EXPECT_TRUE(feasible || at >= t - 1e-5) << at;
    EXPECT_TRUE(!feasible || at < t || at > t + 6e-4) << at;
  }
  EXPECT_THAT(run({"certify", file, "--motion", "leaves.toml"}).out, HasSubstr("is violated at t = "));
}

TEST_F(Certify, ReportsSingularPoses) {
  const std::string cables = PKM_TEST_DATA "/redundant/four-cables.toml";
  const auto box = run({"certify", cables, "--box", "x=-0.1:0.1,y=-0.1:0.1"});
  EXPECT_EQ(box.exit_code, 1);
  EXPECT_THAT(box.out, HasSubstr("feasible   everywhere in the box\n"));
  EXPECT_THAT(box.out, HasSubstr("regular    no, singular at x = 0 mm, y = 0 mm, phi = 0 deg"));
  EXPECT_THAT(box.out, HasSubstr("det(G^T G) = 0), to working precision"));
  EXPECT_THAT(box.err, HasSubstr("the box is not regular everywhere"));
  folder_.write("flat.toml", "type = \"formulas\"\nduration = 1\nx = \"0.1*t\"\ny = 0\nphi = 0\n");
  folder_.write("turned.toml", "type = \"formulas\"\nduration = 1\nx = \"0.1*t\"\ny = 0\nphi = 0.1\n");
  EXPECT_EQ(run({"certify", cables, "--motion", "flat.toml", "--json"}).json()["regular"]["verdict"], "no");
  const auto turned = run({"certify", cables, "--motion", "turned.toml"});
  EXPECT_EQ(turned.exit_code, 0) << turned.err;
  EXPECT_THAT(turned.out, HasSubstr("regular    no singularity along the motion\n"));

  const auto leaves = run({"certify", kMechanisms + "orthoglide.toml", "--box", "x=-0.1:0.12,y=-0.1:0.12,z=-0.1:0.12"});
  EXPECT_THAT(leaves.out, HasSubstr("regular    not examined, because not every pose is feasible\n"));
}

TEST_F(Certify, RejectsInvalidMotions) {
  const std::string file = kMechanisms + "orthoglide.toml";
  folder_.write("m.toml", "type = \"formulas\"\nduration = 1\nx = \"0.01*t\"\ny = 0\nz = 0\n");
  EXPECT_EQ(run({"certify", file, "--motion", "m.toml"}).exit_code, 0);
  EXPECT_THAT(run({"certify", file, "--motion", "missing.toml"}).err, HasSubstr("missing.toml"));
  EXPECT_THAT(run({"certify", file, "--motion", "m.toml", "--box", "x=0:0.1,y=0:0.1,z=0:0.1"}).err,
              HasSubstr("--motion: cannot be combined with --box"));
  EXPECT_THAT(run({"certify", file, "--motion", "m.toml", "--proof", "p"}).err,
              HasSubstr("proofs are written for volumes only"));
  EXPECT_THAT(run({"certify", "quadrupteron", "--motion", "m.toml"}).err, HasSubstr("m.toml:1: phi: found nothing"));
  folder_.write("four.toml", "type = \"formulas\"\nduration = 1\nx = 0\ny = 0\nz = 0\nphi = 0\n");
  EXPECT_THAT(run({"certify", file, "--motion", "four.toml"}).err, HasSubstr("phi"));
}

/// A study of a five-bar whose volumes are checked against certified bounds.
class CertifiedVolumes : public Certify {
 protected:
  void SetUp() override {
    folder_.write("s.toml", "[mechanism]\nfile = \"" + kMechanisms +
                                "five-bar.toml\"\n[variables]\nl_a = { min = 0.2, max = 0.4 }\nl_b = { min = 0.25, max "
                                "= 0.5 }\n[baseline]\nl_a = 0.25\nl_b = 0.35\n[workspace]\ncertified = "
                                "1e-3\n[[objective]]\ntype = \"workspace-ratio\"\n[[stage]]\noptimiser = "
                                "\"ga\"\npopulation = 6\ngenerations = 4\n[final]\nround = \"10 mm\"\n");
  }
};

TEST_F(CertifiedVolumes, ArePrintedByRunShowAndExport) {
  const auto ran = run({"run", "s.toml", "--threads", "1"});
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("volume, at least"));
  EXPECT_THAT(ran.out, HasSubstr("volume, at most"));
  EXPECT_THAT(run({"show", "s.h5"}).out, HasSubstr("volume, at least"));
  const auto shown = run({"show", "s.h5", "--json"}).json();
  for (const char* design : {"best", "rounded", "baseline"}) {
    const auto& printed = shown[design];
    EXPECT_LE(printed["certified"]["lower"], printed["volume"]) << design;
    EXPECT_GE(printed["certified"]["upper"], printed["volume"]) << design;
    EXPECT_LE(printed["certified"]["gap"], 1e-3) << design;
  }
  ASSERT_EQ(run({"export", "s.h5", "--csv", "tables"}).exit_code, 0);
  std::ostringstream table;
  table << std::ifstream(folder_.path() + "/tables/best.csv").rdbuf();
  EXPECT_THAT(table.str(), HasSubstr("workspace,volume at least,m^2,"));
  EXPECT_EQ(run({"run", "s.toml", "--threads", "2", "--output", "two.h5", "--quiet"}).exit_code, 0);
  auto two = run({"show", "two.h5", "--json"}).json(), one = shown;
  two.erase("seconds");
  one.erase("seconds");
  EXPECT_EQ(one, two);
}

TEST_F(CertifiedVolumes, AreCheckedByEvaluate) {
  const auto found = run({"evaluate", "s.toml", "--json"});
  ASSERT_EQ(found.exit_code, 0) << found.err;
  EXPECT_EQ(found.json()["certified"]["holds_volume"], true);
  EXPECT_LE(found.json()["certified"]["gap"], 1e-3);
  EXPECT_LE(run({"evaluate", "s.toml", "--certified", "1e-4", "--json"}).json()["certified"]["gap"], 1e-4);
  EXPECT_THAT(run({"check", "s.toml"}).out, HasSubstr("by bounds with the relative gap 0.001"));
  EXPECT_EQ(run({"check", "s.toml", "--json"}).json()["workspace"]["certified"], 1e-3);
}

TEST_F(Certify, ProofsAreAccepted) {
  std::vector<std::string> mechanisms = {"4ppa-2par", "3crr-r-cru", "quadrupteron", "2t1r-p-hybrid"};
  for (const char* name : {"orthoglide", "five-bar", "rotary-delta", "gough"})
    mechanisms.push_back(kMechanisms + name + ".toml");
  for (const std::string& mechanism : mechanisms) {
    proof_of(mechanism, mechanism.ends_with("rotary-delta.toml") ? "0.8" : "0.3");
    const auto checked = check("a.proof");
    EXPECT_EQ(checked.exit_code, 0) << mechanism << ' ' << checked.err;
    EXPECT_THAT(checked.out, StartsWith("accepted: "));
  }
}

/// Replaces the first occurrence of `from` after the text `after`.
std::string with(std::string text, const std::string& after, const std::string& from, const std::string& to) {
  const auto at = text.find(from, text.find(after));
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

TEST_F(Certify, TamperedProofsAreRefused) {
  const std::string proof = proof_of(kMechanisms + "orthoglide.toml", "0.15");
  EXPECT_EQ(check("a.proof").exit_code, 0) << "untouched";
  const std::string lower = proof.substr(proof.find("volume ") + 7, 5);
  const std::size_t boxes = proof.find("boxes\n") + 6, last = proof.find("end\n");
  // a copy of the proof, and the position of the first step of a kind among the boxes
  const auto find_step = [&](char step) {
    std::string changed = proof;
    const std::size_t at = changed.find(step, boxes);
    EXPECT_LT(at, last) << step;
    return std::pair(changed, at);
  };
  const auto step_changed = [&](char step, char to) {
    auto [changed, at] = find_step(step);
    changed[at] = to;
    return changed;
  };
  /// The enclosure of a root, shrunk to its lower end.
  const auto narrowed_root = [&] {
    auto [changed, at] = find_step('t');
    const auto first = changed.find(' ', at) + 1, second = changed.find(' ', first) + 1,
               third = changed.find(' ', second);
    return changed.replace(second, third - second, changed.substr(first, second - first - 1));
  };
  const std::vector<std::pair<std::string, std::string>> tampered = {
      {"a larger lower bound", with(proof, "volume", lower, "0.0179")},
      {"a smaller upper bound",
       [&] {
         const auto first = proof.find(' ', proof.find("volume") + 7) + 1;
         return std::string(proof).replace(first, proof.find('\n', first) - first, "0.0168");
       }()},
      {"another parameter", with(proof, "given", "0.31 0.31 L", "0.3 0.3 L")},
      {"an interval for a parameter", with(proof, "given", "0.31 0.31 L", "0.3 0.32 L")},
      {"another limit", with(proof, "given", "0.126 0.126", "0.16 0.16")},
      {"another formula", with(proof, "let n3", "n1 + n2", "n1 - n2")},
      {"a formula of an undefined name", with(proof, "let n3", "n1 + n2", "n1 + n99")},
      {"a syntax error in a formula", with(proof, "let n3", "n1 + n2", "n1 n2")},
      {"a name defined twice", with(proof, "let n2", "n2", "n1")},
      {"a wider axis", with(proof, "axis", "-0.31", "-0.5")},
      {"a reversed axis", with(proof, "axis", "-0.31 0.31", "0.31 -0.31")},
      {"a missing axis", with(proof, "axis z", "axis z -0.31 0.31\n", "")},
      {"another constraint", with(proof, "condition", "condition n7 ", "condition n1 ")},
      {"a missing constraint",
       [&] {
         const auto at = proof.rfind("condition ");
         return std::string(proof).erase(at, proof.find('\n', at) + 1 - at);
       }()},
      {"inside instead of outside", step_changed('x', 'h')},
      {"outside instead of inside", step_changed('h', 'x')},
      {"a root without an enclosure", narrowed_root()},
      {"a split declared to be a root", step_changed('s', 'r')},
      {"an unknown step", step_changed('n', 'q')},
      {"a missing box",
       [&] {
         const auto at = proof.find(".\n", boxes), from = proof.rfind('\n', at) + 1;
         return std::string(proof).erase(from, at + 2 - from);
       }()},
      {"a repeated box",
       [&] {
         const auto at = proof.find(".\n", boxes), from = proof.rfind('\n', at) + 1;
         return std::string(proof).insert(from, proof.substr(from, at + 2 - from));
       }()},
      {"a bisected box declared to be final",
       [&] {
         const auto at = proof.find("/0\n", boxes);
         return std::string(proof).replace(at, 2, ".");
       }()},
      {"bisected along a coordinate that is not an outer axis", with(proof, "boxes", "/0\n", "/2\n")},
      {"bisected along the other axis", with(proof, "boxes", "/0\n", "/1\n")},
      {"truncated", proof.substr(0, (boxes + last) / 2)},
      {"without an end", proof.substr(0, last)},
      {"text after the end", proof + "\n"},
      {"another version", with(proof, "pkmopt", "proof 1", "proof 2")},
      {"an empty file", ""},
  };
  EXPECT_GE(tampered.size(), 20U);
  for (const auto& [what, text] : tampered) {
    EXPECT_NE(text, proof) << what;
    folder_.write("tampered.proof", text);
    const auto checked = check("tampered.proof");
    EXPECT_EQ(checked.exit_code, 1) << what << ": " << checked.out;
    EXPECT_THAT(checked.err, StartsWith("refused: ")) << what;
  }
}

/// Proofs of wrong volumes, each of which would pass if a certain rule of the checker were missing.
TEST_F(Certify, FalseProofsAreRefused) {
  struct Case {
    std::string what, volume, head, boxes, reason;
  };
  const Case cases[] = {
      {"a range whose length overflows: heights would be NaN, which is infeasible everywhere; the true volume is 2",
       "0 1", "axis x -1e308 1e308\nlet n1 = (1 - (x * x))\ncondition n1\n", "x0 .\n", "line 3: the range is too long"},
      {"a derivative of sqrt(0), which does not exist, next to that of z; the true volume is 0", "0.7 0.8",
       "axis z -1 1\nlet u = min((z * z), 0)\nlet n1 = ((min(sqrt(u), z) * 2) - 0.5)\ncondition n1\n",
       "t0 671088639 671088641 536870912 n.\n", "is not proven to be monotonic"},
      {"a number that overflows in double precision, although it is 1e400; the true volume is 1", "0 0",
       "axis x 0 1\nlet n1 = ((1e200 * 1e200) + x)\ncondition n1\n", "x0 .\n", "no finite value"},
      {"a third bound of a range", "0 2", "axis x 0 1 2\nlet n1 = x\ncondition n1\n", "h0 .\n",
       "line 3: found '2'; expected the end of the line"},
      {"a third bound of the volume", "0 2 0.5", "axis x 0 1\ncondition x\n", "h0 .\n", "line 2: found '0.5';"},
      {"an infinite volume", "0 inf", "axis x 0 1\ncondition x\n", "h0 .\n", "'inf' is not a finite number"},
      {"a count that overflows", "0 2", "axis x 0 1\ncondition x\n", "h18446744073709551616 .\n",
       "an integer is expected"},
      {"endless bisection", "0 2", "axis x 0 1\naxis y 0 1\ncondition y\n",
       [] {
         std::string boxes;
         for (int i = 0; i < 300; ++i) boxes += "n/0\n";
         return boxes;
       }(),
       "the boxes are bisected too often"},
  };
  for (const Case& one : cases) {
    folder_.write("false.proof",
                  "pkmopt proof 1\nvolume " + one.volume + '\n' + one.head + "boxes\n" + one.boxes + "end\n");
    const auto checked = check("false.proof");
    EXPECT_EQ(checked.exit_code, 1) << one.what << ": " << checked.out;
    EXPECT_THAT(checked.err, AllOf(StartsWith("refused: line "), HasSubstr(one.reason))) << one.what;
  }
}

TEST_F(Certify, RejectsARangeWhoseLengthOverflows) {
  folder_.write("disc.toml", R"([mechanism]
name = "disc"
[parameters]
w = { default = 1, min = 0.1, max = 3, unit = "m" }
[platform]
coordinates = { x = "along x", y = "along y" }
[survey]
sweep = ["x", "y"]
box = { x = [-1e308, 1e308], y = [-1, 1] }
[[limb]]
name = "a"
drive = "formula"
joints = { p = "x", q = "y" }
unit = "m"
[[margin]]
name = "disc"
formula = "w^2 - x^2 - y^2"
unit = "m^2"
)");
  const auto written = run({"certify", "disc.toml", "--proof", "disc.proof"});
  EXPECT_EQ(written.exit_code, 2) << written.out;
  EXPECT_THAT(written.err, HasSubstr("certified bounds: the range of x is longer than the largest double"));
}

/// A proof that cannot be checked gives exit code 2, not that of a rejected proof.
TEST_F(Certify, CheckerReportsWhenItCannotCheck) {
  folder_.write("a.proof", "pkmopt proof 1\nvolume 0 2\naxis x 0 1\ncondition x\nboxes\nh0 .\nend\n");
  EXPECT_EQ(check("a.proof").exit_code, 0);
  const auto shell = [&](const std::string& line) { return run_program({"/bin/sh", "-c", line}, folder_.path()); };
  const std::string checker = "'" PKM_CHECKER "' ";
  const std::pair<std::string, std::string> cases[] = {
      {checker + "absent.proof", "not checked: absent.proof: No such file or directory"},
      {checker + ".", "not checked: .: Is a directory"},
      {checker + "a.proof > /dev/full", "not checked: the output cannot be written"},
      {checker + "--version > /dev/full", "not checked: the output cannot be written"},
      {checker, "usage: pkmopt-check-proof FILE"},
      {checker + "--prove", "usage: pkmopt-check-proof FILE"},
      {checker + "a.proof a.proof", "usage: pkmopt-check-proof FILE"},
  };
  for (const auto& [line, words] : cases) {
    const auto found = shell(line);
    EXPECT_EQ(found.exit_code, 2) << line << found.out;
    EXPECT_THAT(found.err, StartsWith(words)) << line;
  }
#ifndef PKM_CHECK_CONTRACTS  // sanitizers need more memory
  const auto starved = shell("ulimit -v 60000; " + checker + "/dev/zero");
  EXPECT_EQ(starved.exit_code, 2);
  EXPECT_THAT(starved.err, StartsWith("not checked: out of memory"));
#endif
  const auto help = shell(checker + "--help"), version = shell(checker + "--version");
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.out, HasSubstr("2 not checked"));
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_THAT(version.out, StartsWith("pkmopt-check-proof 0."));
}

}  // namespace
}  // namespace pkm::testing
