#include "engine/workspace/components.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <queue>
#include <stdexcept>

#include "engine/core/catalogue.hpp"
#include "engine/core/error.hpp"
#include "engine/core/stop.hpp"
#include "engine/core/unit.hpp"
#include "engine/math/disjoint_sets.hpp"
#include "engine/workspace/side_of_jacobian.hpp"

namespace pkm {
namespace {

/// Finds the side of the singularities on which a pose lies by Mechanism::inspect(), for mechanisms without a faster
/// test.
class InspectedSides final : public PoseSides {
 public:
  InspectedSides(const Mechanism& mechanism, const LimitSpec& limits, const std::string& mode)
      : mechanism_(mechanism), limits_(limits), mode_(mode.empty() ? mechanism.info().modes.front() : mode) {}

  void start(std::span<const double> parameters, Scratch& scratch) const override {
    scratch.get<Parameters>().values.assign(parameters.begin(), parameters.end());
  }
  void find(std::span<const Pose<double>> poses, bool, Scratch& scratch, std::span<std::int8_t> sides) const override {
    const std::vector<double>& parameters = scratch.get<Parameters>().values;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const PoseReport report = mechanism_.inspect(parameters, poses[i], mode_, limits_);
      sides[i] = !report.feasible ? kInfeasible : report.J ? side_of(*report.J) : kSingular;
    }
  }

 private:
  struct Parameters {
    std::vector<double> values;
  };

  const Mechanism& mechanism_;
  LimitSpec limits_;
  std::string mode_;
};

}  // namespace

/// The search for components on the voxel grid of one design.
class ComponentFinder::Search {
 public:
  Search(const ComponentFinder& finder, std::span<const double> parameters, const VoxelMap& map, Scratch& scratch)
      : finder_(finder),
        parameters_(parameters),
        scratch_(scratch),
        axes_(finder.sweep_.swept.size()),
        grid_(map),
        fixed_(finder.mechanism_.info().coordinates.size()) {
    const MechanismInfo& info = finder.mechanism_.info();
    for (const int coordinate : finder.sweep_.fixed)
      fixed_[static_cast<std::size_t>(coordinate)] =
          fixed_value(finder.mechanism_, parameters, finder.plan_, coordinate);
    std::size_t stride = 1;
    for (std::size_t axis = 3; axis-- > 0;) {
      stride_[axis] = stride;
      stride *= size(axis);
    }
    for (std::size_t axis = 0; axis < axes_; ++axis)
      is_periodic_[axis] = info.coordinates[static_cast<std::size_t>(finder.sweep_.swept[axis])].turns() &&
                           grid_.upper[axis] - grid_.lower[axis] > 2 * std::numbers::pi * (1 - 1e-12) && size(axis) > 2;
    finder.sides_->start(parameters, scratch);
  }

  std::size_t axes() const { return axes_; }
  std::size_t size(std::size_t axis) const { return static_cast<std::size_t>(grid_.cells[axis]); }
  std::size_t count() const { return static_cast<std::size_t>(grid_.count()); }
  std::size_t index(std::size_t cell, std::size_t axis) const { return cell / stride_[axis] % size(axis); }

  /// The next cell along an axis; std::nullopt at the end of an axis that is not periodic.
  std::optional<std::size_t> next(std::size_t cell, std::size_t axis) const {
    if (index(cell, axis) + 1 < size(axis)) return cell + stride_[axis];
    if (is_periodic_[axis]) return cell - index(cell, axis) * stride_[axis];
    return {};
  }
  std::optional<std::size_t> previous(std::size_t cell, std::size_t axis) const {
    if (index(cell, axis) > 0) return cell - stride_[axis];
    if (is_periodic_[axis]) return cell + (size(axis) - 1) * stride_[axis];
    return {};
  }

