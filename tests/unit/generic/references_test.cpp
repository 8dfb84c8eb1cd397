// Mechanisms from files against values that another program computed from the same files (tests/data/README.md), and
// what is left beside the contracts of all mechanisms (tests/unit/contracts), which they pass, too.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/catalogue.hpp"
#include "engine/geometry/singular.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "tests/unit/contracts/mechanism_fixtures.hpp"
#include "tests/unit/generic/files.hpp"

namespace pkm {
namespace {

using Json = nlohmann::json;

class DescribedReference : public ::testing::TestWithParam<std::string> {
 protected:
  const Mechanism& mechanism() const { return *test::described(GetParam()); }
  const MechanismInfo& info() const { return mechanism().info(); }
  void SetUp() override { data_ = Json::parse(std::ifstream(PKM_TEST_DATA "/mechanisms/" + GetParam() + ".json")); }
  /// What the references hold under a name; nothing: an empty list.
  const Json& data(const std::string& name) {
    if (!data_.contains(name)) data_[name] = Json::array();
    return data_[name];
  }
  Pose<double> pose_of(const Json& at) const {
    Pose<double> pose(info().coordinates.size());
    for (std::size_t i = 0; i < pose.size(); ++i) pose[i] = at[info().coordinates[i].name];
    return pose;
  }
  PoseReport inspect(const Json& entry) const {
    return mechanism().inspect(test::design_with(info(), entry.value("parameters", Json::object())),
                               pose_of(entry["pose"]), entry.value("mode", ""), no_limits(info()));
  }
  int number_of(const std::string& coordinate) const {
    return static_cast<int>(find_named(info().coordinates, coordinate) - info().coordinates.data());
  }
  /// @param cells  of each swept coordinate; null: as many as make a million
  WorkspacePlan plan(const Json& entry, const Json& cells) const {
    WorkspacePlan plan{.method = VoxelOptions{}, .fixed = {}, .limits = test::limits_with(info(), entry["limits"])};
    for (const auto& [name, value] : entry["held"].items())
      plan.fixed.push_back({.coordinate = number_of(name), .kind = FixedCoordinate::Kind::value, .value = value});
    const Sweep& sweep = sweep_of(info(), plan);
    const auto usual = std::llround(std::pow(1e6, 1 / static_cast<double>(sweep.swept.size())));
    VoxelOptions& voxels = std::get<VoxelOptions>(plan.method);
    for (std::size_t k = 0; k < sweep.swept.size(); ++k)
      voxels.cells[k] = cells.is_null() ? usual : cells[name_of(sweep, k)].get<std::int64_t>();
    return plan;
  }
  const std::string& name_of(const Sweep& sweep, std::size_t k) const {
    return info().coordinates[static_cast<std::size_t>(sweep.swept[k])].name;
  }

