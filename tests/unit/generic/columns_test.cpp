// Exact columns of mechanisms from files against values that two routes agree on (tests/data/generic), areas and
// volumes in closed form (tests/data/mechanisms), and differences.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "engine/workspace/prepare_workspace.hpp"
#include "tests/unit/contracts/mechanism_fixtures.hpp"
#include "tests/unit/generic/files.hpp"

namespace pkm {
namespace {

using Json = nlohmann::json;

const Json& golden() {
  static const Json json = Json::parse(std::ifstream(PKM_TEST_DATA "/generic/generic.json"));
  return json;
}

std::shared_ptr<const Mechanism> mechanism_in(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return read_mechanism_toml(text.str(), path);
}

/// A golden case as a survey of a file.
struct Case {
  std::shared_ptr<const Mechanism> mechanism;
  std::vector<double> design;
  WorkspacePlan plan;

  explicit Case(const Json& entry) {
    static const std::map<std::string, std::string> files = {{"3rpr-xy", "3-rpr"},
                                                             {"3rpr-xyphi", "3-rpr"},
                                                             {"cylinders", "three-cylinders"},
                                                             {"gough", "gough"},
                                                             {"delta", "delta"}};
    const std::string name = entry["case"];
    const auto file = files.find(name);
    mechanism = file == files.end() ? test::described("4ppa-2par")
                                    : mechanism_in(PKM_TEST_DATA "/generic/" + file->second + ".toml");
    const MechanismInfo& info = mechanism->info();
    Json parameters;
    for (const auto& [key, value] : entry["parameters"].items()) parameters[parameter(key)] = value;
    design = test::design_with(info, parameters);
    plan = {.method = ColumnOptions{.tolerance = 1e-8},
            .fixed = {},
            .limits = name == "4ppa-limits" ? test::limits_with(info, parameters) : no_limits(info)};
    if (name == "3rpr-xy") plan.fixed = {{2, FixedCoordinate::Kind::value, parameters["phi"]}};
    if (name == "3rpr-xyphi") plan.fixed = {{.coordinate = 2, .kind = FixedCoordinate::Kind::integrated}};
  }
  static std::string parameter(const std::string& key) { return key == "lu" ? "l_u" : key == "ld" ? "l_d" : key; }
};

TEST(GenericColumns, AreTheGoldenVolumes) {
  int compared = 0;
  for (const Json& entry : golden()["cases"]) {
    const Case known(entry);
    SCOPED_TRACE(entry["case"].get<std::string>() + " " + entry["parameters"].dump());
    const WorkspaceResult<double> found = test::survey(*known.mechanism, known.design, known.plan);
    const double error = std::fabs(found.volume / entry["best_volume"].get<double>() - 1);
    const double accuracy = std::pow(10.0, -entry["digits"].get<double>());
    EXPECT_LT(error, std::max(1e-11, 10 * accuracy));
    EXPECT_LT(found.error, 1e-8);
    EXPECT_LT(error, 1e-12 + accuracy + found.error);
    ++compared;
  }
  EXPECT_EQ(compared, 14);
}

/// By every parameter, in passes of four, with values that have the bits of those without derivatives. A golden design
/// on a change of structure has no derivative there, which its file says.
TEST(GenericColumns, HaveTheGoldenDerivatives) {
  int compared = 0;
  for (const Json& entry : golden()["cases"]) {
    if (entry["gradient"].is_null() || entry["gradient_difference"].get<double>() > 1e-5) continue;
    const Case known(entry);
    const auto evaluator = prepare_workspace(*known.mechanism, known.plan, {});
    const auto& parameters = known.mechanism->info().parameters;
    const double volume = test::survey(*known.mechanism, known.design, known.plan).volume;
    std::vector<double> slopes;
    Scratch scratch;
    for (std::size_t first = 0; first < parameters.size(); first += 4) {
      std::vector<Dual4> design(known.design.begin(), known.design.end());
      for (std::size_t i = first; i < std::min(first + 4, design.size()); ++i)
        design[i] = Dual4::variable(design[i].a, static_cast<int>(i - first));
      WorkspaceResult<Dual4> found;
      evaluator->gradients()->evaluate(design, scratch, found);
      EXPECT_EQ(found.volume.a, volume);
      for (int i = 0; i < 4; ++i) slopes.push_back(found.volume.v[i]);
    }
    double largest = 0;
    for (const auto& [key, slope] : entry["gradient"].items())
      largest = std::fmax(largest, std::fabs(slope.get<double>()));
    for (const auto& [key, slope] : entry["gradient"].items()) {
      const auto at = std::ranges::find(parameters, Case::parameter(key), &Parameter::name);
      if (at == parameters.end()) continue;  // a threshold
      EXPECT_NEAR(slopes[static_cast<std::size_t>(at - parameters.begin())], slope.get<double>(), 1e-6 * largest)
          << entry["case"] << ' ' << key;
      ++compared;
    }
  }
  EXPECT_GT(compared, 60);
}

/// The areas and volumes that references.py has from elsewhere, with whatever coordinates they hold.
TEST(GenericColumns, AreTheExactOnesOfTheReferences) {
  std::set<std::string> compared;
  for (const std::string& name : test::mechanism_files()) {
    const std::string path = PKM_TEST_DATA "/mechanisms/" + name + ".json";
    if (!std::filesystem::exists(path) || !test::described(name)->columns()) continue;
    const MechanismInfo& info = test::described(name)->info();
    for (const Json& exact : Json::parse(std::ifstream(path)).value("exact", Json::array())) {
      WorkspacePlan plan{.method = ColumnOptions{.tolerance = 1e-10}, .fixed = {}, .limits = no_limits(info)};
      for (const auto& [coordinate, value] : exact["held"].items())
        plan.fixed.push_back({static_cast<int>(find_named(info.coordinates, coordinate) - info.coordinates.data()),
                              FixedCoordinate::Kind::value, value});
      const auto design = test::design_with(info, exact["parameters"]);
      const double volume = exact["value"];
      EXPECT_NEAR(test::survey(*test::described(name), design, plan).volume / volume, 1,
                  std::pow(10.0, 1 - exact["digits"].get<double>()) + 1e-13)
          << name << ' ' << exact.dump();
      compared.insert(name);
    }
  }
  EXPECT_THAT(compared, ::testing::IsSupersetOf({"3-rpr", "gough"}));
}

/// One, two and three swept coordinates: areas over a coordinate are the volume, lengths the area.
TEST(GenericColumns, AddUpOverAnIntegratedCoordinate) {
  const auto mechanism = mechanism_in(PKM_TEST_DATA "/generic/three-cylinders.toml");
  const std::vector<double> design = test::nominal(mechanism->info());
  const auto measure = [&](const WorkspacePlan& plan) { return test::survey(*mechanism, design, plan).volume; };
  WorkspacePlan plan{.method = ColumnOptions{}, .fixed = {}, .limits = no_limits(mechanism->info())};
  const double volume = measure(plan);
  plan.fixed = {{.coordinate = 1, .kind = FixedCoordinate::Kind::integrated}};
  EXPECT_NEAR(measure(plan) / volume, 1, 1e-9);
  plan.fixed.push_back({.coordinate = 0, .kind = FixedCoordinate::Kind::integrated});
  EXPECT_NEAR(measure(plan) / volume, 1, 1e-8);
}

/// Three cylinders once more, by margins that are no polynomials.
TEST(GenericColumns, OfAnyFormulasAreThoseOfPolynomials) {
  const auto cylinders = mechanism_in(PKM_TEST_DATA "/generic/three-cylinders.toml");
  const auto others = mechanism_in(PKM_TEST_DATA "/generic/three-cylinders-by-exponentials.toml");
  const std::vector<double> design = test::nominal(cylinders->info());
  WorkspacePlan plan{.method = ColumnOptions{}, .fixed = {}, .limits = no_limits(cylinders->info())};
  const auto compare = [&](double tolerance) {
    std::vector<Dual4> duals(design.begin(), design.end());
    for (std::size_t i = 0; i < 4; ++i) duals[i] = Dual4::variable(design[i], static_cast<int>(i));
    WorkspaceResult<Dual4> known, found;
    evaluate_once<Dual4>(*prepare_workspace(*cylinders, plan, {}), duals, known);
    evaluate_once<Dual4>(*prepare_workspace(*others, plan, {}), duals, found);
    EXPECT_NEAR(found.volume.a / known.volume.a, 1, tolerance);
    EXPECT_LT(found.error, 1e-6);
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(found.volume.v[i], known.volume.v[i], 1e-4 * std::fabs(known.volume.v[i]));
  };
  compare(1e-7);
  for (int coordinate : {0, 1, 2}) {
    plan.fixed = {{coordinate, FixedCoordinate::Kind::value, 0.3}};
    compare(1e-9);
  }
}

/// A line of one unit in the last place cannot be halved: its ends are searched no further.
TEST(GenericColumns, OfALineThatCannotBeHalvedEnd) {
  std::ostringstream file;
  file << std::ifstream(PKM_TEST_DATA "/generic/three-cylinders-by-exponentials.toml").rdbuf();
  const std::string touching =
      "[[margin]]\nname = \"c4\"\nformula = \"-abs(exp(x + y + z) - exp(0.9))\"\nunit = \"1\"\n";
  const auto mechanism = read_mechanism_toml(file.str() + touching, "touching.toml");
  const std::array<double, 2> line = {0.3, std::nextafter(0.3, 1)};
  WorkspacePlan plan{
      .method = ColumnOptions{.box = Box{line, line, line}}, .fixed = {}, .limits = no_limits(mechanism->info())};
  const double volume = test::survey(*mechanism, test::nominal(mechanism->info()), plan).volume;
  EXPECT_GE(volume, 0);
  EXPECT_LE(volume, 1e-48);
}

/// Where they cannot, they say what stands in the way.
TEST(GenericColumns, SayWhyThereAreNone) {
  std::ostringstream file;
  file << std::ifstream(PKM_TEST_DATA "/generic/three-cylinders.toml").rdbuf();
  std::string text = file.str();
  // nothing bounds z
  for (const char* const of_z : {", z = [-1.5, 1.5]", " - z^2", " - (z - dz)^2"})
    text.erase(text.find(of_z), std::string(of_z).size());
  const auto mechanism = read_mechanism_toml(text, "boundless.toml");
  EXPECT_EQ(mechanism->columns(), nullptr);
  EXPECT_EQ(mechanism->why_no_columns(), "it has no [survey] box for z");
}

/// Where cranks fold, columns end at roots of degree four: other designs than the golden one, whose volumes came out
/// the same with up to four times as many places that are looked at, and derivatives against differences.
TEST(GenericColumns, OfCranksAreExactToo) {
  const Mechanism& delta = *test::described("rotary-delta");
  const auto evaluator = prepare_workspace(delta, test::columns(delta.info()), {});
  const auto survey = [&](const std::vector<double>& design) {
    WorkspaceResult<double> found;
    evaluate_once<double>(*evaluator, design, found);
    return found;
  };
  const std::pair<std::vector<double>, double> others[] = {{{0.16, 0.05, 0.17, 0.6, -0.9, 1.6}, 0.1108431442},
                                                           {{0.16, 0.046, 0.174, 0.534, -0.846, 1.463}, 0.0733202319},
                                                           {{0.233, 0.047, 0.219, 0.515, -0.583, 1.815}, 0.0937325498}};
  for (const auto& [design, known] : others) {
    const WorkspaceResult<double> found = survey(design);
    EXPECT_NEAR(found.volume / known, 1, 3e-9);
    EXPECT_LT(found.error, 1e-8);
  }
  const std::vector<double> nominal = test::nominal(delta.info());
  for (std::size_t first : {0, 2}) {
    std::vector<Dual4> design(nominal.begin(), nominal.end());
    for (std::size_t i = 0; i < 4; ++i) design[first + i] = Dual4::variable(nominal[first + i], static_cast<int>(i));
    WorkspaceResult<Dual4> slopes;
    evaluate_once<Dual4>(*evaluator, design, slopes);
    for (std::size_t i = 0; i < 4; ++i) {
      std::vector<double> low = nominal, high = nominal;
      low[first + i] -= 1e-4;
      high[first + i] += 1e-4;
      EXPECT_NEAR(slopes.volume.v[static_cast<int>(i)], (survey(high).volume - survey(low).volume) / 2e-4, 2e-6);
    }
  }
}

/// Where a slide's rod is stretched across a limit of the slide, a cylinder and a sphere touch all along the
/// workspace's edge.
TEST(GenericColumns, AreExactWhereSurfacesTouchAllAlong) {
  const Mechanism& orthoglide = *test::described("orthoglide");
  const std::vector<double> design = test::design_with(
      orthoglide.info(), {{"L", 0.2616425143772651}, {"q_min", 0.1514192579692078}, {"q_max", 0.383}});
  const WorkspaceResult<double> found = test::survey(orthoglide, design, test::columns(orthoglide.info()));
  EXPECT_NEAR(found.volume, 0.0131476, 1e-7);
  EXPECT_LT(found.error, 1e-8);
  EXPECT_LT(found.columns, 5000);
}

/// Poses in columns are feasible, and their weights add up to the volume but for the rule's error.
TEST(GenericColumns, SampleInsideTheWorkspace) {
  for (const char* const name : {"orthoglide", "3-rrr", "4ppa-2par"}) {
    const Mechanism& mechanism = *test::described(name);
    const MechanismInfo& info = mechanism.info();
    const auto evaluator =
        prepare_workspace(mechanism, test::columns(info), {.fields = {&kConditioning}, .poses = true});
    WorkspaceResult<double> found;
    evaluate_once<double>(*evaluator, test::nominal(info), found);
    double sum = 0;
    for (std::size_t i = 0; i < found.pose.size(); ++i) {
      const PoseReport report = mechanism.inspect(test::nominal(info), found.pose[i], info.modes[0], no_limits(info));
      ASSERT_TRUE(report.feasible) << name << ": " << report.reason;
      EXPECT_NEAR(found.field(kConditioning)[i], *report.conditioning, 1e-12);
      sum += found.weight[i];
    }
    EXPECT_NEAR(sum / found.volume, 1, 2e-3) << name;
  }
}

}  // namespace
}  // namespace pkm
