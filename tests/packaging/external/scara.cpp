// Example of a user-defined mechanism: a SCARA arm with a program that optimises it (`scara run scara.toml`).
//
// Two links of lengths l_1 and l_2 rotate about vertical axes. The second one carries a vertical prismatic joint of
// stroke h and a wrist that rotates about the vertical: 3 translational and 1 rotational degrees of freedom. For a
// given sum of the link lengths the workspace is largest if both links are equally long.
#include <cmath>

#include "experiments/app/program.hpp"

enum { kL1, kL2, kStroke };  // indices of the parameters
using Parameters = std::span<const double>;

class Scara final : public pkm::Mechanism {
 public:
  Scara() {
    info_.name = "scara";
    info_.title = "two links, a lift and a wrist";
    info_.source = "the documentation of pkmopt";
    info_.parameters = {{"l_1", "m", 0.3, 0.01, 10, "length of the first link"},  // name, unit, default, bounds
                        {"l_2", "m", 0.25, 0.01, 10, "length of the second link"},
                        {"h", "m", 0.2, 0.01, 10, "stroke of the lift"}};
    info_.coordinates = {{"x", "m"}, {"y", "m"}, {"z", "m"}, {"phi", "rad"}};
    info_.joints = {{"q1", "rad"}, {"q2", "rad"}, {"q3", "m"}, {"q4", "rad"}};
    info_.modes = {"elbow right"};
    // The workspace is a set of (x, y, z) at a fixed phi, whose value does not matter: the wrist has no limits.
    info_.sweeps = {{.swept = {0, 1, 2}, .fixed = {3}, .column = 2}};
  }
  const pkm::MechanismInfo& info() const override { return info_; }

  pkm::PoseReport inspect(Parameters p, const pkm::Pose<double>& at, const std::string&,
                          const pkm::LimitSpec&) const override {
    const double r = std::hypot(at[0], at[1]), z = at[2];
    pkm::PoseReport report;
    report.margins = {{"stretched", p[kL1] + p[kL2] - r},
                      {"folded", r - std::fabs(p[kL1] - p[kL2])},
                      {"low", z},
                      {"high", p[kStroke] - z}};
    for (const auto& [name, margin] : report.margins)
      if (margin < 0) report.reason = "too " + name;
    report.assembles = report.feasible = report.reason.empty();
    const double elbow = std::acos((r * r - p[kL1] * p[kL1] - p[kL2] * p[kL2]) / (2 * p[kL1] * p[kL2]));
    const double shoulder =
        std::atan2(at[1], at[0]) - std::atan2(p[kL2] * std::sin(elbow), p[kL1] + p[kL2] * std::cos(elbow));
    report.joints = {shoulder, elbow, z, at[3] - shoulder - elbow};
    return report;
  }
  std::optional<std::vector<std::array<double, 2>>> ranges(Parameters p) const override {
    const double r = p[kL1] + p[kL2];
    return {{{-r, r}, {-r, r}, {0, p[kStroke]}, {-pkm::kPi, pkm::kPi}}};
  }
  std::optional<double> default_value(Parameters, int) const override { return 0; }  // default value of phi

 private:
  pkm::MechanismInfo info_;
};

int main(int argc, char** argv) {
  pkm::Catalogues all = pkm::all_catalogues();
  all.mechanisms.push_back(std::make_shared<Scara>());
  return pkm::program_main(argc, argv, all);
}
