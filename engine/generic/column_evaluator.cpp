#include "engine/generic/column_evaluator.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "engine/generic/clearance.hpp"
#include "engine/generic/column_volume.hpp"
#include "engine/generic/conditioning.hpp"
#include "engine/generic/dynamics.hpp"
#include "engine/generic/inertia_batch.hpp"
#include "engine/generic/report_limits.hpp"
#include "engine/generic/sample_formulas.hpp"
#include "engine/mechanism/proven_volume.hpp"
#include "engine/workspace/pose_quantities.hpp"
#include "engine/workspace/with_gradients.hpp"

namespace pkm::generic {
namespace {

class GenericColumns final : public WithGradients<GenericColumns>, public VolumeProver {
 public:
  GenericColumns(const Evaluation& evaluation, const WorkspacePlan& plan, const ColumnOptions& columns,
                 const FieldRequest& request)
      : e_(evaluation),
        plan_(plan),
        request_(request),
        mode_(mode_index(evaluation.model.info, request.mode)),
        inner_rule_(gauss_legendre(columns.nodes[0] > 0 ? columns.nodes[0] : kSampleNodes)),
        outer_rule_(gauss_legendre(columns.nodes[1] > 0 ? columns.nodes[1] : kSampleNodes)),
        volume_(evaluation, plan, columns, mode_, request.needs_samples()) {
    if (!request.needs_samples()) return;
    const CoordinateOrder& order = volume_.slices().plan().order;
    std::vector<int> swept(order.outer.begin(), order.outer.end());
    if (order.v) swept.push_back(static_cast<int>(*order.v));
    swept.push_back(static_cast<int>(order.z));
    if (request.has(kConditioning)) conditioning_.emplace(evaluation, swept, mode_);
    if (request.needs_inertia()) inertia_.emplace(evaluation, swept, mode_, request.rotors);
    if (request.has_formulas()) formulas_.emplace(evaluation, request.fields, swept, mode_);
  }

  std::optional<Interval> proven_volume(std::span<const double> parameters) const override {
    DesignScratch scratch;
    e_.fill_inputs<double>(parameters, plan_, mode_, scratch.inputs);
    return volume_.prove(scratch.inputs, scratch.volume);
  }

 private:
  friend WithGradients<GenericColumns>;
  static constexpr int kSampleNodes = 6;

  /// Inputs and results of the last call of measure_with_gradient().
  struct LastGradient {
    const GenericColumns* of = nullptr;
    std::vector<Dual4> inputs;
    std::vector<double> by_input;
    Integral<double> volume;
  };
  struct DesignScratch {
    std::vector<double> inputs;
    ColumnVolume::Scratch volume;
    InertiaScratch inertia;
    LastGradient last;
  };
  template <class S>
  struct SampleScratch {
    std::vector<S> inputs;
    ConditioningScratch<S> conditioning;
    FormulaScratch formulas;
  };

  template <class S>
  void run(std::span<const S> parameters, Scratch& scratch, WorkspaceResult<S>& result) const {
    DesignScratch& design = scratch.get<DesignScratch>();
    SampleScratch<S>& samples = scratch.get<SampleScratch<S>>();
    result.clear(request_.fields);
    e_.fill_inputs<S>(parameters, plan_, mode_, samples.inputs);
    design.inputs.resize(samples.inputs.size());
    std::ranges::transform(samples.inputs, design.inputs.begin(), [](const S& x) { return value_of(x); });
    Integral<double> found;
    if constexpr (std::is_same_v<S, double>) {
      design.last.of = nullptr;
      found = volume_.measure(design.inputs, {}, design.volume);
    } else {
      found = measure_with_gradient(samples.inputs, design);
    }
    found.error = std::max(found.error, std::numeric_limits<double>::epsilon() * found.value);
    set_volume(found, result);
    result.is_sampled = design.volume.is_sampled;
    if (found.value == 0 && found.error > 0) result.error = 1;
    if constexpr (!std::is_same_v<S, double>) {
      for (std::size_t i = 0; i < samples.inputs.size(); ++i)
        if (const double by = design.last.by_input[i]; by != 0)
          result.volume.v = result.volume.v + samples.inputs[i].v * by;
    }
    if (request_.needs_samples()) add_all_samples(0, S(1.0), parameters, samples, design, result);
  }

