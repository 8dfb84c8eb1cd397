// Numbers for people: units, significant digits, and options that all commands share.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/app/print.hpp"
#include "tests/cli/run_program.hpp"
#include "tests/cli/study_folder.hpp"

namespace pkm::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(Digits, AreFourSignificantOnesWithoutCuttingIntegers) {
  EXPECT_EQ(digits(302.1309339), "302.1");
  EXPECT_EQ(digits(0.00012345), "0.0001234");
  EXPECT_EQ(digits(123456), "123456");
  EXPECT_EQ(digits(1.23456e8), "1.235e+08");
  EXPECT_EQ(digits(-0.0), "0");
  EXPECT_EQ(digits(std::nan("")), "-");
  EXPECT_EQ(digits(0.123456789, 7), "0.1234568");
  EXPECT_EQ(signed_digits(0.25), "+0.25");
}

TEST(Digits, AreInUnitsOfPeople) {
  EXPECT_EQ(number(0.1, "m"), "100 mm");
  EXPECT_EQ(number(12.345678, "m"), "12.35 m");
  EXPECT_EQ(number(3.2e-5, "m"), "32 um");
  EXPECT_EQ(number(0, "m"), "0 mm");
  EXPECT_EQ(number(1.0471975512, "rad"), "60 deg");
  EXPECT_EQ(number(0.0125, "s"), "12.5 ms");
  EXPECT_EQ(number(0.1727035763, "m^3"), "0.1727 m^3");
  EXPECT_EQ(number(2.5e-5, "m^3"), "25 cm^3");
  EXPECT_EQ(number(4.4e-5, "m^2"), "44 mm^2");
  EXPECT_EQ(number(12500, "N"), "12.5 kN");
  EXPECT_EQ(number(0.25), "0.25");
  EXPECT_EQ(number(std::nan(""), "m"), "not computed");
  EXPECT_EQ(range_text(-0.25, 0.5, "m"), "-250 .. 500 mm");
  EXPECT_EQ(result_text(0.19, "rad"), "0.19 rad") << "seldom an angle";
}

TEST(Digits, OfBoundsAreRoundedOutwards) {
  EXPECT_EQ(directed_digits(0.227549353784, 4, -1), "0.2275");
  EXPECT_EQ(directed_digits(0.227549353784, 4, 1), "0.2276");
  EXPECT_EQ(directed_digits(-1.23456, 3, -1), "-1.24");
  EXPECT_EQ(directed_digits(0.3, 2, 1), "0.3");
  EXPECT_EQ(directed_digits(0.3, 2, -1), "0.3");
  EXPECT_EQ(bounds_text(0.22754935, 0.22983589, "m^3")[0], "0.22754 m^3");
  EXPECT_EQ(bounds_text(0.22754935, 0.22983589, "m^3")[1], "0.22984 m^3");
}

TEST(Digits, OfVoxelVolumesAreThoseThatTheGridSupports) {
  EXPECT_EQ(known_digits_of_voxels(20, 3), 1);
  EXPECT_EQ(known_digits_of_voxels(1000, 3), 3);
  EXPECT_EQ(known_digits_of_voxels(100, 1), 3);
  EXPECT_EQ(number(0.549540014936, "m^2 rad", known_digits_of_voxels(192, 3)), "0.55 m^2 rad");
  EXPECT_EQ(measure_name(2), "area");
}

TEST(CliConsole, DigitsAreAnOptionOfEveryCommandThatPrintsResults) {
  const std::vector<std::string> pose = {"pose", "4ppa-2par", "--at", "x=0.25,y=0.85,z=-0.8,theta=30deg"};
  EXPECT_THAT(pkmopt(pose).out, HasSubstr("x = 250 mm, y = 850 mm, z = -800 mm, theta = 30 deg"));
  std::vector<std::string> full = pose;
  full.insert(full.end(), {"--digits", "17"});
  EXPECT_THAT(pkmopt(full).out, ::testing::ContainsRegex("q1 +[0-9]+\\.[0-9]{10,} mm"));
  full.back() = "18";
  EXPECT_THAT(pkmopt(full).err, HasSubstr("--digits: found '18'; expected a whole number from 1 to 17"));
}