  Pose<double> pose(const std::array<double, 3>& at) const {
    Pose<double> pose = fixed_;
    for (std::size_t axis = 0; axis < axes_; ++axis) coordinate(pose, axis) = at[axis];
    return pose;
  }
  Pose<double> centre(std::size_t cell) const {
    std::array<double, 3> at{};
    for (std::size_t axis = 0; axis < axes_; ++axis)
      at[axis] = grid_.centre(axis, static_cast<std::int64_t>(index(cell, axis)));
    return pose(at);
  }
  /// Centre of the face between a cell and the next one along an axis.
  Pose<double> face(std::size_t cell, std::size_t axis) const {
    Pose<double> pose = centre(cell);
    coordinate(pose, axis) = grid_.lower[axis] + static_cast<double>(index(cell, axis) + 1) * grid_.step[axis];
    return pose;
  }
  double& coordinate(Pose<double>& pose, std::size_t axis) const {
    return pose[static_cast<std::size_t>(finder_.sweep_.swept[axis])];
  }
  bool is_periodic(std::size_t axis) const { return is_periodic_[axis]; }

  /// For each pose, the side of the singularities on which it lies (PoseSides). The result is valid until the next
  /// call. @param feasible  true: all poses are known to be feasible
  const std::vector<std::int8_t>& sides(std::span<const Pose<double>> poses, bool feasible) {
    sides_.resize(poses.size());
    finder_.sides_->find(poses, feasible, scratch_, sides_);
    return sides_;
  }
  std::int8_t side(const Pose<double>& pose) { return sides({&pose, 1}, false)[0]; }

  /// Calls visit(cell, side) for each cell, where `side` is that of the pose pose_of(cell); evaluates in batches.
  template <class PoseOf, class Visit>
  void find_sides(const std::vector<std::size_t>& cells, const PoseOf& pose_of, bool feasible, const Visit& visit) {
    constexpr std::size_t kBatch = 512;
    for (std::size_t first = 0; first < cells.size(); first += kBatch) {
      check_stop();
      const std::size_t end = std::min(first + kBatch, cells.size());
      poses_.clear();
      for (std::size_t k = first; k < end; ++k) poses_.push_back(pose_of(cells[k]));
      const std::vector<std::int8_t>& found = sides(poses_, feasible);
      for (std::size_t k = first; k < end; ++k) visit(cells[k], found[k - first]);
    }
  }

  /// @return true if a path may lead from a pose on side `a` of the singularities to an adjacent pose on side `b`
  bool are_compatible(std::int8_t a, std::int8_t b) const {
    if (a == PoseSides::kInfeasible || b == PoseSides::kInfeasible) return false;
    return finder_.crossing_ == Crossing::allowed || (a == b && a != PoseSides::kSingular);
  }

  /// @return true if all poses sampled on the straight line between two poses, at most half a cell apart, are
  ///         compatible with its start
  bool is_free(const Pose<double>& from, const Pose<double>& to) {
    double cells = 1;
    for (std::size_t axis = 0; axis < axes_; ++axis) {
      const auto c = static_cast<std::size_t>(finder_.sweep_.swept[axis]);
      cells = std::fmax(cells, std::fabs(to[c] - from[c]) / grid_.step[axis]);
    }
    const auto samples = static_cast<std::size_t>(std::ceil(2 * cells));
    poses_.clear();
    for (std::size_t i = 0; i <= samples; ++i) {
      poses_.push_back(from);
      for (std::size_t c = 0; c < from.size(); ++c)
        poses_.back()[c] = std::lerp(from[c], to[c], static_cast<double>(i) / static_cast<double>(samples));
    }
    const std::vector<std::int8_t>& found = sides(poses_, false);
    return std::ranges::all_of(found, [&](std::int8_t side) { return are_compatible(found.front(), side); });
  }

