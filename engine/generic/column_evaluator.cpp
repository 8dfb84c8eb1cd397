#include "engine/generic/column_evaluator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <stdexcept>

#include "engine/generic/clearance.hpp"
#include "engine/generic/columns/nested_integral.hpp"
#include "engine/generic/conditioning.hpp"
#include "engine/generic/corner_curves/volume.hpp"
#include "engine/generic/dynamics.hpp"
#include "engine/generic/edge_plan.hpp"
#include "engine/generic/inertia_batch.hpp"
#include "engine/generic/outer_quadrature.hpp"
#include "engine/generic/report_limits.hpp"
#include "engine/generic/sample_formulas.hpp"
#include "engine/workspace/pose_quantities.hpp"
#include "engine/workspace/with_gradients.hpp"

namespace pkm::generic {
namespace {

using Kind = FixedCoordinate::Kind;

/// The integrated coordinates. Slices have at most three coordinates in all; the outermost ones in excess of these are
/// left to OuterQuadrature.
struct IntegratedCoordinates {
  std::vector<std::size_t> in_excess, of_slices;

  IntegratedCoordinates(const Sweep& sweep, const WorkspacePlan& plan) {
    for (const int coordinate : sweep.fixed)
      if (how_fixed(plan, coordinate).kind == Kind::integrated)
        of_slices.push_back(static_cast<std::size_t>(coordinate));
    const std::size_t room = 3 - std::min<std::size_t>(3, sweep.swept.size());
    const auto end = of_slices.end() - static_cast<std::ptrdiff_t>(std::min(of_slices.size(), room));
    in_excess.assign(of_slices.begin(), end);
    of_slices.erase(of_slices.begin(), end);
  }
};

/// The orders of coordinates in which slices can have closed forms: each pair of swept ones as (v, z), or each one as
/// z, with the others as outer coordinates (in a single order for lines). Integrated ones are outermost, except for the
/// last one if a single coordinate is swept: slices of these two are planar.
std::vector<CoordinateOrder> orders_of(const Sweep& sweep, const WorkspacePlan& plan, bool are_lines) {
  std::vector<std::size_t> swept(sweep.swept.begin(), sweep.swept.end());
  std::vector<std::size_t> integrated = IntegratedCoordinates(sweep, plan).of_slices;
  if (!are_lines && swept.size() == 1 && !integrated.empty()) {
    swept.push_back(integrated.back());
    integrated.pop_back();
  }
  std::ranges::sort(swept);
  std::vector<CoordinateOrder> orders;
  do {
    CoordinateOrder order{.outer = integrated, .v = {}, .z = swept.back()};
    std::span<const std::size_t> outer = std::span(swept).first(swept.size() - 1);
    if (!are_lines && !outer.empty()) {
      order.v = outer.back();
      outer = outer.first(outer.size() - 1);
    }
    order.outer.insert(order.outer.end(), outer.begin(), outer.end());
    if (!are_lines || std::ranges::is_sorted(outer)) orders.push_back(order);
  } while (std::ranges::next_permutation(swept).found);
  return orders;
}

CoordinateRanges box_of(const Sweep& sweep, std::size_t coordinates, const ColumnOptions& columns) {
  CoordinateRanges box(coordinates);
  if (columns.box)
    for (std::size_t axis = 0; axis < sweep.swept.size(); ++axis)
      box[static_cast<std::size_t>(sweep.swept[axis])] = (*columns.box)[axis];
  return box;
}

struct Plans {
  std::vector<SlicePlan> all;
  std::string why_not;  ///< if there are no plans
};

/// Slices of conics if possible, otherwise lines bounded by polynomials, otherwise any lines. @param max_evaluations
/// maximum number of plans
Plans plans_of(const Evaluation& evaluation, std::size_t mode, const Sweep& sweep, const WorkspacePlan& plan,
               const CoordinateRanges& box, std::size_t max_evaluations = 100) {
  Plans plans;
  for (const auto& [are_lines, curves] : {std::pair{false, false}, {true, false}, {true, true}}) {
    if (!plans.all.empty()) break;
    for (const CoordinateOrder& order : orders_of(sweep, plan, are_lines)) {
      if (plans.all.size() == max_evaluations) return plans;
      SlicePlan made = plan_slices(evaluation, mode, order, curves, box);
      if (made.why_not.empty())
        plans.all.push_back(std::move(made));
      else
        plans.why_not = made.why_not;
    }
  }
  return plans;
}

class GenericColumns final : public WithGradients<GenericColumns> {
 public:
  GenericColumns(const Mechanism& mechanism, const Evaluation& evaluation, const WorkspacePlan& plan,
                 const ColumnOptions& columns, const FieldRequest& request)
      : mechanism_(mechanism),
        e_(evaluation),
        plan_(plan),
        request_(request),
        sweep_(sweep_of(mechanism.info(), plan)),
        mode_(mode_index(mechanism.info(), request.mode)),
        inner_rule_(gauss_legendre(columns.nodes[0] > 0 ? columns.nodes[0] : kSampleNodes)),
        outer_rule_(gauss_legendre(columns.nodes[1] > 0 ? columns.nodes[1] : kSampleNodes)),
        outermost_(evaluation, IntegratedCoordinates(sweep_, plan).in_excess, columns.tolerance) {
    if (request.characteristic_length)
      throw std::invalid_argument("mechanism " + mechanism.info().name +
                                  " has its own characteristic length only; leave out characteristic_length");
    const CoordinateRanges box = box_of(sweep_, evaluation.model.inputs.coordinates, columns);
    auto [plans, why_not] = plans_of(evaluation, mode_, sweep_, plan, box);
    if (plans.empty())
      throw std::invalid_argument("mechanism " + mechanism.info().name + " has no exact columns: " + why_not +
                                  "; set workspace.method = \"voxels\"");
    // Derivatives lose digits at a kink of the measure that no change of the type indicates; with conics two more
    // digits are cheap.
    const CoordinateOrder& order = plans.front().order;
    slice_tolerance_ = (order.v ? 0.01 : 0.1) * columns.tolerance;
    find_corner_curves(plans, columns.tolerance);
    if (order.outer.size() + (order.v ? 2 : 1) == sweep_.swept.size()) {
      edges::EdgePlan edges(evaluation, mode_, sweep_.swept, box, slice_tolerance_);
      if (edges.why_not().empty()) edges_.emplace(std::move(edges));
    }
    plans_ = std::move(plans);
    if (request.needs_samples() || (!edges_ && !corner_curves_)) slices();
    if (request.has(kConditioning)) conditioning_.emplace(evaluation, dual_registers(), mode_);
    if (request.needs_inertia()) inertia_.emplace(evaluation, dual_registers(), mode_, request.rotors);
    if (request.has_formulas()) formulas_.emplace(evaluation, request.fields, dual_registers(), mode_);
  }

