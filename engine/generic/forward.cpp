#include "engine/generic/forward.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/generic/rigid_pose.hpp"

namespace pkm::generic {
namespace {

bool is_finite(std::span<const double> values) {
  return std::ranges::all_of(values, [](double x) { return std::isfinite(x); });
}

/// The residuals f(pose) of the loop-closure equations for given joint positions. Only the constructor allocates
/// memory.
class LoopClosure {
 public:
  LoopClosure(const Evaluation& e, std::span<const double> parameters, const AxisVector<double>& joints,
              std::size_t mode)
      : program_(e.closures),
        first_(e.model.inputs.coordinate(0)),
        inputs_(e.inputs(parameters, no_limits(e.model.info), mode)) {
    std::ranges::copy(joints, inputs_.begin() + static_cast<std::ptrdiff_t>(e.model.inputs.joint(0)));
    dual_inputs_.assign(inputs_.begin(), inputs_.end());
    registers_.resize(program_.registers());
    dual_registers_.resize(program_.registers());
  }

  AxisVector<double> at(const Pose<double>& pose) {
    std::ranges::copy(pose, inputs_.begin() + static_cast<std::ptrdiff_t>(first_));
    program_.run_all<double>(inputs_, std::span(registers_));
    AxisVector<double> f(program_.outputs().size());
    for (std::size_t i = 0; i < f.size(); ++i) f[i] = registers_[program_.outputs()[i]];
    return f;
  }
  /// Derivatives of f with respect to the coordinates, by forward-mode automatic differentiation in blocks of four.
  AxisMatrix<double> jacobian(const Pose<double>& pose) {
    constexpr std::size_t kBlock = Dual4::kDerivatives;
    AxisMatrix<double> G(program_.outputs().size(), pose.size());
    for (std::size_t from = 0; from < pose.size(); from += kBlock) {
      const std::size_t count = std::min(kBlock, pose.size() - from);
      for (std::size_t j = 0; j < pose.size(); ++j) dual_inputs_[first_ + j] = pose[j];
      for (std::size_t j = 0; j < count; ++j) dual_inputs_[first_ + from + j].v[static_cast<int>(j)] = 1;
      program_.run_all<Dual4>(dual_inputs_, std::span(dual_registers_));
      for (std::size_t i = 0; i < G.rows(); ++i)
        for (std::size_t j = 0; j < count; ++j)
          G(i, from + j) = dual_registers_[program_.outputs()[i]].v[static_cast<int>(j)];
    }
    return G;
  }

