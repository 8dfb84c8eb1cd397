// A mechanism of your own: a SCARA arm, designed by pkmopt for the largest workspace.
//
// Two links l_1 and l_2 turn about vertical axes, a lift of stroke h carries the second one's end, where a wrist turns
// the tool: 3 translations and 1 rotation. The tool reaches x, y when its distance r from the first axis is between
// |l_1 - l_2| and l_1 + l_2. For a given sum of the lengths the best arm has equal links.
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "constraints/all.hpp"
#include "engine/setup/study.hpp"
#include "engine/survey/voxel_grid.hpp"
#include "objectives/all.hpp"

namespace {

enum { kL1, kL2, kStroke };  // the parameters' order
using Parameters = std::span<const double>;

bool reaches(Parameters p, double x, double y, double z) {
  const double square = x * x + y * y, least = p[kL1] - p[kL2], greatest = p[kL1] + p[kL2];
  return square >= least * least && square <= greatest * greatest && z >= 0 && z <= p[kStroke];
}

// One design after the other, for a plan that stays the same. Threads share one surveyor.
struct ScaraSurveyor final : pkm::Surveyor {
  explicit ScaraSurveyor(const pkm::SurveyPlan& p) : plan(p) {}
  pkm::VoxelGrid grid(Parameters p) const {
    const double r = p[kL1] + p[kL2];
    return {plan.cells, plan.box.value_or(pkm::Box{{{-r, r}, {-r, r}, {0, p[kStroke]}}})};
  }
  pkm::VoxelMap map(Parameters p) const {
    return pkm::test_every_cell(grid(p), [p](double x, double y, double z) { return reaches(p, x, y, z); });
  }
  void survey(Parameters p, pkm::Survey<double>& survey) const override { pkm::summarise(grid(p), map(p), survey); }
  pkm::SurveyPlan plan;
};

class Scara final : public pkm::Mechanism {
 public:
  Scara() {
    info_.name = "scara";
    info_.title = "two links, a lift and a wrist";
    info_.parameters = {{"l_1", "m", 0.3, 0.01, 10, "length of the first link"},  // name, unit, default, bounds
                        {"l_2", "m", 0.3, 0.01, 10, "length of the second link"},
                        {"h", "m", 0.2, 0.01, 10, "stroke of the lift"}};
    info_.coordinates = {"x", "y", "z", "phi"};
    info_.joints = {"q1", "q2", "q3", "q4"};
    info_.modes = {"elbow"};
    info_.swept = {0, 1, 2};  // x, y, z; the wrist turns freely, so phi is held
    info_.held = 3;
    info_.volume_unit = "m^3";
    info_.size_unit = "m^3";
    info_.size_meaning = "(l_1 + l_2)^2 h";
  }
  const pkm::MechanismInfo& info() const override { return info_; }

  std::unique_ptr<const pkm::Surveyor> prepare(const pkm::SurveyPlan& plan, const pkm::Demand&) const override {
    if (plan.method == pkm::Method::columns)
      throw std::invalid_argument("scara knows no columns; write method = \"voxels\"");
    return std::make_unique<ScaraSurveyor>(plan);
  }
  pkm::VoxelMap voxel_map(Parameters p, const pkm::SurveyPlan& plan) const override {
    return ScaraSurveyor(plan).map(p);
  }
  double size(Parameters p) const override { return (p[kL1] + p[kL2]) * (p[kL1] + p[kL2]) * p[kStroke]; }
  pkm::PoseReport inspect(Parameters p, const pkm::Pose<double>& pose, const std::string&,
                          const pkm::LimitSpec&) const override {
    pkm::PoseReport report;
    report.assembles = report.feasible = reaches(p, pose.x, pose.y, pose.z);
    if (!report.feasible) report.reason = "out of reach";
    return report;
  }
  // A serial arm has one assembly; this one offers no further tests, facts or refusals of a design.
  std::vector<pkm::AssemblyMode> forward(Parameters p, const std::array<double, 4>& q) const override {
    const double x = p[kL1] * std::cos(q[0]) + p[kL2] * std::cos(q[0] + q[1]);
    const double y = p[kL1] * std::sin(q[0]) + p[kL2] * std::sin(q[0] + q[1]);
    return {{{x, y, q[2], q[0] + q[1] + q[3]}, "elbow", true}};
  }
  void design_margins(Parameters, const pkm::LimitSpec&, std::span<double>) const override {}
  pkm::NamedValues facts(Parameters, const pkm::LimitSpec&) const override { return {}; }
  std::string refuse(Parameters) const override { return {}; }

 private:
  pkm::MechanismInfo info_;
};

const char* const kStudy = R"(
mechanism = { type = "scara" }
variables = { l_1 = { min = "100 mm", max = 0.8 }, l_2 = { min = "100 mm", max = 0.8 } }
workspace = { method = "voxels", cells = { x = 100, y = 100, z = 1 } }
objective = [{ type = "workspace-volume" }]
constraint = [{ type = "linear", coefficients = { l_1 = 1, l_2 = 1 }, bound = 1 }]  # l_1 + l_2 <= 1 m
stage = [{ optimiser = "ga", population = 20, generations = 60 }]
)";

struct Silent final : pkm::Monitor {
  bool generation(const pkm::Generation&) override { return true; }  // false would stop the run
  void warn(const std::string& sentence) override { std::fprintf(stderr, "%s\n", sentence.c_str()); }
};

}  // namespace

int main() try {
  const pkm::MechanismList mechanisms = {std::make_shared<Scara>()};
  const pkm::Study study = pkm::read_study_toml(
      kStudy, "scara.toml", {mechanisms, pkm::all_objectives(), pkm::all_constraints(), pkm::all_optimisers()});

  pkm::ParallelEvaluator evaluator;
  Silent monitor;
  pkm::EvaluationTable table(study.problem->shape());
  const auto result = study.stages[0].optimiser->minimise({*study.problem, evaluator, monitor, study.seed, {}}, table);

  const auto best = static_cast<std::size_t>(result.best_row);
  std::printf("best of %zu designs: l_1 = %.3f m, l_2 = %.3f m, workspace %.4f m^3\n", table.size(),
              table.design(best)[0], table.design(best)[1], table.objective_row(best)[0]);
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
