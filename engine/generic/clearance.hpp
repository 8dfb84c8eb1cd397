// Clearance of the links of a description: which have to keep clear of each other, and how far they do.
#pragma once

#include "engine/generic/pose_rows.hpp"

namespace pkm::generic {

/// All but links that stand still both, that have a group in common, or that end in the same point: a joint.
std::vector<LinkPair> pairs_to_keep_clear(const Graph& graph, const std::vector<LinkNodes>& links);

/// The links that do not stand still.
std::vector<std::size_t> moving_links(const Graph& graph, const std::vector<LinkNodes>& links);

/// Of each link, in their order, those that it need not keep clear of; empty where there are no pairs.
std::vector<JoinedLinks> joined_links(const Model& model);

/// The limit in force; none: nobody asks for a clearance.
std::optional<double> clearance_of(const Model& model, const LimitSpec& limits);

/// Throws std::invalid_argument where a plan asks for a clearance. @param why  the sentence behind "mechanism .."
void refuse_clearance(const Model& model, const LimitSpec& limits, const std::string& why);

/// All links of a pose that assembles; empty where the place of one has no value.
/// @param inputs  of the graph, with the pose
template <class S>
std::vector<Capsule<S>> capsules_at(const Evaluation& evaluation, const std::vector<S>& inputs);

/// What is nearest to each other of what has to keep clear.
template <class S>
struct NearestBodies {
  S clearance;  ///< [m], negative where they overlap; not a number where the place of a link has no value
  std::string first, second;
};

/// Of links, and of links and obstacles. None: nothing has to keep clear.
template <class S>
std::optional<NearestBodies<S>> nearest_bodies(const Evaluation& evaluation, const std::vector<S>& inputs,
                                               const Obstacles& obstacles);

/// A clearance limit in a survey, 64 poses at a time.
class ClearanceRows {
 public:
  struct Room {
    PoseRowsRoom poses;
    std::vector<Capsule<double>> links;
    std::vector<Bounds<double>> box;
  };

  ClearanceRows(const Evaluation& evaluation, const std::vector<int>& swept, std::size_t mode, double least,
                const Obstacles& obstacles);

  void start(const std::vector<double>& inputs, Room& room) const;
  /// @return  whether 64 poses wait
  bool add(const Pose<double>& pose, Room& room) const { return rows_.add(pose, room.poses); }
  /// Calls visit(k) for each of the poses that wait, in their order, at which links are too near.
  template <class Visit>
  void finish(Room& room, const Visit& visit) const {
    if (room.poses.count == 0) return;
    rows_.run(room.poses);
    for (std::size_t k = 0; k < room.poses.count; ++k)
      if (!is_clear(k, room)) visit(k);
    room.poses.count = 0;
  }

 private:
  bool is_clear(std::size_t pose, Room& room) const;

  const Model& model_;
  double least_;
  Obstacles obstacles_;
  PoseRows rows_;
  std::vector<expression::Operand> operands_;  ///< seven of each link
};

}  // namespace pkm::generic
