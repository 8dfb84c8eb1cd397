#include <gtest/gtest.h>

#include "tests/unit/config/right_studies.hpp"

namespace pkm {
namespace {

using testing::kFull;
using testing::kSmallest;
using testing::read_right;

TEST(Describe, SpellsOutEveryDefault) {
  EXPECT_EQ(describe(read_right(kSmallest)), R"(  study      wide                         (default)
  file       runs/wide.toml
  seed       1                            (default)
  output     wide.h5                      (default)
  mechanism  slider: a machine for tests

variables
  a  100 .. 900 mm    half width

fixed parameters
  b     800 mm              (default)  distance
  tilt   28.6478897565 deg  (default)  tilt
  mass    2 kg              (default)  mass

workspace
  method     columns                 (default)
  tolerance  1e-08 relative          (default)
  y          default of each design  (default)

limits of a pose
  gap_min     0 mm              (default: inactive)  least gap
  angle_max  85.9436692696 deg  (default: inactive)  greatest angle

objectives
  volume: maximise, in m^2 rad

constraints: none

outputs: none

stages
  1. ga: evolves
    population  40       (default)
    rate        0.5      (default)
    target      not set  (default)
    width       3        (default)

run
  checkpoint  adaptive: at most 2 % of the run time  (default)
  final       best design, not rounded               (default)
)");
}

TEST(Describe, ShowsWhatWasGivenAndWhere) {
  EXPECT_EQ(describe(read_right(kFull)), R"(  study      wide <bounds>
  file       runs/wide.toml
  seed       7
  output     out.h5
  mechanism  slider: a machine for tests

variables
  tilt  -30 .. 28.6478897565 deg          baseline 28.6478897565 deg            tilt
  a     250 .. 720 mm in steps of 100 mm  baseline 800 mm (outside the bounds)  half width

fixed parameters
  b     800 mm    (default)  distance
  mass    0.5 kg             mass

workspace
  method  voxels
  cells   x = 32, z = 34, theta = 60                                               (default)
  box     x = 0 .. 800 mm, z = -1000 .. 1000 mm, theta = -90 .. 85.9436692696 deg
  y       200 mm

limits of a pose
  gap_min     2 a    from constraint[1] gap (line 23)  least gap
  angle_max  45 deg  from workspace.limits (line 19)   greatest angle

objectives
  volume: minimise, in m^2 rad

constraints
  gap: restricts the workspace by gap_min
    angle_max  not set  (default)
  big-enough (volume): >= 0.5 m^2 rad
  linear: margin >= 0, in m
    coefficients  { a = 1, b = -1 }
    bound         0 m

outputs
  shape: dimensionless
    length     0.12 m
    count      5        (default)
    exact      false    (default)
    statistic  "min"
    weights    not set  (default)
    note       not set  (default)

stages
  1. sweep: tries all
  2. ga: evolves
    population  10
    rate         0.5        (default)
    target       2 m^2 rad
    width        6          (default)

run
  checkpoint  every 60 s
  final       best design rounded to 0.01, evaluated again
  exact       exact values of final designs, at most 10 s   (default)

warning: variable a never reaches its max 0.72 m: the largest value min + k step is 0.65 m
)");
}

/// The line of a description that begins with these words.
std::string line_of(const std::string& text, const std::string& begin) {
  const std::string lines = '\n' + text;
  const auto at = lines.find("\n  " + begin);
  return at == std::string::npos ? "no line" : lines.substr(at + 1, lines.find('\n', at + 1) - at - 1);
}

TEST(Describe, MarksWhatIsGivenAndEqualsTheDefault) {
  const std::string given = describe(read_right(
      "[study]\nname = \"wide\"\nseed = 1\noutput = \"wide.h5\"\n" + kSmallest +
      "population = 40\nrate = 0.25\nwidth = 3\n[mechanism.parameters]\nb = 0.8\n[workspace]\nmethod = \"columns\"\n"
      "tolerance = 1e-8\ny = \"middle\"\nlimits = { gap_min = 0, angle_max = 1 }\n"));
  for (const char* const row :
       {"study", "seed", "output", "b ", "method", "tolerance", "y ", "  population", "  width"})
    EXPECT_TRUE(line_of(given, row).find("(default)") != std::string::npos) << line_of(given, row);
  EXPECT_EQ(line_of(given, "  rate").find("(default)"), std::string::npos) << line_of(given, "  rate");
  EXPECT_NE(line_of(given, "gap_min").find("from workspace.limits (line 22) (default: inactive)"), std::string::npos)
      << given;
  EXPECT_EQ(line_of(given, "angle_max").find("(default"), std::string::npos) << given;
  const std::string other = describe(
      read_right(kSmallest + "width = 4\n[workspace]\nmethod = \"voxels\"\ncells = { x = 32, z = 34, theta = 61 }\n"));
  for (const char* const row : {"method", "cells", "  width"})
    EXPECT_EQ(line_of(other, row).find("(default)"), std::string::npos) << line_of(other, row);
  EXPECT_NE(line_of(other, "box").find("(default)"), std::string::npos) << other;
}

}  // namespace
}  // namespace pkm