TEST(CliConsole, VersionAndHelpHaveShortForms) {
  EXPECT_EQ(pkmopt({"-V"}).out, pkmopt({"--version"}).out);
  const auto version = pkmopt({"--version", "--json"}).json();
  EXPECT_EQ(version["program"], "pkmopt");
  EXPECT_THAT(pkmopt({"--version"}).out, HasSubstr("pkmopt " + version["version"].get<std::string>() + " (" +
                                                   version["revision"].get<std::string>() + ")"));
  EXPECT_EQ(pkmopt({"help", "run"}).out, pkmopt({"run", "--help"}).out);
  EXPECT_EQ(pkmopt({"help"}).out, pkmopt({"--help"}).out);
  EXPECT_THAT(pkmopt({"help", "runn"}).err, HasSubstr("did you mean 'run'?"));
  EXPECT_EQ(pkmopt({"--json"}).exit_code, 2);
}

constexpr const char* kStudy = R"([mechanism]
type = "4ppa-2par"
[variables]
a = { min = "150 mm", max = "1 ft" }
b = { min = "31.5 inch", max = "1.2 m" }
[baseline]
a = 0.2
[workspace]
method = "voxels"
cells = { x = 12, z = 12, theta = 12 }
[[objective]]
type = "workspace-ratio"
[[output]]
name = "rail spacing"
type = "expression"
expression = "b"
unit = "m"
[[stage]]
optimiser = "ga"
population = 6
generations = 2
)";

TEST(CliConsole, AShortRunPrintsNothingTwiceAndNoEfficiency) {
  const StudyFolder folder;
  folder.write("s.toml", kStudy);
  const auto text = pkmopt({"run", "s.toml", "-o", "s.h5"}, folder.path());
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_THAT(text.out, ::testing::ContainsRegex("\n  a +mm +"));
  EXPECT_THAT(text.out, HasSubstr("workspace-ratio, exact"));
  EXPECT_THAT(text.out, Not(HasSubstr("rail spacing, exact"))) << "equal to that of the voxels";
  EXPECT_THAT(text.out, Not(HasSubstr("parallel efficiency")));
  const auto printed = pkmopt({"run", "s.toml", "-o", "t.h5", "--json", "-q"}, folder.path());
  EXPECT_EQ(printed.exit_code, 0);
  EXPECT_EQ(printed.err, "");
  EXPECT_EQ(printed.json()["file"], "t.h5");
  EXPECT_EQ(printed.json()["best"], pkmopt({"show", "s.h5", "--json"}, folder.path()).json()["best"]);
  const auto seeds = pkmopt({"run", "s.toml", "-o", "u.h5", "--json", "--seeds", "2"}, folder.path());
  EXPECT_EQ(seeds.json()["seeds"].size(), 2u);
  EXPECT_EQ(seeds.json()["seeds"][0]["best"], printed.json()["best"]);
}

TEST(CliConsole, AnOptimiserInCapitalsIsRecognised) {
  const StudyFolder folder;
  std::string study = kStudy;
  folder.write("s.toml", study.replace(study.find("\"ga\""), 4, "\"GA\""));
  EXPECT_THAT(pkmopt({"run", "s.toml"}, folder.path()).err, HasSubstr("; did you mean 'ga'?"));
}

TEST(CliConsole, CellsOfACutCoordinateAreNotNeeded) {
  const std::vector<std::string> cut = {"workspace", "4ppa-2par", "--cut", "theta=0", "--json", "--cells"};
  auto with = [&](const std::string& cells) {
    std::vector<std::string> arguments = cut;
    arguments.push_back(cells);
    return pkmopt(arguments);
  };
  EXPECT_EQ(with("x=20,z=10").json()["cells"], 200);
  EXPECT_EQ(with("20").json()["cells"], 400);
  EXPECT_THAT(with("x=20,z=10,theta=4").err,
              HasSubstr("--cells: found cells of theta, at which the workspace is cut; expected cells of x, z"));
}

TEST(CliConsole, FieldsOfAFineGridThatNothingDrawsAreThoseOfACoarserOne) {
  const StudyFolder folder;
  const auto workspace = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"workspace", PKM_EXPERIMENTS "/mechanisms/five-bar.toml", "--json"});
    return pkmopt(more, folder.path()).json();
  };
  const auto fine = workspace({"--cells", "60"}), coarse = workspace({"--cells", "48"}),
             drawn = workspace({"--cells", "60", "-o", "map.svg"});
  EXPECT_EQ(fine["cells"], 3600);
  EXPECT_EQ(fine["field_cells"], 48 * 48);
  EXPECT_EQ(fine["fields"], coarse["fields"]);
  EXPECT_EQ(drawn["field_cells"], 3600);
  EXPECT_NE(drawn["fields"], coarse["fields"]);
  for (const char* const key : {"volume", "feasible_cells", "axes", "touches_box"}) EXPECT_EQ(fine[key], drawn[key]);
}

}  // namespace
}  // namespace pkm::testing