  /// Calls visit(cell) for the cells of components within two cells of the one that contains a pose, the nearest one
  /// first, until it returns false.
  template <class Visit>
  void for_cells_near(const ConnectedComponents& components, const Pose<double>& pose, const Visit& visit) {
    constexpr std::int64_t kNear = 2;
    std::array<double, 3> at{};  // position of the pose, in units of cells
    Cell from{}, end{1, 1, 1};
    for (std::size_t axis = 0; axis < axes_; ++axis) {
      const double value = pose[static_cast<std::size_t>(finder_.sweep_.swept[axis])];
      at[axis] = grid_.step[axis] > 0 ? (value - grid_.lower[axis]) / grid_.step[axis] : 0;
      const std::int64_t middle =
          std::clamp(static_cast<std::int64_t>(at[axis]), std::int64_t{0}, grid_.cells[axis] - 1);
      from[axis] = std::max<std::int64_t>(middle - kNear, 0);
      end[axis] = std::min(middle + kNear + 1, grid_.cells[axis]);
    }
    near_.clear();
    Cell cell;
    for (cell[0] = from[0]; cell[0] < end[0]; ++cell[0])
      for (cell[1] = from[1]; cell[1] < end[1]; ++cell[1])
        for (cell[2] = from[2]; cell[2] < end[2]; ++cell[2]) {
          if (components.label[grid_.index(cell)] == 0) continue;
          double distance = 0;
          for (std::size_t axis = 0; axis < axes_; ++axis) {
            const double cells = static_cast<double>(cell[axis]) + 0.5 - at[axis];
            distance += cells * cells;
          }
          near_.emplace_back(distance, grid_.index(cell));
        }
    std::ranges::sort(near_);
    for (const auto& [distance, candidate] : near_)
      if (!visit(candidate)) return;
  }

  /// The nearest cell of a component that a feasible straight line connects with a pose. Throws DesignError if there is
  /// none, or if the pose is infeasible, singular or outside of the grid.
  std::size_t cell_near(const ConnectedComponents& components, const std::array<double, 3>& at,
                        const std::string& what) {
    const MechanismInfo& info = finder_.mechanism_.info();
    std::vector<std::string> words;
    bool is_outside = false;
    for (std::size_t axis = 0; axis < axes_; ++axis) {
      const AxisInfo& named = info.coordinates[static_cast<std::size_t>(finder_.sweep_.swept[axis])];
      words.push_back(named.name + " = " + with_degrees(at[axis], named.unit));
      is_outside = is_outside || !(at[axis] >= grid_.lower[axis] && at[axis] <= grid_.upper[axis]);
    }
    const std::string name = what + " " + join(words);
    const Pose<double> given = pose(at);
    const std::int8_t own = side(given);
    if (own == PoseSides::kInfeasible) {
      const std::string& mode = finder_.mode_.empty() ? info.modes.front() : finder_.mode_;
      const PoseReport report = finder_.mechanism_.inspect(parameters_, given, mode, finder_.plan_.limits);
      throw DesignError(name + " is infeasible" + (report.reason.empty() ? "" : ": " + report.reason));
    }
    if (is_outside) throw DesignError(name + " is outside of the box of the workspace");
    if (own == PoseSides::kSingular && finder_.crossing_ == Crossing::forbidden)
      throw DesignError(name + " is singular");
    std::optional<std::size_t> nearest;
    for_cells_near(components, given, [&](std::size_t candidate) {
      if (!is_free(given, centre(candidate))) return true;
      nearest = candidate;
      return false;
    });
    if (nearest) return *nearest;
    throw DesignError("no cell of the grid near " + name + " is connected with it; expected more cells");
  }

 private:
  const ComponentFinder& finder_;
  std::span<const double> parameters_;
  Scratch& scratch_;
  std::size_t axes_;
  VoxelGrid grid_;
  Pose<double> fixed_;  ///< values of the fixed coordinates
  std::array<std::size_t, 3> stride_{};
  std::array<bool, 3> is_periodic_{};
  std::vector<std::int8_t> sides_;
  std::vector<Pose<double>> poses_;
  std::vector<std::pair<double, std::size_t>> near_;
};

