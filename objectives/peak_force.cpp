// Greatest magnitude of an actuator's force along a motion, over its samples. Gradient solvers see the power mean of
// the magnitudes (power_mean).
#include "engine/dynamics/coupling.hpp"
#include "engine/problem/inertia_options.hpp"
#include "engine/problem/motion_quantity.hpp"
#include "objectives/list.hpp"

namespace pkm {
namespace {

template <class S>
void append_magnitudes(const std::string& joint, const AxisVector<S>& forces, const AxisVector<S>&,
                       std::vector<S>& field) {
  for (std::size_t i = 0; i < forces.size(); ++i)
    if (joint == "worst" || joint[0] == static_cast<char>('1' + i)) field.push_back(magnitude(forces[i]));
}

}  // namespace

ObjectiveEntry peak_force() {
  return {
      .name = "peak-force",
      .meaning = "greatest force of the actuators along a motion",
      .direction = Direction::minimise,
      .options = motion_options({"worst"}),
      .unit = [](const EntryContext& context) { return force_unit(context); },
      .refusal = [](const Mechanism& mechanism) { return refuse_without_dynamics("peak-force", mechanism); },
      .demand = [](const EntryContext&, Demand&) {},
      .make =
          [](const EntryContext& context) {
            return make_motion_quantity(context, append_magnitudes<double>, append_magnitudes<Dual4>);
          },
      .detail = [](const EntryContext& context) { return motion_detail("peak force", context); },
      .reads_survey = false,
  };
}

}  // namespace pkm