 private:
  friend WithGradients<GenericColumns>;
  static constexpr int kSampleNodes = 6;

  struct Known {
    const GenericColumns* of = nullptr;
    std::vector<Dual4> inputs;
    std::vector<double> by_input;
    Integral<double> volume;
  };
  using CornerCurves = corner_curves::Volume;
  struct Room {
    std::vector<double> inputs;
    IntegralScratch integral;
    CornerCurves::Scratch corner_curves;
    edges::EdgePlan::Scratch edges;
    InertiaScratch inertia;
    Known known;
    bool is_sampled = false;  ///< a volume of the design is one of slices
  };
  template <class S>
  struct SampleRoom {
    std::vector<S> inputs;
    ConditioningScratch<S> conditioning;
    std::vector<S> formulas;
  };

  /// The quadrature over slices. It is chosen at the first use, because that can take longer than many volumes by
  /// edges.
  const NestedIntegral& slices() const {
    std::call_once(is_chosen_, [&] { integral_.emplace(fastest(plans_), slice_tolerance_); });
    return *integral_;
  }

  /// The swept and integrated coordinates.
  std::vector<int> dual_registers() const {
    const CoordinateOrder& order = slices().plan().order;
    std::vector<int> all(order.outer.begin(), order.outer.end());
    if (order.v) all.push_back(static_cast<int>(*order.v));
    all.push_back(static_cast<int>(order.z));
    return all;
  }

