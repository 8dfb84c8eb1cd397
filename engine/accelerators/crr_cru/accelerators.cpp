#include "engine/accelerators/crr_cru/accelerators.hpp"

#include "engine/accelerators/crr_cru/forward.hpp"
#include "engine/accelerators/crr_cru/planned.hpp"

namespace pkm::crr_cru {
namespace {

/// The coordinates that may be fixed while the other three are swept: each of the four.
int fixed_coordinate(const WorkspacePlan& plan) {
  for (int coordinate = 0; coordinate < 4; ++coordinate) {
    std::vector<int> swept;
    for (int k = 0; k < 4; ++k)
      if (k != coordinate) swept.push_back(k);
    const bool named = !plan.swept.empty() || !plan.held.empty();
    const bool fixes = plan.held.empty() || plan.held.front().coordinate == coordinate;
    if ((named || coordinate == 3) && fixes && sweeps(plan, swept)) return coordinate;
  }
  return -1;
}

/// "-,-,+,-", and that for "".
WorkingMode mode_called(const std::string& name) {
  WorkingMode mode = {-1, -1, 1, -1};
  for (std::size_t i = 0; 2 * i < name.size(); ++i) mode[i] = name[2 * i] == '+' ? 1 : -1;
  return mode;
}

/// The analyses of one mechanism with one mass model.
class Analyses final : public ColumnAccelerator, public VoxelAccelerator {
 public:
  Analyses(Platform platform, MassModel mass_model) : platform_(platform), mass_model_(mass_model) {}

 private:
  bool serves(const WorkspacePlan& plan, const ColumnOptions&, const Demand&) const override { return serves(plan); }
  bool serves(const WorkspacePlan& plan, const VoxelOptions&, const Demand&) const override { return serves(plan); }
  static bool serves(const WorkspacePlan& plan) {
    const int fixed = fixed_coordinate(plan);
    return plan.held.size() <= 1 && fixed >= 0 && how_fixed(plan, fixed).kind != FixedCoordinate::Kind::integrated &&
           !asks_clearance(plan, kClearanceMin);
  }
  std::unique_ptr<const WorkspaceEvaluator> prepare(const WorkspacePlan& plan, const ColumnOptions& columns,
                                                    const Demand& demand) const override {
    return make_surveyor(planned(plan, demand), columns);
  }
  std::unique_ptr<const VoxelEvaluator> prepare(const WorkspacePlan& plan, const VoxelOptions& voxels,
                                                const Demand& demand) const override {
    return make_surveyor(planned(plan, demand), voxels);
  }
  Planned planned(const WorkspacePlan& plan, const Demand& demand) const {
    const FixedCoordinate fixed = how_fixed(plan, fixed_coordinate(plan));
    return {
        .platform = platform_,
        .mass_model = mass_model_,
        .mode = mode_called(demand.mode),
        .held = {static_cast<std::size_t>(fixed.coordinate), fixed.kind == FixedCoordinate::Kind::middle, fixed.value},
        .limits = limits(plan.limits),
        .demand = demand};
  }

  Platform platform_;
  MassModel mass_model_;
};

class Forward final : public ForwardKinematics {
 public:
  explicit Forward(Platform platform) : platform_(platform) {}
  std::vector<AssemblyMode> assemblies(std::span<const double> parameters,
                                       const AxisVector<double>& joints) const override {
    return forward(geometry(platform_, parameters), joints);
  }

 private:
  Platform platform_;
};

}  // namespace

Accelerators accelerators(Platform platform, const std::string& mass_model) {
  const auto analyses =
      std::make_shared<const Analyses>(platform, mass_model == "geometry" ? MassModel::geometry : MassModel::table);
  return {.columns = analyses, .voxels = analyses, .forward = std::make_shared<const Forward>(platform)};
}

}  // namespace pkm::crr_cru
