#include "engine/generic/pose_sides.hpp"

#include <cmath>

#include "engine/generic/clearance.hpp"
#include "engine/generic/kinematics.hpp"
#include "engine/generic/pose_batch.hpp"
#include "engine/generic/report_limits.hpp"
#include "engine/math/satisfied.hpp"
#include "engine/mechanism/mechanism.hpp"
#include "engine/workspace/side_of_jacobian.hpp"

namespace pkm::generic {
namespace {

/// The constraints that a feasible pose has to satisfy, as nodes of the model's graph.
std::vector<Node> constraint_nodes(const Model& model) {
  std::vector<Node> nodes;
  for (const auto* const list : {&model.domains, &model.margins})
    for (const Result& result : *list) nodes.push_back(result.node);
  nodes.insert(nodes.end(), model.defined.begin(), model.defined.end());
  return nodes;
}

std::vector<Node> joined(std::vector<Node> nodes, const std::vector<Node>& others) {
  nodes.insert(nodes.end(), others.begin(), others.end());
  return nodes;
}

class GenericSides final : public PoseSides {
 public:
  GenericSides(const Evaluation& evaluation, const WorkspacePlan& plan, std::size_t mode)
      : e_(evaluation),
        plan_(plan),
        mode_(mode),
        has_other_limits_(clearance_of(evaluation.model, plan.limits) ||
                          first_report_limit(evaluation.model, plan.limits)),
        constraints_(constraint_nodes(evaluation.model).size()),
        jacobian_(evaluation.model, evaluation.model.jacobian, swept(), mode),
        all_(evaluation.model, joined(constraint_nodes(evaluation.model), evaluation.model.jacobian), swept(), mode) {}

  void start(std::span<const double> parameters, Scratch& scratch) const override {
    Buffers& buffers = scratch.get<Buffers>();
    buffers.parameters.assign(parameters.begin(), parameters.end());
    e_.fill_inputs<double>(parameters, plan_, mode_, buffers.inputs);
    jacobian_.start(buffers.inputs, buffers.jacobian);
    all_.start(buffers.inputs, buffers.all);
  }

  void find(std::span<const Pose<double>> poses, bool feasible, Scratch& scratch,
            std::span<std::int8_t> sides) const override {
    Buffers& buffers = scratch.get<Buffers>();
    const PoseBatch& batch = feasible ? jacobian_ : all_;
    PoseBatchScratch& memory = feasible ? buffers.jacobian : buffers.all;
    for (std::size_t first = 0; first < poses.size();) {
      std::size_t next = first;
      while (next < poses.size() && !batch.add(poses[next++], memory)) {
      }
      batch.run(memory);
      memory.count = 0;
      for (std::size_t k = 0; k < next - first; ++k)
        sides[first + k] = side(batch, feasible ? 0 : constraints_, k, memory);
      first = next;
    }
    if (!feasible && has_other_limits_)
      for (std::size_t k = 0; k < poses.size(); ++k)
        if (sides[k] != kInfeasible && !inspect_pose(e_, buffers.parameters, poses[k], mode_, plan_.limits).feasible)
          sides[k] = kInfeasible;
  }

 private:
  struct Buffers {
    std::vector<double> parameters, inputs;
    PoseBatchScratch jacobian, all;
  };

  const std::vector<int>& swept() const { return sweep_of(e_.model.info, plan_).swept; }

  /// Side of the singularities on which a pose of the batch lies, or kInfeasible. The outputs of the batch are the
  /// constraints, followed by the elements of the Jacobian.
  std::int8_t side(const PoseBatch& batch, std::size_t constraints, std::size_t pose,
                   const PoseBatchScratch& scratch) const {
    for (std::size_t i = 0; i < constraints; ++i)
      if (!is_satisfied(PoseBatch::value(batch.operand(i), pose, scratch))) return kInfeasible;
    AxisMatrix<double> J(e_.model.inputs.joints, e_.model.inputs.coordinates);
    for (std::size_t i = 0; i < J.size(); ++i) J[i] = PoseBatch::value(batch.operand(constraints + i), pose, scratch);
    return side_of(J);
  }

  const Evaluation& e_;
  WorkspacePlan plan_;
  std::size_t mode_;
  /// true: some limits are not given by formulas, i.e. a clearance or limits of quantities that pose reports contain
  bool has_other_limits_;
  std::size_t constraints_;  ///< number of constraints: the first outputs of the batch `all_`
  PoseBatch jacobian_, all_;
};

}  // namespace

std::unique_ptr<const PoseSides> prepare_pose_sides(const Evaluation& evaluation, const WorkspacePlan& plan,
                                                    const std::string& mode) {
  return std::make_unique<GenericSides>(evaluation, plan, mode_index(evaluation.model.info, mode));
}

}  // namespace pkm::generic