ComponentFinder::ComponentFinder(const Mechanism& mechanism, const WorkspacePlan& plan, const std::string& mode,
                                 Crossing crossing)
    : mechanism_(mechanism), plan_(plan), sweep_(sweep_of(mechanism.info(), plan)), mode_(mode), crossing_(crossing) {
  const MechanismInfo& info = mechanism.info();
  for (const int coordinate : sweep_.fixed) {
    const auto kind = how_fixed(plan, coordinate).kind;
    if (kind == FixedCoordinate::Kind::integrated || kind == FixedCoordinate::Kind::listed)
      throw std::invalid_argument("components of a workspace need a single value of " +
                                  info.coordinates[static_cast<std::size_t>(coordinate)].name +
                                  ", but the workspace analysis " +
                                  (kind == FixedCoordinate::Kind::listed ? "has several" : "integrates over it") +
                                  "; fix it at one value, or sweep it");
  }
  if (info.joints.size() < info.coordinates.size() && crossing == Crossing::forbidden)
    throw std::invalid_argument("mechanism " + info.name + " has fewer joints (" + std::to_string(info.joints.size()) +
                                ") than coordinates (" + std::to_string(info.coordinates.size()) +
                                "), so that every pose is singular and belongs to no component");
  if (mechanism.voxels()) sides_ = mechanism.voxels()->prepare_sides(plan, mode);
  if (!sides_) sides_ = std::make_unique<InspectedSides>(mechanism, plan.limits, mode);
}

ConnectedComponents ComponentFinder::find(std::span<const double> parameters, const VoxelMap& map,
                                          Scratch& scratch) const {
  Search search(*this, parameters, map, scratch);
  std::vector<std::int8_t> side(search.count(), PoseSides::kInfeasible);
  std::vector<std::size_t> cells;
  for (std::size_t cell = 0; cell < search.count(); ++cell)
    if (map.feasible[cell] != 0) cells.push_back(cell);
  search.find_sides(
      cells, [&](std::size_t cell) { return search.centre(cell); }, true,
      [&](std::size_t cell, std::int8_t found) { side[cell] = found; });

  DisjointSets sets(search.count());
  const auto is_joined = [&](std::size_t cell, std::size_t next) { return sets.root(cell) == sets.root(next); };
  // Faces between a cell and the next one along the axis, each represented by the first of the two cells: `faces`
  // contains those that are tested first, `rest` the others.
  std::vector<std::size_t> faces, rest;
  for (std::size_t axis = search.axes(); axis-- > 0;) {
    const auto next_of = [&](std::size_t cell) { return *search.next(cell, axis); };
    const auto test = [&](const std::vector<std::size_t>& tested) {
      search.find_sides(
          tested, [&](std::size_t cell) { return search.face(cell, axis); }, false,
          [&](std::size_t cell, std::int8_t found) {
            if (search.are_compatible(side[cell], found)) sets.unite(cell, next_of(cell));
          });
    };
    rest.clear();
    for (const std::size_t cell : cells) {
      const auto next = search.next(cell, axis);
      if (next && search.are_compatible(side[cell], side[*next]) && !is_joined(cell, *next)) rest.push_back(cell);
    }
    // Consecutive faces that separate the same two sets are tested beginning with the middle one: if the middle face
    // connects the two sets, the other faces need no test.
    faces.clear();
    const auto pair_of = [&](std::size_t cell) { return std::pair(sets.root(cell), sets.root(next_of(cell))); };
    for (auto first = rest.begin(); first != rest.end();) {
      const auto end = std::find_if(first, rest.end(),
                                    [&, pair = pair_of(*first)](std::size_t cell) { return pair_of(cell) != pair; });
      faces.push_back(*(first + (end - first) / 2));
      first = end;
    }
    test(faces);
    std::erase_if(rest, [&](std::size_t cell) {
      return is_joined(cell, next_of(cell)) || std::ranges::binary_search(faces, cell);
    });
    test(rest);
  }

  ConnectedComponents components;
  components.label.assign(search.count(), 0);
  const auto belongs = [&](std::size_t cell) { return search.are_compatible(side[cell], side[cell]); };
  std::vector<WorkspaceComponent> found;
  for (const std::size_t cell : cells) {
    if (!belongs(cell)) continue;
    // The cell of the set with the lowest index, which has therefore been visited before.
    const std::size_t root = sets.root(cell);
    if (root == cell) {
      found.push_back({.first = cell, .side = crossing_ == Crossing::allowed ? PoseSides::kSingular : side[cell]});
      components.label[cell] = static_cast<std::uint32_t>(found.size());
    }
    components.label[cell] = components.label[root];
    ++found[components.label[root] - 1].cells;
  }
  std::vector<std::uint32_t> order(found.size()), number(found.size() + 1);
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::stable_sort(order, [&](std::uint32_t a, std::uint32_t b) { return found[a].cells > found[b].cells; });
  for (std::uint32_t k = 0; k < order.size(); ++k) {
    components.all.push_back(found[order[k]]);
    number[order[k] + 1] = k + 1;
  }
  for (std::uint32_t& label : components.label) label = number[label];
  return components;
}

