// Exact columns of mechanisms from files against values that two routes agree on (tests/data/generic), areas and
// volumes in closed form (tests/data/mechanisms), and differences.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "engine/survey/survey_set.hpp"
#include "tests/unit/contracts/nominal.hpp"
#include "tests/unit/mechanisms/described/files.hpp"

namespace pkm {
namespace {

using Json = nlohmann::json;

const Json& golden() {
  static const Json json = Json::parse(std::ifstream(PKM_TEST_DATA "/generic/generic.json"));
  return json;
}

std::shared_ptr<const Mechanism> read(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return read_mechanism_toml(text.str(), path);
}

/// A golden case as a survey of a file.
struct Case {
  std::shared_ptr<const Mechanism> mechanism;
  std::vector<double> design;
  SurveyPlan plan;

  explicit Case(const Json& entry) {
    static const std::map<std::string, std::string> files = {
        {"3rpr-xy", "3-rpr"}, {"3rpr-xyphi", "3-rpr"}, {"cylinders", "three-cylinders"}, {"gough", "gough"}};
    const std::string name = entry["case"];
    const auto file = files.find(name);
    mechanism =
        file == files.end() ? test::described("4ppa-2par") : read(PKM_TEST_DATA "/generic/" + file->second + ".toml");
    const MechanismInfo& info = mechanism->info();
    Json parameters;
    for (const auto& [key, value] : entry["parameters"].items()) parameters[parameter(key)] = value;
    design = test::design_with(info, parameters);
    plan = {.method = ColumnOptions{.tolerance = 1e-8},
            .held = {},
            .limits = name == "4ppa-limits" ? test::limits_with(info, parameters) : no_limits(info)};
    if (name == "3rpr-xy") plan.held = {{2, HeldCoordinate::Kind::value, parameters["phi"]}};
    if (name == "3rpr-xyphi") plan.held = {{.coordinate = 2, .kind = HeldCoordinate::Kind::integrated}};
  }
  static std::string parameter(const std::string& key) { return key == "lu" ? "l_u" : key == "ld" ? "l_d" : key; }
};

/// All but the rotary Delta, whose cranks fold at surfaces of degree four.
std::vector<Json> cases() {
  std::vector<Json> some;
  for (const Json& entry : golden()["cases"])
    if (entry["case"] != "delta") some.push_back(entry);
  return some;
}

TEST(DescribedColumns, AreTheGoldenVolumes) {
  int compared = 0;
  for (const Json& entry : cases()) {
    const Case known(entry);
    SCOPED_TRACE(entry["case"].get<std::string>() + " " + entry["parameters"].dump());
    const Survey<double> found = test::survey(*known.mechanism, known.design, known.plan);
    const double error = std::fabs(found.volume / entry["best_volume"].get<double>() - 1);
    EXPECT_LT(error, std::max(1e-11, std::pow(10.0, 1 - entry["digits"].get<double>())));
    EXPECT_LT(found.error, 1e-8);
    EXPECT_LT(error, 1e-12 + found.error);
    ++compared;
  }
  EXPECT_EQ(compared, 12);
}

/// By every parameter, in passes of four, with values that have the bits of those without derivatives. A golden design
/// on a change of structure has no derivative there, which its file says.
TEST(DescribedColumns, HaveTheGoldenDerivatives) {
  int compared = 0;
  for (const Json& entry : cases()) {
    if (entry["gradient_difference"].get<double>() > 1e-5) continue;
    const Case known(entry);
    const auto surveyor = prepare_survey(*known.mechanism, known.plan, {});
    const auto& parameters = known.mechanism->info().parameters;
    const double volume = test::survey(*known.mechanism, known.design, known.plan).volume;
    std::vector<double> slopes;
    Scratch scratch;
    for (std::size_t first = 0; first < parameters.size(); first += 4) {
      std::vector<Dual4> design(known.design.begin(), known.design.end());
      for (std::size_t i = first; i < std::min(first + 4, design.size()); ++i)
        design[i] = Dual4::variable(design[i].a, static_cast<int>(i - first));
      Survey<Dual4> found;
      surveyor->slopes()->survey(design, scratch, found);
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
TEST(DescribedColumns, AreTheExactOnesOfTheReferences) {
  std::set<std::string> compared;
  for (const std::string& name : test::mechanism_files()) {
    const std::string path = PKM_TEST_DATA "/mechanisms/" + name + ".json";
    if (!std::filesystem::exists(path) || !test::described(name)->columns()) continue;
    const MechanismInfo& info = test::described(name)->info();
    for (const Json& exact : Json::parse(std::ifstream(path)).value("exact", Json::array())) {
      SurveyPlan plan{.method = ColumnOptions{.tolerance = 1e-10}, .held = {}, .limits = no_limits(info)};
      for (const auto& [coordinate, value] : exact["held"].items())
        plan.held.push_back({static_cast<int>(find_named(info.coordinates, coordinate) - info.coordinates.data()),
                             HeldCoordinate::Kind::value, value});
      const auto design = test::design_with(info, exact["parameters"]);
      const double volume = exact["value"];
      EXPECT_NEAR(test::survey(*test::described(name), design, plan).volume / volume, 1,
                  std::pow(10.0, 1 - exact["digits"].get<double>()) + 1e-13)
          << name << ' ' << exact.dump();
      compared.insert(name);
    }
  }
  EXPECT_THAT(compared, testing::IsSupersetOf({"3-rpr", "gough"}));
}

/// One, two and three swept coordinates: areas over a coordinate are the volume, lengths the area.
TEST(DescribedColumns, AddUpOverAnIntegratedCoordinate) {
  const auto mechanism = read(PKM_TEST_DATA "/generic/three-cylinders.toml");
  const std::vector<double> design = test::nominal(mechanism->info());
  const auto measure = [&](const SurveyPlan& plan) { return test::survey(*mechanism, design, plan).volume; };
  SurveyPlan plan{.method = ColumnOptions{}, .held = {}, .limits = no_limits(mechanism->info())};
  const double volume = measure(plan);
  plan.held = {{.coordinate = 1, .kind = HeldCoordinate::Kind::integrated}};
  EXPECT_NEAR(measure(plan) / volume, 1, 1e-9);
  plan.held.push_back({.coordinate = 0, .kind = HeldCoordinate::Kind::integrated});
  EXPECT_NEAR(measure(plan) / volume, 1, 1e-8);
}

/// Where they cannot, they say what stands in the way.
TEST(DescribedColumns, SayWhyThereAreNone) {
  const auto& delta = test::described("rotary-delta");
  EXPECT_EQ(delta->columns(), nullptr);
  try {
    prepare_survey(*delta, test::columns(delta->info()), {});
    FAIL() << "accepted";
  } catch (const std::invalid_argument& refusal) {
    EXPECT_STREQ(refusal.what(),
                 "mechanism rotary-delta has no column surveys: 'arm1 reaches' is no polynomial of degree two; take "
                 "workspace.method = \"voxels\"");
  }
}

/// Where a slide's rod is stretched across a limit of the slide, a cylinder and a sphere touch all along the
/// workspace's edge.
TEST(DescribedColumns, AreExactWhereSurfacesTouchAllAlong) {
  const Mechanism& orthoglide = *test::described("orthoglide");
  const std::vector<double> design = test::design_with(
      orthoglide.info(), {{"L", 0.2616425143772651}, {"q_min", 0.1514192579692078}, {"q_max", 0.383}});
  const Survey<double> found = test::survey(orthoglide, design, test::columns(orthoglide.info()));
  EXPECT_NEAR(found.volume, 0.0131476, 1e-7);
  EXPECT_LT(found.error, 1e-8);
  EXPECT_LT(found.columns, 5000);
}

/// Poses in columns are feasible, and their weights add up to the volume but for the rule's error.
TEST(DescribedColumns, SampleInsideTheWorkspace) {
  for (const char* const name : {"orthoglide", "3-rrr", "4ppa-2par"}) {
    const Mechanism& mechanism = *test::described(name);
    const MechanismInfo& info = mechanism.info();
    const auto surveyor = prepare_survey(mechanism, test::columns(info), {.fields = {&kConditioning}, .poses = true});
    Survey<double> found;
    survey_once<double>(*surveyor, test::nominal(info), found);
    double sum = 0;
    for (std::size_t i = 0; i < found.pose.size(); ++i) {
      const PoseReport report = mechanism.inspect(test::nominal(info), found.pose[i], info.modes[0], no_limits(info));
      ASSERT_TRUE(report.feasible) << name << ": " << report.reason;
      EXPECT_NEAR(found.of(kConditioning)[i], *report.conditioning, 1e-12);
      sum += found.weight[i];
    }
    EXPECT_NEAR(sum / found.volume, 1, 2e-3) << name;
  }
}

}  // namespace
}  // namespace pkm
