// Peak loads along a motion. The load is an actuator force, an actuator power (force times speed, driving or braking),
// a joint speed or a joint acceleration; for mechanisms with drive trains also a motor torque or a motor speed. The
// value is the maximum magnitude over the samples of the motion; for the motor torque, the root mean square is also
// available. Speeds and accelerations do not need masses. Gradient solvers use the power mean of the magnitudes instead
// of the maximum (power_mean).
//
// The values depend on the design only. They use neither a workspace analysis nor the limits of poses, which the
// constraint `motion` tests (constraints/motion.cpp). If the mechanism does not assemble at a sample, the value is NaN
// and the design `failed`, unless the constraint has rejected it; the reason states the time of the sample.
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/catalogue.hpp"
#include "engine/core/team.hpp"
#include "engine/core/unit.hpp"
#include "engine/math/statistics.hpp"
#include "engine/mechanism/inverse_dynamics.hpp"
#include "engine/problem/motion_options.hpp"
#include "engine/problem/pose_options.hpp"
#include "objectives/list.hpp"

namespace pkm {
namespace {

/// The magnitude that is evaluated for each actuator.
enum class Load { force, power, motor_torque, motor_speed, joint_speed, joint_acceleration };

/// Whether the load follows from the kinematics alone, without masses.
bool is_kinematic(Load load) {
  return load == Load::motor_speed || load == Load::joint_speed || load == Load::joint_acceleration;
}

/// Scratch memory for the loads of all samples, also if several threads compute them in batches.
template <class S>
struct LoadScratch {
  struct Batch {
    std::vector<S> loads;
    std::size_t assembled;  ///< number of samples before the first that does not assemble
  };
  std::vector<S> loads;
  std::vector<Batch> batches;
  std::vector<InverseDynamicsScratch<S>> by_worker;
};

class PeakLoad final : public Quantity {
 public:
  PeakLoad(const EntryContext& context, Load load)
      : motion_(context),
        mode_(mode_of(context)),
        wrench_(wrench_of(context)),
        joint_(context.options.word("joint")),
        sharpness_(context.options.number("sharpness")),
        load_(load),
        by_rms_(load == Load::motor_torque && context.options.word("statistic") == "rms") {
    if (const Unsupported reason = why_no_joint_forces(context.mechanism))
      no_forces_ = "joint speeds along a motion have no derivatives without dynamics: " + *reason;
  }

  Unsupported why_no_derivatives() const override { return no_forces_ ? no_forces_ : motion_.why_no_derivatives(); }

  double value(const DesignView<double>& design) const override {
    std::vector<double>& loads = design.scratch.get<LoadScratch<double>>().loads;
    if (collect(design, loads) < motion_.size()) return std::numeric_limits<double>::quiet_NaN();
    if (by_rms_) replace_by_rms(loads);
    double peak = 0;
    for (const double load : loads) {
      if (!std::isfinite(load)) return load;
      peak = std::fmax(peak, load);
    }
    return peak;
  }
  Dual4 smooth(const DesignView<Dual4>& design) const override {
    std::vector<Dual4>& loads = design.scratch.get<LoadScratch<Dual4>>().loads;
    const bool defined = collect(design, loads) == motion_.size() &&
                         std::ranges::all_of(loads, [](const Dual4& load) { return std::isfinite(load.a); });
    if (!defined) return Dual4(std::numeric_limits<double>::quiet_NaN());
    if (by_rms_) replace_by_rms(loads);
    return power_mean(loads, sharpness_);
  }
  std::string why_undefined(const DesignView<double>& design) const override {
    std::vector<double> loads;
    const std::size_t assembled = collect(design, loads);
    const auto samples = motion_.of(design);
    if (assembled < samples.size()) {
      const MotionSample& at = samples[assembled];
      const PoseReport report =
          design.mechanism.inspect(design.parameters, at.pose, mode_, no_limits(design.mechanism.info()));
      return "the motion " + motion_.name() + " leaves the reach of the mechanism at t = " + with_unit(at.time, "s") +
             (report.reason.empty() ? "" : " (" + report.reason + ")");
    }
    const auto infinite = std::find_if(loads.begin(), loads.end(), [](double load) { return !std::isfinite(load); });
    if (infinite == loads.end()) return {};
    const auto k = static_cast<std::size_t>(infinite - loads.begin()) * samples.size() / loads.size();
    return "the motion " + motion_.name() + " passes through a singularity at t = " + with_unit(samples[k].time, "s") +
           ", sample " + std::to_string(k + 1) + " of " + std::to_string(samples.size());
  }