 private:
  const expression::Program& program_;
  std::size_t first_;  ///< index of the first coordinate among the inputs of the graph
  std::vector<double> inputs_, registers_;
  std::vector<Dual4> dual_inputs_, dual_registers_;
};

struct Solution {
  /// The pose to which Newton's method converged; std::nullopt if it did not converge.
  std::optional<Pose<double>> pose;
  bool is_defined_at_start = false;  ///< true: all residuals of the loop-closure equations are finite at the start pose
};

/// Solves the loop-closure equations by Newton's method with bounded steps, to rounding accuracy.
Solution solve_closures(LoopClosure& closure, Pose<double> pose) {
  constexpr int kMaxIterations = 60, kMaxHalvings = 10;
  constexpr double kMaxStep = 0.5;  // maximum step in a coordinate, relative to 1 + |coordinate| [m, rad]
  // Once the relative step size is smaller than this, the iteration ends as soon as the steps do not shrink by half any
  // more.
  constexpr double kConverged = 1e-9;
  double last_size = std::numeric_limits<double>::infinity();
  AxisVector<double> f = closure.at(pose);
  const bool is_defined_at_start = is_finite(f);
  for (int i = 0; i < kMaxIterations && is_finite(f); ++i) {
    const AxisVector<double> step = solve(closure.jacobian(pose), f * -1.0);
    if (!is_finite(step)) break;
    double size = 0;
    for (std::size_t k = 0; k < pose.size(); ++k) size = std::max(size, std::fabs(step[k]) / (1 + std::fabs(pose[k])));
    double factor = std::min(1.0, kMaxStep / std::max(size, 1e-300));
    const Pose<double> previous = pose;
    // Halve the step until all residuals are finite.
    for (int halvings = 0; halvings < kMaxHalvings; ++halvings, factor /= 2) {
      pose = previous + step * factor;
      f = closure.at(pose);
      if (is_finite(f)) break;
    }
    if (size == 0 || (size < kConverged && size >= last_size / 2)) return {pose, true};
    last_size = size;
  }
  return {{}, is_defined_at_start};
}

/// The working mode in which the inverse kinematics gives the given joint positions at a pose; "" if there is none.
std::string mode_with(const Evaluation& e, std::span<const double> parameters, const Pose<double>& pose,
                      const AxisVector<double>& joints) {
  const MechanismInfo& info = e.model.info;
  for (std::size_t mode = 0; mode < info.modes.size(); ++mode) {
    std::vector<double> inputs = e.inputs(parameters, no_limits(info), mode);
    std::ranges::copy(pose, inputs.begin() + static_cast<std::ptrdiff_t>(e.model.inputs.coordinate(0)));
    const auto same = [](double x, double y) { return std::fabs(x - y) <= 1e-7 * (1 + std::fabs(y)); };
    if (std::ranges::equal(outputs_of(e.joints, inputs), joints, same)) return info.modes[mode];
  }
  return "";
}

/// Indices of the working modes whose loop-closure equations have to be solved separately: all modes if the equations
/// contain signs of the working mode, as only those given by formulas can; otherwise a single one.
std::vector<std::size_t> modes_of_closures(const Model& model) {
  const auto is_sign = [&](Node node) {
    const auto input = static_cast<std::size_t>(model.graph[node].input);
    return model.graph[node].input >= 0 && input >= model.inputs.sign(0) && input < model.inputs.coordinate(0);
  };
  const bool signs = std::ranges::any_of(model.graph.reachable(model.closures), is_sign);
  std::vector<std::size_t> modes(signs ? model.info.modes.size() : 1);
  std::iota(modes.begin(), modes.end(), std::size_t{0});
  return modes;
}

/// Start poses in the search box of the mechanism file: the centre, then a Kronecker sequence.
class StartPoses {
 public:
  StartPoses(const Evaluation& e, std::span<const double> parameters) {
    for (std::size_t i = 0; i < e.model.inputs.coordinates; ++i)
      ranges_.push_back(e.range(parameters, no_limits(e.model.info), 0, i).value_or(std::array{-1.0, 1.0}));
  }
  Pose<double> operator[](std::size_t number) const {
    Pose<double> pose(ranges_.size());
    for (std::size_t i = 0; i < pose.size(); ++i) {
      const double fraction =
          0.5 + static_cast<double>(number) * std::sqrt(static_cast<double>(std::array{2, 3, 5, 7, 11, 13}[i]));
      pose[i] = ranges_[i][0] + (fraction - std::floor(fraction)) * (ranges_[i][1] - ranges_[i][0]);
    }
    return pose;
  }

 private:
  std::vector<std::array<double, 2>> ranges_;
};

/// The assembly modes found so far; no two of them have the same rigid-body pose.
class AssemblySet {
 public:
  enum class Angles { principal, as_found };

  AssemblySet(const Evaluation& e, std::span<const double> parameters, const AxisVector<double>& joints, Angles angles)
      : e_(e), parameters_(parameters), joints_(joints), angles_(angles) {}

  /// Adds a pose if the inverse kinematics of a working mode reproduces the joint positions there, and if no earlier
  /// pose is the same rigid-body pose.
  /// @return true if it was added
  bool add(Pose<double> pose) {
    const Model& model = e_.model;
    for (std::size_t i = 0; i < pose.size(); ++i)
      if (model.rotation_axes[i]) pose[i] = wrapped(pose[i]);
    std::string working_mode = mode_with(e_, parameters_, pose, joints_);
    if (working_mode.empty()) return false;
    const RigidPose rigid = rigid_pose(e_, inputs(pose, working_mode));
    const auto is_same = [&](std::size_t k) {
      return is_same_pose(model, modes_[k].pose, rigid_[k], pose, rigid, kSamePose);
    };
    for (std::size_t k = 0; k < modes_.size(); ++k)
      if (is_same(k)) return false;
    if (angles_ == Angles::principal) make_principal(pose, rigid, working_mode);
    const double size = std::fabs(*std::ranges::max_element(pose, {}, [](double x) { return std::fabs(x); }));
    for (double& x : pose)
      if (std::fabs(x) < 1e-14 * size) x = 0;  // replace a rounding error by 0
    modes_.push_back(
        {.pose = pose, .mode = "found " + std::to_string(modes_.size() + 1), .working_mode = working_mode});
    rigid_.push_back(rigid);
    return true;
  }

