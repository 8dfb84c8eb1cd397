// Size and mass of a mechanism: volume, base area and height of the installation space, the axis-parallel bounding box
// of all links over the workspace or along a motion, and the total length of the moving links
// (engine/workspace/installation_space.hpp); and the mass of the moving bodies.
//
// The poses are those of the workspace analysis: the centres of all feasible cells (voxels) or the nodes of the
// quadrature (columns). Both lie inside the workspace, so that the box is too small: by less than a cell, or by less
// than the distance between the boundary and the outermost nodes.
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/unit.hpp"
#include "engine/mechanism/total_mass.hpp"
#include "engine/problem/motion_options.hpp"
#include "engine/problem/pose_options.hpp"
#include "engine/workspace/installation_space.hpp"
#include "objectives/list.hpp"

namespace pkm {
namespace {

bool has_motion(const EntryContext& context) { return context.options.has("motion"); }

/// The installation space that a thread computed last, because several quantities of a design use the same one.
struct SpaceScratch {
  const Mechanism* mechanism = nullptr;
  std::string mode;
  std::vector<double> parameters;
  std::vector<Pose<double>> poses;
  std::optional<InstallationSpace> space;
};

using Measure = double (*)(const InstallationSpace& space);

class SizeMeasure final : public Quantity {
 public:
  SizeMeasure(const EntryContext& context, const std::string& name, Measure measure)
      : name_(name), mode_(mode_of(context)), measure_(measure) {
    if (has_motion(context)) motion_.emplace(context);
  }

  double value(const DesignView<double>& design) const override {
    const std::optional<InstallationSpace>& space = space_of(design);
    return space ? measure_(*space) : std::numeric_limits<double>::quiet_NaN();
  }
  Dual4 smooth(const DesignView<Dual4>&) const override { throw std::logic_error(*why_no_derivatives()); }
  Unsupported why_no_derivatives() const override {
    return name_ + " is an extremum over poses and links, which has none; use an optimiser without gradients";
  }
  std::string why_undefined(const DesignView<double>& design) const override {
    if (!motion_) return design.workspace->pose.empty() ? "no pose is feasible" : "";
    for (const MotionSample& at : motion_->of(design))
      if (design.mechanism.links()->place(design.parameters, at.pose, mode_).empty())
        return "the motion " + motion_->name() + " leaves the reach of the mechanism at t = " + with_unit(at.time, "s");
    return {};
  }

 private:
  const std::optional<InstallationSpace>& space_of(const DesignView<double>& design) const {
    std::vector<Pose<double>> along;
    if (motion_)
      for (const MotionSample& at : motion_->of(design)) along.push_back(at.pose);
    const std::vector<Pose<double>>& poses = motion_ ? along : design.workspace->pose;
    SpaceScratch& last = design.scratch.get<SpaceScratch>();
    if (last.mechanism == &design.mechanism && last.mode == mode_ && last.poses == poses &&
        std::ranges::equal(last.parameters, design.parameters))
      return last.space;
    last.mechanism = &design.mechanism;
    last.mode = mode_;
    last.parameters.assign(design.parameters.begin(), design.parameters.end());
    last.poses = poses;
    return last.space = installation_space(design.mechanism, design.parameters, mode_, poses);
  }

  std::string name_, mode_;
  Measure measure_;
  /// The motion over whose poses the size is measured; std::nullopt: over the poses of the workspace analysis.
  std::optional<SampledMotion> motion_;
};

/// @param what  description of the measure, such as "base area of the box of all links"
ObjectiveEntry size_entry(const std::string& name, const std::string& what, const std::string& unit, Measure measure) {
  OptionSpec motion = motion_option(), samples = samples_option();
  motion.required = false;
  motion.meaning += "; default: the poses of the workspace";
  return {
      .name = name,
      .meaning = what + " over the workspace or along a motion",
      .direction = Direction::minimise,
      .options = {motion, samples, mode_option()},
      .unit = [unit](const EntryContext&) { return unit; },
      .refusal = [name](const Mechanism& mechanism) -> Unsupported {
        if (mechanism.links()) return {};
        return "objective " + name + " needs links, and mechanism " + mechanism.info().name +
               " has none; define `radius` in its limbs, or [[link]], in the mechanism file";
      },
      .request =
          [](const EntryContext& context, FieldRequest& request) {
            if (has_motion(context)) return;
            request.poses = true;
            request.mode = mode_of(context);
          },
      .make = [name,
               measure](const EntryContext& context) { return std::make_unique<SizeMeasure>(context, name, measure); },
      .detail =
          [what](const EntryContext& context) {
            return what + (has_motion(context) ? " along the motion " + context.options.word("motion")
                                               : " over the workspace");
          },
      .range = nonnegative,
      .needs_workspace = [](const EntryContext& context) { return !has_motion(context); },
  };
}

ObjectiveEntry mass_entry() {
  return {
      .name = "mass",
      .meaning = "total mass of the moving bodies of the mechanism file, without drive trains",
      .direction = Direction::minimise,
      .unit = [](const EntryContext&) { return std::string("kg"); },
      .refusal = [](const Mechanism& mechanism) -> Unsupported {
        if (find_total_mass(mechanism)) return {};
        return "objective mass needs masses, and mechanism " + mechanism.info().name + " has none";
      },
      .make =
          [](const EntryContext&) {
            return make_quantity([]<class S>(const DesignView<S>& design) {
              return S(find_total_mass(design.mechanism)->total_mass(design.parameters));
            });
          },
      .range = nonnegative,
      .uses_workspace = false,
  };
}

}  // namespace

std::vector<ObjectiveEntry> size_objectives() {
  static const auto edge = [](const InstallationSpace& space, std::size_t axis) {
    return space.box.upper[axis] - space.box.lower[axis];
  };
  const std::string box = " of the box of all links";
  return {size_entry("installation-space", "volume" + box, "m^3",
                     [](const InstallationSpace& space) { return edge(space, 0) * edge(space, 1) * edge(space, 2); }),
          size_entry("footprint", "base area (x, y)" + box, "m^2",
                     [](const InstallationSpace& space) { return edge(space, 0) * edge(space, 1); }),
          size_entry("height", "height (along z)" + box, "m",
                     [](const InstallationSpace& space) { return edge(space, 2); }),
          size_entry("link-length", "sum of the largest lengths of all moving links", "m",
                     [](const InstallationSpace& space) { return space.moving_length; }),
          mass_entry()};
}

}  // namespace pkm
