// Analyses of one design at arrays of poses.
#include <algorithm>
#include <cmath>
#include <limits>

#include "bindings/c/handles.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/core/unit.hpp"
#include "engine/generic/mechanism.hpp"
#include "engine/mechanism/abilities/nearest_assembly.hpp"
#include "engine/mechanism/sampled_poses.hpp"

namespace pkm::c {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
/// Minimum number of poses for which several threads are used, for cheap and for costly analyses of a pose.
constexpr std::size_t kManyCheapPoses = 2000, kManyPoses = 64;

std::size_t coordinates_of(const pkmopt_design& design) { return design.mechanism->info().coordinates.size(); }
std::size_t joints_of(const pkmopt_design& design) { return design.mechanism->info().joints.size(); }

Pose<double> pose_at(const pkmopt_design& design, const double* poses, std::size_t k) {
  const std::size_t n = coordinates_of(design);
  Pose<double> pose(n);
  std::copy_n(poses + k * n, n, pose.begin());
  return pose;
}

const generic::Evaluation& evaluation_of(const pkmopt_design& design) {
  const generic::Evaluation* const found = generic::evaluation_of(*design.mechanism);
  if (!found) throw std::logic_error("the mechanism has no formulas");
  return *found;
}

const std::vector<generic::LinkNodes>& links_of(const pkmopt_design& design) {
  const auto& links = evaluation_of(design).model.links;
  if (links.empty())
    throw ConfigError({"", 0, "links"}, "mechanism " + design.mechanism->info().name +
                                            " has none; define `radius` in its limbs, or [[link]]");
  return links;
}

void evaluate(const generic::PoseArrays& arrays, const pkmopt_design& design, std::size_t count, const double* poses,
              double* values, const pkmopt_options* options) {
  with_options(options, count >= kManyCheapPoses, [&] {
    arrays.evaluate(design.parameters, design.limits, {poses, count * coordinates_of(design)},
                    {values, count * arrays.width()});
  });
}

/// Calls work(k) for each pose, on several threads if there are at least kManyPoses poses.
template <class Work>
void for_each_pose(std::size_t count, const pkmopt_options* options, const Work& work) {
  with_options(options, count >= kManyPoses, [&] {
    parallel_for(count, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        check_stop();
        work(k);
      }
    });
  });
}

PoseReport inspect(const pkmopt_design& design, const Pose<double>& pose) {
  return design.mechanism->inspect(design.parameters, pose, design.mode, design.limits);
}

/// Names of the margins of a pose at which the mechanism can be assembled; any other pose has only the first of these
/// margins. The names are determined at the first use.
const std::vector<std::string>& margin_names(const pkmopt_design& design) {
  constexpr std::size_t kTrials = 10'000;
  std::call_once(design.has_margin_names, [&] {
    const SampledPoses poses(*design.mechanism, design.parameters);
    for (std::size_t trial = 1; trial <= kTrials; ++trial) {
      const PoseReport report = inspect(design, poses[trial]);
      if (!report.assembles) continue;
      for (const auto& [name, value] : report.margins) design.margin_names.push_back(name);
      return;
    }
    throw DesignError("none of " + std::to_string(kTrials) + " sampled poses assembles");
  });
  return design.margin_names;
}

/// Drive forces and joint-space equations of motion of one state.
struct Dynamics {
  const pkmopt_design& design;
  const double *poses, *velocities, *accelerations, *wrenches;
  double *forces, *inertia, *coriolis, *gravity;

  void find(std::size_t k) const {
    const std::size_t n = joints_of(design);
    const auto row = [&](const double* values, std::size_t width) {
      AxisVector<double> vector(width);
      if (values) std::copy_n(values + k * width, width, vector.begin());
      return vector;
    };
    const std::size_t coordinates = coordinates_of(design);
    const MotionState<double> state{pose_at(design, poses, k), row(velocities, coordinates)};
    PoseDynamics<double> found;
    design.mechanism->dynamics()->equations(design.parameters, design.mode, {&state, 1}, {&found, 1});
    const auto store = [&](double* to, const auto& values, std::size_t width) {
      if (to) std::ranges::copy(values, to + k * width);
    };
    if (!found.assembles) {
      for (double* const to : {forces, coriolis, gravity})
        if (to) std::fill_n(to + k * n, n, kNan);
      if (inertia) std::fill_n(inertia + k * n * n, n * n, kNan);
      return;
    }
    if (forces) {
      Wrench<double> wrench;
      if (wrenches) std::copy_n(wrenches + 6 * k, 6, wrench.begin());
      store(forces, drive_forces<double>(found, row(accelerations, coordinates), wrench), n);
    }
    if (!inertia && !coriolis && !gravity) return;
    const JointSpace<double> joint = joint_space(found);
    store(inertia, joint.M_q, n * n);
    store(coriolis, joint.c_q, n);
    store(gravity, joint.G_q, n);
  }
};

}  // namespace
}  // namespace pkm::c

