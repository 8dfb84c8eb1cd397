#include "engine/workspace/home_columns.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>
#include <stdexcept>

#include "engine/core/error.hpp"
#include "engine/mechanism/abilities/sided_columns.hpp"
#include "engine/workspace/components.hpp"
#include "engine/workspace/with_gradients.hpp"

namespace pkm {
namespace {

class HomeColumns final : public WithGradients<HomeColumns> {
 public:
  HomeColumns(const Mechanism& mechanism, const WorkspacePlan& plan, const FieldRequest& request,
              std::unique_ptr<const VoxelEvaluator> map)
      : mechanism_(mechanism),
        plan_(plan),
        request_(request),
        home_(*plan.home),
        finder_(mechanism, grid_of_components(mechanism.info(), plan), request.mode),
        map_(std::move(map)) {
    plan_.home.reset();
    has_gradients_ = analysis(0, false).gradients() != nullptr;
  }
  const GradientEvaluator* gradients() const override { return has_gradients_ ? this : nullptr; }
  std::string why_no_derivatives() const override { return analysis(0, false).why_no_derivatives(); }

 private:
  friend WithGradients<HomeColumns>;

  /// The component of the workspace of one design that contains the home pose.
  struct Home {
    std::shared_ptr<const bool> of;  ///< identity_ of the HomeColumns that computed the other members; null: not
                                     ///< computed
    std::vector<double> parameters;
    VoxelMap map;
    ConnectedComponents components;
    std::uint32_t label = 0;
    std::int8_t side = 0;    ///< side of the singularities to which the columns are restricted; 0: the columns are not
                             ///< restricted
    bool is_single = false;  ///< true: no other component is on this side of the singularities
  };
  template <class S>
  struct Nodes {
    WorkspaceResult<S> all;
    std::vector<Pose<double>> poses;
    std::vector<std::int8_t> inside;
  };
  struct Analysis {
    std::once_flag is_prepared;
    std::shared_ptr<const Mechanism> mechanism;  ///< mechanism restricted to one side of the singularities; null: the
                                                 ///< mechanism itself
    std::unique_ptr<const WorkspaceEvaluator> evaluator;
  };

  /// The columns on one side of the singularities, or on both. Each is prepared at its first use, because
  /// most designs need only one of them. @param nodes  true: the analysis also stores the poses of all nodes
  const WorkspaceEvaluator& analysis(std::int8_t side, bool nodes) const {
    Analysis& found = analyses_[static_cast<std::size_t>(side + 1)][nodes];
    std::call_once(found.is_prepared, [&] {
      const Mechanism* mechanism = &mechanism_;
      FieldRequest request = request_;
      request.poses = request.poses || nodes;
      request.every_pose = request.every_pose || nodes;
      const std::string ends = "the component that holds the home pose ends at a singularity, ",
                        remedy = "; set workspace.method = \"voxels\"";
      if (side != 0) {
        // With two outer coordinates, columns along which det J is no polynomial take minutes.
        if (sweep_of(mechanism_.info(), plan_).swept.size() > 2)
          throw DesignError(ends + "at which columns can end if one or two coordinates are swept, but not three" +
                            remedy);
        found.mechanism = columns_on_side(*mechanism_.columns(), side);
        mechanism = found.mechanism.get();
      }
      if (!mechanism)
        throw DesignError(ends + "at which the columns of mechanism " + mechanism_.info().name + " cannot end" +
                          remedy);
      if (!mechanism->columns())
        throw DesignError(ends + "which is no surface of columns: " + mechanism->why_no_columns() + remedy);
      try {
        found.evaluator = mechanism->columns()->prepare(plan_, *plan_.columns(), request);
      } catch (const std::invalid_argument& reason) {
        if (side == 0) throw;
        throw DesignError(ends + "which columns do not support: " + reason.what());  // the reason names a remedy
      }
    });
    return *found.evaluator;
  }

  /// The component of a design that contains the home pose. It is computed once for all blocks of derivatives, because
  /// the design has the same values in all of them.
  template <class S>
  const Home& find_home(std::span<const S> parameters, Scratch& scratch) const {
    Home& home = scratch.get<Home>();
    const auto same = [](const S& a, double b) { return value_of(a) == b; };
    if (home.of == identity_ && std::ranges::equal(parameters, home.parameters, same)) return home;
    home.of.reset();
    home.parameters.resize(parameters.size());
    std::ranges::transform(parameters, home.parameters.begin(), [](const S& x) { return value_of(x); });
    home.map = map_->map(home.parameters);
    home.components = finder_.find(home.parameters, home.map, scratch);
    home.label = finder_.holding(home.parameters, home.map, home.components, home_, "the home pose", scratch);
    const std::vector<WorkspaceComponent>& all = home.components.all;
    const std::int8_t own = all[home.label - 1].side;
    home.side = finder_.ends_at_singularity(home.map, home.components, home.label) ? own : std::int8_t{0};
    home.is_single = std::ranges::count_if(
                         all, [&](const WorkspaceComponent& each) { return home.side == 0 || each.side == own; }) == 1;
    home.of = identity_;
    return home;
  }