  /// The plan whose analysis of the default design at low accuracy takes the least work.
  SlicePlan fastest(const std::vector<SlicePlan>& plans) const {
    const double tolerance = plans.front().order.v ? 1e-3 : 1e-2;
    const bool has_curves = std::ranges::any_of(plans.front().surfaces, &Surface::is_transcendental);
    if ((plans.size() == 1 && !has_curves) || plans.front().order.outer.empty()) return plans.front();
    std::vector<double> design;
    for (const Parameter& p : mechanism_.info().parameters) design.push_back(p.nominal);
    Room memory;
    std::optional<std::size_t> best;
    // interval operations, or surfaces in slices: about a second
    long least = has_curves ? 100'000'000 : 10'000'000;
    for (std::size_t i = 0; i < plans.size(); ++i) {
      const NestedIntegral trial(plans[i], tolerance);
      const auto per_slice = static_cast<long>(plans[i].surfaces.size() + 8 * plans[i].independent.back().size());
      NestedIntegral::Budget budget;
      (has_curves ? budget.operations : budget.evaluations) = has_curves ? least : std::max(1L, least / per_slice);
      fill_inputs<double>(design, memory.inputs);
      trial.measure(memory.inputs, memory.integral, budget);
      const long work = has_curves ? memory.integral.column.operations : memory.integral.evaluations * per_slice;
      if (work >= least) continue;
      best = i;
      least = work;
    }
    if (!best && has_curves)
      throw std::invalid_argument("mechanism " + mechanism_.info().name +
                                  " has no exact columns that can be computed in seconds: its constraints are no "
                                  "polynomials of degree four; use voxels");
    return plans[best.value_or(0)];
  }

  /// Among the plans that corner curves serve, the one that takes the least work for the default design.
  void find_corner_curves(const std::vector<SlicePlan>& plans, double tolerance) {
    std::vector<double> design, inputs;
    for (const Parameter& p : mechanism_.info().parameters) design.push_back(p.nominal);
    CornerCurves::Scratch scratch;
    double least = std::numeric_limits<double>::infinity();
    for (const SlicePlan& plan : plans) {
      CornerCurves curves(plan, tolerance);
      if (!curves.why_not().empty()) continue;
      fill_inputs<double>(design, inputs);
      if (!curves.measure(inputs, scratch)) continue;
      const double work = scratch.work();
      if (work >= least) continue;
      least = work;
      corner_curves_.emplace(std::move(curves));
    }
  }

  bool has_outermost() const { return !outermost_.coordinates().empty(); }
  /// The volume over all coordinates, and its derivatives unless `by_input` is empty.
  Integral<double> measure(std::vector<double>& inputs, std::span<double> by_input, Room& memory) const {
    memory.is_sampled = false;
    const auto inner = [&](std::span<const double> at, std::span<double> by) { return measure_inside(at, by, memory); };
    return has_outermost() ? outermost_.measure(inputs, by_input, inner) : inner(inputs, by_input);
  }
  /// Over at most three coordinates: by edges or corner curves if they serve the design, otherwise by slices. Samples
  /// need the slices in any case.
  Integral<double> measure_inside(std::span<const double> inputs, std::span<double> by_input, Room& memory) const {
    const bool needs_gradient = !by_input.empty();
    std::optional<Integral<double>> found;
    if (edges_) found = edges_->measure(inputs, memory.edges, by_input);
    if (!found && corner_curves_) {
      found = corner_curves_->measure(inputs, memory.corner_curves);
      if (found && needs_gradient) corner_curves_->add_gradient(by_input, memory.corner_curves);
    }
    if (found && !uses_slices()) return *found;
    const Integral<double> by_slices = needs_gradient ? slices().measure_for_gradient(inputs, memory.integral)
                                                      : slices().measure(inputs, memory.integral);
    if (!found && needs_gradient) slices().add_gradient(by_input, memory.integral);
    // a single slice is exact
    memory.is_sampled = memory.is_sampled || (!found && !slices().plan().order.outer.empty());
    return better_of(found, by_slices);
  }
  /// Whether samples follow from the slices of the volume; with outermost coordinates they have slices of their own.
  bool uses_slices() const { return request_.needs_samples() && !has_outermost(); }
  /// The volume without slices, if there is one. Where slices, and thus samples, have missed a part of the workspace,
  /// the error says so.
  static Integral<double> better_of(const std::optional<Integral<double>>& found, const Integral<double>& by_slices) {
    if (!found) return by_slices;
    const double missed = std::fabs(found->value - by_slices.value) - by_slices.error;
    return {found->value, std::max(found->error, missed), by_slices.evaluations};
  }

