// Example of a program without studies: the workspace of a user-defined mechanism, counted on a voxel grid.
#include <cmath>
#include <cstdio>

#include "engine/workspace/prepare_workspace.hpp"

namespace {

/// Planar arm with two links: 2 rotating joints move a point in the plane.
class Arm final : public pkm::Mechanism {
 public:
  Arm() {
    info_.name = "arm";
    info_.title = "two links in a plane";
    info_.source = "the documentation of pkmopt";
    info_.parameters = {{"l_1", "m", 0.3, 0.01, 10, "length of the first link"},
                        {"l_2", "m", 0.2, 0.01, 10, "length of the second link"}};
    info_.coordinates = {{"x", "m"}, {"y", "m"}};
    info_.joints = {{"q1", "rad"}, {"q2", "rad"}};
    info_.modes = {"elbow right"};
    info_.sweeps = pkm::all_sweeps(info_.coordinates, {0, 1});
  }
  const pkm::MechanismInfo& info() const override { return info_; }
  pkm::PoseReport inspect(std::span<const double> p, const pkm::Pose<double>& at, const std::string&,
                          const pkm::LimitSpec&) const override {
    const double r = std::hypot(at[0], at[1]);
    const double elbow = std::acos((r * r - p[0] * p[0] - p[1] * p[1]) / (2 * p[0] * p[1]));
    pkm::PoseReport report;
    report.margins = {{"stretched", p[0] + p[1] - r}, {"folded", r - std::fabs(p[0] - p[1])}};
    report.assembles = report.feasible = report.margins[0].second >= 0 && report.margins[1].second >= 0;
    if (!report.feasible) report.reason = "out of reach";
    report.joints = {std::atan2(at[1], at[0]) - std::atan2(p[1] * std::sin(elbow), p[0] + p[1] * std::cos(elbow)),
                     elbow};
    return report;
  }
  std::optional<std::vector<std::array<double, 2>>> ranges(std::span<const double> p) const override {
    const double r = p[0] + p[1];
    return {{{-r, r}, {-r, r}}};
  }

 private:
  pkm::MechanismInfo info_;
};

}  // namespace

int main() {
  const Arm arm;
  const double lengths[] = {0.3, 0.2};
  pkm::WorkspacePlan plan;
  plan.method = pkm::VoxelOptions{.cells = {400, 400, 1}};
  plan.limits = pkm::no_limits(arm.info());
  pkm::WorkspaceResult<double> found;
  pkm::evaluate_once<double>(*pkm::prepare_workspace(arm, plan, {}), lengths, found);
  const double exact = pkm::kPi * (0.5 * 0.5 - 0.1 * 0.1);  // a ring
  std::printf("workspace %.6f m^2, exactly %.6f m^2\n", found.volume, exact);
  return std::fabs(found.volume - exact) < 1e-3 ? 0 : 1;
}