std::uint32_t ComponentFinder::holding(std::span<const double> parameters, const VoxelMap& map,
                                       const ConnectedComponents& components, const std::array<double, 3>& at,
                                       const std::string& what, Scratch& scratch) const {
  Search search(*this, parameters, map, scratch);
  return components.label[search.cell_near(components, at, what)];
}

bool ComponentFinder::ends_at_singularity(const VoxelMap& map, const ConnectedComponents& components,
                                          std::uint32_t label) const {
  const VoxelGrid grid(map);
  const std::array<std::size_t, 3> stride = {grid.index({1, 0, 0}), grid.index({0, 1, 0}), 1};
  const auto side = [&](std::size_t cell) {
    const std::uint32_t own = components.label[cell];
    return own > 0 ? components.all[own - 1].side : PoseSides::kSingular;
  };
  const auto ends_between = [&](std::size_t cell, std::size_t next) {
    return map.feasible[cell] != 0 && map.feasible[next] != 0 && side(cell) != side(next) &&
           (components.label[cell] == label || components.label[next] == label);
  };
  Cell cell;
  for (cell[0] = 0; cell[0] < grid.cells[0]; ++cell[0])
    for (cell[1] = 0; cell[1] < grid.cells[1]; ++cell[1])
      for (cell[2] = 0; cell[2] < grid.cells[2]; ++cell[2])
        for (std::size_t axis = 0; axis < sweep_.swept.size(); ++axis)
          if (cell[axis] + 1 < grid.cells[axis] && ends_between(grid.index(cell), grid.index(cell) + stride[axis]))
            return true;
  return false;
}

void ComponentFinder::find_members(std::span<const double> parameters, const VoxelMap& map,
                                   const ConnectedComponents& components, std::uint32_t home,
                                   std::span<const Pose<double>> poses, Scratch& scratch,
                                   std::vector<std::int8_t>& inside) const {
  Search search(*this, parameters, map, scratch);
  // The first elements of `sets` are the labels, the other elements are the poses.
  const std::size_t labels = components.all.size() + 1;
  DisjointSets sets(labels + poses.size());
  std::vector<std::uint32_t> tried;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    check_stop();
    if (i > 0 && search.is_free(poses[i - 1], poses[i])) sets.unite(labels + i - 1, labels + i);
    tried.clear();
    search.for_cells_near(components, poses[i], [&](std::size_t cell) {
      const std::uint32_t label = components.label[cell];
      if (std::ranges::find(tried, label) != tried.end()) return true;
      tried.push_back(label);
      if (search.is_free(poses[i], search.centre(cell))) sets.unite(label, labels + i);
      return true;
    });
  }
  inside.resize(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const std::size_t root = sets.root(labels + i);
    inside[i] = root == sets.root(home) ? 1 : root < labels ? 0 : -1;
  }
}

