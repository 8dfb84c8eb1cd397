#include "engine/generic/exact_accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "engine/core/catalogue.hpp"
#include "engine/core/stop.hpp"
#include "engine/core/team.hpp"
#include "engine/generic/evaluation.hpp"
#include "engine/generic/kinematics.hpp"
#include "engine/generic/mechanism.hpp"
#include "engine/geometry/pose_error.hpp"
#include "engine/geometry/singular.hpp"

namespace pkm::generic {
namespace {

struct PlatformError {
  double position = 0, angle = 0;  ///< displacement of the platform's origin [m], and angle of its rotation [rad]
};

/// The displacement of the platform between two frames. Each frame consists of the origin, then the rows of its
/// rotation matrix.
PlatformError displacement(const std::vector<double>& from, const std::vector<double>& to) {
  const auto R = [](const std::vector<double>& frame, std::size_t i, std::size_t k) { return frame[3 + 3 * i + k]; };
  Matrix<double, 3, 3> turn;  // rotation from the first frame to the second
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k) turn(i, j) += R(to, i, k) * R(from, j, k);
  const double sine = std::hypot(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0), turn(1, 0) - turn(0, 1)) / 2,
               cosine = (turn(0, 0) + turn(1, 1) + turn(2, 2) - 1) / 2;
  return {std::hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2]), std::atan2(sine, cosine)};
}

class ExactAccuracy {
 public:
  ExactAccuracy(const Evaluation& e, std::span<const double> parameters)
      : e_(e),
        parameters_(parameters),
        inputs_(e.inputs(parameters, no_limits(e.model.info), 0)),
        bounds_(e.model.graph, e.model.joint_errors) {}

  PlatformError operator()(const Pose<double>& pose) const {
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    std::vector<double> inputs = inputs_;
    place(pose, inputs);
    const std::vector<double> bounds = outputs_of(bounds_, inputs), frame = outputs_of(e_.frame, inputs);
    const PoseReport report = inspect_sample(e_, parameters_, pose, inputs);
    if (!report.J || is_singular(*report.J)) return {kNaN, kNaN};
    PlatformError worst;
    const bool is_complete = visit_vertices(bounds, [&](const AxisVector<double>& change) {
      if (!find_pose(*report.joints + change, *report.J, pose, inputs)) return false;
      const PlatformError error = displacement(frame, outputs_of(e_.frame, inputs));
      worst = {std::fmax(worst.position, error.position), std::fmax(worst.angle, error.angle)};
      return true;
    });
    return is_complete ? worst : PlatformError{kNaN, kNaN};
  }

 private:
  void place(const Pose<double>& pose, std::vector<double>& inputs) const {
    std::ranges::copy(pose, inputs.begin() + static_cast<std::ptrdiff_t>(e_.model.inputs.coordinate(0)));
  }
  /// Finds the pose with the given joint positions and writes the coordinates of the last step but one, which are equal
  /// to rounding, to `inputs`.
  /// @return false if Newton's method does not converge
  bool find_pose(const AxisVector<double>& joints, const AxisMatrix<double>& J, const Pose<double>& near,
                 std::vector<double>& inputs) const {
    const auto correction = [&](const Pose<double>& pose) {
      place(pose, inputs);
      AxisVector<double> rest = joints;
      const std::vector<double> found = outputs_of(e_.joints, inputs);
      for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= found[i];
      return std::optional<AxisVector<double>>(solve(J, rest));
    };
    return refine_pose(near, correction).has_value();
  }

  const Evaluation& e_;
  std::span<const double> parameters_;
  std::vector<double> inputs_;
  expression::Program bounds_;
};

}  // namespace

std::vector<WorkspaceField> exact_accuracy_fields(const Mechanism& mechanism, std::span<const double> parameters,
                                                  const std::vector<Pose<double>>& poses) {
  const Evaluation* const e = evaluation_of(mechanism);
  if (!e || e->model.joint_errors.empty()) return {};
  std::vector<PlatformError> errors(poses.size());
  const ExactAccuracy at(*e, parameters);
  parallel_for(poses.size(), [&](std::size_t i, std::size_t end) {
    for (; i < end; ++i) {
      check_stop();
      errors[i] = at(poses[i]);
    }
  });
  std::vector<WorkspaceField> fields;
  const auto add = [&](const std::string& name, const std::string& unit, const std::string& what,
                       double PlatformError::*value) {
    if (!find_named(mechanism.info().quantities, name)) return;
    fields.push_back({name + "_exact", unit, "maximum " + what + " error of the platform", {}});
    for (const PlatformError& error : errors) fields.back().values.push_back(error.*value);
  };
  add("accuracy", "m", "position", &PlatformError::position);
  add("accuracy_angle", "rad", "orientation", &PlatformError::angle);
  return fields;
}

}  // namespace pkm::generic
