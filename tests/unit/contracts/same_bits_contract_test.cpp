// Contract of reproducibility: results have the same bits for every instruction set, number of threads and build. New
// mechanisms are tested automatically.
#include <array>
#include <bit>
#include <cstdint>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "engine/core/instruction_set.hpp"
#include "engine/core/team.hpp"
#include "tests/unit/contracts/catalogue_problem.hpp"

namespace pkm {
namespace {

using Bits = std::vector<std::uint64_t>;

class SameBitsContract : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { use_instruction_set(InstructionSet::baseline); }
  void TearDown() override { use_instruction_set(widest_instruction_set()); }

  const Mechanism& mechanism() const { return *test::test_mechanism(GetParam()); }
  const MechanismInfo& info() const { return mechanism().info(); }

  static void add(Bits& bits, const std::vector<double>& values) {
    for (const double value : values) bits.push_back(std::bit_cast<std::uint64_t>(value));
  }
  static void add(Bits& bits, const WorkspaceResult<double>& survey) {
    bits.push_back(static_cast<std::uint64_t>(survey.feasible_cells) * 2 + survey.touches_box);
    add(bits, std::vector<double>{survey.volume, survey.error});
    add(bits, survey.weight);
    for (const PoseQuantity* const quantity : pose_quantities())
      for (std::size_t i = 0; i < kMaxJoints; ++i) add(bits, survey.field(*quantity, i));
  }

  /// Results of the analyses of random designs with random limits, by voxels and by columns, for every sweep. Columns
  /// of files, which take milliseconds, for one design and with a loose tolerance.
  Bits surveys() const {
    Bits bits;
    Stream random(7, 0, 0, Stream::Use::start);
    for (int i = 0; i < 3; ++i) {
      const std::vector<double> design = i == 0 ? test::nominal(info()) : test::random_design(info(), random);
      const LimitSpec limits = i == 0 ? no_limits(info()) : test::random_limits(info(), random);
      for (const Sweep& sweep : test::sweeps(mechanism()))
        for (WorkspacePlan& plan : test::plans(mechanism(), sweep, mechanism().voxels() ? 13 : 6)) {
          plan.limits = limits;
          if (auto* columns = std::get_if<ColumnOptions>(&plan.method); columns && test::is_from_file(info())) {
            if (i > 0) continue;
            columns->tolerance = 1e-3;
          }
          const FieldRequest request =
              plan.columns() ? test::request_without_inertia(mechanism()) : test::request_of_all_fields(mechanism());
          add(bits, test::survey(mechanism(), design, plan, request));
          if (plan.columns()) continue;
          for (const std::uint8_t cell : voxel_map(mechanism(), design, plan).feasible) bits.push_back(cell);
        }
    }
    return bits;
  }

  bool has_derivatives() const {
    return mechanism().columns() && prepare_workspace(mechanism(), test::columns(info()), {})->gradients();
  }
  /// Derivatives of all quantities with respect to all parameters at random designs; empty if the analyses have none.
  Bits derivatives() const {
    Bits bits;
    if (!has_derivatives()) return bits;
    // Centres of the task box for which the digests below were recorded.
    static const std::map<std::string, Pose<double>> poses = {{"4ppa-2par", {0.3, 0.85, -0.8, 0.1}},
                                                              {"3crr-r-cru", {0.2, 0.17, 0.22, 0.1}},
                                                              {"quadrupteron", {0.2, 0.17, 0.22, 0.1}},
                                                              {"2t1r-p-hybrid", {0, 0.01, 0.23, 0.1}}};
    const auto known = poses.find(info().name);
    const Pose<double> centre = known == poses.end() ? test::reference_pose(mechanism()) : known->second;
    Stream random(8, 0, 0, Stream::Use::start);
    // For files, again with a loose tolerance.
    WorkspacePlan plan =
        test::is_from_file(info()) ? test::columns(info(), {.tolerance = 1e-3}) : test::columns(info());
    for (int i = 0; i < 2; ++i) {
      const std::vector<double> design = test::random_design(info(), random);
      plan.limits = test::random_limits(info(), random);
      // Files: the volume only, since their samples do not use kernels (see sample_slopes_test.cpp).
      const test::Of of = test::is_from_file(info()) ? test::Of::volume : test::Of::kinematics;
      const DesignProblem problem = test::everything(test::test_mechanism(GetParam()), plan, of, centre);
      add(bits, problem.derivatives(design, problem.parts().varies));
    }
    return bits;
  }

  template <class Compute>
  void same_on_every_set(const Compute& compute, std::size_t min_size = 100) const {
    const Bits baseline = compute();
    ASSERT_GT(baseline.size(), min_size);
    for (const auto set : {InstructionSet::avx2, InstructionSet::avx512}) {
      if (set > widest_instruction_set()) continue;
      use_instruction_set(set);
      EXPECT_TRUE(compute() == baseline) << name_of(set);
    }
  }
};

TEST_P(SameBitsContract, WorkspaceAnalysesOnEveryInstructionSet) {
  same_on_every_set([&] { return surveys(); });
}
TEST_P(SameBitsContract, DerivativesOnEveryInstructionSet) {
  if (GetParam() == "file-par4") GTEST_SKIP() << "same code as the rotary Delta, but slower";
  if (!has_derivatives()) GTEST_SKIP() << "no derivatives";
  same_on_every_set([&] { return derivatives(); }, test::is_from_file(info()) ? 4 : 100);
}

// Regression test for all compilers and build types: FNV-1a digests of all results. If a change alters results
// intentionally, record the digests that the failed test prints; kAlgorithms may have to be increased.
TEST_P(SameBitsContract, FrozenForEveryBuild) {
  static const std::map<std::string, std::array<std::uint64_t, 2>> frozen = {
      {"4ppa-2par", {2548449595726939524u, 2699388991165454200u}},
      {"3crr-r-cru", {3112937151643096935u, 668358513492202419u}},
      {"quadrupteron", {201858033743621524u, 17824418026016447371u}},
      {"2t1r-p-hybrid", {16625734768430114416u, 8456353499674356445u}}};
  const auto digest = [](const Bits& bits) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const std::uint64_t word : bits)
      for (int byte = 0; byte < 8; ++byte) hash = (hash ^ (word >> (8 * byte) & 0xff)) * 0x100000001b3u;
    return hash;
  };
  const auto known = frozen.find(info().name);
  if (known == frozen.end()) GTEST_SKIP() << "no digests are recorded for " << info().name;
  EXPECT_EQ(digest(surveys()), known->second[0]);
  EXPECT_EQ(digest(derivatives()), known->second[1]);
}

TEST_P(SameBitsContract, WorkspaceAnalysesAndDerivativesWithATeam) {
  if (GetParam() == "file-par4") GTEST_SKIP() << "same code as the rotary Delta, but slower";
  const Bits alone = surveys(), derivatives_alone = derivatives();
  with_team(3, [&] {
    EXPECT_TRUE(surveys() == alone);
    EXPECT_TRUE(derivatives() == derivatives_alone);
  });
}

INSTANTIATE_TEST_SUITE_P(All, SameBitsContract, testing::ValuesIn(test::mechanisms_and_files()),
                         [](const auto& name) { return test::test_name(name.param); });

}  // namespace
}  // namespace pkm