ComponentFinder::Path ComponentFinder::path(std::span<const double> parameters, const VoxelMap& map,
                                            const ConnectedComponents& components, const std::array<double, 3>& from,
                                            const std::array<double, 3>& to, Scratch& scratch) const {
  Search search(*this, parameters, map, scratch);
  const std::size_t start = search.cell_near(components, from, "the pose"),
                    goal = search.cell_near(components, to, "the pose");
  const std::uint32_t label = components.label[start];
  if (components.label[goal] != label) throw DesignError("the two poses are in different components");
  const auto inside = [&](std::size_t cell) { return components.label[cell] == label; };
  const auto neighbour = [&](std::size_t cell, std::size_t k) {
    return k % 2 == 0 ? search.next(cell, k / 2) : search.previous(cell, k / 2);
  };
  // Compute the distances of the cells from the boundary of the component, in cells (breadth-first search).
  std::vector<std::uint32_t> distance(search.count(), 0);
  std::vector<std::size_t> wave;
  for (std::size_t cell = 0; cell < search.count(); ++cell) {
    if (!inside(cell)) continue;
    bool at_boundary = false;
    for (std::size_t k = 0; k < 2 * search.axes(); ++k)
      if (const auto other = neighbour(cell, k)) at_boundary = at_boundary || !inside(*other);
    if (!at_boundary) continue;
    distance[cell] = 1;
    wave.push_back(cell);
  }
  for (std::size_t i = 0; i < wave.size(); ++i)
    for (std::size_t k = 0; k < 2 * search.axes(); ++k)
      if (const auto other = neighbour(wave[i], k); other && inside(*other) && distance[*other] == 0) {
        distance[*other] = distance[wave[i]] + 1;
        wave.push_back(*other);
      }
  const auto cost_of = [&](std::size_t cell) {
    // The distance is 0 if the component has no boundary.
    const double d = distance[cell] == 0 ? std::numeric_limits<double>::infinity() : distance[cell];
    return 1 + 8 / (d * d);
  };

  std::vector<double> cost(search.count(), std::numeric_limits<double>::infinity());
  std::vector<std::size_t> before(search.count(), search.count());
  std::vector<bool> is_final(search.count(), false);
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  cost[start] = 0;
  queue.emplace(0, start);
  while (!queue.empty() && !is_final[goal]) {
    check_stop();
    const std::size_t cell = queue.top().second;
    queue.pop();
    if (is_final[cell]) continue;
    is_final[cell] = true;
    for (std::size_t k = 0; k < 2 * search.axes(); ++k) {
      const auto other = neighbour(cell, k);
      if (!other || !inside(*other) || is_final[*other]) continue;
      const double through = cost[cell] + cost_of(*other);
      if (through >= cost[*other]) continue;
      const std::int8_t side = search.side(search.face(k % 2 == 0 ? cell : *other, k / 2));
      if (!search.are_compatible(components.all[label - 1].side, side)) continue;
      cost[*other] = through;
      before[*other] = cell;
      queue.emplace(through, *other);
    }
  }
  PKM_EXPECTS(is_final[goal]);
  std::vector<std::size_t> cells;
  for (std::size_t cell = goal; cell != search.count(); cell = before[cell]) cells.push_back(cell);
  std::ranges::reverse(cells);

  Path found;
  found.cells.push_back(search.pose(from));
  for (const std::size_t cell : cells) found.cells.push_back(search.centre(cell));
  found.cells.push_back(search.pose(to));
  // Choose equivalent angles such that consecutive points do not differ by a full revolution.
  for (std::size_t i = 1; i < found.cells.size(); ++i)
    for (std::size_t axis = 0; axis < search.axes(); ++axis) {
      if (!search.is_periodic(axis)) continue;
      double& angle = search.coordinate(found.cells[i], axis);
      const double turns = std::round((search.coordinate(found.cells[i - 1], axis) - angle) / (2 * std::numbers::pi));
      if (turns != 0) angle += 2 * std::numbers::pi * turns;
    }
  const auto equal = [](const Pose<double>& a, const Pose<double>& b) { return std::ranges::equal(a, b); };
  found.cells.erase(std::unique(found.cells.begin(), found.cells.end(), equal), found.cells.end());
  // From each corner, continue with the farthest point that a feasible straight line connects with it.
  found.corners.push_back(found.cells.front());
  for (std::size_t i = 0; i + 1 < found.cells.size();) {
    std::size_t j = found.cells.size() - 1;
    while (j > i + 1 && !search.is_free(found.cells[i], found.cells[j])) --j;
    found.corners.push_back(found.cells[j]);
    i = j;
  }
  return found;
}

}  // namespace pkm
