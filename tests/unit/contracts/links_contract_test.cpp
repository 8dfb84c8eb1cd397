// Contract of links: for every mechanism that provides the positions of its links (PlacedLink).
#include <gtest/gtest.h>

#include <map>

#include "tests/unit/contracts/mechanism_fixtures.hpp"

namespace pkm {
namespace {

double length(const PlacedLink& link) {
  const Point3<double> along = difference(link.body.axis.to, link.body.axis.from);
  return std::sqrt(dot(along, along));
}

/// Links whose length equals a parameter: link name, parameter name.
std::multimap<std::string, std::string> known_lengths(const std::string& mechanism) {
  static const std::multimap<std::string, std::string> rods = {
      {"rod 11", "l_11"}, {"rod 12", "l_12"}, {"rod 21", "l_21"}, {"rod 22", "l_22"},
      {"rod 31", "l_31"}, {"rod 32", "l_32"}, {"rod 41", "l_41"}, {"rod 42", "l_42"}};
  static const std::map<std::string, std::multimap<std::string, std::string>> known = {
      {"4ppa-2par",
       {{"upper bar 1 of slider 1", "l_u"},
        {"upper bar 2 of slider 4", "l_u"},
        {"lower bar 1 of limb 1", "l_d"},
        {"lower bar 2 of limb 2", "l_d"},
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
  const Mechanism& mechanism() const { return *test::test_mechanism(GetParam()); }
  const MechanismInfo& info() const { return mechanism().info(); }
  std::vector<double> parameters() const { return test::nominal(info()); }
  std::vector<PlacedLink> links(const Pose<double>& at) const {
    return mechanism().links()->place(parameters(), at, info().modes.front());
  }
  Pose<double> reference() const { return test::reference_pose(mechanism()); }
  /// The reference pose, followed by poses around it.
  std::vector<Pose<double>> poses() const {
    std::vector<Pose<double>> all = {reference()};
    for (std::size_t c = 0; c < reference().size(); ++c)
      for (const double by : {-0.02, 0.02}) {
        all.push_back(reference());
        all.back()[c] += by;
      }
    return all;
  }
};

TEST_P(LinksContract, LinksHaveTheSameNamesAndLengthsAtEveryPose) {
  const auto first = links(reference());
  ASSERT_FALSE(first.empty());
  for (const auto& pose : poses()) {
    const auto all = links(pose);
    ASSERT_EQ(all.size(), first.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_EQ(all[i].name, first[i].name);
      EXPECT_EQ(all[i].part, first[i].part);
      EXPECT_EQ(all[i].body.radius, first[i].body.radius);
      EXPECT_GT(all[i].body.radius, 0) << all[i].name;
      // all other links are rigid
      const bool is_telescopic =
          all[i].name.starts_with("telescopic") || all[i].name.starts_with("leg of") || all[i].name == "shaft";
      EXPECT_TRUE(is_telescopic || std::fabs(length(all[i]) - length(first[i])) < 1e-12) << all[i].name;
    }
  }
}

TEST_P(LinksContract, EndsOfLimbLinksTouchTheLimbTheFrameOrThePlatform) {
  if (test::is_from_file(info())) GTEST_SKIP() << "files need not define links of the base";
  constexpr double kRoundoff = 1e-9;
  for (const auto& pose : poses()) {
    const auto all = links(pose);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const PlacedLink& link = all[i];
      if (link.part == kFramePart || link.part == kPlatformPart || link.name == "tool") continue;
      if (link.part == "carriage") continue;  // rails end at the stroke limits, which a carriage may exceed
      for (const Point3<double>& end : {link.body.axis.from, link.body.axis.to}) {
        double distance = 1;
        for (std::size_t k = 0; k < all.size(); ++k) {
          const bool other_limb = all[k].part.starts_with("limb ") && all[k].part != link.part;
          if (k != i && !other_limb)
            distance = std::fmin(distance, segment_distance(Segment<double>{end, end}, all[k].body.axis));
        }
        EXPECT_LT(distance, kRoundoff) << link.name << " of " << link.part;
      }
    }
  }
}

TEST_P(LinksContract, LengthsEqualTheParameters) {
  const auto all = links(reference());
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

TEST_P(LinksContract, LinksMoveContinuouslyWithThePose) {
  constexpr double kStep = 1e-7;
  const auto here = links(reference());
  for (std::size_t c = 0; c < reference().size(); ++c) {
    auto moved = reference();
    moved[c] += kStep;
    const auto there = links(moved);
    double largest = 0;
    for (std::size_t i = 0; i < here.size(); ++i)
      for (const auto end : {&Segment<double>::from, &Segment<double>::to}) {
        const Point3<double> shift = difference(there[i].body.axis.*end, here[i].body.axis.*end);
        largest = std::fmax(largest, std::sqrt(dot(shift, shift)));
        EXPECT_TRUE(here[i].part != kFramePart || !(dot(shift, shift) > 0)) << here[i].name;
      }
    EXPECT_LT(largest, 20 * kStep);
    const bool turns_a_tool = info().coordinates[c].name == "theta" && info().name.ends_with("delta-with-shaft");
    EXPECT_TRUE(largest > 0.05 * kStep || turns_a_tool) << "coordinate " << c << " moves nothing";
  }
}

TEST_P(LinksContract, APoseThatDoesNotAssembleHasNoLinks) {
  const Pose<double> far = test::unreachable_pose(info());
  if (mechanism().inspect(parameters(), far, info().modes.front(), no_limits(info())).assembles)
    GTEST_SKIP() << "all poses assemble";
  EXPECT_TRUE(links(far).empty());
}

INSTANTIATE_TEST_SUITE_P(All, LinksContract, testing::ValuesIn(test::mechanisms_and_all_files()),
                         [](const auto& name) { return test::test_name(name.param); });

}  // namespace
}  // namespace pkm
