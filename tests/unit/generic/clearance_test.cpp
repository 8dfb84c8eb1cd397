// Clearance of the links of described mechanisms: which pairs count, their distance against the convex problem solved
// in another way, surveys against single poses. papers_test.cpp compares it with the built-in mechanisms'.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "engine/math/random.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "tests/unit/contracts/catalogue_problem.hpp"
#include "tests/unit/generic/files.hpp"

namespace pkm {
namespace {

using Point = Point3<double>;

LimitSpec clearance_limit(const MechanismInfo& info, double least) {
  LimitSpec limits = no_limits(info);
  limits.given[static_cast<std::size_t>(find_named(info.limits, std::string("clearance_min")) - info.limits.data())] =
      least;
  return limits;
}

std::optional<double> clearance_at(const Mechanism& mechanism, const std::vector<double>& design,
                                   const Pose<double>& pose) {
  for (const auto& [name, value] :
       mechanism.inspect(design, pose, mechanism.info().modes.front(), no_limits(mechanism.info())).angles)
    if (name == "clearance") return value;
  return {};
}

/// Poses that assemble.
std::vector<Pose<double>> some_poses(const Mechanism& mechanism, const std::vector<double>& design, std::size_t count) {
  const auto ranges = *mechanism.ranges(design);
  Stream random(41, 0, 0, Stream::Use::start);
  std::vector<Pose<double>> found;
  for (int tried = 0; tried < 100000 && found.size() < count; ++tried) {
    Pose<double> pose(ranges.size());
    for (std::size_t i = 0; i < pose.size(); ++i) pose[i] = ranges[i][0] + random.u01() * (ranges[i][1] - ranges[i][0]);
    if (mechanism.inspect(design, pose, mechanism.info().modes.front(), no_limits(mechanism.info())).feasible)
      found.push_back(pose);
  }
  return found;
}

Point along(const Segment<double>& segment, double t) {
  Point p;
  for (std::size_t i = 0; i < 3; ++i) p[i] = segment.from[i] + t * (segment.to[i] - segment.from[i]);
  return p;
}

/// Least value of a convex function of [0, 1].
template <class F>
double least_of(const F& f) {
  double low = 0, high = 1;
  for (int i = 0; i < 80; ++i) {
    const double third = (high - low) / 3;
    if (f(low + third) < f(high - third))
      high -= third;
    else
      low += third;
  }
  return std::min({f(0.0), f(1.0), f((low + high) / 2)});
}

/// The distance of a point of one to one of the other, which is convex in both places, minimised by thirds.
double distance_by_thirds(const Segment<double>& a, const Segment<double>& b) {
  return least_of([&](double s) {
    const Point p = along(a, s);
    return least_of([&](double t) {
      const Point d = difference(p, along(b, t));
      return std::hypot(d[0], d[1], d[2]);
    });
  });
}

TEST(DescribedClearance, IsTheLeastDistanceOfLinksThatAreNotJoined) {
  int compared = 0;
  for (const char* const name : {"rotary-delta", "gough", "par4", "orthoglide", "3-rrr"}) {
    SCOPED_TRACE(name);
    const Mechanism& mechanism = *test::described(name);
    const std::vector<double> design = test::nominal(mechanism.info());
    const auto joined = mechanism.links()->joined();
    for (const Pose<double>& pose : some_poses(mechanism, design, 4)) {
      const auto links = mechanism.links()->place(design, pose, mechanism.info().modes.front());
      ASSERT_EQ(joined.size(), links.size());
      double least = 100;
      for (std::size_t i = 0; i < links.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
          if (!std::ranges::count(joined[i].others, links[k].name))
            least = std::fmin(least, distance_by_thirds(links[i].body.axis, links[k].body.axis) - links[i].body.radius -
                                         links[k].body.radius);
      EXPECT_NEAR(*clearance_at(mechanism, design, pose), least, 1e-7);  // thirds end where a square is flat
      ++compared;
    }
  }
  EXPECT_GE(compared, 15);
}

TEST(DescribedClearance, LeavesOutWhatIsJoined) {
  const auto joined = test::described("rotary-delta")->links()->joined();
  std::map<std::string, std::set<std::string>> others;
  for (const JoinedLinks& each : joined) others[each.link] = {each.others.begin(), each.others.end()};
  using Names = std::set<std::string>;
  EXPECT_EQ(others["crank of arm1"], (Names{"rod of arm1"}));
  EXPECT_EQ(others["rod of arm1"], (Names{"crank of arm1", "platform's arm of arm1"}));
  EXPECT_EQ(others["platform's arm of arm2"],
            (Names{"rod of arm2", "platform's arm of arm1", "platform's arm of arm3"}));
  // rails stand still, and a rail is of its limb
  for (const JoinedLinks& each : test::described("orthoglide")->links()->joined())
    if (each.link.starts_with("rail")) {
      EXPECT_EQ(each.others.size(), 3u) << each.link;
    }
}

/// A file in which `text` stands in place of `old`.
std::shared_ptr<const Mechanism> changed(const std::string& name, const std::string& old, const std::string& text) {
  std::string file = test::text_of_mechanism(name);
  const auto at = file.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return read_mechanism_toml(file.replace(at, old.size(), text), name + ".toml");
}

TEST(DescribedClearance, LinksNameLimbsAsTheirGroups) {
  const auto others = [](const std::string& group) {
    const auto mechanism = changed(
        "rotary-delta", "[[limit]]",
        "[[link]]\nname = \"post\"\nfrom = [0, 0, 0]\nto = [0, 0, \"-r\"]\nradius = \"5 mm\"\n" + group + "[[limit]]");
    return mechanism->links()->joined().back();
  };
  EXPECT_EQ(others("").link, "post");
  EXPECT_TRUE(others("").others.empty());
  EXPECT_EQ(others("group = \"arm2\"\n").others, (std::vector<std::string>{"crank of arm2", "rod of arm2"}));
  EXPECT_EQ(others("group = \"arm\"\n").others.size(), 6u);
  EXPECT_EQ(others("group = [\"platform\", \"arm1\"]\n").others.size(), 5u);
}

TEST(DescribedClearance, ThePoseNamesThePairThatIsTooNear) {
  const Mechanism& delta = *test::described("rotary-delta");
  const std::vector<double> design = test::nominal(delta.info());
  const Pose<double> pose = {0, 0, -0.45};
  const double clearance = *clearance_at(delta, design, pose);
  const auto report = [&](double least) {
    return delta.inspect(design, pose, "", clearance_limit(delta.info(), least));
  };
  EXPECT_TRUE(report(clearance - 1e-9).feasible);
  const PoseReport near = report(clearance + 1e-9);
  EXPECT_FALSE(near.feasible);
  EXPECT_EQ(near.margins.back().first, "clearance_min");
  EXPECT_NEAR(near.margins.back().second, -1e-9, 1e-15);
  EXPECT_TRUE(near.reason.starts_with("clearance_min is violated: ") && near.reason.ends_with(" are too near"))
      << near.reason;
  EXPECT_NE(report(kInactiveClearance).margins.back().first, "clearance_min") << "it cuts nothing";
}

TEST(DescribedClearance, VoxelsAreThePosesThatAreClear) {
  std::int64_t cut = 0, left = 0;
  for (const char* const name : {"rotary-delta", "gough", "3-rrr", "2t1r-p-hybrid"}) {
    SCOPED_TRACE(name);
    const Mechanism& mechanism = *test::described(name);
    const MechanismInfo& info = mechanism.info();
    const std::vector<double> design = test::nominal(info);
    const std::array<std::int64_t, 3> cells = {17, 18, 70};
    WorkspacePlan plan{.method = VoxelOptions{.cells = cells}, .fixed = {}, .limits = no_limits(info)};
    const Sweep& sweep = sweep_of(info, plan);
    const VoxelMap all = voxel_map(mechanism, design, plan);
    // what some of the poses keep
    std::vector<std::optional<double>> clearance(all.feasible.size());
    std::vector<double> sorted;
    for (std::size_t i = 0; i < all.feasible.size(); ++i) {
      if (!all.feasible[i]) continue;
      const auto at = static_cast<std::int64_t>(i);
      const std::array<std::int64_t, 3> cell = {at / (cells[1] * cells[2]), at / cells[2] % cells[1], at % cells[2]};
      Pose<double> pose(info.coordinates.size());
      for (const int fixed : sweep.fixed)
        pose[static_cast<std::size_t>(fixed)] = fixed_value(mechanism, design, plan, fixed);
      for (std::size_t axis = 0; axis < sweep.swept.size(); ++axis)
        pose[static_cast<std::size_t>(sweep.swept[axis])] = all.lower[axis] + (static_cast<double>(cell[axis]) + 0.5) *
                                                                                  (all.upper[axis] - all.lower[axis]) /
                                                                                  static_cast<double>(cells[axis]);
      clearance[i] = clearance_at(mechanism, design, pose);
      if (clearance[i]) sorted.push_back(*clearance[i]);
    }
    std::ranges::sort(sorted);
    ASSERT_GT(sorted.size(), 50u);
    const double least = sorted[sorted.size() / 3] + 1e-9;
    plan.limits = clearance_limit(info, least);
    const VoxelMap map = voxel_map(mechanism, design, plan);
    for (std::size_t i = 0; i < map.feasible.size(); ++i) {
      if (!clearance[i] || std::fabs(*clearance[i] - least) < 1e-12) continue;
      EXPECT_EQ(map.feasible[i] == 1, *clearance[i] >= least) << *clearance[i];
      ++(map.feasible[i] ? left : cut);
    }
    const auto count = std::ranges::count(map.feasible, 1);
    const WorkspaceResult<double> survey = test::survey(mechanism, design, plan, {.fields = {&kConditioning}});
    EXPECT_EQ(survey.feasible_cells, count);
    EXPECT_EQ(static_cast<std::int64_t>(survey.weight.size()), count);
  }
  EXPECT_GT(cut, 400);
  EXPECT_GT(left, 400);
}

TEST(DescribedClearance, ColumnsAndBoundsAreRefused) {
  const Mechanism& mechanism = *test::described("linear-delta");
  const std::vector<double> design = test::nominal(mechanism.info());
  WorkspacePlan plan{.method = ColumnOptions{}, .fixed = {}, .limits = clearance_limit(mechanism.info(), 0)};
  const auto message = [](const auto& work) {
    try {
      work();
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  const auto survey = [&] { prepare_workspace(mechanism, plan, {}); };
  const auto bound = [&] { mechanism.bounds()->volume(design, plan, "", {.gap = 0.5, .max_boxes = 10}); };
  EXPECT_EQ(message(survey),
            "mechanism linear-delta has no exact columns with a clearance limit (clearance_min), because the distance "
            "of two links is not given by a formula; set workspace.method = \"voxels\"");
  EXPECT_EQ(
      message(bound),
      "mechanism linear-delta has no certified bounds with a clearance limit (clearance_min), because the distance "
      "of two links is not given by a formula; use voxels, or remove the limit");
  plan.limits = clearance_limit(mechanism.info(), kInactiveClearance);
  EXPECT_EQ(message(survey), "accepted") << "it cuts nothing";
  EXPECT_EQ(message(bound), "accepted");
}

TEST(DescribedClearance, KeepsItsName) {
  const auto message = [](const std::string& old, const std::string& text) {
    try {
      changed("rotary-delta", old, text);
    } catch (const std::exception& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_NE(message("name     = \"clear_z\"", "name = \"clearance_min\"").find("clearance_min is predefined"),
            std::string::npos);
  EXPECT_NE(message("[platform]", "clearance_min = { default = \"1 m\", min = 0, max = 2 }\n[platform]")
                .find("rename the parameter"),
            std::string::npos);
}

}  // namespace
}  // namespace pkm
