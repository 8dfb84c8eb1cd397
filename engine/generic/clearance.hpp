// Clearance: minimum distance between links, modelled as capsules, that are not joined, and between links and
// obstacles.
#pragma once

#include "engine/generic/pose_batch.hpp"

namespace pkm::generic {

/// The pairs of links whose clearance is tested, in ascending order: all pairs except those of two fixed links, of
/// links with a common group, and of links that share an end point, at which they are joined.
std::vector<LinkPair> pairs_to_keep_clear(const Graph& graph, const std::vector<LinkNodes>& links);

/// Indices of the links that move and whose clearance is tested.
std::vector<std::size_t> moving_links(const Graph& graph, const std::vector<LinkNodes>& links);

/// For each link, the links that are exempt from the clearance test with it; empty if no clearance is tested at all.
std::vector<JoinedLinks> joined_links(const Model& model);

/// The clearance limit [m]; std::nullopt if there is none or it is inactive.
std::optional<double> clearance_of(const Model& model, const LimitSpec& limits);

/// Throws std::invalid_argument if the limits include a clearance.
/// @param why  rest of the message, which begins with "mechanism NAME"
void refuse_clearance(const Model& model, const LimitSpec& limits, const std::string& why);

/// The links of the mechanism as capsules, at a pose at which the mechanism assembles; empty if a position is
/// undefined.
/// @param inputs  values of the graph's inputs, including the pose
template <class S>
std::vector<Capsule<S>> capsules_at(const Evaluation& evaluation, const std::vector<S>& inputs);

/// Two links, or a link and an obstacle, with the minimum clearance.
template <class S>
struct NearestBodies {
  S clearance;  ///< distance of the two bodies [m], < 0 if they overlap; NaN if the position of a link is undefined
  std::string first, second;
};

/// The two bodies with the minimum clearance at a pose; std::nullopt if no clearance is tested.
/// @param inputs  values of the graph's inputs, including the pose
template <class S>
std::optional<NearestBodies<S>> nearest_bodies(const Evaluation& evaluation, const std::vector<S>& inputs,
                                               const Obstacles& obstacles);

/// Scratch memory of ClearanceBatch.
struct ClearanceScratch {
  PoseBatchScratch poses;
  std::vector<Capsule<double>> links;
  std::vector<Bounds<double>> boxes;
};

/// Tests a clearance limit for the poses of a workspace analysis, in SIMD batches.
class ClearanceBatch {
 public:
  ClearanceBatch(const Evaluation& evaluation, const std::vector<int>& swept, std::size_t mode, double limit,
                 const Obstacles& obstacles);

  /// start() evaluates what does not depend on the swept coordinates, and empties the batch of poses. add() adds a pose
  /// and returns true if the batch is full.
  void start(const std::vector<double>& inputs, ClearanceScratch& scratch) const;
  bool add(const Pose<double>& pose, ClearanceScratch& scratch) const { return batch_.add(pose, scratch.poses); }
  /// Calls visit(k), in ascending order, for the index k in the batch of each pose that violates the limit; then
  /// empties the batch.
  template <class Visit>
  void finish(ClearanceScratch& scratch, const Visit& visit) const {
    if (scratch.poses.count == 0) return;
    batch_.run(scratch.poses);
    for (std::size_t k = 0; k < scratch.poses.count; ++k)
      if (!is_clear(k, scratch)) visit(k);
    scratch.poses.count = 0;
  }

 private:
  bool is_clear(std::size_t pose, ClearanceScratch& scratch) const;

  const Model& model_;
  double limit_;
  Obstacles obstacles_;
  PoseBatch batch_;
  std::vector<expression::Operand> operands_;  ///< operands of the link positions and radii, kNumbers per link
};

}  // namespace pkm::generic
