// Greatest magnitude along a motion, over its samples, of an actuator's force, of its power (force times speed, driving
// or braking), of its speed and acceleration, and with drive trains of its motor's torque and speed; of the torque also
// the root of the mean square. Speeds and accelerations need no masses.
// Gradient solvers see the power mean of the magnitudes (power_mean).
//
// They depend on the design alone: no survey, and none of the limits of poses, which the constraint `motion` tests
// (constraints/motion.cpp). Where the mechanism does not assemble somewhere along the motion there is no force: the
// value is NaN, the design `failed` unless the constraint has rejected it, and the reason names the time.
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/catalogue.hpp"
#include "engine/core/team.hpp"
#include "engine/core/unit.hpp"
#include "engine/math/statistics.hpp"
#include "engine/mechanism/drive_along.hpp"
#include "engine/problem/motion_options.hpp"
#include "engine/problem/pose_options.hpp"
#include "objectives/list.hpp"

namespace pkm {
namespace {

/// What is looked at of each actuator.
enum class Load { force, power, motor_torque, motor_speed, joint_speed, joint_acceleration };

/// Speeds and accelerations need no masses.
bool is_kinematic(Load load) {
  return load == Load::motor_speed || load == Load::joint_speed || load == Load::joint_acceleration;
}

Wrench<double> wrench_of(const Options& options) {
  Wrench<double> wrench;
  if (!options.has("wrench")) return wrench;
  const NamedNumbers& given = options.numbers("wrench");
  for (std::size_t i = 0; i < wrench_names().size(); ++i)
    if (const auto at = given.find(wrench_names()[i]); at != given.end()) wrench[i] = at->second;
  return wrench;
}

/// Room for the samples' loads, and for what is found by several threads.
template <class S>
struct Loads {
  struct Batch {
    std::vector<S> loads;
    std::size_t assembled;
  };
  std::vector<S> of_samples;
  std::vector<Batch> batches;
  std::vector<DriveScratch<S>> of_workers;
};

class AlongMotion final : public Quantity {
 public:
  AlongMotion(const EntryContext& context, Load load)
      : name_(motion_of(context).name),
        samples_(samples_of(context)),
        mode_(mode_of(context)),
        wrench_(wrench_of(context.options)),
        joint_(context.options.word("joint")),
        sharpness_(context.options.number("sharpness")),
        load_(load),
        by_rms_(load == Load::motor_torque && context.options.word("statistic") == "rms") {
    if (const Refusal reason = no_joint_forces(context.mechanism))
      why_no_derivatives_ = "speeds of the joints along a motion have none here: " + *reason;
  }

  Refusal no_derivatives() const override { return why_no_derivatives_; }

  double value(const DesignView<double>& design) const override {
    std::vector<double>& loads = design.scratch.get<Loads<double>>().of_samples;
    if (collect(design, loads) < samples_.size()) return std::numeric_limits<double>::quiet_NaN();
    if (by_rms_) take_roots_of_mean_squares(loads);
    double greatest = 0;
    for (const double load : loads) {
      if (!std::isfinite(load)) return load;
      greatest = std::fmax(greatest, load);
    }
    return greatest;
  }
  Dual4 smooth(const DesignView<Dual4>& design) const override {
    std::vector<Dual4>& loads = design.scratch.get<Loads<Dual4>>().of_samples;
    const bool known = collect(design, loads) == samples_.size() &&
                       std::ranges::all_of(loads, [](const Dual4& load) { return std::isfinite(load.a); });
    if (!known) return Dual4(std::numeric_limits<double>::quiet_NaN());
    if (by_rms_) take_roots_of_mean_squares(loads);
    return power_mean(loads, sharpness_);
  }
  std::string why_undefined(const DesignView<double>& design) const override {
    std::vector<double> loads;
    const std::size_t last = collect(design, loads);
    if (last < samples_.size()) {
      const MotionSample& at = samples_[last];
      const PoseReport report =
          design.mechanism.inspect(design.parameters, at.pose, mode_, no_limits(design.mechanism.info()));
      return "the motion " + name_ + " leaves the reach of the mechanism at t = " + with_unit(at.time, "s") +
             (report.reason.empty() ? "" : " (" + report.reason + ")");
    }
    const auto infinite = std::find_if(loads.begin(), loads.end(), [](double load) { return !std::isfinite(load); });
    if (infinite == loads.end()) return {};
    const auto k = static_cast<std::size_t>(infinite - loads.begin()) * samples_.size() / loads.size();
    return "the motion " + name_ + " meets a singularity at t = " + with_unit(samples_[k].time, "s") + ", sample " +
           std::to_string(k + 1) + " of " + std::to_string(samples_.size());
  }