  template <class S>
  void run(std::span<const S> parameters, Scratch& scratch, WorkspaceResult<S>& result) const {
    const Home& home = find_home(parameters, scratch);
    if (home.is_single) {
      evaluate_workspace(analysis(home.side, false), parameters, scratch, result);
    } else {
      Nodes<S>& nodes = scratch.get<Nodes<S>>();
      evaluate_workspace(analysis(home.side, true), parameters, scratch, nodes.all);
      keep_members(home, scratch, nodes, result);
    }
    result.is_sampled = true;
  }

  /// Copies the nodes of the component, and computes its share of the volume. If the workspace has other nodes, too,
  /// the relative error includes the error of the sum of all weights; it always includes the weights of nodes that
  /// belong to no component.
  template <class S>
  void keep_members(const Home& home, Scratch& scratch, Nodes<S>& nodes, WorkspaceResult<S>& result) const {
    const WorkspaceResult<S>& all = nodes.all;
    PKM_EXPECTS(all.pose.size() == all.weight.size());
    nodes.poses.clear();
    for (const Pose<S>& pose : all.pose) {
      nodes.poses.emplace_back(pose.size());
      std::ranges::transform(pose, nodes.poses.back().begin(), [](const S& x) { return value_of(x); });
    }
    finder_.find_members(home.parameters, home.map, home.components, home.label, nodes.poses, scratch, nodes.inside);
    const auto sum = [&](auto belongs) {
      S weight{};
      for (std::size_t i = 0; i < nodes.inside.size(); ++i)
        if (belongs(nodes.inside[i])) weight += all.weight[i];
      return weight;
    };
    const S own = sum([](int inside) { return inside == 1; }), total = sum([](int) { return true; });
    const double lost = value_of(sum([](int inside) { return inside < 0; })), volume = value_of(all.volume);
    const bool is_whole = value_of(own) == value_of(total);
    result.clear(request_.fields);
    result.columns = all.columns;
    if (!(value_of(own) > 0)) {  // the component is narrower than the distances between the nodes
      result.error = 1;
      return;
    }
    result.volume = is_whole ? all.volume : all.volume * (own / total);
    result.error = all.error + lost / value_of(own);
    if (!is_whole) result.error += std::fabs(value_of(total) - volume) / value_of(own);
    if (!request_.needs_samples()) return;
    const auto copy = [&](const auto& from, auto& to) {
      for (std::size_t i = 0; i < from.size(); ++i)
        if (nodes.inside[i] == 1) to.push_back(from[i]);
    };
    copy(all.weight, result.weight);
    if (request_.poses) copy(all.pose, result.pose);
    for (const auto& [quantity, field] : all.fields)
      for (std::size_t k = 0; k < field.size(); ++k) copy(field[k], result.fields[quantity][k]);
  }

  const Mechanism& mechanism_;
  WorkspacePlan plan_;
  FieldRequest request_;
  std::array<double, 3> home_;
  ComponentFinder finder_;
  std::unique_ptr<const VoxelEvaluator> map_;
  bool has_gradients_ = false;
  std::shared_ptr<const bool> identity_ = std::make_shared<const bool>(true);
  mutable std::array<std::array<Analysis, 2>, 3> analyses_;
};

}  // namespace

std::unique_ptr<const WorkspaceEvaluator> prepare_home_columns(const Mechanism& mechanism, const WorkspacePlan& plan,
                                                               const FieldRequest& request,
                                                               std::unique_ptr<const VoxelEvaluator> map) {
  return std::make_unique<HomeColumns>(mechanism, plan, request, std::move(map));
}

WorkspacePlan grid_of_components(const MechanismInfo& info, const WorkspacePlan& plan) {
  constexpr std::array<std::int64_t, 3> kCells = {1024, 128, 32};  // number of cells along each axis, by number of axes
  const ColumnOptions& columns = *plan.columns();
  VoxelOptions voxels{.box = columns.box};
  const std::size_t axes = sweep_of(info, plan).swept.size();
  std::fill_n(voxels.cells.begin(), axes, kCells[axes - 1]);
  WorkspacePlan grid = plan;
  grid.method = voxels;
  grid.home.reset();
  return grid;
}

}  // namespace pkm
