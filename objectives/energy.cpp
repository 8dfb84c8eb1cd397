// Energy of the drives over a motion, by the trapezoidal rule over its samples: of the joints (force times speed), or
// of the motors (torque times speed) if there are drive trains. With recuperation, it is the integral of the total
// power; without recuperation, it is the integral of the positive powers of the single drives.
//
// With the option `law`, the motion is the fastest one along the same path (cycle_time.cpp), and the rule is applied to
// the intervals of its nodes.
//
// The value depends on the design only. If the mechanism does not assemble at a sample, the value is NaN and the design
// `failed`, unless the constraint `motion` has rejected it.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "engine/core/error.hpp"
#include "engine/core/unit.hpp"
#include "engine/mechanism/inverse_dynamics.hpp"
#include "engine/problem/fastest_options.hpp"
#include "engine/problem/pose_options.hpp"
#include "objectives/list.hpp"

namespace pkm {
namespace {

class Energy final : public Quantity {
 public:
  explicit Energy(const EntryContext& context)
      : motion_(context),
        mode_(mode_of(context)),
        wrench_(wrench_of(context)),
        recuperates_(context.options.flag("recuperation")) {}

  Unsupported why_no_derivatives() const override { return motion_.why_no_derivatives(); }
  double value(const DesignView<double>& design) const override { return integral(design).energy; }
  Dual4 smooth(const DesignView<Dual4>& design) const override { return integral(design).energy; }
  std::string why_undefined(const DesignView<double>& design) const override {
    const Integral<double> found = integral(design);
    if (std::isfinite(found.energy)) return {};
    const auto samples = motion_.of(design);
    if (found.samples == samples.size()) return "the motion " + motion_.name() + " passes through a singularity";
    return "the motion " + motion_.name() +
           " leaves the reach of the mechanism at t = " + with_unit(samples[found.samples].time, "s");
  }

 private:
  template <class S>
  struct Integral {
    S energy;
    std::size_t samples;  ///< number of samples before the first that does not assemble
  };

  template <class S>
  Integral<S> integral(const DesignView<S>& design) const {
    return motion_.with(design, [&](const auto& samples) { return integral(design, samples); });
  }
  template <class S, class Sample>
  Integral<S> integral(const DesignView<S>& design, std::span<const Sample> samples) const {
    Integral<S> found{S(0.0), 0};
    const DriveTrains* const trains = design.mechanism.drive_trains();
    const S step = S(samples.back().time) / static_cast<double>(samples.size() - 1);
    found.samples = inverse_dynamics_of<S>(
        *design.mechanism.dynamics(), design.parameters, mode_, samples, wrench_,
        design.scratch.template get<InverseDynamicsScratch<S>>(), [&](std::size_t k, const ActuatorState<S>& drive) {
          const S weight = k == 0 || k + 1 == samples.size() ? S(step * 0.5) : step;
          for (std::size_t i = 0; i < drive.speeds.size(); ++i) {
            const S power =
                trains ? S(drive.torque((*trains)[i], i) * drive.speeds[i] * (*trains)[i].ratio) : drive.power(i);
            if (recuperates_ || !(value_of(power) < 0)) found.energy += power * weight;
          }
        });
    if (found.samples < samples.size()) found.energy = S(std::numeric_limits<double>::quiet_NaN());
    return found;
  }

  SampledMotion motion_;
  std::string mode_;
  Wrench<double> wrench_;
  bool recuperates_;
};

/// The energy over the fastest motion.
class EnergyOfFastest final : public Quantity {
 public:
  explicit EnergyOfFastest(const EntryContext& context)
      : fastest_(context), recuperates_(context.options.flag("recuperation")) {}

  Unsupported why_no_derivatives() const override {
    return "the energy over a fastest motion has no derivatives; use an optimiser without gradients";
  }
  double value(const DesignView<double>& design) const override {
    try {
      return fastest_.with_times(
          design, [&](const MovesOfMotion& moves, const ShortestTimes& times, const DesignWithLimits& at) {
            return energy_of(moves, times, at, recuperates_);
          });
    } catch (const DesignError&) {
      return std::numeric_limits<double>::quiet_NaN();
    }
  }
  Dual4 smooth(const DesignView<Dual4>&) const override { throw std::logic_error(*why_no_derivatives()); }
  std::string why_undefined(const DesignView<double>& design) const override { return fastest_.why_undefined(design); }

 private:
  FastestOfDesign fastest_;
  bool recuperates_;
};

std::unique_ptr<Quantity> make_energy(const EntryContext& context) {
  if (context.options.word("law") != "given") return std::make_unique<EnergyOfFastest>(context);
  for (const char* const limit : {"tool_speed", "tool_acceleration"})
    if (context.options.has(limit))
      throw std::invalid_argument(std::string(limit) +
                                  " limits the fastest motion; give law = \"optimal\" or law = \"own\", too");
  return std::make_unique<Energy>(context);
}

}  // namespace

ObjectiveEntry energy() {
  std::vector<OptionSpec> options = {
      motion_option(),
      {.name = "recuperation",
       .kind = OptionKind::flag,
       .initial = false,
       .meaning = "true: drives that brake return their energy; false: it is lost"},
      {.name = "law",
       .kind = OptionKind::word,
       .initial = std::string("given"),
       .choices = {"given", "optimal", "own"},
       .meaning = "given: the motion itself; otherwise the fastest motion along its path, as of cycle-time"},
      samples_option(),
      mode_option(),
      wrench_option()};
  std::ranges::move(fastest_options(), std::back_inserter(options));
  return {
      .name = "energy",
      .meaning = "energy of the drives over a motion: of the motors with drive trains, otherwise of the joints",
      .direction = Direction::minimise,
      .options = std::move(options),
      .unit = [](const EntryContext&) { return std::string("J"); },
      .refusal = [](const Mechanism& mechanism) { return check_dynamics("energy", mechanism); },
      .make = make_energy,
      .detail =
          [](const EntryContext& context) {
            return std::string("energy of the drives over the ") +
                   (context.options.word("law") == "given" ? "motion " : "fastest motion along ") +
                   context.options.word("motion") + (context.options.flag("recuperation") ? ", with recuperation" : "");
          },
      .uses_workspace = false,
  };
}

}  // namespace pkm