 private:
  /// The loads of all samples, or of those before the first at which the mechanism does not assemble.
  template <class S>
  std::size_t collect(const DesignView<S>& design, std::vector<S>& loads) const {
    loads.clear();
    if constexpr (std::is_same_v<S, double>)
      if (why_no_derivatives_) return collect_rates(design, loads);
    if (has_team()) return collect_with_team(design, loads);
    return drive_along<S>(*design.mechanism.dynamics(), design.parameters, mode_, samples_, wrench_,
                          design.scratch.template get<DriveScratch<S>>(),
                          [&](std::size_t, const Drive<S>& drive) { append(design, drive, loads); });
  }
  /// By influence coefficients, of mechanisms whose drives have no forces.
  std::size_t collect_rates(const DesignView<double>& design, std::vector<double>& loads) const {
    for (std::size_t k = 0; k < samples_.size(); ++k) {
      const MotionSample& at = samples_[k];
      const auto joints = design.mechanism.velocities()->influence(design.parameters, at.pose, mode_);
      if (!joints) return k;
      append(design,
             Drive<double>{.speeds = joints->G * at.velocity,
                           .accelerations = accelerations<double, 0>(*joints, at.velocity, at.acceleration)},
             loads);
    }
    return samples_.size();
  }
  template <class S>
  std::size_t collect_with_team(const DesignView<S>& design, std::vector<S>& loads) const {
    Loads<S>& room = design.scratch.template get<Loads<S>>();
    room.batches.resize((samples_.size() + kDriveBatch - 1) / kDriveBatch);
    room.of_workers.resize(workers());
    share_pieces(room.batches.size(), [&](std::size_t number, std::size_t end, std::size_t worker) {
      for (; number < end; ++number) {
        typename Loads<S>::Batch& batch = room.batches[number];
        batch.loads.clear();
        const auto some = std::span(samples_).subspan(number * kDriveBatch);
        batch.assembled =
            drive_along<S>(*design.mechanism.dynamics(), design.parameters, mode_,
                           some.first(std::min(kDriveBatch, some.size())), wrench_, room.of_workers[worker],
                           [&](std::size_t, const Drive<S>& drive) { append(design, drive, batch.loads); });
      }
    });
    std::size_t assembled = 0;
    for (std::size_t number = 0; number < room.batches.size() && assembled == number * kDriveBatch; ++number) {
      const auto& batch = room.batches[number];
      loads.insert(loads.end(), batch.loads.begin(), batch.loads.end());
      assembled += batch.assembled;
    }
    return assembled;
  }
  /// Appends those of one sample, of the joints looked at.
  template <class S>
  void append(const DesignView<S>& design, const Drive<S>& drive, std::vector<S>& loads) const {
    S total(0.0);
    for (std::size_t i = 0; i < drive.speeds.size(); ++i) {
      const S load = load_of(design, drive, i);
      total += load;
      if (joint_ == "worst" || joint_[0] == static_cast<char>('1' + i)) loads.push_back(magnitude(load));
    }
    if (joint_ == "total") loads.push_back(magnitude(total));
  }
  template <class S>
  S load_of(const DesignView<S>& design, const Drive<S>& drive, std::size_t joint) const {
    if (load_ == Load::force) return drive.forces[joint];
    if (load_ == Load::power) return drive.power(joint);
    if (load_ == Load::joint_speed) return drive.speeds[joint];
    if (load_ == Load::joint_acceleration) return drive.accelerations[joint];
    const DriveTrain& train = (*design.mechanism.drive_trains())[joint];
    return load_ == Load::motor_torque ? drive.torque(train, joint) : drive.speeds[joint] * train.ratio;
  }
  /// Of each joint over the samples, in place of its loads.
  template <class S>
  void take_roots_of_mean_squares(std::vector<S>& loads) const {
    const std::size_t joints = loads.size() / samples_.size();
    for (std::size_t j = 0; j < joints; ++j) {
      S sum(0.0);
      for (std::size_t k = j; k < loads.size(); k += joints) sum += loads[k] * loads[k];
      loads[j] = root_or_zero(S(sum / static_cast<double>(samples_.size())));
    }
    loads.resize(joints);
  }

