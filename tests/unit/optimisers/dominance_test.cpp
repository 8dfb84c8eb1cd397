// Compares non-dominated sorting and the non-dominated set with their definitions, on random scores with many ties.
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

/// @param coarse  integer scores in [0, 5], so that many are equal
Scores random_scores(std::size_t count, std::size_t objectives, bool coarse, unsigned seed) {
  std::mt19937 engine(seed);
  Scores scores{objectives};
  for (std::size_t i = 0; i < count * objectives; ++i)
    scores.values.push_back(coarse ? static_cast<double>(engine() % 6) : static_cast<double>(engine()));
  return scores;
}

/// Front indices by the definition: the next front consists of the designs that no remaining design dominates.
std::vector<std::uint32_t> fronts_by_definition(const Scores& scores) {
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

TEST(Dominance, RequiresNoWorseAndOneBetterScore) {
  const double a[] = {1, 2}, b[] = {1, 3}, c[] = {0, 9};
  EXPECT_TRUE(dominates(a, b, 2));
  EXPECT_FALSE(dominates(b, a, 2));
  EXPECT_FALSE(dominates(a, a, 2));
  EXPECT_FALSE(dominates(a, c, 2));
  EXPECT_FALSE(dominates(c, a, 2));
}

TEST(Dominance, SortingMatchesTheDefinition) {
  for (const std::size_t objectives : {2u, 3u, 4u, 5u})
    for (const bool coarse : {false, true})
      for (unsigned seed = 1; seed <= 20; ++seed) {
        const Scores scores = random_scores(seed * 5, objectives, coarse, seed);
        std::vector<std::uint32_t> front;
        non_dominated_sort(scores, front);
        EXPECT_EQ(front, fronts_by_definition(scores))
            << objectives << " objectives, coarse " << coarse << ", seed " << seed;
      }
}

TEST(Dominance, EmptyInputHasNoFronts) {
  std::vector<std::uint32_t> front = {7};
  non_dominated_sort(Scores{2}, front);
  EXPECT_TRUE(front.empty());
}

TEST(NonDominatedSet, KeepsTheFirstOfEqualNonDominatedDesigns) {
  for (const std::size_t objectives : {2u, 3u, 4u})
    for (const bool coarse : {false, true})
      for (unsigned seed = 1; seed <= 20; ++seed) {
        const Scores all = random_scores(120, objectives, coarse, seed);
        NonDominatedSet set(objectives);
        for (std::size_t first = 0; first < all.size(); first += 8) {  // in batches, like generations
          Scores batch{objectives};
          std::vector<std::int64_t> ids;
          for (std::size_t i = first; i < first + 8; ++i) {
            batch.add({all[i], objectives});
            ids.push_back(static_cast<std::int64_t>(i));
          }
          set.add(batch, ids);
        }
        std::set<std::int64_t> expected;
        for (std::size_t i = 0; i < all.size(); ++i) {
          bool is_member = true;
          for (std::size_t j = 0; j < all.size() && is_member; ++j) {
            const bool earlier_twin = j < i && std::equal(all[i], all[i] + objectives, all[j]);
            is_member = !earlier_twin && !dominates(all[j], all[i], objectives);
          }
          if (is_member) expected.insert(static_cast<std::int64_t>(i));
        }
        EXPECT_EQ(std::set(set.ids().begin(), set.ids().end()), expected) << objectives << ' ' << seed;
        ASSERT_EQ(set.ids().size(), set.scores().size());
        for (std::size_t k = 0; k < set.size(); ++k) {
          const double* mine = set.scores()[k];
          EXPECT_TRUE(std::equal(mine, mine + objectives, all[static_cast<std::size_t>(set.ids()[k])]));
          EXPECT_LE(set.scores()[k > 0 ? k - 1 : 0][0], mine[0]);
        }
      }
}

TEST(NonDominatedSet, AddReturnsWhetherTheSetChanged) {
  NonDominatedSet set(2);
  EXPECT_FALSE(set.add(Scores{2}, {}));
  EXPECT_TRUE(set.add({2, {1, 2, 2, 1}}, std::vector<std::int64_t>{4, 5}));
  EXPECT_FALSE(set.add({2, {1, 2, 3, 3}}, std::vector<std::int64_t>{6, 7}));
  EXPECT_TRUE(set.add({2, {0, 0}}, std::vector<std::int64_t>{8}));
  EXPECT_THAT(set.ids(), ElementsAre(8));
}

TEST(NonDominatedSet, IsTruncatedToItsMaximumSizeAndKeepsTheExtremes) {
  NonDominatedSet set(2, 5);
  for (int i = 0; i <= 100; ++i) {
    const double t = (i * 37 % 101) / 100.0;
    set.add({2, {t, 1 - t}}, std::vector<std::int64_t>{i});
    EXPECT_LE(set.size(), 5u);
  }
  EXPECT_EQ(set.scores()[0][0], 0);
  EXPECT_EQ(set.scores()[4][0], 1);
}

}  // namespace
}  // namespace pkm