 private:
  Json data_;
};

TEST_P(DescribedReference, JointsAndVerdictsInEveryMode) {
  ASSERT_GE(data("poses").size(), 8u);
  for (const Json& entry : data("poses")) {
    SCOPED_TRACE(entry.dump());
    const PoseReport report = inspect(entry);
    ASSERT_TRUE(report.joints);
    for (std::size_t i = 0; i < info().joints.size(); ++i) {
      const Json& joint = entry["joints"][info().joints[i].name];
      if (joint.is_null())
        EXPECT_FALSE(std::isfinite((*report.joints)[i])) << info().joints[i].name;
      else
        EXPECT_NEAR((*report.joints)[i], joint.get<double>(), 1e-12) << info().joints[i].name;
    }
    EXPECT_EQ(report.assembles, entry["assembles"].get<bool>()) << report.reason;
    EXPECT_EQ(report.feasible, entry["feasible"].get<bool>()) << report.reason;
  }
}

TEST_P(DescribedReference, CountsOfCells) {
  ASSERT_GE(data("voxels").size(), 2u);
  for (const Json& entry : data("voxels")) {
    SCOPED_TRACE(entry.dump());
    const WorkspacePlan plan = this->plan(entry, entry["cells"]);
    const auto design = test::design_with(info(), entry["parameters"]);
    EXPECT_EQ(test::survey(mechanism(), design, plan).feasible_cells, entry["feasible"].get<std::int64_t>());
    const VoxelMap map = voxel_map(mechanism(), design, plan);
    EXPECT_EQ(std::ranges::count(map.feasible, 1), entry["feasible"].get<std::int64_t>());
    const Sweep& sweep = sweep_of(info(), plan);
    for (std::size_t k = 0; k < sweep.swept.size(); ++k) {
      const Json& range = entry["box"][name_of(sweep, k)];
      EXPECT_NEAR(map.lower[k], range[0].get<double>(), 1e-14);
      EXPECT_NEAR(map.upper[k], range[1].get<double>(), 1e-14);
    }
  }
}

TEST_P(DescribedReference, ExactVolumesWithinWhatAMillionCellsCanTell) {
  if (data("exact").empty()) GTEST_SKIP() << "no exact volume is known";
  for (const Json& entry : data("exact")) {
    SCOPED_TRACE(entry.dump());
    const auto found = test::survey(mechanism(), test::design_with(info(), entry["parameters"]), plan(entry, nullptr));
    EXPECT_NEAR(found.volume / entry["value"].get<double>(), 1, 2e-3);
  }
}

TEST_P(DescribedReference, JacobianIsThatOfTheClosuresInEveryMode) {
  int compared = 0;
  for (const Json& entry : data("poses")) {
    const PoseReport report = inspect(entry);
    if (!report.J) continue;
    SCOPED_TRACE(entry.dump());
    const std::size_t n = info().joints.size();
    // Jq J = G, so J = Jq^-1 G
    double largest = 1;
    for (const double slope : *report.J) largest = std::fmax(largest, std::fabs(slope));
    const AxisMatrix<double> product = *report.Jq * *report.J;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < info().coordinates.size(); ++j)
        EXPECT_NEAR(product(i, j), (*report.G)(i, j), 1e-10 * largest);
    ++compared;
  }
  EXPECT_GT(compared, 5);
}

TEST_P(DescribedReference, ForwardKinematicsFindThePoseInEveryMode) {
  if (!mechanism().forward()) GTEST_SKIP() << "more joints than coordinates";
  int compared = 0;
  for (const Json& entry : data("poses")) {
    const PoseReport report = inspect(entry);
    if (!report.assembles || is_singular(*report.G)) continue;
    SCOPED_TRACE(entry.dump());
    const auto design = test::design_with(info(), entry["parameters"]);
    double nearest = 1;
    for (const AssemblyMode& mode : mechanism().forward()->assemblies(design, *report.joints)) {
      double distance = 0;
      if (mode.working_mode != entry["mode"] && entry["mode"] != "") continue;
      for (std::size_t i = 0; i < mode.pose.size(); ++i)
        distance = std::fmax(distance, std::fabs(mode.pose[i] - pose_of(entry["pose"])[i]));
      nearest = std::fmin(nearest, distance);
    }
    EXPECT_LT(nearest, 1e-8);
    ++compared;
  }
  EXPECT_GT(compared, 0);
}

TEST_P(DescribedReference, ConditioningWhereItIsKnown) {
  if (data("conditioning").empty()) GTEST_SKIP() << "nowhere";
  for (const Json& entry : data("conditioning"))
    EXPECT_NEAR(inspect(entry).conditioning.value_or(-1), entry["value"].get<double>(), 1e-9) << entry;
}

std::vector<std::string> with_references() {
  std::vector<std::string> some;
  for (const std::string& name : test::mechanism_files())
    if (std::filesystem::exists(PKM_TEST_DATA "/mechanisms/" + name + ".json")) some.push_back(name);
  return some;
}
INSTANTIATE_TEST_SUITE_P(All, DescribedReference, ::testing::ValuesIn(with_references()),
                         [](const auto& name) { return test::test_name(name.param); });

TEST(DescribedFiles, AreAllComparedWithSomething) {
  EXPECT_EQ(test::mechanism_files().size(), 8u);
  EXPECT_EQ(with_references().size(), 8u);  // the other four with the built-in mechanisms
}

TEST(DescribedBox, IsThatOfTheDefaultMode) {
  const auto box_of = [](const std::string& signs) {
    const auto mechanism = read_mechanism_toml(
        "[mechanism]\nname = \"slide\"\n[parameters]\nl = { default = 2, min = 1, max = 3 }\n"
        "[platform]\ncoordinates = { x = \"along x\" }\n[modes]\ne = [" +
            signs +
            "]\n[survey]\nbox = { x = [\"e*l\", \"e*l + 1\"] }\n"
            "[[limb]]\nname = \"q\"\ndrive = \"formula\"\njoint = \"x + e\"\n",
        "slide.toml");
    return (*mechanism->ranges(std::vector{2.0}))[0];
  };
  EXPECT_EQ(box_of("\"+\", \"-\""), (std::array{2.0, 3.0}));
  EXPECT_EQ(box_of("\"-\", \"+\""), (std::array{-2.0, -1.0}));
}

double length(const PlacedLink& link) {
  const Point3<double> way = difference(link.body.axis.to, link.body.axis.from);
  return std::sqrt(dot(way, way));
}

TEST(DescribedLinks, EndWhereTheJointsSay) {
  const auto placed = [](const std::string& name, const Pose<double>& pose) {
    const Mechanism& m = *test::described(name);
    std::map<std::string, PlacedLink> links;
    for (const PlacedLink& link : m.links()->place(test::nominal(m.info()), pose, m.info().modes.front()))
      links.insert({link.name, link});
    return links;
  };
  const auto joints = [](const std::string& name, const Pose<double>& pose) {
    const Mechanism& m = *test::described(name);
    return *m.inspect(test::nominal(m.info()), pose, m.info().modes.front(), no_limits(m.info())).joints;
  };
  const Pose<double> above = {0.05, -0.08, -0.45};
  const double q = joints("rotary-delta", above)[0];  // of the crank over the x axis, which turns down
  auto delta = placed("rotary-delta", above);
  const Point3<double>& elbow = delta.at("crank of arm1").body.axis.to;
  EXPECT_NEAR(elbow[0], 0.2 + 0.2 * std::cos(q), 1e-14);
  EXPECT_NEAR(elbow[1], 0, 1e-14);
  EXPECT_NEAR(elbow[2], -0.2 * std::sin(q), 1e-14);
  for (const std::string arm : {"arm1", "arm2", "arm3"}) {
    EXPECT_NEAR(length(delta.at("crank of " + arm)), 0.2, 1e-14);
    EXPECT_NEAR(length(delta.at("rod of " + arm)), 0.5, 1e-14);
    EXPECT_NEAR(length(delta.at("platform's arm of " + arm)), 0.05, 1e-14);
  }

  const Pose<double> tilted = {0.05, 0.1, 1.2, 0.1, -0.15, 0.2};
  const auto& legs = test::described("gough")->info().joints;
  const auto gough = placed("gough", tilted);
  for (std::size_t i = 0; i < legs.size(); ++i)
    EXPECT_NEAR(length(gough.at("leg of " + legs[i].name)), joints("gough", tilted)[i], 1e-14);

  const Pose<double> aside = {0.1, -0.05, -0.3};
  const auto linear = placed("linear-delta", aside);
  const Mechanism& m = *test::described("linear-delta");
  for (std::size_t i = 0; i < 3; ++i) {
    const PlacedLink& rod = linear.at("rod of " + m.info().joints[i].name);
    EXPECT_NEAR(rod.body.axis.from[2], joints("linear-delta", aside)[i], 1e-14);
    EXPECT_NEAR(
        length(rod),
        test::nominal(
            m.info())[static_cast<std::size_t>(find_named(m.info().parameters, "l") - m.info().parameters.data())],
        1e-14);
  }

  const Pose<double> pose = {0.4, 1.25, -0.8, 0.1};
  const auto papers = placed("4ppa-2par", pose);
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& slider = papers.at("slider " + std::to_string(i + 1)).body.axis;
    EXPECT_NEAR((slider.from[1] + slider.to[1]) / 2, joints("4ppa-2par", pose)[i], 1e-14);
  }
  EXPECT_NEAR(length(papers.at("upper bar 1 of slider 3")), 0.6, 1e-14);
  EXPECT_NEAR(length(papers.at("lower bar 2 of limb 2")), 0.55, 1e-14);
  EXPECT_NEAR(length(papers.at("platform")), 0.2, 1e-14);
}

}  // namespace
}  // namespace pkm