 private:
  /// Computes the loads of all samples, up to the first at which the mechanism does not assemble. Returns the number of
  /// samples evaluated.
  template <class S>
  std::size_t collect(const DesignView<S>& design, std::vector<S>& loads) const {
    loads.clear();
    return motion_.with(design, [&](const auto& samples) { return collect(design, samples, loads); });
  }
  template <class S, class Sample>
  std::size_t collect(const DesignView<S>& design, std::span<const Sample> samples, std::vector<S>& loads) const {
    if constexpr (std::is_same_v<S, double>)
      if (no_forces_) return collect_rates(design, samples, loads);
    if (has_team()) return collect_with_team(design, samples, loads);
    return inverse_dynamics_of<S>(*design.mechanism.dynamics(), design.parameters, mode_, samples, wrench_,
                                  design.scratch.template get<InverseDynamicsScratch<S>>(),
                                  [&](std::size_t, const ActuatorState<S>& drive) { append(design, drive, loads); });
  }
  /// Computes the joint speeds or accelerations of all samples by influence coefficients, for mechanisms without joint
  /// forces. @return the number of samples before the first at which the mechanism does not assemble
  std::size_t collect_rates(const DesignView<double>& design, std::span<const MotionSample> samples,
                            std::vector<double>& loads) const {
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const MotionSample& at = samples[k];
      const auto joints = design.mechanism.velocities()->influence(design.parameters, at.pose, mode_);
      if (!joints) return k;
      append(design,
             ActuatorState<double>{.speeds = joints->G * at.velocity,
                                   .accelerations = accelerations(*joints, at.velocity, at.acceleration)},
             loads);
    }
    return samples.size();
  }
  template <class S, class Sample>
  std::size_t collect_with_team(const DesignView<S>& design, std::span<const Sample> samples,
                                std::vector<S>& loads) const {
    LoadScratch<S>& buffers = design.scratch.template get<LoadScratch<S>>();
    buffers.batches.resize((samples.size() + kInverseDynamicsBatch - 1) / kInverseDynamicsBatch);
    buffers.by_worker.resize(workers());
    parallel_for(buffers.batches.size(), [&](std::size_t number, std::size_t end, std::size_t worker) {
      for (; number < end; ++number) {
        typename LoadScratch<S>::Batch& batch = buffers.batches[number];
        batch.loads.clear();
        const auto some = samples.subspan(number * kInverseDynamicsBatch);
        batch.assembled = inverse_dynamics_of<S>(
            *design.mechanism.dynamics(), design.parameters, mode_,
            some.first(std::min(kInverseDynamicsBatch, some.size())), wrench_, buffers.by_worker[worker],
            [&](std::size_t, const ActuatorState<S>& drive) { append(design, drive, batch.loads); });
      }
    });
    std::size_t assembled = 0;
    for (std::size_t number = 0; number < buffers.batches.size() && assembled == number * kInverseDynamicsBatch;
         ++number) {
      const auto& batch = buffers.batches[number];
      loads.insert(loads.end(), batch.loads.begin(), batch.loads.end());
      assembled += batch.assembled;
    }
    return assembled;
  }
  /// Appends the loads of one sample: of the selected joint, of all joints ("worst"), or their sum ("total").
  template <class S>
  void append(const DesignView<S>& design, const ActuatorState<S>& drive, std::vector<S>& loads) const {
    S total(0.0);
    for (std::size_t i = 0; i < drive.speeds.size(); ++i) {
      const S load = load_of(design, drive, i);
      total += load;
      if (joint_ == "worst" || joint_[0] == static_cast<char>('1' + i)) loads.push_back(magnitude(load));
    }
    if (joint_ == "total") loads.push_back(magnitude(total));
  }
  template <class S>
  S load_of(const DesignView<S>& design, const ActuatorState<S>& drive, std::size_t joint) const {
    if (load_ == Load::force) return drive.forces[joint];
    if (load_ == Load::power) return drive.power(joint);
    if (load_ == Load::joint_speed) return drive.speeds[joint];
    if (load_ == Load::joint_acceleration) return drive.accelerations[joint];
    const DriveTrain& train = (*design.mechanism.drive_trains())[joint];
    return load_ == Load::motor_torque ? drive.torque(train, joint) : drive.speeds[joint] * train.ratio;
  }
  /// Replaces the loads by one root mean square per joint over the samples.
  template <class S>
  void replace_by_rms(std::vector<S>& loads) const {
    const std::size_t joints = loads.size() / motion_.size();
    for (std::size_t j = 0; j < joints; ++j) {
      S sum(0.0);
      for (std::size_t k = j; k < loads.size(); k += joints) sum += loads[k] * loads[k];
      loads[j] = sqrt_or_zero(S(sum / static_cast<double>(motion_.size())));
    }
    loads.resize(joints);
  }