  /// The inputs, with fixed coordinates at their values.
  template <class S>
  void fill_inputs(std::span<const S> parameters, std::vector<S>& inputs) const {
    const Inputs& at = e_.model.inputs;
    inputs.resize(at.count());
    e_.fill_inputs<S>(parameters, plan_.limits, mode_, inputs);
    for (const int coordinate : sweep_.fixed) {
      const auto i = static_cast<std::size_t>(coordinate);
      const FixedCoordinate fixed = how_fixed(plan_, coordinate);
      if (fixed.kind == Kind::integrated) continue;
      S& input = inputs[at.coordinate(i)];
      const auto middle =
          fixed.kind == Kind::default_value ? e_.of_design<S>(e_.default_values[i], parameters) : std::nullopt;
      if (fixed.kind == Kind::default_value && !middle) throw_no_default_value(mechanism_.info(), coordinate);
      input = middle ? *middle : S(fixed.kind == Kind::listed ? fixed.values.front() : fixed.value);
    }
  }

  template <class S>
  void run(std::span<const S> parameters, Scratch& scratch, WorkspaceResult<S>& survey) const {
    Room& memory = scratch.get<Room>();
    SampleRoom<S>& samples = scratch.get<SampleRoom<S>>();
    survey.clear(request_.fields);
    fill_inputs<S>(parameters, samples.inputs);
    memory.inputs.resize(samples.inputs.size());
    std::ranges::transform(samples.inputs, memory.inputs.begin(), [](const S& x) { return value_of(x); });
    Integral<double> found;
    if constexpr (std::is_same_v<S, double>) {
      memory.known.of = nullptr;
      found = measure(memory.inputs, {}, memory);
    } else {
      found = with_slopes(samples.inputs, memory);
    }
    found.error = std::max(found.error, std::numeric_limits<double>::epsilon() * found.value);
    set_volume(found, survey);
    survey.is_sampled = memory.is_sampled;
    if (found.value == 0 && found.error > 0) survey.error = 1;
    if constexpr (!std::is_same_v<S, double>) {
      for (std::size_t i = 0; i < samples.inputs.size(); ++i)
        survey.volume.v = survey.volume.v + samples.inputs[i].v * memory.known.by_input[i];
    }
    if (request_.needs_samples()) add_all_samples(0, S(1.0), parameters, samples, memory, survey);
  }

  /// At nodes of the outermost coordinates, those of the slices there.
  template <class S>
  void add_all_samples(std::size_t level, const S& weight, std::span<const S> parameters, SampleRoom<S>& samples,
                       Room& memory, WorkspaceResult<S>& survey) const {
    if (level == outermost_.coordinates().size()) {
      if (has_outermost()) {
        if constexpr (std::is_same_v<S, double>)
          slices().measure(memory.inputs, memory.integral);
        else
          slices().measure_for_gradient(memory.inputs, memory.integral);
      }
      return add_samples(weight, parameters, samples, memory, survey);
    }
    const std::size_t input = e_.model.inputs.coordinate(outermost_.coordinates()[level]);
    pkm::visit_nodes(outermost_.range(level, samples.inputs), outer_rule_,
                     [&](const S& at, const S& jacobian, double own) {
                       samples.inputs[input] = at;
                       memory.inputs[input] = value_of(at);
                       add_all_samples<S>(level + 1, weight * jacobian * own, parameters, samples, memory, survey);
                     });
  }

