// Check of a limb's `across`: crank and rod stay in planes normal to this direction, so the component of B - A along it
// has to be the same at every pose. The component is evaluated at random poses in the box of [survey], for the default
// design and for random designs.

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "engine/config/mechanism_draft.hpp"
#include "engine/expression/program.hpp"
#include "engine/math/random.hpp"

namespace pkm {
namespace {

using expression::Node;
using generic::Inputs;

// Number of designs, the first of which is the default one, and number of poses per design.
constexpr std::uint32_t kDesigns = 8, kPoses = 16;
// Changes of the component of B - A that are smaller than this, relative to |B - A|, are attributed to rounding.
constexpr double kConstant = 1e-9;

std::string length_text(double length) {
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.4g m", length);
  return text.data();
}

struct Extent {
  double least = kUnbounded, greatest = -kUnbounded;
  void add(double x) {
    least = std::min(least, x);
    greatest = std::max(greatest, x);
  }
};

/// Generator of random inputs of the graph: one design, and poses in the box of [survey].
class RandomPoses {
 public:
  RandomPoses(const generic::Model& model, std::uint32_t design)
      : model_(model), random_(0, design, 0, Stream::Use::start), inputs_(model.inputs.count()) {
    for (std::size_t i = 0; i < model.info.parameters.size(); ++i) {
      const Parameter& p = model.info.parameters[i];
      inputs_[i] = design == 0 ? p.nominal : between(p.lower, p.upper);
    }
    for (std::size_t i = 0; i < model.inputs.limits; ++i)
      inputs_[model.inputs.limit(i)] =
          model.limit_parameters[i] ? inputs_[*model.limit_parameters[i]] : model.info.limits[i].inactive;
    for (std::size_t i = 0; i < model.inputs.signs; ++i) inputs_[model.inputs.sign(i)] = model.signs.front()[i];
    for (std::size_t i = 0; i < model.box.size(); ++i) {
      const auto& range = model.box[i];
      std::array<double, 2> ends = {-1, 1};
      if (range && !model.is_contracted[i])
        std::ranges::transform(*range, ends.begin(), [&](Node node) { return values({node}).front(); });
      const bool usable = ends[0] <= ends[1] && std::isfinite(ends[1] - ends[0]);
      box_.push_back(usable ? ends : std::array{-1.0, 1.0});
    }
  }

  /// Computes the values of the nodes at the next random pose.
  std::vector<double> next(const std::vector<Node>& nodes) {
    for (std::size_t i = 0; i < box_.size(); ++i)
      inputs_[model_.inputs.coordinate(i)] = between(box_[i][0], box_[i][1]);
    return values(nodes);
  }

 private:
  double between(double from, double to) { return from + (to - from) * random_.u01(); }
  std::vector<double> values(const std::vector<Node>& nodes) const {
    const expression::Program program(model_.graph, nodes);
    std::vector<double> registers, found;
    program.run_all<double>(inputs_, registers);
    for (const std::uint32_t output : program.outputs()) found.push_back(registers[output]);
    return found;
  }

  const generic::Model& model_;
  Stream random_;
  std::vector<double> inputs_;
  std::vector<std::array<double, 2>> box_;
};

}  // namespace

void refuse_changing_planes(MechanismDraft& draft) {
  std::vector<Node> nodes;  // two nodes for each limb: the component of B - A along the normal, and |B - A|^2
  for (const LimbInPlane& limb : draft.in_planes) {
    const limbs::Vector3 v = limb.B - limb.A;
    nodes.push_back(dot(v, limb.normal).node());
    nodes.push_back(dot(v, v).node());
  }
  if (nodes.empty()) return;
  for (std::uint32_t design = 0; design < kDesigns; ++design) {
    RandomPoses poses(draft.model, design);
    std::vector<Extent> offsets(draft.in_planes.size()), sizes(draft.in_planes.size());
    for (std::uint32_t k = 0; k < kPoses; ++k) {
      const std::vector<double> values = poses.next(nodes);
      for (std::size_t i = 0; i < offsets.size(); ++i) {
        // Skip this pose, because the limb cannot be assembled at it.
        if (!std::isfinite(values[2 * i]) || !std::isfinite(values[2 * i + 1])) continue;
        offsets[i].add(values[2 * i]);
        sizes[i].add(std::sqrt(values[2 * i + 1]));
      }
    }
    for (std::size_t i = 0; i < offsets.size(); ++i) {
      if (offsets[i].greatest - offsets[i].least <= kConstant * sizes[i].greatest) continue;
      const LimbInPlane& limb = draft.in_planes[i];
      if (limb.is_swivel)
        throw limb.across.refusal(
            "this axis of the universal joint does not stay normal to that of the revolute joint at the platform; give "
            "formulas in `follows` or `origin` that keep it normal");
      throw limb.across.refusal(
          "the component of B - A along `across` changes with the pose (" + length_text(offsets[i].least) + " to " +
          length_text(offsets[i].greatest) + (design == 0 ? "" : " for a design other than the default") +
          "), so the limb cannot stay in the plane normal to `across`; give formulas in `follows`, `origin` or `end` "
          "that keep it in this plane, omit `across` if the rod ends in ball joints, or put `end` into the plane if a "
          "joint slides along `across`");
    }
  }
}

}  // namespace pkm