  const std::vector<AssemblyMode>& modes() const { return modes_; }
  /// The mirror image (mirror_image()) of the assembly mode with index k, as a pose.
  std::optional<Pose<double>> mirrored(std::size_t k) const {
    return mirror_image(e_, inputs(modes_[k].pose, modes_[k].working_mode));
  }

 private:
  // Poses whose difference is smaller [m, or 1 for rotation matrices] are equal. This threshold is 1000 times the error
  // of Newton's method.
  static constexpr double kSamePose = 1e-6;

  /// Replaces the angles of a pose by equivalent angles in the principal ranges (rigid_pose.hpp), unless no working
  /// mode's inverse kinematics reproduces the joint positions at the new pose.
  void make_principal(Pose<double>& pose, const RigidPose& rigid, std::string& working_mode) const {
    Pose<double> principal = pose;
    set_angles(e_.model, rigid.rotation, principal);
    const auto is_near = [](double x, double y) { return std::fabs(wrapped(x - y)) < kSamePose; };
    if (std::ranges::equal(principal, pose, is_near)) return;
    const std::string mode = mode_with(e_, parameters_, principal, joints_);
    if (mode.empty() ||
        !is_same_pose(e_.model, principal, rigid_pose(e_, inputs(principal, mode)), pose, rigid, kSamePose))
      return;
    pose = principal;
    working_mode = mode;
  }

  std::vector<double> inputs(const Pose<double>& pose, const std::string& mode) const {
    const MechanismInfo& info = e_.model.info;
    std::vector<double> inputs = e_.inputs(parameters_, no_limits(info), mode_index(info, mode));
    std::ranges::copy(pose, inputs.begin() + static_cast<std::ptrdiff_t>(e_.model.inputs.coordinate(0)));
    return inputs;
  }

  const Evaluation& e_;
  std::span<const double> parameters_;
  const AxisVector<double>& joints_;
  Angles angles_;
  std::vector<AssemblyMode> modes_;
  std::vector<RigidPose> rigid_;  ///< rigid-body pose of each assembly mode in modes_, by index
};

}  // namespace

std::vector<AssemblyMode> assemblies_of(const Evaluation& e, std::span<const double> parameters,
                                        const AxisVector<double>& joints) {
  const StartPoses poses(e, parameters);
  AssemblySet found(e, parameters, joints, AssemblySet::Angles::principal);
  std::vector<LoopClosure> closures;  // one element for each working mode of modes_of_closures()
  for (const std::size_t mode : modes_of_closures(e.model)) {
    LoopClosure& of_mode = closures.emplace_back(e, parameters, joints, mode);
    // Number of consecutive starts that found no new pose, not counting starts at which the loop-closure equations are
    // undefined.
    std::size_t idle = 0;
    for (std::size_t tried = 0; tried < kMaxStarts && idle < kMaxIdleStarts; ++tried) {
      const Solution solution = solve_closures(of_mode, poses[tried]);
      idle += solution.is_defined_at_start;
      if (solution.pose && found.add(*solution.pose)) idle = 0;
    }
  }
  // The set grows in this loop, so that mirror images of mirror images are also added.
  for (std::size_t k = 0; k < found.modes().size(); ++k)
    if (const auto start = found.mirrored(k))
      for (LoopClosure& of_mode : closures)
        if (const Solution solution = solve_closures(of_mode, *start); solution.pose) found.add(*solution.pose);
  return found.modes();
}

std::vector<AssemblyMode> assemblies_near(const Evaluation& e, std::span<const double> parameters,
                                          const AxisVector<double>& joints, const Pose<double>& from) {
  AssemblySet found(e, parameters, joints, AssemblySet::Angles::as_found);
  for (const std::size_t mode : modes_of_closures(e.model)) {
    LoopClosure closure(e, parameters, joints, mode);
    if (const Solution solution = solve_closures(closure, from); solution.pose) found.add(*solution.pose);
  }
  return found.modes();
}

}  // namespace pkm::generic
