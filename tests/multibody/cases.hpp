// Mechanisms whose multibody models are compared with MuJoCo and Simbody, at random feasible poses.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "engine/dynamics/pose_dynamics.hpp"
#include "engine/generic/mechanism.hpp"
#include "engine/generic/multibody_model.hpp"
#include "engine/generic/rigid_pose.hpp"
#include "engine/math/random.hpp"
#include "engine/mechanism/sampled_poses.hpp"
#include "tests/unit/generic/files.hpp"

namespace pkm::test {

struct MultibodyCase {
  std::string name;             ///< of a mechanism file
  bool has_orientation = true;  ///< false: the platform is a pin, whose rotation is without meaning
};
inline void PrintTo(const MultibodyCase& tested, std::ostream* out) { *out << tested.name; }

inline const std::vector<MultibodyCase>& multibody_cases() {
  static const std::vector<MultibodyCase> list = {{"rotary-delta"},
                                                  {"linear-delta"},
                                                  {"orthoglide"},
                                                  {"gough"},
                                                  {"3-rpr"},
                                                  {"3-rrr"},
                                                  {"3crr-r-cru"},
                                                  {"quadrupteron"},
                                                  {"4ppa-2par"},
                                                  {"five-bar", false},
                                                  {"chains/tripteron"},
                                                  {"chains/hexaglide"},
                                                  {"chains/isoglide4-t3r1"}};
  return list;
}

inline std::string name_of_case(const ::testing::TestParamInfo<MultibodyCase>& tested) {
  std::string word = tested.param.name;
  std::ranges::replace_if(
      word, [](char c) { return c == '-' || c == '/'; }, '_');
  return word;
}

/// A mechanism with its nominal design, its reference pose, and values by the generic engine.
class NominalDesign {
 public:
  explicit NominalDesign(const std::string& name) : mechanism_(described(name)) {
    for (const Parameter& p : info().parameters) design_.push_back(p.nominal);
    reference_ = central_pose(*mechanism_, design_, no_limits(info()), mode()).value();
  }
  const MechanismInfo& info() const { return mechanism_->info(); }
  const std::string& mode() const { return info().modes.front(); }
  const Pose<double>& reference() const { return reference_; }
  MultibodyModel model() const { return generic::multibody_model(*mechanism_, design_, reference_, mode()); }

  PoseReport inspect(const Pose<double>& pose) const {
    return mechanism_->inspect(design_, pose, mode(), no_limits(info()));
  }
  generic::RigidPose platform(const Pose<double>& pose) const {
    return generic::rigid_pose(evaluation(), inputs(pose));
  }
  /// The point at which wrenches act.
  Eigen::Vector3d wrench_point(const Pose<double>& pose) const {
    const auto& nodes = *evaluation().model.wrench_point;
    const expression::Program program(evaluation().model.graph, {nodes.begin(), nodes.end()});
    const std::vector<double> found = generic::outputs_of(program, inputs(pose));
    return {found[0], found[1], found[2]};
  }
  AxisVector<double> forces(const MotionState<double>& state, const AxisVector<double>& acceleration,
                            const Wrench<double>& wrench) const {
    PoseDynamics<double> d;
    mechanism_->dynamics()->equations(std::span<const double>(design_), mode(), {&state, 1}, {&d, 1});
    return drive_forces(d, acceleration, wrench);
  }

  /// The pose at a fraction of the way from the reference pose to another one.
  Pose<double> between(const Pose<double>& pose, double fraction) const {
    Pose<double> at = reference_;
    for (std::size_t i = 0; i < at.size(); ++i) at[i] += fraction * (pose[i] - at[i]);
    return at;
  }
  /// Random feasible poses, not close to singularities, that the mechanism reaches from the reference pose on the
  /// straight line.
  std::vector<Pose<double>> poses(std::size_t count) const {
    constexpr double kMinConditioning = 0.05;
    Stream random(29, 0, 0, Stream::Use::start);
    const auto ranges = mechanism_->ranges(design_).value();
    std::vector<Pose<double>> found;
    const auto is_usable = [&](const Pose<double>& pose) {
      const PoseReport report = inspect(pose);
      return report.feasible && report.conditioning.value_or(1) >= kMinConditioning;
    };
    for (int trial = 0; trial < 100'000 && found.size() < count; ++trial) {
      Pose<double> pose = reference_;
      for (std::size_t i = 0; i < pose.size(); ++i) {
        const auto [from, to] = ranges[i];
        // of six coordinates nearby, because hardly any pose is feasible with all of them far away
        const double reach = pose.size() < 6 ? 0.5 : 0.15;
        pose[i] += (random.u01() - 0.5) * (info().coordinates[i].turns() ? 1 : reach * (to - from));
      }
      bool usable = true;
      for (int step = 1; step <= 10 && usable; ++step) usable = is_usable(between(pose, 0.1 * step));
      if (usable) found.push_back(pose);
    }
    return found;
  }

 private:
  const generic::Evaluation& evaluation() const { return *generic::evaluation_of(*mechanism_); }
  std::vector<double> inputs(const Pose<double>& pose) const {
    std::vector<double> all = evaluation().inputs<double>(design_, no_limits(info()), 0);
    std::ranges::copy(pose, all.begin() + static_cast<std::ptrdiff_t>(evaluation().model.inputs.coordinate(0)));
    return all;
  }

  std::shared_ptr<const Mechanism> mechanism_;
  std::vector<double> design_;
  Pose<double> reference_;
};

}  // namespace pkm::test
