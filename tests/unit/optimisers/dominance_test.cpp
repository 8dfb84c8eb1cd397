// Non-dominated sorting and the archive against their definitions, on random scores with many ties.
#include "engine/optimisers/dominance.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>

#include "tests/unit/optimisers/dominates.hpp"

namespace pkm {
namespace {

using ::testing::ElementsAre;

/// Coarse ones are whole numbers below 6, so that many are equal.
Scores random_scores(std::size_t count, std::size_t objectives, bool coarse, unsigned seed) {
  std::mt19937 engine(seed);
  Scores scores{objectives};
  for (std::size_t i = 0; i < count * objectives; ++i)
    scores.values.push_back(coarse ? static_cast<double>(engine() % 6) : static_cast<double>(engine()));
  return scores;
}

/// By the definition: what nobody is left to dominate is the next front.
std::vector<std::uint32_t> peeled(const Scores& scores) {
  const std::size_t n = scores.size();
  constexpr std::uint32_t kNone = 1u << 30;
  std::vector<std::uint32_t> front(n, kNone);
  for (std::uint32_t number = 0; std::ranges::count(front, kNone) > 0; ++number) {
    const std::vector<std::uint32_t> before = front;
    for (std::size_t i = 0; i < n; ++i) {
      bool free = before[i] == kNone;
      for (std::size_t j = 0; j < n && free; ++j)
        free = before[j] != kNone || !dominates(scores[j], scores[i], scores.objectives);
      if (free) front[i] = number;
    }
  }
  return front;
}

TEST(Dominance, NowhereWorseAndSomewhereBetter) {
  const double a[] = {1, 2}, b[] = {1, 3}, c[] = {0, 9};
  EXPECT_TRUE(dominates(a, b, 2));
  EXPECT_FALSE(dominates(b, a, 2));
  EXPECT_FALSE(dominates(a, a, 2));
  EXPECT_FALSE(dominates(a, c, 2));
  EXPECT_FALSE(dominates(c, a, 2));
}

TEST(Dominance, FrontsAreThoseOfTheDefinition) {
  for (const std::size_t objectives : {2u, 3u, 4u, 5u})
    for (const bool coarse : {false, true})
      for (unsigned seed = 1; seed <= 20; ++seed) {
        const Scores scores = random_scores(seed * 5, objectives, coarse, seed);
        std::vector<std::uint32_t> front;
        sort_fronts(scores, front);
        EXPECT_EQ(front, peeled(scores)) << objectives << " objectives, coarse " << coarse << ", seed " << seed;
      }
}

TEST(Dominance, NothingToSort) {
  std::vector<std::uint32_t> front = {7};
  sort_fronts(Scores{2}, front);
  EXPECT_TRUE(front.empty());
}

TEST(Archive, HoldsTheFirstOfAllNonDominatedScores) {
  for (const std::size_t objectives : {2u, 3u, 4u})
    for (const bool coarse : {false, true})
      for (unsigned seed = 1; seed <= 20; ++seed) {
        const Scores all = random_scores(120, objectives, coarse, seed);
        Archive archive(objectives);
        for (std::size_t first = 0; first < all.size(); first += 8) {  // in batches, as generations come
          Scores batch{objectives};
          std::vector<std::int64_t> ids;
          for (std::size_t i = first; i < first + 8; ++i) {
            batch.add({all[i], objectives});
            ids.push_back(static_cast<std::int64_t>(i));
          }
          archive.add(batch, ids);
        }
        std::set<std::int64_t> expected;
        for (std::size_t i = 0; i < all.size(); ++i) {
          bool kept = true;
          for (std::size_t j = 0; j < all.size() && kept; ++j) {
            const bool earlier_twin = j < i && std::equal(all[i], all[i] + objectives, all[j]);
            kept = !earlier_twin && !dominates(all[j], all[i], objectives);
          }
          if (kept) expected.insert(static_cast<std::int64_t>(i));
        }
        EXPECT_EQ(std::set(archive.ids().begin(), archive.ids().end()), expected) << objectives << ' ' << seed;
        ASSERT_EQ(archive.ids().size(), archive.scores().size());
        for (std::size_t k = 0; k < archive.size(); ++k) {
          const double* mine = archive.scores()[k];
          EXPECT_TRUE(std::equal(mine, mine + objectives, all[static_cast<std::size_t>(archive.ids()[k])]));
          EXPECT_LE(archive.scores()[k > 0 ? k - 1 : 0][0], mine[0]);
        }
      }
}

TEST(Archive, SaysWhetherAnythingWasGained) {
  Archive archive(2);
  EXPECT_FALSE(archive.add(Scores{2}, {}));
  EXPECT_TRUE(archive.add({2, {1, 2, 2, 1}}, std::vector<std::int64_t>{4, 5}));
  EXPECT_FALSE(archive.add({2, {1, 2, 3, 3}}, std::vector<std::int64_t>{6, 7}));
  EXPECT_TRUE(archive.add({2, {0, 0}}, std::vector<std::int64_t>{8}));
  EXPECT_THAT(archive.ids(), ElementsAre(8));
}

TEST(Archive, KeepsToItsLimitAndItsEnds) {
  Archive archive(2, 5);
  for (int i = 0; i <= 100; ++i) {
    const double t = (i * 37 % 101) / 100.0;
    archive.add({2, {t, 1 - t}}, std::vector<std::int64_t>{i});
    EXPECT_LE(archive.size(), 5u);
  }
  EXPECT_EQ(archive.scores()[0][0], 0);
  EXPECT_EQ(archive.scores()[4][0], 1);
}

}  // namespace
}  // namespace pkm
