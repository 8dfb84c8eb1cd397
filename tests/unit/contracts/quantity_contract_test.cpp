// Contract of objectives and constraints: every entry of the catalogues, with every mechanism that supports it. New
// entries are tested automatically.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "constraints/all.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/math/random.hpp"
#include "engine/mechanism/with_drive_trains.hpp"
#include "engine/problem/built_machines.hpp"
#include "objectives/all.hpp"
#include "tests/own_mechanisms/three_ropes.hpp"
#include "tests/unit/contracts/mechanism_fixtures.hpp"

namespace pkm {
namespace {

using test::best_plan;
using test::nominal;
using ::testing::HasSubstr;

/// A mechanism without any optional capability, with the parameters and coordinates of another one.
class Bare final : public Mechanism {
 public:
  explicit Bare(const Mechanism& of) : info_(of.info()) {
    info_.name = "bare-machine";
    info_.limits.clear();
    info_.characteristic_length = "";
  }
  const MechanismInfo& info() const override { return info_; }
  PoseReport inspect(std::span<const double>, const Pose<double>&, const std::string&,
                     const LimitSpec&) const override {
    return {};
  }

 private:
  MechanismInfo info_;
};

/// The mechanisms of the contract suites, and one with drive trains.
MechanismList mechanisms_with_a_driven_one() {
  MechanismList all = test::mechanisms();
  const auto bare = *std::ranges::find_if(all, [](const auto& m) { return m.name() == "3crr-r-cru"; });
  const DriveTrain screw{.ratio = 300, .rotor = 1e-6, .efficiency = 0.9, .coulomb = 1, .viscous = 2};
  all.push_back(with_drive_trains(bare, DriveTrains(4, screw)));
  return all;
}

/// Calls action(entry, mechanism) for all pairs of an entry and a mechanism that supports it.
template <class List, class Do>
void for_all_supported(const List& entries, const Do& action) {
  for (const auto& entry : entries) {
    int supported = 0;
    for (const auto& mechanism : mechanisms_with_a_driven_one()) {
      SCOPED_TRACE(entry.name + " of " + mechanism->info().name);
      if (entry.refusal(*mechanism)) continue;
      ++supported;
      action(entry, *mechanism);
    }
    // tests/unit/config/orientation_objective_test.cpp has mechanisms with three angles
    const bool has_own_tests = entry.name == "orientation-workspace";
    EXPECT_TRUE(supported > 0 || has_own_tests) << entry.name << ": no mechanism supports it";
  }
}

/// Default options; required ones get values that are satisfied by the nominal design.
Options some_options(const std::vector<OptionSpec>& specs, const MechanismInfo& info, const std::string& expression) {
  Options options = default_options(specs);
  for (const OptionSpec& spec : specs) {
    if (spec.kind == OptionKind::named_numbers && spec.required)
      options.set(spec.name, NamedNumbers{{info.parameters[0].name, 1.0}});
    if (spec.name == "bound") options.set(spec.name, info.parameters[0].nominal);
    if (spec.name == "expression") options.set(spec.name, expression);
    if (spec.name == "call") options.set(spec.name, std::string("cost.py:price"));
    if (spec.name == "quantity") options.set(spec.name, test::some_quantity(info));
    if (spec.name == "region") options.set(spec.name, std::string("task"));
    if (spec.name == "motion" && spec.required) options.set(spec.name, std::string("swing"));
    // a limit of the fastest motion
    if (spec.name == "tool_acceleration" && options.word("law") != "given") options.set(spec.name, 50.0);
  }
  return options;
}
Options some_options(const ObjectiveEntry& entry, const MechanismInfo& info) {
  return some_options(entry.options, info, "volume * " + info.parameters[0].name);
}
Options some_options(const ConstraintEntry& entry, const MechanismInfo& info) {
  return some_options(entry.options(info), info,
                      shortest(info.parameters[0].nominal) + " - " + info.parameters[0].name);
}

/// All objectives but those of other programs, whose values are not those of pkmopt, the largest solids, which need a
/// workspace over lengths only (tests/cli/largest_solid_test.cpp), and the yield, whose values are computed by the
/// design problem (tests/unit/config/tolerance_test.cpp).
std::vector<ObjectiveEntry> own_objectives() {
  std::vector<ObjectiveEntry> all = all_objectives();
  std::erase_if(all, [](const ObjectiveEntry& entry) {
    return entry.name == "python" || entry.name == kYield || entry.name.starts_with("largest-");
  });
  return all;
}

double value(const ObjectiveEntry& entry, const Mechanism& mechanism, const WorkspacePlan& plan) {
  const Options options = some_options(entry, mechanism.info());
  const auto motions = test::motions(mechanism);
  const EntryContext context{mechanism, plan, options, {}, motions};
  FieldRequest request;
  entry.request(context, request);
  const auto parameters = nominal(mechanism.info());
  const auto survey = test::survey(mechanism, parameters, plan, request);
  Scratch scratch;
  return entry.make(context)->value({mechanism, parameters, &survey, scratch});
}

TEST(ObjectiveContract, HasNameMeaningAndUnit) {
  for_all_supported(all_objectives(), [](const ObjectiveEntry& entry, const Mechanism& mechanism) {
    const WorkspacePlan p = best_plan(mechanism);
    const Options options = some_options(entry, mechanism.info());
    EXPECT_NE(entry.name, "");
    EXPECT_NE(entry.meaning, "");
    EXPECT_TRUE(!entry.detail || !entry.detail({mechanism, p, options}).empty());
    EXPECT_NE(entry.unit({mechanism, p, options}), "");
    for (const OptionSpec& option : entry.options) EXPECT_NE(option.meaning, "") << option.name;
  });
}

TEST(ObjectiveContract, VoxelsAgreeWithColumnsOrFinerVoxelsToGridAccuracy) {
  for_all_supported(own_objectives(), [](const ObjectiveEntry& entry, const Mechanism& mechanism) {
    const double fine = value(entry, mechanism, best_plan(mechanism, 30));
    const double voxels = value(entry, mechanism, test::voxels(mechanism.info(), mechanism.columns() ? 40 : 19));
    EXPECT_TRUE(std::isfinite(fine) && fine != 0);
    EXPECT_NEAR(voxels / fine, 1, 0.05);
  });
}

/// Whether the objective gives a reason why its value is undefined.
bool is_explained(const ObjectiveEntry& entry, const Mechanism& mechanism, const WorkspacePlan& plan) {
  const Options options = some_options(entry, mechanism.info());
  const auto motions = test::motions(mechanism);
  const auto parameters = nominal(mechanism.info());
  const WorkspaceResult<double> empty;
  Scratch scratch;
  return !entry.make({mechanism, plan, options, {}, motions})
              ->why_undefined({mechanism, parameters, &empty, scratch})
              .empty();
}

TEST(ObjectiveContract, IsDefinedOrExplainedOnAnEmptyWorkspace) {
  for_all_supported(own_objectives(), [](const ObjectiveEntry& entry, const Mechanism& mechanism) {
    for (WorkspacePlan& p : test::plans(mechanism, mechanism.info().sweeps.front(), 10)) {
      p.limits = test::infeasible_limits(mechanism, p);
      EXPECT_TRUE(std::isfinite(value(entry, mechanism, p)) || is_explained(entry, mechanism, p));
    }
  });
}

/// Either the bare mechanism supports the entry, or the reason names both the entry and the mechanism.
template <class Entry>
void expect_both_named(const Entry& entry, const Mechanism& mechanism) {
  const Unsupported refusal = entry.refusal(Bare(mechanism));
  if (!refusal) return;
  EXPECT_THAT(*refusal, HasSubstr(entry.name));
  EXPECT_THAT(*refusal, HasSubstr("bare-machine"));
}

TEST(ObjectiveContract, ReasonNamesTheEntryAndTheUnsupportedMechanism) {
  for_all_supported(all_objectives(),
                    [](const auto& entry, const auto& mechanism) { expect_both_named(entry, mechanism); });
  const Bare bare(*all_mechanisms()[0]);
  EXPECT_TRUE(find_named(all_objectives(), "workspace-ratio")->refusal(bare));
  EXPECT_TRUE(find_named(all_objectives(), "conditioning")->refusal(bare));
}

TEST(ObjectiveContract, DynamicsNeedASquareJacobian) {
  const test::ThreeRopes ropes;
  for (const std::string name : {"dci", "dci-uniformity", "inertia-condition", "peak-force", "peak-power"})
    EXPECT_EQ(find_named(all_objectives(), name)->refusal(ropes),
              "objective " + name +
                  " needs dynamics, and mechanism three-ropes has 3 joints for 2 coordinates, not as many of both");
}

TEST(ConstraintContract, ReasonNamesTheEntryAndTheUnsupportedMechanism) {
  for_all_supported(all_constraints(), [](const ConstraintEntry& entry, const Mechanism& mechanism) {
    expect_both_named(entry, mechanism);
    EXPECT_TRUE(!entry.pose_level() || entry.refusal(Bare(mechanism)));
  });
}

double margin(const ConstraintEntry& entry, const Mechanism& mechanism, const std::vector<double>& parameters) {
  const WorkspacePlan p = best_plan(mechanism);
  const Options options = some_options(entry, mechanism.info());
  const std::vector<Region> regions = {test::task(mechanism)};
  const std::vector<DesignMotion> motions = test::motions(mechanism);
  Scratch scratch;
  return entry.make({mechanism, p, options, regions, motions})->value({mechanism, parameters, nullptr, scratch});
}

TEST(ConstraintContract, HasNameMeaningAndUnit) {
  for_all_supported(all_constraints(), [](const ConstraintEntry& entry, const Mechanism& mechanism) {
    EXPECT_NE(entry.name, "");
    EXPECT_NE(entry.meaning, "");
    for (const OptionSpec& option : entry.options(mechanism.info())) EXPECT_NE(option.meaning, "") << option.name;
    const WorkspacePlan p = best_plan(mechanism);
    const Options options = some_options(entry, mechanism.info());
    EXPECT_TRUE(entry.pose_level() || !entry.unit({mechanism, p, options}).empty());
    EXPECT_TRUE(!entry.detail || !entry.detail({mechanism, p, options}).empty());
  });
}

TEST(ConstraintContract, DesignLevelConstraintsAreSatisfiedBySomeDesignsOnly) {
  for_all_supported(all_constraints(), [](const ConstraintEntry& entry, const Mechanism& mechanism) {
    if (entry.pose_level()) return;
    int satisfied = 0, violated = 0;
    Stream random(1, 0, 0, Stream::Use::start);
    for (int i = 0; i < 200; ++i) {
      auto design = nominal(mechanism.info());
      const double share = i / 200.0;  // amplitude: parameters vary up to 0.4 to 2 times their nominal values
      for (double& p : design) p *= 1 + share * (1.6 * random.u01() - 0.6);
      const double m = margin(entry, mechanism, design);
      ASSERT_TRUE(std::isfinite(m));
      ++(m >= 0 ? satisfied : violated);
    }
    EXPECT_GT(satisfied, 0);
    EXPECT_GT(violated, 0);
  });
}

/// Designs of 4ppa-2par whose margins are easily computed by hand from the equations.
TEST(ConstraintContract, MarginsOfHandComputedDesigns) {
  const Mechanism& machine =
      **std::ranges::find_if(all_mechanisms(), [](const auto& m) { return m.name() == "4ppa-2par"; });
  const auto with = [&](const std::string& name, double v) {
    auto design = nominal(machine.info());
    for (std::size_t i = 0; i < design.size(); ++i)
      if (machine.info().parameters[i].name == name) design[i] = v;
    return design;
  };
  const auto of = [&](const std::string& constraint, const std::vector<double>& design) {
    return margin(*find_named(all_constraints(), constraint), machine, design);
  };
  EXPECT_NEAR(of("rail-length", with("L0", 1.3)), 0.1, 1e-12);  // L0 - 2 l_u, l_u = 0.6
  EXPECT_NEAR(of("rail-length", with("L0", 1.1)), -0.1, 1e-12);
  EXPECT_NEAR(of("workspace-shape", with("l_d", 0.6)), 0.1, 1e-12);  // 2 l_d against |(l_u, b)| = |(0.6, 0.8)| = 1
  EXPECT_NEAR(of("workspace-shape", with("l_d", 0.4)), -0.1, 1e-12);
  EXPECT_NEAR(of("linear", with("a", 0.1)), 0.1, 1e-12);  // a <= 0.2
  EXPECT_NEAR(of("linear", with("a", 0.3)), -0.1, 1e-12);
}

TEST(ConstraintContract, PoseLevelConstraintsOnlyReduceTheWorkspace) {
  for_all_supported(all_constraints(), [](const ConstraintEntry& entry, const Mechanism& mechanism) {
    if (!entry.pose_level()) return;
    const MechanismInfo& info = mechanism.info();
    const auto volume = [&](WorkspacePlan p, const Options& options) {
      p.limits = entry.limits(info, options);
      return test::survey(mechanism, nominal(info), p).volume;
    };
    const auto uncut = [&](const WorkspacePlan& p) { return test::survey(mechanism, nominal(info), p).volume; };
    std::vector<WorkspacePlan> plans;
    for (const Sweep& sweep : test::sweeps(mechanism)) plans.push_back(best_plan(mechanism, sweep, 20));
    const auto specs = entry.options(info);
    EXPECT_TRUE(!specs.empty() || volume(plans[0], {}) < uncut(plans[0]));
    for (const OptionSpec& spec : specs) {
      const LimitInfo* limit = find_named(info.limits, spec.name);
      if (!limit) continue;
      // A value that leaves little or no workspace; at most 1 m for lengths without a natural maximum.
      const auto index = static_cast<std::size_t>(limit - info.limits.data());
      const double end = std::min(*test::infeasible_limits(info).given[index], 1.0);
      double smallest_ratio = 1;  // over the sweeps: a limit has no effect in a sweep whose fixed coordinate it bounds
      for (const WorkspacePlan& p : plans) {
        const double free = uncut(p);
        double before = free;
        for (const double share : {0.25, 0.5, 0.75, 1.0}) {
          Options options = default_options(specs);
          options.set(spec.name, (1 - share) * limit->inactive + share * end);
          const double cut = volume(p, options);
          EXPECT_LE(cut, before * (1 + 1e-8)) << spec.name << ", " << share << ", " << volume_unit(info, p);
          before = cut;
        }
        smallest_ratio = std::min(smallest_ratio, before / free);
      }
      EXPECT_LT(smallest_ratio, 0.5) << spec.name;
    }
  });
}

}  // namespace
}  // namespace pkm