  SampledMotion motion_;
  std::string mode_;
  Wrench<double> wrench_;
  std::string joint_;
  double sharpness_;
  Load load_;
  bool by_rms_;
  Unsupported no_forces_;
};

/// @param joints  words that the option `joint` accepts besides joint numbers; the first is the default
/// @param forces  whether the load depends on a wrench on the platform
std::vector<OptionSpec> load_options(const std::vector<std::string>& joints, bool forces = true) {
  std::vector<OptionSpec> options = {
      motion_option(),
      {.name = "joint",
       .kind = OptionKind::word,
       .initial = joints.front(),
       .choices = joint_choices(joints),
       .meaning = "number of the joint; worst: the maximum over all joints" +
                  std::string(joints.size() > 1 ? "; total: the sum over the joints" : "")},
      samples_option(),
      mode_option(),
      wrench_option(),
      {.name = "sharpness",
       .initial = 200.0,
       .lower = 1,
       .upper = 1e6,
       .meaning = "exponent of the power mean, the smooth approximation of the peak for gradient solvers; larger is "
                  "more accurate"},
  };
  if (!forces) std::erase_if(options, [](const OptionSpec& option) { return option.name == "wrench"; });
  return options;
}

/// The unit of the selected joints. Throws std::invalid_argument if "worst" would compare prismatic and revolute
/// joints.
/// @param what  the loads with their units, for the message: "forces [N] and torques [N m]"
std::string unit_of_joints(const EntryContext& context, const std::string& what, const std::string& prismatic,
                           const std::string& revolute) {
  const auto& joints = context.mechanism.info().joints;
  const std::string& joint = context.options.word("joint");
  validate_joint(context.mechanism, joint);
  const bool turns = (joint == "worst" ? joints.front() : joints[static_cast<std::size_t>(joint[0] - '1')]).turns();
  if (joint == "worst" && std::ranges::any_of(joints, [turns](const AxisInfo& j) { return j.turns() != turns; }))
    throw std::invalid_argument("mechanism " + context.mechanism.info().name + " has prismatic and revolute joints: " +
                                what + " cannot be compared; select one joint");
  return turns ? revolute : prismatic;
}
std::string force_unit(const EntryContext& context) {
  return unit_of_joints(context, "forces [N] and torques [N m]", "N", "N m");
}
std::string speed_unit(const EntryContext& context) {
  return unit_of_joints(context, "speeds [m/s] and [rad/s]", "m/s", "rad/s");
}
std::string acceleration_unit(const EntryContext& context) {
  return unit_of_joints(context, "accelerations [m/s^2] and [rad/s^2]", "m/s^2", "rad/s^2");
}

Unsupported check_speeds(const std::string& objective, const Mechanism& mechanism) {
  if (mechanism.velocities() || !why_no_joint_forces(mechanism)) return {};
  return "objective " + objective + " needs joint speeds, and mechanism " + mechanism.info().name +
         " has neither influence coefficients nor masses";
}

Unsupported check_drive_trains(const std::string& objective, const Mechanism& mechanism) {
  if (mechanism.drive_trains()) return {};
  return "objective " + objective + " needs drive trains, and mechanism " + mechanism.info().name +
         " has none; define them in the study in [[drive_train]]";
}

std::vector<OptionSpec> torque_options() {
  std::vector<OptionSpec> options = load_options({"worst"});
  options.push_back({.name = "statistic",
                     .kind = OptionKind::word,
                     .initial = std::string("peak"),
                     .choices = {"peak", "rms"},
                     .meaning = "peak: maximum over the samples; rms: root mean square over the samples"});
  return options;
}

/// @param what  name of the load with spaces: "peak force" (listed as "peak force of joint 2 along the motion pick")
ObjectiveEntry load_entry(Load load, const std::string& what, const std::string& meaning,
                          const std::vector<OptionSpec>& options, std::string (*unit)(const EntryContext&)) {
  std::string name = what;
  std::ranges::replace(name, ' ', '-');
  const bool of_motor = load == Load::motor_torque || load == Load::motor_speed;
  return {
      .name = name,
      .meaning = meaning,
      .direction = Direction::minimise,
      .options = options,
      .unit = unit,
      .refusal =
          [name, load, of_motor](const Mechanism& mechanism) {
            Unsupported reason = is_kinematic(load) ? check_speeds(name, mechanism) : check_dynamics(name, mechanism);
            if (!reason && of_motor) reason = check_drive_trains(name, mechanism);
            return reason;
          },
      .make = [load](const EntryContext& context) { return std::make_unique<PeakLoad>(context, load); },
      .detail =
          [what](const EntryContext& context) {
            const std::string& joint = context.options.word("joint");
            validate_joint(context.mechanism, joint);
            const std::string of = joint == "worst"   ? "the worst joint"
                                   : joint == "total" ? "all joints together"
                                                      : "joint " + joint;
            const bool rms = context.options.has("statistic") && context.options.word("statistic") == "rms";
            return (rms ? "RMS " : "") + what + " of " + of + " along the motion " + context.options.word("motion");
          },
      .range = nonnegative,
      .uses_workspace = false,
  };
}

}  // namespace

std::vector<ObjectiveEntry> peak_objectives() {
  return {
      load_entry(Load::force, "peak force", "maximum force of the actuators along a motion", load_options({"worst"}),
                 force_unit),
      load_entry(Load::power, "peak power", "maximum power of the actuators along a motion, driving or braking",
                 load_options({"worst", "total"}), [](const EntryContext&) { return std::string("W"); }),
      load_entry(Load::motor_torque, "motor torque", "torque of the motors along a motion, with drive trains",
                 torque_options(), [](const EntryContext&) { return std::string("N m"); }),
      load_entry(Load::motor_speed, "motor speed", "maximum speed of the motors along a motion, with drive trains",
                 load_options({"worst"}, false), [](const EntryContext&) { return std::string("rad/s"); }),
      load_entry(Load::joint_speed, "joint speed", "maximum speed of the joints along a motion",
                 load_options({"worst"}, false), speed_unit),
      load_entry(Load::joint_acceleration, "joint acceleration", "maximum acceleration of the joints along a motion",
                 load_options({"worst"}, false), acceleration_unit)};
}

}  // namespace pkm
