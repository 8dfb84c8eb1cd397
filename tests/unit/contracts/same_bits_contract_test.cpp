// What a mechanism computes has the same bits on every instruction set, number of threads and build. A new mechanism is
// tested without a change here.
#include <array>
#include <bit>
#include <cstdint>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "engine/core/instruction_set.hpp"
#include "engine/core/team.hpp"
#include "tests/unit/contracts/everything.hpp"

namespace pkm {
namespace {

using Bits = std::vector<std::uint64_t>;

class SameBitsContract : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { use_instruction_set(InstructionSet::baseline); }
  void TearDown() override { use_instruction_set(widest_instruction_set()); }

  const Mechanism& mechanism() const { return *test::mechanism_called(GetParam()); }
  const MechanismInfo& info() const { return mechanism().info(); }

  static void add(Bits& bits, const std::vector<double>& values) {
    for (const double value : values) bits.push_back(std::bit_cast<std::uint64_t>(value));
  }
  static void add(Bits& bits, const Survey<double>& survey) {
    bits.push_back(static_cast<std::uint64_t>(survey.feasible_cells) * 2 + survey.touches_box);
    add(bits, std::vector<double>{survey.volume, survey.error});
    add(bits, survey.weight);
    for (const PoseQuantity* const quantity : pose_quantities())
      for (std::size_t i = 0; i < kMostJoints; ++i) add(bits, survey.of(*quantity, i));
  }

  /// Surveys of random designs under random limits, voxels and columns of every sweep. Columns of files, which take
  /// milliseconds, of one design and to a few digits.
  Bits surveys() const {
    Bits bits;
    Stream random(7, 0, 0, Stream::Use::start);
    for (int i = 0; i < 3; ++i) {
      const std::vector<double> design = i == 0 ? test::nominal(info()) : test::random_design(info(), random);
      const LimitSpec limits = i == 0 ? no_limits(info()) : test::random_limits(info(), random);
      for (const Sweep& sweep : test::sweeps(mechanism()))
        for (SurveyPlan& plan : test::plans(mechanism(), sweep, mechanism().voxels() ? 13 : 6)) {
          plan.limits = limits;
          if (auto* columns = std::get_if<ColumnOptions>(&plan.method); columns && test::is_of_file(info())) {
            if (i > 0) continue;
            columns->tolerance = 1e-3;
          }
          const Demand demand = plan.columns() ? test::no_inertia(mechanism()) : test::all_fields(mechanism());
          add(bits, test::survey(mechanism(), design, plan, demand));
          if (plan.columns()) continue;
          for (const std::uint8_t cell : voxel_map(mechanism(), design, plan).feasible) bits.push_back(cell);
        }
    }
    return bits;
  }

  bool has_slopes() const {
    return mechanism().columns() && prepare_survey(mechanism(), test::columns(info()), {})->slopes();
  }
  /// Slopes of all quantities by all parameters at random designs; none where surveys have none.
  Bits slopes() const {
    Bits bits;
    if (!has_slopes()) return bits;
    // The poses to be feasible for which bits were frozen.
    static const std::map<std::string, Pose<double>> poses = {{"4ppa-2par", {0.3, 0.85, -0.8, 0.1}},
                                                              {"3crr-r-cru", {0.2, 0.17, 0.22, 0.1}},
                                                              {"quadrupteron", {0.2, 0.17, 0.22, 0.1}},
                                                              {"2t1r-p-hybrid", {0, 0.01, 0.23, 0.1}}};
    const auto known = poses.find(info().name);
    const Pose<double> centre = known == poses.end() ? test::usual_pose(mechanism()) : known->second;
    Stream random(8, 0, 0, Stream::Use::start);
    // Of files to a few digits, too.
    SurveyPlan plan = test::is_of_file(info()) ? test::columns(info(), {.tolerance = 1e-3}) : test::columns(info());
    for (int i = 0; i < 2; ++i) {
      const std::vector<double> design = test::random_design(info(), random);
      plan.limits = test::random_limits(info(), random);
      // Samples of files have no kernels: sample_slopes_test.cpp.
      const test::Of of = test::is_of_file(info()) ? test::Of::volume : test::Of::kinematics;
      const DesignProblem problem = test::everything(test::mechanism_called(GetParam()), plan, of, centre);
      add(bits, problem.slopes(design, problem.parts().varies));
    }
    return bits;
  }

  template <class Compute>
  void same_on_every_set(const Compute& compute, std::size_t least = 100) const {
    const Bits baseline = compute();
    ASSERT_GT(baseline.size(), least);
    for (const auto set : {InstructionSet::avx2, InstructionSet::avx512}) {
      if (set > widest_instruction_set()) continue;
      use_instruction_set(set);
      EXPECT_TRUE(compute() == baseline) << name_of(set);
    }
  }
};

TEST_P(SameBitsContract, SurveysOnEveryInstructionSet) {
  same_on_every_set([&] { return surveys(); });
}
TEST_P(SameBitsContract, SlopesOnEveryInstructionSet) {
  if (GetParam() == "file-par4") GTEST_SKIP() << "lines as those of the rotary Delta, and slower";
  if (!has_slopes()) GTEST_SKIP() << "no derivatives";
  same_on_every_set([&] { return slopes(); }, test::is_of_file(info()) ? 4 : 100);
}

// The same by every compiler and build type, and before and after a change of the code: FNV-1a of all bits. Where a
// change is meant to alter results, the new number is printed here, and kAlgorithms may have to grow.
TEST_P(SameBitsContract, FrozenForEveryBuild) {
  static const std::map<std::string, std::array<std::uint64_t, 2>> frozen = {
      {"4ppa-2par", {8382162162617326300u, 14614484613441112679u}},
      {"3crr-r-cru", {14690203622816652029u, 3279866717563740931u}},
      {"quadrupteron", {6337568740313223246u, 16919900044832421225u}},
      {"2t1r-p-hybrid", {10818615019609464694u, 89049761760987848u}}};
  const auto digest = [](const Bits& bits) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const std::uint64_t word : bits)
      for (int byte = 0; byte < 8; ++byte) hash = (hash ^ (word >> (8 * byte) & 0xff)) * 0x100000001b3u;
    return hash;
  };
  const auto known = frozen.find(info().name);
  if (known == frozen.end()) GTEST_SKIP() << "no bits are frozen for " << info().name;
  EXPECT_EQ(digest(surveys()), known->second[0]);
  EXPECT_EQ(digest(slopes()), known->second[1]);
}

TEST_P(SameBitsContract, SurveysAndSlopesByATeam) {
  if (GetParam() == "file-par4") GTEST_SKIP() << "lines as those of the rotary Delta, and slower";
  const Bits alone = surveys(), slopes_alone = slopes();
  with_team(3, [&] {
    EXPECT_TRUE(surveys() == alone);
    EXPECT_TRUE(slopes() == slopes_alone);
  });
}

INSTANTIATE_TEST_SUITE_P(All, SameBitsContract, testing::ValuesIn(test::mechanisms_and_files()),
                         [](const auto& name) { return test::test_name(name.param); });

}  // namespace
}  // namespace pkm
