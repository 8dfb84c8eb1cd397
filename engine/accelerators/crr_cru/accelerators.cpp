#include "engine/accelerators/crr_cru/accelerators.hpp"

#include "engine/accelerators/crr_cru/analysis.hpp"
#include "engine/accelerators/crr_cru/forward.hpp"

namespace pkm::crr_cru {
namespace {

/// Index of the coordinate that a plan fixes if it sweeps the other three of x, y, z, phi; -1 if it sweeps fewer. If
/// the plan does not name the fixed coordinate, it is phi.
int fixed_coordinate(const WorkspacePlan& plan) {
  for (int coordinate = 0; coordinate < 4; ++coordinate) {
    std::vector<int> swept = {0, 1, 2, 3};
    std::erase(swept, coordinate);
    const bool is_named = !plan.swept.empty() || !plan.fixed.empty();
    const bool fixes = plan.fixed.empty() || plan.fixed.front().coordinate == coordinate;
    if ((is_named || coordinate == 3) && fixes && sweeps(plan, swept)) return coordinate;
  }
  return -1;
}

/// Reads the elbow signs of the four limbs from the name of a mode, such as the default "-,-,+,-".
WorkingMode working_mode(const std::string& name) {
  WorkingMode mode = {-1, -1, 1, -1};
  for (std::size_t i = 0; 2 * i < name.size(); ++i) mode[i] = name[2 * i] == '+' ? 1 : -1;
  return mode;
}

/// Prepares the workspace analyses of one mechanism with one mass model.
class Analyses final : public ColumnAccelerator, public VoxelAccelerator {
 public:
  Analyses(Platform platform, MassModel mass_model) : platform_(platform), mass_model_(mass_model) {}

 private:
  bool serves(const WorkspacePlan& plan, const ColumnOptions&, const FieldRequest& request) const override {
    return serves(plan) && stores_poses(request);
  }
  bool serves(const WorkspacePlan& plan, const VoxelOptions&, const FieldRequest& request) const override {
    return serves(plan) && stores_poses(request);
  }
  /// Returns true unless poses are requested that the closed form does not store. It stores poses only if the inertia
  /// is requested; otherwise, one sample of the conditioning represents a whole slice, in which the conditioning is
  /// constant.
  static bool stores_poses(const FieldRequest& request) { return !request.poses || request.needs_inertia(); }
  static bool serves(const WorkspacePlan& plan) {
    const int fixed = fixed_coordinate(plan);
    return plan.fixed.size() <= 1 && fixed >= 0 && how_fixed(plan, fixed).kind != FixedCoordinate::Kind::integrated &&
           !requires_clearance(plan, kClearanceMin);
  }
  std::unique_ptr<const WorkspaceEvaluator> prepare(const WorkspacePlan& plan, const ColumnOptions& columns,
                                                    const FieldRequest& request) const override {
    return make_evaluator(settings(plan, request), columns);
  }
  std::unique_ptr<const VoxelEvaluator> prepare(const WorkspacePlan& plan, const VoxelOptions& voxels,
                                                const FieldRequest& request) const override {
    return make_evaluator(settings(plan, request), voxels);
  }
  AnalysisSettings settings(const WorkspacePlan& plan, const FieldRequest& request) const {
    return {.platform = platform_,
            .mass_model = mass_model_,
            .mode = working_mode(request.mode),
            .fixed = how_fixed(plan, fixed_coordinate(plan)),
            .limits = limits(plan.limits),
            .request = request};
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