  /// Samples the slice at every quadrature node of the outermost coordinates, and appends the resulting samples to the
  /// result of the analysis.
  /// @param weight  product of the quadrature weights of the outermost coordinates whose index is less than `level`
  template <class S>
  void add_all_samples(std::size_t level, const S& weight, std::span<const S> parameters, SampleScratch<S>& samples,
                       DesignScratch& design, WorkspaceResult<S>& result) const {
    if (level == volume_.outermost().coordinates().size()) {
      if (volume_.has_outermost()) volume_.place_nodes(design.inputs, !std::is_same_v<S, double>, design.volume);
      return add_samples(weight, parameters, samples, design, result);
    }
    const std::size_t input = e_.model.inputs.coordinate(volume_.outermost().coordinates()[level]);
    pkm::visit_nodes(volume_.outermost().range(level, samples.inputs), outer_rule_,
                     [&](const S& at, const S& jacobian, double own) {
                       samples.inputs[input] = at;
                       design.inputs[input] = value_of(at);
                       add_all_samples<S>(level + 1, weight * jacobian * own, parameters, samples, design, result);
                     });
  }

  /// Volume of the workspace; its derivatives with respect to all inputs are cached in design.last. The caller
  /// differentiates with respect to four parameters at a time and calls this function once for each block of four; the
  /// first call computes the derivatives for all blocks, because only the derivatives of `inputs` differ between
  /// blocks.
  Integral<double> measure_with_gradient(const std::vector<Dual4>& inputs, DesignScratch& design) const {
    LastGradient& last = design.last;
    const auto same_derivatives = [](const Dual4& x, const Dual4& y) { return std::ranges::equal(x.v.d, y.v.d); };
    if (last.of == this && std::ranges::equal(last.inputs, inputs, {}, &Dual4::a, &Dual4::a) &&
        !std::ranges::equal(last.inputs, inputs, same_derivatives))
      return last.volume;
    last.of = this;
    last.inputs = inputs;
    last.by_input.assign(design.inputs.size(), 0);
    last.volume = volume_.measure(design.inputs, last.by_input, design.volume);
    return last.volume;
  }

  /// Appends the quadrature nodes of the last volume, in the slices that design.volume holds, to the samples.
  /// @param share  factor by which the quadrature weights of these nodes are multiplied
  template <class S>
  void add_samples(const S& share, std::span<const S> parameters, SampleScratch<S>& samples, DesignScratch& design,
                   WorkspaceResult<S>& result) const {
    const std::vector<S>& inputs = samples.inputs;
    const CoordinateOrder& order = volume_.slices().plan().order;
    if (inertia_) {
      check_masses(e_, parameters);
      inertia_->start(inputs, design.inertia);
    }
    if (conditioning_) conditioning_->start(parameters, inputs, samples.conditioning);
    if (formulas_) formulas_->start(inputs, samples.formulas);
    Pose<S> pose(e_.model.inputs.coordinates);
    std::copy_n(&inputs[e_.model.inputs.coordinate(0)], pose.size(), pose.begin());
    std::vector<S>* const conditioning = result.find(kConditioning);
    volume_.slices().for_each_node<S>(inputs, outer_rule_, inner_rule_, design.volume.integral,
                                      [&](const std::vector<S>& outer, const S& v, const S& z, const S& weight) {
                                        for (std::size_t i = 0; i < outer.size(); ++i) pose[order.outer[i]] = outer[i];
                                        if (order.v) pose[*order.v] = v;
                                        pose[order.z] = z;
                                        result.weight.push_back(share * weight);
                                        if (request_.poses) result.pose.push_back(pose);
                                        if (conditioning)
                                          conditioning->push_back(conditioning_->at(pose, samples.conditioning));
                                        if (inertia_) inertia_->add(pose, design.inertia, result);
                                        if (formulas_) formulas_->add(pose, samples.formulas, result);
                                      });
    if (inertia_) inertia_->finish(design.inertia, result);
    if (formulas_) formulas_->finish(samples.formulas, result);
  }

  const Evaluation& e_;
  WorkspacePlan plan_;
  FieldRequest request_;
  std::size_t mode_;
  GaussRule inner_rule_, outer_rule_;
  ColumnVolume volume_;
  std::optional<SampleConditioning> conditioning_;  ///< absent if the conditioning is not requested
  std::optional<InertiaBatch> inertia_;             ///< absent if no fields of inertia are requested
  std::optional<SampleFormulas> formulas_;          ///< absent if no fields given by formulas are requested
};

}  // namespace

std::unique_ptr<const WorkspaceEvaluator> prepare_columns(const Evaluation& evaluation, const WorkspacePlan& plan,
                                                          const ColumnOptions& columns, const FieldRequest& request) {
  refuse_clearance(evaluation.model, plan.limits,
                   "has no exact columns with a clearance limit (clearance_min), because the distance of two links "
                   "is not given by a formula; set workspace.method = \"voxels\"");
  refuse_report_limits(evaluation.model, plan.limits, "exact columns");
  if (request.characteristic_length)
    throw std::invalid_argument("mechanism " + evaluation.model.info.name +
                                " has its own characteristic length; remove characteristic_length");
  return std::make_unique<GenericColumns>(evaluation, plan, columns, request);
}

}  // namespace pkm::generic