  /// The volume and its derivatives with respect to all inputs. Parameters come in blocks of four (forward mode), of
  /// which the first one computes the results for all, because only the derivatives differ.
  Integral<double> with_slopes(const std::vector<Dual4>& inputs, Room& memory) const {
    Known& known = memory.known;
    const auto same_slopes = [](const Dual4& x, const Dual4& y) { return std::ranges::equal(x.v.d, y.v.d); };
    if (known.of == this && std::ranges::equal(known.inputs, inputs, {}, &Dual4::a, &Dual4::a) &&
        !std::ranges::equal(known.inputs, inputs, same_slopes))
      return known.volume;
    known.of = this;
    known.inputs = inputs;
    known.by_input.assign(memory.inputs.size(), 0);
    known.volume = measure(memory.inputs, known.by_input, memory);
    return known.volume;
  }

  template <class S>
  void add_samples(const S& share, std::span<const S> parameters, SampleRoom<S>& samples, Room& memory,
                   WorkspaceResult<S>& survey) const {
    const std::vector<S>& inputs = samples.inputs;
    const CoordinateOrder& order = slices().plan().order;
    if (inertia_) {
      check_masses(e_, parameters);
      inertia_->start(inputs, memory.inertia);
    }
    if (conditioning_) conditioning_->start(parameters, inputs, samples.conditioning);
    if (formulas_) formulas_->start(inputs, samples.formulas);
    Pose<S> pose(e_.model.inputs.coordinates);
    std::copy_n(&inputs[e_.model.inputs.coordinate(0)], pose.size(), pose.begin());
    std::vector<S>* const conditioning = survey.find(kConditioning);
    slices().for_each_node<S>(inputs, outer_rule_, inner_rule_, memory.integral,
                              [&](const std::vector<S>& outer, const S& v, const S& z, const S& weight) {
                                for (std::size_t i = 0; i < outer.size(); ++i) pose[order.outer[i]] = outer[i];
                                if (order.v) pose[*order.v] = v;
                                pose[order.z] = z;
                                survey.weight.push_back(share * weight);
                                if (request_.poses) survey.pose.push_back(pose);
                                if (conditioning)
                                  conditioning->push_back(conditioning_->at(pose, samples.conditioning));
                                if (inertia_) inertia_->add(pose, memory.inertia, survey);
                                if (formulas_) formulas_->add(pose, samples.formulas, survey);
                              });
    if (inertia_) inertia_->finish(memory.inertia, survey);
  }

  const Mechanism& mechanism_;
  const Evaluation& e_;
  WorkspacePlan plan_;
  FieldRequest request_;
  const Sweep& sweep_;
  std::size_t mode_;
  GaussRule inner_rule_, outer_rule_;
  OuterQuadrature outermost_;  ///< coordinates beyond three
  std::vector<SlicePlan> plans_;
  double slice_tolerance_ = 0;
  mutable std::once_flag is_chosen_;
  mutable std::optional<NestedIntegral> integral_;
  std::optional<edges::EdgePlan> edges_;            ///< if the workspace is a solid with edges
  std::optional<CornerCurves> corner_curves_;       ///< if a plan is served by them
  std::optional<SampleConditioning> conditioning_;  ///< if they are requested
  std::optional<InertiaBatch> inertia_;
  std::optional<SampleFormulas> formulas_;
};

}  // namespace

std::string why_no_columns(const Mechanism& mechanism, const Evaluation& evaluation) {
  const WorkspacePlan usual{.method = ColumnOptions{}, .fixed = {}, .limits = no_limits(mechanism.info())};
  const Sweep& sweep = mechanism.info().sweeps.front();
  const std::size_t coordinates = evaluation.model.inputs.coordinates;
  const Plans plans = plans_of(evaluation, 0, sweep, usual, box_of(sweep, coordinates, {}), 1);
  return plans.all.empty() ? plans.why_not : "";
}

std::unique_ptr<const WorkspaceEvaluator> prepare_columns(const Mechanism& mechanism, const Evaluation& evaluation,
                                                          const WorkspacePlan& plan, const ColumnOptions& columns,
                                                          const FieldRequest& request) {
  refuse_clearance(evaluation.model, plan.limits,
                   "has no columns under a clearance (clearance_min), because links that meet end columns where "
                   "no formula says; set workspace.method = \"voxels\"");
  refuse_report_limits(evaluation.model, plan.limits, "exact columns");
  return std::make_unique<GenericColumns>(mechanism, evaluation, plan, columns, request);
}

}  // namespace pkm::generic
