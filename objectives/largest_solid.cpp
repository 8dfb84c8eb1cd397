// The largest box, cylinder or sphere in the workspace (rectangle or circle in the plane), under all limits of the
// study: engine/workspace/largest_solid.hpp. A design without a feasible pose has the value 0.
#include "engine/workspace/largest_solid.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/mechanism/ordered_margins.hpp"
#include "engine/problem/largest_solid_options.hpp"
#include "objectives/list.hpp"

namespace pkm {
namespace {

/// The solid that a thread found last: the value of a design and all blocks of its derivatives use the same solid.
struct SolidScratch {
  const Quantity* owner = nullptr;
  std::vector<double> parameters;
  LargestSolid found;
};

class LargestSolidMeasure final : public Quantity {
 public:
  LargestSolidMeasure(SolidKind kind, const EntryContext& context)
      : finder_(solid_finder(kind, context)), is_size_(measures_size(context.options)) {}

  double value(const DesignView<double>& design) const override {
    const LargestSolid& found = solid_of(design.parameters, design.scratch);
    return is_size_ ? found.solid.dimensions.front() : found.volume;
  }
  Dual4 smooth(const DesignView<Dual4>& design) const override {
    std::vector<double> values;
    for (const Dual4& parameter : design.parameters) values.push_back(parameter.a);
    const LargestSolid& found = solid_of(values, design.scratch);
    if (!(found.volume > 0)) return Dual4(0.0);
    const Dual4 volume = finder_.volume(design.parameters, found);
    if (!is_size_) return volume;
    // If the proportions are fixed, the volume is proportional to size^n, where n is the number of axes.
    Dual4 size(found.solid.dimensions.front());
    const double factor = size.a / (static_cast<double>(finder_.spec().shape.axes()) * volume.a);
    for (int k = 0; k < 4; ++k) size.v[k] = factor * volume.v[k];
    return size;
  }
  const LargestSolidFinder* largest_solid() const override { return &finder_; }

 private:
  const LargestSolid& solid_of(std::span<const double> parameters, Scratch& scratch) const {
    SolidScratch& last = scratch.get<SolidScratch>();
    if (last.owner == this && std::ranges::equal(last.parameters, parameters)) return last.found;
    last.owner = nullptr;
    last.found = finder_.find(parameters);
    last.parameters.assign(parameters.begin(), parameters.end());
    last.owner = this;
    return last.found;
  }

  LargestSolidFinder finder_;
  bool is_size_;
};

ObjectiveEntry entry_of(SolidKind kind, const std::string& name, const std::string& meaning) {
  return {
      .name = name,
      .meaning = meaning,
      .direction = Direction::maximise,
      .options = largest_solid_options(kind),
      .unit =
          [](const EntryContext& context) {
            if (measures_size(context.options)) return std::string("m");
            return std::string(sweep_of(context.mechanism.info(), context.plan).swept.size() == 2 ? "m^2" : "m^3");
          },
      .refusal = [name](const Mechanism& mechanism) -> Unsupported {
        if (find_ordered_margins(mechanism)) return {};
        return "objective " + name + " needs a mechanism file; mechanism " + mechanism.info().name +
               " has no formulas of the margins of poses";
      },
      .make = [kind](const EntryContext& context) { return std::make_unique<LargestSolidMeasure>(kind, context); },
      .detail =
          [kind](const EntryContext& context) {
            const bool is_plane = sweep_of(context.mechanism.info(), context.plan).swept.size() == 2;
            const std::string solid = kind == SolidKind::cylinder ? "cylinder"
                                      : kind == SolidKind::box    ? (is_plane ? "rectangle" : "box")
                                                                  : (is_plane ? "circle" : "sphere");
            const std::string& ratio = context.options.has("ratio") ? context.options.word("ratio") : "";
            const std::string what = measures_size(context.options) ? "first dimension" : "measure";
            return what + " of the largest " + solid + (ratio.empty() ? "" : " of proportions " + ratio) +
                   " in the workspace";
          },
      .range = nonnegative,
      // The objective performs a voxel analysis of its own.
      .needs_workspace = [](const EntryContext&) { return false; },
  };
}

}  // namespace

std::vector<ObjectiveEntry> largest_solid_objectives() {
  return {
      entry_of(SolidKind::box, "largest-box", "volume or edge of the largest box in the workspace"),
      entry_of(SolidKind::cylinder, "largest-cylinder", "volume or diameter of the largest cylinder in the workspace"),
      entry_of(SolidKind::sphere, "largest-sphere",
               "volume or diameter of the largest sphere in the workspace (circle, if two coordinates are swept)")};
}

}  // namespace pkm
