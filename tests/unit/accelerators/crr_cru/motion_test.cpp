// (3CRR/R)&CRU and Quadrupteron along motions: golden forces, quintic moves, oscillation, handling cycle; objectives.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/catalogue.hpp"
#include "engine/mechanism/trajectory.hpp"
#include "engine/motion/motion_factories.hpp"
#include "engine/problem/design_problem.hpp"
#include "objectives/all.hpp"
#include "tests/unit/accelerators/crr_cru/golden.hpp"

namespace pkm::testing::crr {
namespace {

using Json = nlohmann::json;
using ::testing::HasSubstr;

const std::vector<AxisInfo>& coordinates() { return mechanism("quadrupteron").info().coordinates; }  // of both

Trajectory along(const Json& entry, const Motion& motion) {
  const Mechanism& m = mechanism(entry["mechanism"]);
  return compute_trajectory(m, nominal(), mode_name(mode_of(entry["sigma"])), no_limits(m.info()), motion, entry["n"]);
}

void expect_close(const AxisVector<double>& found, const Json& expected, const char* what) {
  double scale = 0;
  for (const double value : expected) scale = std::fmax(scale, std::fabs(value));
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(found[i], expected[i].get<double>(), kGoldenAccuracy * scale) << what;
}

TEST(CrrCruMotion, GoldenQuinticMoves) {
  ASSERT_GT(golden()["quintic"].size(), 10u);
  for (const Json& entry : golden()["quintic"]) {
    SCOPED_TRACE(entry.dump());
    const AxisVector<double> from = vector_of(entry["X0"]), to = from + vector_of(entry["dX"]);
    const double T = min_move_duration(TimeLaw::quintic, coordinates(), from, to, {.acceleration = entry["a"]});
    expect_close(along(entry, *point_to_point(from, {{0, to, T}}, 0, TimeLaw::quintic)).summary.peak_force,
                 entry["tau_abs_max"], "peak force");
  }
}

TEST(CrrCruMotion, GoldenOscillation) {
  for (const Json& entry : golden()["eq35"]) {
    SCOPED_TRACE(entry.dump());
    const Trajectory found = along(entry, *oscillation(space_axes(coordinates()), vector_of(entry["X0"]), 0.01, 1, 1));
    EXPECT_TRUE(found.periodic);
    AxisVector<double> least = *found.points[0].forces, greatest = least;
    for (const TrajectoryPoint& p : found.points)
      for (std::size_t i = 0; i < 4; ++i) {
        least[i] = std::fmin(least[i], (*p.forces)[i]);
        greatest[i] = std::fmax(greatest[i], (*p.forces)[i]);
      }
    expect_close(least, entry["tau_min"], "least");
    expect_close(greatest, entry["tau_max"], "greatest");
  }
}

TEST(CrrCruMotion, GoldenHandlingCycle) {
  for (const Json& entry : golden()["adept"]) {
    SCOPED_TRACE(entry.dump());
    PickAndPlace cycle;
    cycle.axes = space_axes(coordinates());
    cycle.start = vector_of(entry["P0"]);
    cycle.lift = entry["lift"];
    cycle.reach = entry["reach"];
    cycle.lift_time = entry["Tv"];
    cycle.reach_time = entry["Th"];
    cycle.overlap = entry["overlap"];
    cycle.turn = entry["dphi"];
    cycle.direction = std::atan2(entry["direction"][1].get<double>(), entry["direction"][0].get<double>());
    const Trajectory found = along(entry, *pick_and_place(cycle));
    const TrajectorySummary& s = found.summary;
    EXPECT_NEAR(found.duration, entry["duration"].get<double>(), 1e-14);
    EXPECT_EQ(s.infeasible, 0u);
    expect_close(s.peak_force, entry["peak_force"], "peak force");
    expect_close(s.rms_force, entry["rms_force"], "RMS force");
    expect_close(s.peak_power, entry["peak_power"], "peak power");
    expect_close(*s.peak_speed, entry["peak_speed"], "peak speed");
    const double power = entry["peak_total_power"];
    EXPECT_NEAR(s.peak_total_power, power, kGoldenAccuracy * power);
    EXPECT_NEAR(s.min_total_power, entry["min_total_power"].get<double>(), kGoldenAccuracy * power);
    // There and back from rest to rest, all work is given back; along half the way the rods' heights change.
    cycle.back = true;
    const Trajectory whole = along(entry, *pick_and_place(cycle));
    EXPECT_TRUE(whole.periodic);
    EXPECT_NEAR(whole.summary.energy, 0, 1e-6);
    EXPECT_GT(std::fabs(s.energy), 1e-3);
    EXPECT_GT(s.energy_drawn, 0.1);
  }
}

TEST(CrrCruMotion, AccelerationsOfTheJointsAreDerivativesOfTheirSpeeds) {
  for (const std::string& name : both()) {
    const Mechanism& m = mechanism(name);
    const auto formula = [](const char* text) { return Formula(text, time_name()); };
    const auto motion = motion_from_formulas(
        {formula("0.2 + 0.02*sin(3*t)"), formula("0.17"), formula("0.22 + 0.01*t"), formula("0.5*cos(2*t)")}, 1);
    const auto fine = compute_trajectory(m, nominal(), m.info().modes[0], no_limits(m.info()), *motion, 2001).points;
    for (std::size_t k = 1; k + 1 < fine.size(); k += 100)
      for (std::size_t i = 0; i < 4; ++i) {
        const double h = fine[k + 1].motion.time - fine[k - 1].motion.time;
        EXPECT_NEAR((*fine[k].speeds)[i], ((*fine[k + 1].joints)[i] - (*fine[k - 1].joints)[i]) / h, 1e-6);
        EXPECT_NEAR((*fine[k].accelerations)[i], ((*fine[k + 1].speeds)[i] - (*fine[k - 1].speeds)[i]) / h, 1e-6);
      }
  }
}

TEST(CrrCruMotion, InfeasibleSamplesAreMarkedAndLeaveTheOthers) {
  const Mechanism& m = mechanism("3crr-r-cru");
  const auto motion = point_to_point({0.2, 0.17, 0.22, 0}, {{0, {0.2, 0.17, 0.6, 0}, 1}}, 0, TimeLaw::quintic);
  const Trajectory found = compute_trajectory(m, nominal(), m.info().modes[0], no_limits(m.info()), *motion, 101);
  EXPECT_GT(found.summary.infeasible, 0u);
  EXPECT_FALSE(found.summary.has_forces);
  EXPECT_TRUE(found.points.front().feasible && found.points.front().forces);
  EXPECT_FALSE(found.points.back().feasible || found.points.back().forces);
  EXPECT_THAT(found.points.back().reason, HasSubstr("cannot reach the pose"));
}

/// The machine as a study has it: one motion, one objective of the rod lengths and masses.
DesignProblem problem_of(const std::string& name, const std::string& objective, const std::string& joint,
                         const std::shared_ptr<const Motion>& motion) {
  const ObjectiveEntry& entry = *find_named(all_objectives(), objective);
  const DesignMotion named{{"pick", motion}};
  Options options = default_options(entry.options);
  options.set("motion", std::string("pick"));
  options.set("joint", joint);
  options.set("wrench", NamedNumbers{{"Fz", -5.0}, {"Mz", 0.1}});
  ProblemParts parts;
  parts.mechanism = *std::ranges::find_if(all_mechanisms(), [&](const auto& m) { return m.name() == name; });
  parts.parameters = nominal();
  parts.plan.limits = no_limits(parts.mechanism->info());
  parts.plan.method = ColumnOptions{.nodes = {1, 1}};
  std::vector<Variable> variables;
  for (std::size_t i = 0; i < parts.parameters.size(); ++i) {
    const Parameter& p = parts.mechanism->info().parameters[i];
    variables.push_back({p.name, p.unit, p.lower, p.upper});
    parts.varies.push_back(i);
  }
  parts.space = DesignSpace(variables);
  const EntryContext context{*parts.mechanism, parts.plan, options, {}, {&named, 1}};
  parts.objectives.push_back({.name = objective, .unit = entry.unit(context), .quantity = entry.make(context)});
  return DesignProblem(parts);
}

std::shared_ptr<const Motion> turning_cycle() {
  PickAndPlace cycle;
  cycle.axes = space_axes(coordinates());
  cycle.start = {0.06, 0.17, 0.2, -0.4};
  cycle.reach = 0.2;
  cycle.lift_time = 0.12;
  cycle.overlap = 0.05;
  cycle.turn = 0.8;
  return pick_and_place(cycle);
}

TEST(CrrCruMotion, ObjectivesAreThePeaksOfTheTrajectory) {
  const auto motion = turning_cycle();
  for (const std::string& name : both()) {
    const Mechanism& m = mechanism(name);
    const TrajectorySummary s =
        compute_trajectory(m, nominal(), m.info().modes[0], no_limits(m.info()), *motion, 201, {{0, 0, -5, 0, 0, 0.1}})
            .summary;
    const auto value = [&](const char* objective, const char* joint) {
      return problem_of(name, objective, joint, motion).report(nominal()).objectives[0];
    };
    EXPECT_EQ(value("peak-force", "3"), s.peak_force[2]);
    EXPECT_EQ(value("peak-force", "worst"), *std::ranges::max_element(s.peak_force));
    EXPECT_EQ(value("peak-power", "1"), s.peak_power[0]);
    EXPECT_EQ(value("peak-power", "worst"), *std::ranges::max_element(s.peak_power));
    EXPECT_EQ(value("peak-power", "total"), std::fmax(s.peak_total_power, -s.min_total_power));
  }
}

TEST(CrrCruMotion, DerivativesOfTheSmoothPeakEqualDifferences) {
  const auto motion = turning_cycle();
  for (const std::string& name : both())
    for (const auto& [objective, joint] :
         {std::pair{"peak-force", "worst"}, {"peak-force", "4"}, {"peak-power", "worst"}, {"peak-power", "total"}}) {
      SCOPED_TRACE(name + " " + objective + " " + joint);
      const DesignProblem problem = problem_of(name, objective, joint, motion);
      std::vector<double> p = nominal();
      p[kSlideMass] = 0.1;  // masses are differentiated away from 0, below which there are none
      p[kPayload] = 0.2;
      p[kPayloadOffset] = 0.02;
      const std::vector<double> derivatives = problem.derivatives(p, problem.parts().varies);
      const double worst = problem.report(p).objectives[0];
      EXPECT_LE(derivatives[0], worst);
      EXPECT_GT(derivatives[0], 0.95 * worst);
      double largest = 0;
      for (std::size_t i = 0; i < p.size(); ++i) largest = std::fmax(largest, std::fabs(derivatives[1 + i] * p[i]));
      EXPECT_GT(largest, 0.1 * worst);
      for (std::size_t i = 0; i < p.size(); ++i) {
        const double h = 1e-5 * (p[i] == 0 ? 1 : p[i]);
        const auto moved = [&](double steps) {
          std::vector<double> q = p;
          q[i] += steps * h;
          return problem.derivatives(q, {})[0];
        };
        const double difference = (8 * (moved(1) - moved(-1)) - (moved(2) - moved(-2))) / (12 * h);
        const double size = p[i] == 0 ? 1 : std::fabs(p[i]);
        EXPECT_NEAR(derivatives[1 + i] * size, difference * size, 1e-6 * largest)
            << problem.parts().mechanism->info().parameters[i].name;
      }
    }
}

TEST(CrrCruMotion, ADesignThatCannotFollowFailsWithAReason) {
  const DesignProblem problem = problem_of("3crr-r-cru", "peak-force", "worst", turning_cycle());
  std::vector<double> p = nominal();
  p[kL11] *= 0.2;
  const DesignReport report = problem.report(p);
  EXPECT_EQ(report.status, Status::failed);
  EXPECT_TRUE(std::isnan(report.objectives[0]));
  EXPECT_THAT(report.reason, HasSubstr("peak-force: the motion pick leaves the reach of the mechanism at t = "));
  EXPECT_THAT(report.reason, HasSubstr("limb1 cannot reach"));
  EvaluationTable table(problem.shape(Detail::derivatives));
  table.extend(1);
  std::ranges::copy(p, table.design(0).begin());
  Scratch scratch;
  problem.evaluate(p, scratch, table.slot(0));
  EXPECT_EQ(table.status[0], Status::failed);
}

}  // namespace
}  // namespace pkm::testing::crr
