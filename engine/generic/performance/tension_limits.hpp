// Loads that cables with limited tensions can balance: hyperplane shifting method (Bouchard, Gosselin, Moore, Journal
// of Mechanisms and Robotics 2 (2010); Gouttefarde, Krut, ARK 2010). All results are formulas of the pose.
//
// Cables are straight and massless. In the coordinates of the platform, A t is the force of the drives, where A = -J^T
// for cables, whose tension t shortens them. The forces A t of all allowed tensions form a zonotope. The normal c of
// each of its faces is normal to n - 1 columns of A, where n is the number of coordinates, so all faces are found by
// enumeration, for any number of redundant cables. A set of loads is balanced if it is on the inner side of every face.
// Drives without limits of tension may exert any force: faces are normal to all of their columns.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "engine/expression/term_matrix.hpp"

namespace pkm::generic {

/// A set of loads in the coordinates of the platform [N, N m]: centre + sum of u_k half_axes[k] over all |u_k| <= 1.
struct LoadSet {
  std::vector<expression::Term> centre;
  std::vector<std::vector<expression::Term>> half_axes;
};

struct TensionBalance {
  /// Tension factor (Pham, Yeo, Yang 2009): the largest ratio of the minimum to the maximum tension among tensions > 0
  /// that balance each other. It is negative if there are none, i.e. outside of the wrench-closure workspace.
  expression::Term factor;
  /// The largest s [N] for which all loads are balanced by tensions between t_min + s and t_max - s; negative at poses
  /// that are not wrench-feasible, -infinity at singular poses.
  expression::Term reserve;
  /// Radius of the largest ball of forces [N] at the platform's origin that are balanced in addition to all loads.
  /// Negative: not all loads are balanced. std::nullopt: the origin does not move.
  std::optional<expression::Term> capacity;
};

/// @param J            joints x coordinates: q' = J x'; at least as many joints as coordinates
/// @param translation  T_v: velocity of the platform's origin for unit rates of the coordinates; may have no rows
/// @param tensions     minimum and maximum tension [N], by joint; std::nullopt: a drive without limits. There are fewer
///                     drives without limits than coordinates
/// @param loads        the sets of loads, each of which has to be balanced
TensionBalance tension_balance(const expression::TermMatrix& J, const expression::TermMatrix& translation,
                               const std::vector<std::optional<std::array<expression::Term, 2>>>& tensions,
                               const std::vector<LoadSet>& loads);

}  // namespace pkm::generic
