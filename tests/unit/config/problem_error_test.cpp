// Workspaces, objectives, constraints and stages that are wrong.

#include "tests/unit/config/wrong_studies.hpp"

namespace pkm {
namespace {

using testing::expect_messages;
using testing::kMachine;
using testing::kProblem;
using testing::kStage;
using testing::kVolume;
using testing::message_of;

TEST(ProblemErrors, Workspace) {
  expect_messages(
      kMachine + "[workspace]\n",
      {
          {"method = \"voxel\"",
           "s.toml:4: workspace.method: found \"voxel\"; expected one of columns, voxels; did you mean 'voxels'?"},
          {"metod = \"voxels\"",
           "s.toml:4: workspace.metod: found an unknown key; expected one of method, tolerance, nodes, cells, box, "
           "home, "
           "sweep, limits, certified, exact, y; did you mean 'method'?"},
          {"tolerance = 1", "s.toml:4: workspace.tolerance: found 1; expected a number in [1e-13, 0.1]"},
          {"tolerance = \"1e-8 m\"",
           "s.toml:4: workspace.tolerance: found \"1e-8 m\"; expected a number, or text such as \"5 %\""},
          {"tolerance = 1e-6\nnodes = { x = 4, theta = 4 }",
           "s.toml:5: workspace.nodes: tolerance (line 4) and nodes both set the accuracy; give one of them"},
          {"nodes = { x = 4 }", "s.toml:4: workspace.nodes.theta: found nothing; expected a number of nodes"},
          {"nodes = { x = 4, z = 4 }",
           "s.toml:4: workspace.nodes.z: columns run along z, which has no nodes; expected x, theta"},
          {"nodes = { x = 0, theta = 4 }", "s.toml:4: workspace.nodes.x: found 0; expected an integer in [1, 200]"},
          {"cells = { x = 1, z = 1, theta = 1 }",
           "s.toml:4: workspace.cells: this key requires method = \"voxels\", but the study's method is \"columns\""},
          {"method = \"columns\"\nbox = {}",
           "s.toml:5: workspace.box: this key requires method = \"voxels\", but the study's method is \"columns\""},
          {"method = \"voxels\"\ntolerance = 1e-6",
           "s.toml:5: workspace.tolerance: this key requires method = \"columns\", but the study's method is "
           "\"voxels\""},
          {"method = \"voxels\"\ncells = { x = 0, z = 1, theta = 1 }",
           "s.toml:5: workspace.cells.x: found 0; expected an integer in [1, 1048576]"},
          {"method = \"voxels\"\ncells = { x = 3.0, z = 1, theta = 1 }",
           "s.toml:5: workspace.cells.x: found 3.0; expected an integer in [1, 1048576]"},
          {"method = \"voxels\"\ncells = { x = 2000, z = 2000, theta = 2000 }",
           "s.toml:5: workspace.cells: found 8000000000 cells; expected at most 268435456 (a voxel map takes a byte "
           "of "
           "memory per cell)"},
          {"method = \"voxels\"\ncells = 32",
           "s.toml:5: workspace.cells: found 32; expected a table { x = .., z = .., theta = .. }"},
          {"method = \"voxels\"\ncells = { x = 1, y = 1, theta = 1 }",
           "s.toml:5: workspace.cells.y: found an unknown coordinate; expected one of x, z, theta; did you mean 'x'?"},
          {"method = \"voxels\"\ny = \"integrated\"\ncells = { x = 1, z = 1, theta = 1 }",
           "s.toml:6: workspace.cells.y: found nothing; expected a number of cells"},
          {"method = \"voxels\"\nbox = { x = [0, 1], z = [0, 1] }",
           "s.toml:5: workspace.box.theta: found nothing; expected a range [from, to]"},
          {"method = \"voxels\"\nbox = { x = [1, 0], z = [0, 1], theta = [0, 1] }",
           "s.toml:5: workspace.box.x: found [1, 0]; expected a range [from, to] with from < to"},
          {"method = \"voxels\"\nbox = { x = [0, 9], z = [0, 1], theta = [-90, 90] }",
           "s.toml:5: workspace.box.theta[1]: found -90; expected an angle in [-pi, pi] rad; write \"-90 deg\" for "
           "degrees"},
          {"method = \"voxels\"\nbox = { x = [0, 1], z = [0, 1], theta = [0, \"270 deg\"] }",
           "s.toml:5: workspace.box.theta[2]: found \"270 deg\"; expected an angle in [-pi, pi] rad"},
          {"method = \"voxels\"\nbox = { x = [1], z = [0, 1], theta = [0, 1] }",
           "s.toml:5: workspace.box.x: found [1]; expected a range [from, to]"},
          {"method = \"voxels\"\nbox = { x = [0, \"9 deg\"], z = [0, 1], theta = [0, 1] }",
           "s.toml:5: workspace.box.x[2]: found \"9 deg\"; expected a number in m, or text with a unit made of um, mm, "
           "cm, dm, m, km, in, inch, ft"},
          {"y = \"midle\"",
           "s.toml:4: workspace.y: found \"midle\"; expected \"middle\", \"integrated\" or a number in m; did you mean "
           "'middle'?"},
          {"y = \"1 rad\"",
           "s.toml:4: workspace.y: found \"1 rad\"; expected \"middle\", \"integrated\" or a number in m"},
          {"limits = { gap_mni = 0.1 }",
           "s.toml:4: workspace.limits.gap_mni: found an unknown limit; expected one of gap_min, angle_max; did you "
           "mean 'gap_min'?"},
          {"limits = { angle_max = \"90 deg\" }",
           "s.toml:4: workspace.limits.angle_max: found \"90 deg\"; expected a number in [0, 1.5] rad"},
          {"limits = 3", "s.toml:4: workspace.limits: found 3; expected a table { gap_min = .., angle_max = .. }"},
      });
  EXPECT_EQ(message_of(kVolume + kStage +
                       "[workspace]\nmethod = \"voxels\"\ny = \"integrated\"\n"
                       "box = { x = [0, 1], z = [0, 1], theta = [0, 1] }"),
            "s.toml:10: workspace: the slider cannot integrate inside a given box");
}

TEST(ProblemErrors, Objectives) {
  expect_messages(
      kProblem,
      {
          {"[objective]\ntype = \"volume\"",
           "s.toml:5: objective: found a table; expected a list of tables, each written [[objective]]"},
          {"objective = [1]",  // inside [variables]: TOML's own rule
           "s.toml:5: variables.objective: found an unknown parameter; expected one of a, b, tilt, mass"},
          {"[[objective]]\nname = \"v\"",
           "s.toml:5: objective[1].type: found nothing; expected one of volume, shape, force"},
          {"[[objective]]\ntpye = \"volume\"",
           "s.toml:6: objective[1].tpye: found an unknown key; expected type = one of volume, shape, force; did you "
           "mean "
           "'type'?"},
          {"[[objective]]\ntype = \"volum\"",
           "s.toml:6: objective[1].type: found \"volum\"; expected one of volume, shape, force; did you mean "
           "'volume'?"},
          {"[[objective]]\ntype = \"volume\"\ndirection = \"minimize\"",
           "s.toml:7: objective[1].direction: found \"minimize\"; expected one of minimise, maximise; did you mean "
           "'minimise'?"},
          {"[[objective]]\ntype = \"force\"",
           "s.toml:6: objective[1].type: force needs bodies, which the mechanism slider does not describe"},
          {"[[objective]]\ntype = \"volume\"\n[[objective]]\ntype = \"volume\"",
           "s.toml:7: objective[2]: the name 'volume' is already used; give this one another name with name = \"...\""},
          {"[[objective]]\ntype = \"volume\"\nname = \"a/b\"",
           "s.toml:7: objective[1].name: found \"a/b\"; expected a name of letters, digits, blanks between them, '-', "
           "'_' and '.'"},
          {"[[objective]]\ntype = \"shape\"\ncont = 3",
           "s.toml:7: objective[1].cont: found an unknown key; expected one of type, name, direction, region, robust, "
           "length, "
           "count, "
           "exact, statistic, weights, note; did you mean 'count'?"},
          {"[[objective]]\ntype = \"shape\"\ncount = 3.0",
           "s.toml:7: objective[1].count: found 3.0; expected an integer in [1, 100]"},
          {"[[objective]]\ntype = \"shape\"\ncount = 101",
           "s.toml:7: objective[1].count: found 101; expected an integer in [1, 100]"},
          {"[[objective]]\ntype = \"shape\"\nexact = 1",
           "s.toml:7: objective[1].exact: found 1; expected true or false"},
          {"[[objective]]\ntype = \"shape\"\nstatistic = \"men\"",
           "s.toml:7: objective[1].statistic: found \"men\"; expected one of mean, min; did you mean 'mean'?"},
          {"[[objective]]\ntype = \"shape\"\nnote = 3", "s.toml:7: objective[1].note: found 3; expected text"},
          {"[[objective]]\ntype = \"shape\"\nlength = \"20 m\"",
           "s.toml:7: objective[1].length: found \"20 m\"; expected a number in [0, 10] m"},
          {"[[objective]]\ntype = \"shape\"\nweights = 3",
           "s.toml:7: objective[1].weights: found 3; expected a table of numbers, { name = number, ... }"},
          {"[[objective]]\ntype = \"shape\"\nweights = { a = 2 }",
           "s.toml:7: objective[1].weights.a: found 2; expected a number in [0, 1]"},
          {"[[objective]]\ntype = \"shape\"\nlength = 1\n[[output]]\ntype = \"shape\"\nlength = 2",
           "s.toml:8: output[1]: conditioning is requested with two different characteristic lengths; use one length "
           "in all tables"},
          {"[[output]]\ntype = \"volume\"\ndirection = \"minimise\"",
           "s.toml:7: output[1].direction: found an unknown key; expected one of type, name, region, robust; did you "
           "mean "
           "'region'?"},
      });
}

TEST(ProblemErrors, Constraints) {
  expect_messages(
      kVolume,
      {
          {"[[constraint]]\ntype = \"raech\"",
           "s.toml:8: constraint[1].type: found \"raech\"; expected one of gap, reach, linear, volume, shape, force; "
           "did "
           "you mean 'reach'?"},
          {"[[constraint]]\ntype = \"reach\"\nbound = 1",
           "s.toml:9: constraint[1].bound: found an unknown key; expected one of type, name, robust"},
          {"[[constraint]]\ntype = \"linear\"\nbound = 1",
           "s.toml:7: constraint[1].coefficients: found nothing; expected a table of numbers, { name = number, ... }"},
          {"[[constraint]]\ntype = \"linear\"\ncoefficients = { q = 1 }\nbound = 1",
           "s.toml:7: constraint[1]: coefficients name no parameter 'q'"},
          {"[[constraint]]\ntype = \"linear\"\ncoefficients = { a = 1 }\nbound = \"2 rad\"",
           "s.toml:10: constraint[1].bound: found \"2 rad\"; expected a number in m, or text with a unit made of um, "
           "mm, "
           "cm, dm, m, km, in, inch, ft"},
          {"[[constraint]]\ntype = \"reach\"\n[[constraint]]\ntype = \"reach\"",
           "s.toml:9: constraint[2]: the name 'reach' is already used; give this one another name with name = \"...\""},
          {"[[constraint]]\ntype = \"volume\"",
           "s.toml:7: constraint[1]: give min = .. or max = ..: the objective volume is used as a constraint"},
          {"[[constraint]]\ntype = \"volume\"\nmin = 1\nmax = 2",
           "s.toml:7: constraint[1]: found both min and max; give one of them, and write a second [[constraint]] for "
           "the other"},
          {"[[constraint]]\ntype = \"volume\"\nmin = \"1 m^3\"",
           "s.toml:9: constraint[1].min: found \"1 m^3\"; expected a number in m^2 rad, or text with a unit made of "
           "um, "
           "mm, cm, dm, m, km, in, inch, ft, mrad, rad, deg, °"},
          {"[[constraint]]\ntype = \"force\"\nmax = 1",
           "s.toml:8: constraint[1].type: force needs bodies, which the mechanism slider does not describe"},
          {"[[constraint]]\ntype = \"gap\"\nangle_max = 0",
           "s.toml:7: constraint[1]: an angle_max of 0 leaves no pose"},
          {"[[constraint]]\ntype = \"gap\"\n[[constraint]]\ntype = \"gap\"",
           "s.toml:9: constraint[2]: the threshold gap_min is set here and in constraint[1] gap (line 7); set it once"},
          {"[workspace]\nlimits = { angle_max = 1 }\n[[constraint]]\ntype = \"gap\"\nangle_max = 1",
           "s.toml:9: constraint[1]: the threshold angle_max is set here and in workspace.limits (line 8); set it "
           "once"},
      },
      kStage);
}

TEST(ProblemErrors, OnlyStudiesWithStagesRun) {
  const Study study = read_study_toml(kVolume, "s.toml", testing::fake_catalogues());
  EXPECT_TRUE(study.stages.empty());
  try {
    require_stages(study, testing::fake_catalogues());
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "s.toml: stage: found nothing; expected at least one [[stage]] with optimiser = one of ga, simple, "
                 "newton, sweep, broken; without stages a study can be evaluated, but not run");
  }
}

TEST(ProblemErrors, Stages) {
  const std::string two = kVolume + "[[objective]]\ntype = \"shape\"\n";
  const std::string discrete =
      "[mechanism]\ntype = \"slider\"\n[variables]\na = { min = 0.1, max = 0.9, step = 0.1 }\n"
      "[[objective]]\ntype = \"volume\"\n";
  expect_messages(
      "",
      {
          {(kVolume + "[[stage]]\ntype = \"ga\""),
           "s.toml:7: stage[1].optimiser: found nothing; expected one of ga, simple, newton, sweep, broken"},
          {(kVolume + "[[stage]]\noptimizer = \"ga\""),
           "s.toml:8: stage[1].optimizer: found an unknown key; expected optimiser = one of ga, simple, newton, sweep, "
           "broken; did you mean 'optimiser'?"},
          {(kVolume + "[[stage]]\noptimiser = \"swep\""),
           "s.toml:8: stage[1].optimiser: found \"swep\"; expected one of ga, simple, newton, sweep, broken; did you "
           "mean "
           "'sweep'?"},
          {(kVolume + "[[stage]]\noptimiser = \"ga\"\npopulaton = 3"),
           "s.toml:9: stage[1].populaton: found an unknown key; expected one of optimiser, population, rate, target, "
           "width; "
           "did "
           "you mean 'population'?"},
          {(kVolume + "[[stage]]\noptimiser = \"ga\"\npopulation = 1"),
           "s.toml:9: stage[1].population: found 1; expected an integer in [2, 1e+06]"},
          {(kVolume + "[[stage]]\noptimiser = \"ga\"\ntarget = \"2 m\""),
           "s.toml:9: stage[1].target: found \"2 m\"; expected a number in m^2 rad, or text with a unit made of um, "
           "mm, "
           "cm, dm, m, km, in, inch, ft, mrad, rad, deg, °"},
          {(kVolume + "[[stage]]\noptimiser = \"broken\""),
           "s.toml:7: stage[1]: elite must be smaller than population"},
          {(two + "[[stage]]\noptimiser = \"ga\""),
           "s.toml:10: stage[1].optimiser: the optimiser ga handles 1 objective, but the study has 2 (volume, shape)"},
          {(kProblem + "[[stage]]\noptimiser = \"ga\""),
           "s.toml:6: stage[1].optimiser: the optimiser ga needs an objective, but the study has no [[objective]]"},
          {(kMachine + "[[objective]]\ntype = \"volume\"\n[[stage]]\noptimiser = \"ga\""),
           "s.toml:6: stage[1].optimiser: the optimiser ga needs variables, but the study's [variables] is empty"},
          {(kVolume + "[[constraint]]\ntype = \"reach\"\n[[stage]]\noptimiser = \"simple\""),
           "s.toml:10: stage[1].optimiser: the optimiser simple handles no constraints, but the study has reach"},
          {(discrete + "[[stage]]\noptimiser = \"simple\""),
           "s.toml:8: stage[1].optimiser: the optimiser simple handles continuous variables only, but the variable a "
           "has "
           "a step"},
          {(kVolume + "[workspace]\nmethod = \"voxels\"\n[[stage]]\noptimiser = \"newton\""),
           "s.toml:10: stage[1].optimiser: the optimiser newton needs derivatives, but voxel counts are piecewise "
           "constant and have no derivatives; set workspace.method = \"columns\""},
      });
}

TEST(ProblemErrors, References) {
  expect_messages(
      kVolume,
      {{"[[reference]]\nseconds = 1",
        "s.toml:7: reference[1].name: found nothing; expected where the result was published"},
       {"[[reference]]\nname = \"p\"\nvalues = { volumme = 1 }",
        "s.toml:9: reference[1].values.volumme: found an unknown objective or output; expected one of volume; "
        "did you mean 'volume'?"},
       {"[[reference]]\nname = \"p\"\nvalues = { volume = \"1 m\" }",
        "s.toml:9: reference[1].values.volume: found \"1 m\"; expected a number in m^2 rad, or text with a unit made "
        "of "
        "um, mm, cm, dm, m, km, in, inch, ft, mrad, rad, deg, °"},
       {"[[reference]]\nname = \"p\"\ndesign = { b = 1 }",
        "s.toml:9: reference[1].design.b: found an unknown variable; expected one of a; did you mean 'a'?"},
       {"[[reference]]\nname = \"p\"\nseconds = -1",
        "s.toml:9: reference[1].seconds: found -1; expected a number >= 0 s"}},
      kStage);
}

}  // namespace
}  // namespace pkm
