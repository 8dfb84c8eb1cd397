#include "engine/generic/pose_arrays.hpp"

#include <cmath>
#include <limits>
#include <numeric>

#include "engine/core/stop.hpp"
#include "engine/core/team.hpp"
#include "engine/math/satisfied.hpp"

namespace pkm::generic {
namespace {

std::vector<int> all_coordinates(const Model& model) {
  std::vector<int> all(model.inputs.coordinates);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

/// The given nodes, followed by the nodes that determine whether the mechanism assembles at a pose: joint coordinates
/// and constraints.
std::vector<Node> with_assembly(const Model& model, std::vector<Node> values) {
  values.insert(values.end(), model.joints.begin(), model.joints.end());
  for (const Result& domain : model.domains) values.push_back(domain.node);
  return values;
}

}  // namespace

PoseArrays PoseArrays::joints(const Evaluation& evaluation, std::size_t mode) {
  return {evaluation, mode, evaluation.model.joints};
}
PoseArrays PoseArrays::jacobians(const Evaluation& evaluation, std::size_t mode) {
  return {evaluation, mode, evaluation.model.jacobian};
}
PoseArrays PoseArrays::quantity(const Evaluation& evaluation, std::size_t mode, std::size_t index) {
  return {evaluation, mode, {evaluation.model.quantities.at(index)}};
}

PoseArrays::PoseArrays(const Evaluation& evaluation, std::size_t mode, std::vector<Node> nodes)
    : e_(evaluation),
      mode_(mode),
      width_(nodes.size()),
      batch_(evaluation.model, with_assembly(evaluation.model, std::move(nodes)), all_coordinates(evaluation.model),
             mode) {}

void PoseArrays::evaluate(std::span<const double> parameters, const LimitSpec& limits, std::span<const double> poses,
                          std::span<double> values) const {
  const std::size_t coordinates = e_.model.inputs.coordinates, joints = e_.model.inputs.joints;
  const std::vector<double> inputs = e_.inputs(parameters, limits, mode_);
  std::vector<expression::Operand> outputs;
  for (std::size_t i = 0; i < batch_.outputs().size(); ++i) outputs.push_back(batch_.operand(i));
  parallel_for(poses.size() / coordinates, [&](std::size_t begin, std::size_t end) {
    PoseBatchScratch scratch;
    batch_.start(inputs, scratch);
    Pose<double> pose(coordinates);
    std::size_t first = begin;  // index of the first pose of the batch
    for (std::size_t k = begin; k < end; ++k) {
      std::ranges::copy(poses.subspan(k * coordinates, coordinates), pose.begin());
      if (!batch_.add(pose, scratch) && k + 1 < end) continue;
      check_stop();
      batch_.run(scratch);
      for (std::size_t i = 0; i < scratch.count; ++i) {
        const auto at = [&](std::size_t output) { return PoseBatch::value(outputs[output], i, scratch); };
        bool assembles = true;
        for (std::size_t j = 0; j < joints && assembles; ++j) assembles = std::isfinite(at(width_ + j));
        for (std::size_t j = width_ + joints; j < outputs.size() && assembles; ++j) assembles = is_satisfied(at(j));
        for (std::size_t j = 0; j < width_; ++j)
          values[(first + i) * width_ + j] = assembles ? at(j) : std::numeric_limits<double>::quiet_NaN();
      }
      scratch.count = 0;
      first = k + 1;
    }
  });
}

}  // namespace pkm::generic