using namespace pkm::c;

pkmopt_status pkmopt_design_create(const pkmopt_mechanism* mechanism, const double* parameters, const char* mode,
                                   const double* limits, pkmopt_design** design) {
  return guarded([&] {
    const pkm::MechanismInfo& info = mechanism->mechanism->info();
    auto made = std::make_unique<pkmopt_design>();
    made->mechanism = mechanism->mechanism;
    for (std::size_t i = 0; i < info.parameters.size(); ++i)
      made->parameters.push_back(parameters ? parameters[i] : info.parameters[i].nominal);
    made->mode = mode ? mode : info.modes.front();
    if (!pkm::contains(info.modes, made->mode))
      throw pkm::ConfigError({"", 0, "mode"}, "'" + made->mode + "'", "one of " + pkm::join(info.modes),
                             pkm::nearest_name(made->mode, info.modes));
    made->mode_index = pkm::mode_index(info, made->mode);
    made->limits = pkm::no_limits(info);
    for (std::size_t i = 0; limits && i < info.limits.size(); ++i) {
      if (std::isnan(limits[i])) continue;
      const pkm::LimitInfo& limit = info.limits[i];
      if (!(limits[i] >= limit.lower && limits[i] <= limit.upper))
        throw pkm::ConfigError({"", 0, "limits." + limit.name}, pkm::with_degrees(limits[i], limit.unit),
                               "a value in " + pkm::format_range(limit.lower, limit.upper, limit.unit));
      made->limits.given[i] = limits[i];
    }
    if (const pkm::Unsupported reason = made->mechanism->refuse(made->parameters)) throw pkm::DesignError(*reason);
    *design = made.release();
  });
}

void pkmopt_design_free(pkmopt_design* design) { delete design; }

pkmopt_status pkmopt_design_inverse(const pkmopt_design* design, size_t count, const double* poses, double* joints,
                                    const pkmopt_options* options) {
  return guarded([&] {
    std::call_once(design->has_joints, [&] {
      design->joints.emplace(pkm::generic::PoseArrays::joints(evaluation_of(*design), design->mode_index));
    });
    evaluate(*design->joints, *design, count, poses, joints, options);
  });
}

pkmopt_status pkmopt_design_jacobians(const pkmopt_design* design, size_t count, const double* poses, double* jacobians,
                                      const pkmopt_options* options) {
  return guarded([&] {
    std::call_once(design->has_jacobians, [&] {
      design->jacobians.emplace(pkm::generic::PoseArrays::jacobians(evaluation_of(*design), design->mode_index));
    });
    evaluate(*design->jacobians, *design, count, poses, jacobians, options);
  });
}

pkmopt_status pkmopt_design_quantity(const pkmopt_design* design, const char* name, size_t count, const double* poses,
                                     double* values, const pkmopt_options* options) {
  return guarded([&] {
    const std::string wanted = required_text(name, "name");
    const pkm::MechanismInfo& info = design->mechanism->info();
    if (wanted == "conditioning")
      return for_each_pose(count, options, [&](std::size_t k) {
        values[k] = inspect(*design, pose_at(*design, poses, k)).conditioning.value_or(kNan);
      });
    const pkm::QuantityInfo* const found = pkm::find_named(info.quantities, wanted);
    if (!found) {
      for (const pkm::UndefinedQuantity& other : info.undefined_quantities)
        if (other.name == wanted)
          throw pkm::ConfigError({"", 0, "quantity"}, wanted + " is not defined for " + info.name + ": " + other.why);
      std::vector<std::string> names = pkm::names_of(info.quantities);
      names.emplace_back("conditioning");
      throw pkm::ConfigError({"", 0, "quantity"}, "'" + wanted + "'", "one of " + pkm::join(names),
                             pkm::nearest_name(wanted, names));
    }
    if (found->of_motion)
      throw pkm::ConfigError({"", 0, "quantity"}, wanted + " depends on rates or inputs, not on the pose alone");
    const auto index = static_cast<std::size_t>(found - info.quantities.data());
    const auto quantity = pkm::generic::PoseArrays::quantity(evaluation_of(*design), design->mode_index, index);
    evaluate(quantity, *design, count, poses, values, options);
  });
}

