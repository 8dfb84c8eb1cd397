// Connected components of a voxel workspace, by union-find over cells: the parts of the workspace in which the robot
// can move without leaving the limits and without crossing a singularity ("generalised aspects" of a working mode,
// Wenger and Chablat 1998).
//
// Two neighbouring feasible cells are connected if their centres and the centre of their common face are feasible and
// lie on the same side of the singularities (PoseSides). Cells whose centre is singular belong to no component. An axis
// over a full turn is periodic: its last cell is a neighbour of its first one. Gaps and necks of less than half a cell
// may be missed.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/mechanism/mechanism.hpp"
#include "engine/workspace/voxel_grid.hpp"

namespace pkm {

struct WorkspaceComponent {
  std::int64_t cells = 0;
  std::size_t first = 0;  ///< lowest index of the component's cells
  std::int8_t side = 0;   ///< sign of det J in the component; PoseSides::kSingular if components may cross
                          ///< singularities
};

struct ConnectedComponents {
  std::vector<std::uint32_t> label;     ///< for each cell, the number of its component, from 1; 0: the cell belongs to
                                        ///< no component
  std::vector<WorkspaceComponent> all;  ///< component k has the number k + 1; the largest one comes first
};

/// Whether paths within a component may cross singularities; if not, components end there.
enum class Crossing { forbidden, allowed };

/// Finds the connected components of voxel workspaces. Immutable and thread-safe.
class ComponentFinder {
 public:
  /// Throws std::invalid_argument with one sentence if the plan is not supported: coordinates that are integrated over
  /// or have several values, and mechanisms with fewer joints than coordinates.
  /// @param mechanism  must outlive this object
  /// @param mode       working mode; "": the first
  ComponentFinder(const Mechanism& mechanism, const WorkspacePlan& plan, const std::string& mode,
                  Crossing crossing = Crossing::forbidden);

  /// @param map  feasible cells of the same design and plan
  ConnectedComponents find(std::span<const double> parameters, const VoxelMap& map, Scratch& scratch) const;
  /// Number of the component that holds a pose. Throws DesignError with the reason if there is none: the pose is
  /// outside of the grid, infeasible or singular, or no cell near it is connected with it.
  /// @param at    values of the swept coordinates
  /// @param what  name of the pose in messages: "the home pose"
  std::uint32_t holding(std::span<const double> parameters, const VoxelMap& map, const ConnectedComponents& components,
                        const std::array<double, 3>& at, const std::string& what, Scratch& scratch) const;
  /// @return true if a cell of a component has a feasible neighbour that is singular or on the other side of the
  /// singularities
  bool ends_at_singularity(const VoxelMap& map, const ConnectedComponents& components, std::uint32_t label) const;
  /// Determines which poses are in the component that holds the home pose. Two consecutive poses, and a pose and a cell
  /// near it, are connected if the straight line between them is feasible, so that poses can also connect components of
  /// the grid.
  /// @param home    number of the component that holds the home pose
  /// @param inside  receives for each pose 1 if it is in the component, 0 if it is in another one, and -1 if no cell
  ///   and no pose is connected with it
  void find_members(std::span<const double> parameters, const VoxelMap& map, const ConnectedComponents& components,
                    std::uint32_t home, std::span<const Pose<double>> poses, Scratch& scratch,
                    std::vector<std::int8_t>& inside) const;
  /// A polyline within one component from one pose to another, through centres of connected cells. It prefers cells far
  /// from the boundary of the component: the shortest path (Dijkstra's algorithm) with the cost 1 + 8 / d^2 of a cell
  /// at the distance d from the boundary, in cells. Every two neighbouring points are connected by a straight line
  /// whose sampled poses are feasible and on one side of the singularities. Throws DesignError if a
  /// pose is in no component, or if the two poses are in different components.
  struct Path {
    std::vector<Pose<double>> cells;    ///< all points of the polyline
    std::vector<Pose<double>> corners;  ///< points of a shortened polyline, without the points that a straight line
                                        ///< between others can replace
  };
  Path path(std::span<const double> parameters, const VoxelMap& map, const ConnectedComponents& components,
            const std::array<double, 3>& from, const std::array<double, 3>& to, Scratch& scratch) const;

 private:
  class Search;

  const Mechanism& mechanism_;
  WorkspacePlan plan_;
  const Sweep& sweep_;
  std::string mode_;
  Crossing crossing_;
  std::unique_ptr<const PoseSides> sides_;
};

}  // namespace pkm