  std::string name_;
  std::vector<MotionSample> samples_;
  std::string mode_;
  Wrench<double> wrench_;
  std::string joint_;
  double sharpness_;
  Load load_;
  bool by_rms_;
  Refusal why_no_derivatives_;
};

/// @param joints  the words that `joint` knows besides numbers; the first is the default
/// @param forces  whether they depend on a wrench
std::vector<OptionSpec> load_options(const std::vector<std::string>& joints, bool forces = true) {
  std::vector<std::pair<std::string, std::string>> wrench;
  for (std::size_t i = 0; i < wrench_names().size(); ++i) wrench.emplace_back(wrench_names()[i], i < 3 ? "N" : "N m");
  std::vector<OptionSpec> options = {
      motion_option(),
      {.name = "joint",
       .kind = OptionKind::word,
       .initial = joints.front(),
       .choices = numbers_of_joints(joints),
       .meaning = "the joint looked at; worst: the greatest of all joints" +
                  std::string(joints.size() > 1 ? "; total: the sum over the joints" : "")},
      samples_option(),
      mode_option(),
      {.name = "wrench",
       .kind = OptionKind::named_numbers,
       .meaning = "force and moment on the platform, the same all the time; default: none",
       .fields = wrench},
      {.name = "sharpness",
       .initial = 200.0,
       .lower = 1,
       .upper = 1e6,
       .meaning = "of the smooth stand-in for the peak that gradient solvers are given, the mean of powers of this "
                  "exponent: larger is nearer"},
  };
  if (!forces) std::erase_if(options, [](const OptionSpec& option) { return option.name == "wrench"; });
  return options;
}

/// The unit that the joints looked at share. Throws std::invalid_argument where they have different ones.
/// @param what  "forces [N] and torques [N m]"
std::string unit_of_joints(const EntryContext& context, const std::string& what, const std::string& of_slides,
                           const std::string& of_turns) {
  const auto& joints = context.mechanism.info().joints;
  const std::string& joint = context.options.word("joint");
  refuse_unknown_joint(context.mechanism, joint);
  const bool turns = (joint == "worst" ? joints.front() : joints[static_cast<std::size_t>(joint[0] - '1')]).turns();
  if (joint == "worst" && std::ranges::any_of(joints, [turns](const AxisInfo& j) { return j.turns() != turns; }))
    throw std::invalid_argument("mechanism " + context.mechanism.info().name + " has joints of both kinds, whose " +
                                what + " have no greatest; name a joint");
  return turns ? of_turns : of_slides;
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

Refusal refuse_without_speeds(const std::string& objective, const Mechanism& mechanism) {
  if (mechanism.velocities() || !no_joint_forces(mechanism)) return {};
  return "objective " + objective + " needs speeds of the joints, and mechanism " + mechanism.info().name +
         " has neither influence coefficients nor masses";
}

Refusal refuse_without_drive_trains(const std::string& objective, const Mechanism& mechanism) {
  if (mechanism.drive_trains()) return {};
  return "objective " + objective + " needs drive trains, and mechanism " + mechanism.info().name +
         " has none; a study gives it some in [[drive_train]]";
}

std::vector<OptionSpec> torque_options() {
  std::vector<OptionSpec> options = load_options({"worst"});
  options.push_back({.name = "statistic",
                     .kind = OptionKind::word,
                     .initial = std::string("peak"),
                     .choices = {"peak", "rms"},
                     .meaning = "the greatest, or the root of the mean square over the samples"});
  return options;
}

/// @param what  "peak force", for listings: "peak force of joint 2 along the motion pick"
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
            Refusal reason =
                is_kinematic(load) ? refuse_without_speeds(name, mechanism) : refuse_without_dynamics(name, mechanism);
            if (!reason && of_motor) reason = refuse_without_drive_trains(name, mechanism);
            return reason;
          },
      .make = [load](const EntryContext& context) { return std::make_unique<AlongMotion>(context, load); },
      .detail =
          [what](const EntryContext& context) {
            const std::string& joint = context.options.word("joint");
            refuse_unknown_joint(context.mechanism, joint);
            const std::string of = joint == "worst"   ? "the worst joint"
                                   : joint == "total" ? "all joints together"
                                                      : "joint " + joint;
            const bool rms = context.options.has("statistic") && context.options.word("statistic") == "rms";
            return (rms ? "RMS " : "") + what + " of " + of + " along the motion " + context.options.word("motion");
          },
      .range = not_negative,
      .reads_survey = false,
  };
}

}  // namespace

std::vector<ObjectiveEntry> peak_objectives() {
  return {
      load_entry(Load::force, "peak force", "greatest force of the actuators along a motion", load_options({"worst"}),
                 force_unit),
      load_entry(Load::power, "peak power", "greatest power of the actuators along a motion, driving or braking",
                 load_options({"worst", "total"}), [](const EntryContext&) { return std::string("W"); }),
      load_entry(Load::motor_torque, "motor torque", "torque of the motors along a motion, with drive trains",
                 torque_options(), [](const EntryContext&) { return std::string("N m"); }),
      load_entry(Load::motor_speed, "motor speed", "greatest speed of the motors along a motion, with drive trains",
                 load_options({"worst"}, false), [](const EntryContext&) { return std::string("rad/s"); }),
      load_entry(Load::joint_speed, "joint speed", "greatest speed of the joints along a motion",
                 load_options({"worst"}, false), speed_unit),
      load_entry(Load::joint_acceleration, "joint acceleration", "greatest acceleration of the joints along a motion",
                 load_options({"worst"}, false), acceleration_unit)};
}

}  // namespace pkm