pkmopt_status pkmopt_design_margin_names(const pkmopt_design* design, char** json) {
  return guarded([&] { *json = allocated(Json(margin_names(*design))); });
}

pkmopt_status pkmopt_design_margins(const pkmopt_design* design, size_t count, const double* poses, double* margins,
                                    const pkmopt_options* options) {
  return guarded([&] {
    const std::vector<std::string>& names = margin_names(*design);
    for_each_pose(count, options, [&](std::size_t k) {
      double* const row = margins + k * names.size();
      std::fill_n(row, names.size(), kNan);
      std::size_t i = 0;
      for (const auto& [name, value] : inspect(*design, pose_at(*design, poses, k)).margins) {
        if (i == names.size() || names[i] != name) throw std::logic_error("margin " + name + " was not expected");
        row[i++] = value;
      }
    });
  });
}

pkmopt_status pkmopt_design_forward(const pkmopt_design* design, size_t count, const double* joints, const double* near,
                                    size_t capacity, double* poses, size_t* found, const pkmopt_options* options) {
  return guarded([&] {
    const pkm::ForwardKinematics* const forward = design->mechanism->forward();
    const pkm::MechanismInfo& info = design->mechanism->info();
    if (!forward)
      throw pkm::ConfigError({"", 0, "forward kinematics"},
                             "mechanism " + info.name + " has none: its numbers of joints and coordinates differ");
    const std::size_t n = coordinates_of(*design), q = joints_of(*design);
    for_each_pose(count, options, [&](std::size_t k) {
      pkm::AxisVector<double> values(q);
      std::copy_n(joints + k * q, q, values.begin());
      std::vector<pkm::AssemblyMode> modes;
      if (near) {
        if (auto nearest =
                pkm::nearest_assembly(*design->mechanism, design->parameters, values, pose_at(*design, near, k)))
          modes.push_back(std::move(*nearest));
      } else {
        modes = forward->assemblies(design->parameters, values);
        std::erase_if(modes, [](const pkm::AssemblyMode& mode) { return !mode.usual; });
      }
      found[k] = 0;
      for (const pkm::AssemblyMode& mode : modes) {
        if (found[k] < capacity) std::ranges::copy(mode.pose, poses + (k * capacity + found[k]) * n);
        ++found[k];
      }
      for (std::size_t i = found[k]; i < capacity; ++i) std::fill_n(poses + (k * capacity + i) * n, n, kNan);
    });
  });
}

pkmopt_status pkmopt_design_dynamics(const pkmopt_design* design, size_t count, const double* poses,
                                     const double* velocities, const double* accelerations, const double* wrenches,
                                     double* forces, double* inertia, double* coriolis, double* gravity,
                                     const pkmopt_options* options) {
  return guarded([&] {
    if (const pkm::Unsupported reason = pkm::why_no_joint_forces(*design->mechanism))
      throw pkm::ConfigError({"", 0, "dynamics"}, *reason);
    const Dynamics dynamics{*design, poses, velocities, accelerations, wrenches, forces, inertia, coriolis, gravity};
    for_each_pose(count, options, [&](std::size_t k) { dynamics.find(k); });
  });
}

pkmopt_status pkmopt_design_link_names(const pkmopt_design* design, char** json) {
  return guarded([&] {
    Json names = Json::array();
    for (const auto& link : links_of(*design)) names.push_back({{"name", link.name}, {"part", link.part}});
    *json = allocated(names);
  });
}

pkmopt_status pkmopt_design_links(const pkmopt_design* design, size_t count, const double* poses, double* capsules,
                                  const pkmopt_options* options) {
  return guarded([&] {
    const std::size_t links = links_of(*design).size();
    for_each_pose(count, options, [&](std::size_t k) {
      double* to = capsules + k * links * 7;
      const auto placed =
          design->mechanism->links()->place(design->parameters, pose_at(*design, poses, k), design->mode);
      if (placed.empty()) std::fill_n(to, links * 7, kNan);
      for (const pkm::PlacedLink& link : placed) {
        to = std::ranges::copy(link.body.axis.from, to).out;
        to = std::ranges::copy(link.body.axis.to, to).out;
        *to++ = link.body.radius;
      }
    });
  });
}
