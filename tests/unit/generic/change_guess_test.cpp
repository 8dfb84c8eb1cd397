// Changes of structure are guessed from what vanishes there, in far fewer steps than halving takes; what does not
// vanish costs a few.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/generic/columns/change_guess.hpp"

namespace pkm::generic {
namespace {

constexpr double kChange = 0.3217, kNear = 1e-15;
const auto nowhere = [](const Mark&, const Mark&) { return std::numeric_limits<double>::infinity(); };

struct Closing {
  double low = 0.3, high = 0.35;
  int steps = 0;

  /// @param see  (at, whether it is beyond the change)
  template <class See>
  void run(ChangeGuess& guess, const See& see) {
    while (high - low > kNear && steps < 1000) {
      const double at = guess.next(low, high, kNear);
      ASSERT_GE(at, low);
      ASSERT_LE(at, high);
      if (at <= low || at >= high) break;
      ++steps;
      const bool is_upper = at > kChange;
      see(at, is_upper);
      (is_upper ? high : low) = at;
    }
    EXPECT_NEAR(low, kChange, 2 * kNear);
    EXPECT_NEAR(high, kChange, 2 * kNear);
  }
};

constexpr int kHalvings = 46;  // of 0.05 to 1e-15

/// Two corners of different surfaces meet, in proportion to the distance from the change; of the same ones like a root.
TEST(ChangeGuess, FollowsAnArcThatVanishes) {
  for (const bool is_root : {false, true})
    for (const bool is_above : {false, true}) {
      SCOPED_TRACE(testing::Message() << is_root << is_above);
      ChangeGuess guess;
      guess.start(false);
      Closing closing;
      closing.run(guess, [&](double at, bool is_upper) {
        Marks marks = {{.key = 9, .of = 9, .t = at}};
        if (is_upper == is_above) {
          const double distance = std::fabs(at - kChange), size = distance * (1 + 3 * distance);
          const double half = is_root ? std::sqrt(size) : size;
          marks.push_back({.key = 1, .of = 1, .t = 0.5 - half, .s = 0.1});
          marks.push_back({.key = is_root ? 1U : 2U, .of = is_root ? 1U : 2U, .t = 0.5 + half, .s = 0.1});
        }
        guess.see(at, is_upper, 1 + (is_upper ? 1U : 0U), marks, nowhere);
      });
      EXPECT_LT(closing.steps, kHalvings / 2);
    }
}

/// A part between two breaks, of which nobody knows how it vanishes.
TEST(ChangeGuess, LearnsWhetherAPartVanishesLikeARoot) {
  for (const bool is_root : {false, true}) {
    ChangeGuess guess;
    guess.start(false);
    Closing closing;
    closing.run(guess, [&](double at, bool is_upper) {
      Marks marks;
      if (!is_upper) {
        const double distance = kChange - at, width = is_root ? std::sqrt(distance) : distance;
        marks = {{.key = 4, .of = 0, .t = 0.2}, {.key = 5, .of = 1, .t = 0.2 + width * (1 + width)}};
      }
      guess.see(at, is_upper, is_upper ? 0 : 1, marks, nowhere);
    });
    EXPECT_LT(closing.steps, kHalvings * 2 / 3);
  }
}

/// One corner takes another's place where a third surface passes: how far it is from that tells.
TEST(ChangeGuess, FollowsACornerToTheSurfaceThatCutsIt) {
  ChangeGuess guess;
  guess.start(false);
  Closing closing;
  closing.run(guess, [&](double at, bool is_upper) {
    const std::uint64_t key = is_upper ? 2 : 1;
    const Marks marks = {{.key = key, .of = key, .t = 0.4, .s = 0.2}};
    guess.see(at, is_upper, key, marks, [&](const Mark&, const Mark&) { return std::sin(std::fabs(at - kChange)); });
  });
  EXPECT_LT(closing.steps, kHalvings / 2);
}

/// Ends of columns go on beyond the place where they meet: their distance has a sign.
TEST(ChangeGuess, FollowsEndsThatPassEachOther) {
  ChangeGuess guess;
  guess.start(true);
  Closing closing;
  const auto see = [&](double at, bool is_upper) {
    const double d = at - kChange;
    const Marks marks = {{.key = 2, .of = 1, .t = 0.7, .bounds = !is_upper},
                         {.key = 4, .of = 2, .t = 0.7 + std::sin(d) + 2 * d * d, .bounds = is_upper}};
    guess.see(at, is_upper, is_upper ? 2 : 1, marks, nowhere);
  };
  see(closing.low, false);
  see(closing.high, true);
  closing.run(guess, see);
  EXPECT_LT(closing.steps, kHalvings / 3);
}

TEST(ChangeGuess, FollowsAConditionThatChangesItsSign) {
  ChangeGuess guess;
  guess.start(false);
  Closing closing;
  closing.run(guess, [&](double at, bool is_upper) { guess.see_size(at, is_upper, std::exp(kChange) - std::exp(at)); });
  EXPECT_LT(closing.steps, kHalvings / 3);
}

/// Marks that say nothing of the change, and that mislead.
TEST(ChangeGuess, HalvesWhereNothingVanishes) {
  for (const double slope : {0.0, 1.0, -1.0}) {
    ChangeGuess guess;
    guess.start(false);
    Closing closing;
    closing.run(guess, [&](double at, bool is_upper) {
      const std::uint64_t key = is_upper ? 10 : 0;
      const Marks marks = {{.key = key + 1, .of = key + 1, .t = 0.1},
                           {.key = key + 2, .of = key + 2, .t = 0.9 + slope * (at - kChange)}};
      guess.see(at, is_upper, key + 1, marks, nowhere);
    });
    EXPECT_LT(closing.steps, kHalvings * 3 / 2);
  }
}

/// Close to the change rounding makes structures that are neither: what was guessed before is not lost.
TEST(ChangeGuess, KeepsItsGuessWhereStructuresFlicker) {
  ChangeGuess guess;
  guess.start(false);
  Closing closing;
  closing.run(guess, [&](double at, bool is_upper) {
    const double distance = std::fabs(at - kChange);
    Marks marks;
    if (is_upper && distance > 1e-12)
      marks = {{.key = 1, .of = 1, .t = 0.5}, {.key = 2, .of = 2, .t = 0.5 + distance * (1 + distance)}};
    guess.see(at, is_upper, !is_upper ? 1 : distance > 1e-12 ? 2 : 3, marks, nowhere);
  });
  EXPECT_LT(closing.steps, kHalvings * 2 / 3);
}

}  // namespace
}  // namespace pkm::generic
