#include "experiments/app/motor_check.hpp"

#include "engine/mechanism/motor_demand.hpp"
#include "experiments/app/axes.hpp"

namespace pkm {

void report_motor_check(const Target& target, const std::string& mode, const Trajectory& trajectory,
                        const std::vector<Motor>& motors, Printout& out) {
  const Mechanism& mechanism = *target.mechanism;
  const DriveTrains& trains = *mechanism.drive_trains();
  const auto& joints = target.info().joints;
  const auto loads = joint_loads(trains, trajectory);
  const bool feasible = trajectory.summary.infeasible == 0;
  std::vector<Row> rows = {{"", "sufficient", "reserve", "limited by", "coupling index", "motion feasible"}};
  out.json["motors"] = Json::array();
  for (const Motor& motor : motors) {
    MotorFit worst;
    std::string worst_joint;
    Json reserves = Json::object();
    for (std::size_t i = 0; i < trains.size(); ++i) {
      const MotorFit here = fit(motor, trains[i], loads[i]);
      reserves[joints[i].name] = {{"reserve", here.reserve},
                                  {"bounded_by", here.bounded_by},
                                  {"peak_torque", here.peak_torque},
                                  {"rms_torque", here.rms_torque},
                                  {"speed", here.speed}};
      if (!worst_joint.empty() && !(here.reserve < worst.reserve)) continue;
      worst = here;
      worst_joint = joints[i].name;
    }
    const double coupling = mean_coupling_index(motor, mechanism, target.parameters, mode, trajectory);
    rows.push_back({motor.name, worst.reserve >= 1 ? "yes" : "no", number(worst.reserve),
                    worst.bounded_by + " of " + worst_joint, number(coupling), feasible ? "yes" : "no"});
    out.json["motors"].push_back({{"name", motor.name},
                                  {"does_it", worst.reserve >= 1},
                                  {"reserve", worst.reserve},
                                  {"joints", reserves},
                                  {"dci", coupling},
                                  {"follows_the_motion", feasible}});
  }
  out.add_table(
      "motor check (reserve: capacity / demand; coupling index: largest of the drives, mean over the samples)", rows);
}

}  // namespace pkm
