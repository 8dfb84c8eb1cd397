// Greatest magnitude of an actuator's power along a motion, over its samples: force times speed, driving or braking.
// Gradient solvers see the power mean of the magnitudes (power_mean).
#include "engine/dynamics/coupling.hpp"
#include "engine/problem/inertia_options.hpp"
#include "engine/problem/motion_quantity.hpp"
#include "objectives/list.hpp"

namespace pkm {
namespace {

template <class S>
void append_power(const std::string& joint, const AxisVector<S>& forces, const AxisVector<S>& speeds,
                  std::vector<S>& field) {
  S total(0.0);
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const S power = forces[i] * speeds[i];
    total += power;
    if (joint == "worst" || joint[0] == static_cast<char>('1' + i)) field.push_back(magnitude(power));
  }
  if (joint == "total") field.push_back(magnitude(total));
}

}  // namespace

ObjectiveEntry peak_power() {
  return {
      .name = "peak-power",
      .meaning = "greatest power of the actuators along a motion, driving or braking",
      .direction = Direction::minimise,
      .options = motion_options({"worst", "total"}),
      .unit = [](const EntryContext&) { return std::string("W"); },
      .refusal = [](const Mechanism& mechanism) { return refuse_without_dynamics("peak-power", mechanism); },
      .demand = [](const EntryContext&, Demand&) {},
      .make =
          [](const EntryContext& context) {
            return make_motion_quantity(context, append_power<double>, append_power<Dual4>);
          },
      .detail = [](const EntryContext& context) { return motion_detail("peak power", context); },
      .reads_survey = false,
  };
}

}  // namespace pkm
