// What every mechanism that says where its links are is held to.
#include <gtest/gtest.h>

#include <map>

#include "tests/unit/contracts/nominal.hpp"

namespace pkm {
namespace {

double length(const PlacedLink& link) {
  const Point3<double> along = difference(link.body.axis.to, link.body.axis.from);
  return std::sqrt(dot(along, along));
}

/// Names of the links whose length is the value of a parameter.
std::multimap<std::string, std::string> known_lengths(const std::string& mechanism) {
  static const std::multimap<std::string, std::string> rods = {
      {"rod 11", "l_11"}, {"rod 12", "l_12"}, {"rod 21", "l_21"}, {"rod 22", "l_22"},
      {"rod 31", "l_31"}, {"rod 32", "l_32"}, {"rod 41", "l_41"}, {"rod 42", "l_42"}};
  static const std::map<std::string, std::multimap<std::string, std::string>> known = {
      {"4ppa-2par",
       {{"upper bar of slider 1", "l_u"},
        {"upper bar of slider 4", "l_u"},
        {"lower bar of limb 1", "l_d"},
        {"lower bar of limb 2", "l_d"},
        {"platform", "a"},
        {"rail 1", "L0"},
        {"rail 2", "L0"}}},
      {"2t1r-p-hybrid", {{"link A", "L1"}, {"link B", "L2"}, {"link C", "L3"}}},
      {"3crr-r-cru", rods},
      {"quadrupteron", rods},
      {"five-bar", {{"crank 1", "l_1"}, {"crank 2", "l_1"}, {"rod 1", "l_2"}, {"rod 2", "l_2"}}},
      {"rotary-delta", {{"crank 1", "l_1"}, {"crank 3", "l_1"}, {"rod 1", "l_2"}, {"rod 3", "l_2"}}}};
  const auto found = known.find(mechanism);
  return found == known.end() ? std::multimap<std::string, std::string>() : found->second;
}

class LinksContract : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (!mechanism().links()) GTEST_SKIP() << info().name << " has no links";
  }
  const Mechanism& mechanism() const { return *test::mechanism_called(GetParam()); }
  const MechanismInfo& info() const { return mechanism().info(); }
  std::vector<double> parameters() const { return test::nominal(info()); }
  std::vector<PlacedLink> links(const Pose<double>& at) const {
    return mechanism().links()->place(parameters(), at, info().modes.front());
  }
  Pose<double> usual() const { return test::usual_pose(mechanism()); }
  /// Poses around the usual one, that one first.
  std::vector<Pose<double>> poses() const {
    std::vector<Pose<double>> all = {usual()};
    for (std::size_t c = 0; c < usual().size(); ++c)
      for (const double by : {-0.02, 0.02}) {
        all.push_back(usual());
        all.back()[c] += by;
      }
    return all;
  }
};

TEST_P(LinksContract, LinksOfEveryPoseAreTheSameOnes) {
  const auto first = links(usual());
  ASSERT_FALSE(first.empty());
  for (const auto& pose : poses()) {
    const auto all = links(pose);
    ASSERT_EQ(all.size(), first.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_EQ(all[i].name, first[i].name);
      EXPECT_EQ(all[i].part, first[i].part);
      EXPECT_EQ(all[i].body.radius, first[i].body.radius);
      EXPECT_GT(all[i].body.radius, 0) << all[i].name;
      // all others are rigid
      const bool stretches = all[i].name.starts_with("telescopic") || all[i].name.starts_with("leg of");
      EXPECT_TRUE(stretches || std::fabs(length(all[i]) - length(first[i])) < 1e-12) << all[i].name;
    }
  }
}

TEST_P(LinksContract, BothEndsOfALimbsLinksMeetALimbsOtherLinksTheFrameOrThePlatform) {
  if (test::is_of_file(info())) GTEST_SKIP() << "files need not draw what limbs stand on";
  constexpr double kRoundoff = 1e-9;
  for (const auto& pose : poses()) {
    const auto all = links(pose);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const PlacedLink& link = all[i];
      if (link.part == kFramePart || link.part == kPlatformPart || link.name == "tool") continue;
      if (link.part == "carriage") continue;  // its rails end where the strokes do
      for (const Point3<double>& end : {link.body.axis.from, link.body.axis.to}) {
        double nearest = 1;
        for (std::size_t k = 0; k < all.size(); ++k) {
          const bool elsewhere = all[k].part.starts_with("limb ") && all[k].part != link.part;
          if (k != i && !elsewhere)
            nearest = std::fmin(nearest, segment_distance(Segment<double>{end, end}, all[k].body.axis));
        }
        EXPECT_LT(nearest, kRoundoff) << link.name << " of " << link.part;
      }
    }
  }
}

TEST_P(LinksContract, LengthsAreThoseOfTheParameters) {
  const auto all = links(usual());
  const auto p = parameters();
  for (const auto& [name, parameter] : known_lengths(info().name)) {
    const auto at = std::ranges::find(info().parameters, parameter, &Parameter::name);
    ASSERT_NE(at, info().parameters.end()) << parameter;
    int found = 0;
    for (const PlacedLink& link : all) {
      if (link.name != name) continue;
      EXPECT_NEAR(length(link), p[static_cast<std::size_t>(at - info().parameters.begin())], 1e-12) << name;
      ++found;
    }
    EXPECT_GT(found, 0) << name;
  }
}

TEST_P(LinksContract, LinksFollowThePoseWithoutJumps) {
  constexpr double kStep = 1e-7;
  const auto here = links(usual());
  for (std::size_t c = 0; c < usual().size(); ++c) {
    auto moved = usual();
    moved[c] += kStep;
    const auto there = links(moved);
    double most = 0;
    for (std::size_t i = 0; i < here.size(); ++i)
      for (const auto end : {&Segment<double>::from, &Segment<double>::to}) {
        const Point3<double> way = difference(there[i].body.axis.*end, here[i].body.axis.*end);
        most = std::fmax(most, std::sqrt(dot(way, way)));
        EXPECT_TRUE(here[i].part != kFramePart || !(dot(way, way) > 0)) << here[i].name;
      }
    EXPECT_LT(most, 20 * kStep);
    EXPECT_GT(most, 0.05 * kStep) << "coordinate " << c << " moves nothing";
  }
}

TEST_P(LinksContract, APoseThatDoesNotAssembleHasNone) {
  const Pose<double> far = test::far_pose(info());
  if (mechanism().inspect(parameters(), far, info().modes.front(), no_limits(info())).assembles)
    GTEST_SKIP() << "all poses assemble";
  EXPECT_TRUE(links(far).empty());
}

INSTANTIATE_TEST_SUITE_P(All, LinksContract, testing::ValuesIn(test::mechanisms_and_files()),
                         [](const auto& name) { return test::test_name(name.param); });

}  // namespace
}  // namespace pkm
