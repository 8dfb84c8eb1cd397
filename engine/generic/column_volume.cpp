#include "engine/generic/column_volume.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "engine/core/stop.hpp"

namespace pkm::generic {
namespace {

/// Maximum number of slices that are evaluated to place the quadrature nodes of samples, if the volume is known without
/// slices.
constexpr long kMaxSlicesForNodes = 4'000'000;

/// The coordinates that are integrated over although they are not swept. The quadrature over slices has at most three
/// coordinates, swept ones included; OuterQuadrature integrates over the outermost ones beyond that.
struct IntegratedCoordinates {
  std::vector<std::size_t> beyond_three, of_slices;

  IntegratedCoordinates(const Sweep& sweep, const WorkspacePlan& plan) {
    for (const int coordinate : sweep.fixed)
      if (how_fixed(plan, coordinate).kind == FixedCoordinate::Kind::integrated)
        of_slices.push_back(static_cast<std::size_t>(coordinate));
    const std::size_t available = 3 - std::min<std::size_t>(3, sweep.swept.size());
    const auto end = of_slices.end() - static_cast<std::ptrdiff_t>(std::min(of_slices.size(), available));
    beyond_three.assign(of_slices.begin(), end);
    of_slices.erase(of_slices.begin(), end);
  }
};

/// Orders of the coordinates for which slices may have closed forms. A planar slice spans two coordinates (v, z), a
/// line the coordinate z. For planar slices, each pair of swept coordinates is tried as (v, z); for lines, each swept
/// coordinate is tried as z, with one order of the others. All other swept coordinates are outer ones. Coordinates that
/// are integrated over without being swept come first, except that the last one becomes v if a single coordinate is
/// swept.
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

/// Maximum number of interval operations of the analysis that decides whether columns with transcendental constraints
/// are supported: about one second.
constexpr long kMaxOperations = 30'000'000;

/// Whether the analysis certainly exceeds kMaxOperations if all samples of the outermost coordinate take as many
/// operations as the one in the middle of its range. It is much faster than the analysis itself.
bool takes_too_long(const NestedIntegral& integral, std::span<const double> inputs, IntegralScratch& scratch) {
  constexpr long kLimit = kMaxOperations / kSamplesOfLines;
  return integral.operations_of_middle_slice(inputs, scratch, kLimit) >= kLimit;
}

/// The volume of the workspace; std::nullopt as soon as the interval operations reach the budget.
std::optional<Integral<double>> measure_within(const NestedIntegral& integral, std::span<const double> inputs,
                                               IntegralScratch& scratch, const NestedIntegral::Budget& budget) {
  const StopScope limit([&] { return scratch.column.operations >= budget.operations; });
  try {
    return integral.measure(inputs, scratch, budget);
  } catch (const Stopped&) {
    if (limit.is_requested_by_outer_scope()) throw;
    return {};
  }
}

struct Plans {
  std::vector<SlicePlan> all;
  std::string why_not;  ///< reason why there are no plans; empty if there are some
};

/// Plans with planar slices bounded by conics if possible, otherwise with lines bounded by polynomials, otherwise with
/// any lines.
/// @param max_plans  maximum number of plans
Plans plans_of(const Evaluation& evaluation, std::size_t mode, const WorkspacePlan& plan, const ColumnOptions& columns,
               std::size_t max_plans = 100) {
  const Sweep& sweep = sweep_of(evaluation.model.info, plan);
  const CoordinateRanges box = box_of(sweep, evaluation.model.inputs.coordinates, columns);
  Plans plans;
  for (const auto& [are_lines, curves] : {std::pair{false, false}, {true, false}, {true, true}}) {
    if (!plans.all.empty()) break;
    for (const CoordinateOrder& order : orders_of(sweep, plan, are_lines)) {
      if (plans.all.size() == max_plans) return plans;
      SlicePlan made = plan_slices(evaluation, mode, order, curves, box);
      if (made.why_not.empty())
        plans.all.push_back(std::move(made));
      else
        plans.why_not = made.why_not;
    }
  }
  return plans;
}

}  // namespace

std::string why_no_columns(const Evaluation& evaluation) {
  const MechanismInfo& info = evaluation.model.info;
  if (!evaluation.model.tensions.empty())
    return "the limits of the cables' tensions are no polynomials of low degree along a coordinate";
  const WorkspacePlan plan{.method = ColumnOptions{}, .fixed = {}, .limits = no_limits(info)};
  const Plans plans = plans_of(evaluation, 0, plan, {}, 1);
  return plans.all.empty() ? plans.why_not : "";
}

ColumnVolume::ColumnVolume(const Evaluation& evaluation, const WorkspacePlan& plan, const ColumnOptions& columns,
                           std::size_t mode, bool needs_samples)
    : e_(evaluation),
      plan_(plan),
      mode_(mode),
      needs_samples_(needs_samples),
      outermost_(evaluation, IntegratedCoordinates(sweep_of(evaluation.model.info, plan), plan).beyond_three,
                 columns.tolerance) {
  Plans plans = plans_of(evaluation, mode, plan, columns);
  if (plans.all.empty())
    throw std::invalid_argument("mechanism " + evaluation.model.info.name + " has no exact columns: " + plans.why_not +
                                "; set workspace.method = \"voxels\"");
  plans_ = std::move(plans.all);
  // Use a stricter tolerance than that of the volume, because derivatives are less accurate near kinks of the area or
  // length of a slice that no critical value indicates. For conics, two more digits are cheap.
  const CoordinateOrder& order = plans_.front().order;
  slice_tolerance_ = (order.v ? 0.01 : 0.1) * columns.tolerance;
  choose_corner_curves(columns.tolerance);
  const Sweep& sweep = sweep_of(evaluation.model.info, plan);
  if (order.outer.size() + (order.v ? 2 : 1) == sweep.swept.size()) {
    edges::EdgePlan edges(evaluation, mode, sweep.swept, box_of(sweep, evaluation.model.inputs.coordinates, columns),
                          slice_tolerance_);
    if (edges.why_not().empty()) edges_.emplace(std::move(edges));
  }
  if (needs_samples || (!edges_ && !corner_curves_)) slices();
  if (!needs_samples) return;
  shares_ranges_ = corner_curves_ && corner_curves_->plan().order == slices().plan().order;
  if (shares_ranges_) return;
  corner_curves::Volume curves(slices().plan(), columns.tolerance);
  if (curves.why_not().empty()) ranges_for_nodes_.emplace(std::move(curves));
}

const NestedIntegral& ColumnVolume::slices() const {
  std::call_once(is_chosen_, [&] { slices_.emplace(choose_slices(), slice_tolerance_); });
  return *slices_;
}

std::vector<double> ColumnVolume::inputs_of_default_design() const {
  std::vector<double> design, inputs;
  for (const Parameter& p : e_.model.info.parameters) design.push_back(p.nominal);
  e_.fill_inputs<double>(design, plan_, mode_, inputs);
  return inputs;
}

/// Chooses the plan of slices whose analysis of the default design at low accuracy takes the least work.
SlicePlan ColumnVolume::choose_slices() const {
  const SlicePlan& first = plans_.front();
  const double tolerance = first.order.v ? 1e-3 : 1e-2;
  const bool has_curves = std::ranges::any_of(first.surfaces, &Surface::is_transcendental);
  if ((plans_.size() == 1 && !has_curves) || first.order.outer.empty()) return first;
  const std::vector<double> inputs = inputs_of_default_design();
  IntegralScratch scratch;
  const SlicePlan* best = nullptr;
  // Least work of the plans analysed so far, and limit of the work for the next plan: number of interval operations, or
  // of slices times surfaces. The first limit corresponds to about one second.
  long least = has_curves ? kMaxOperations : 10'000'000;
  for (const SlicePlan& plan : plans_) {
    const auto per_slice = static_cast<long>(plan.surfaces.size() + 8 * plan.independent.back().size());
    NestedIntegral::Budget budget;
    (has_curves ? budget.operations : budget.evaluations) = has_curves ? least : std::max(1L, least / per_slice);
    const NestedIntegral integral(plan, tolerance);
    if (has_curves && takes_too_long(integral, inputs, scratch)) continue;
    const std::optional<Integral<double>> measured = measure_within(integral, inputs, scratch, budget);
    if (!measured) continue;
    const Integral<double>& found = *measured;
    // If the workspace of the default design is empty, the work gives no information about other designs.
    if (!has_curves && &plan == &first && found.value == 0) return first;
    const long work = has_curves ? scratch.column.operations : found.evaluations * per_slice;
    if (work >= least) continue;
    best = &plan;
    least = work;
  }
  if (!best && has_curves)
    throw std::invalid_argument("mechanism " + e_.model.info.name +
                                " has no exact columns that can be computed in seconds, because its constraints are "
                                "not polynomials of degree four or less; set workspace.method = \"voxels\"");
  return best ? *best : first;
}

/// Chooses, among the plans that corner curves can integrate, the one that takes the least work for the default design.
void ColumnVolume::choose_corner_curves(double tolerance) {
  corner_curves::Volume::Scratch scratch;
  double least = std::numeric_limits<double>::infinity();
  for (const SlicePlan& plan : plans_) {
    corner_curves::Volume curves(plan, tolerance);
    if (!curves.why_not().empty() || !curves.measure(inputs_of_default_design(), scratch)) continue;
    const double work = scratch.work();
    if (work >= least) continue;
    least = work;
    corner_curves_.emplace(std::move(curves));
  }
}

Integral<double> ColumnVolume::measure(std::vector<double>& inputs, std::span<double> by_input,
                                       Scratch& scratch) const {
  scratch.is_sampled = false;
  const auto inner = [&](std::span<const double> at, std::span<double> by) { return measure_inside(at, by, scratch); };
  return has_outermost() ? outermost_.measure(inputs, by_input, inner) : inner(inputs, by_input);
}

std::optional<Interval> ColumnVolume::prove(std::span<const double> inputs, Scratch& scratch) const {
  if (!edges_ || has_outermost()) return {};
  return edges_->prove(inputs, scratch.edges);
}

/// Volume over the innermost coordinates, at most three, for given values of the outermost ones.
Integral<double> ColumnVolume::measure_inside(std::span<const double> inputs, std::span<double> by_input,
                                              Scratch& scratch) const {
  const bool needs_gradient = !by_input.empty();
  std::optional<Integral<double>> found;
  bool by_corner_curves = false;
  if (edges_) found = edges_->measure(inputs, scratch.edges, by_input);
  if (!found && corner_curves_) {
    found = corner_curves_->measure(inputs, scratch.corner_curves);
    by_corner_curves = found.has_value();
    if (found && needs_gradient) corner_curves_->add_gradient(by_input, scratch.corner_curves);
  }
  // If there are outermost coordinates, place_nodes() places the nodes of the samples later.
  if (found && (!needs_samples_ || has_outermost())) return *found;
  if (found && place_between_ranges(inputs, by_corner_curves, scratch)) return *found;
  if (found) {  // the volume is known, and the slices only place the nodes of samples
    const Integral<double> by_slices = slices().measure(inputs, scratch.integral, {.evaluations = kMaxSlicesForNodes});
    // The error includes the part of the workspace that the slices, and therefore the samples, have missed.
    const double missed = std::fabs(found->value - by_slices.value);
    scratch.is_sampled = by_slices.evaluations >= kMaxSlicesForNodes;
    const double error = scratch.is_sampled ? missed : missed - by_slices.error;
    return {found->value, std::max(found->error, error), by_slices.evaluations};
  }
  const Integral<double> by_slices = needs_gradient ? slices().measure_for_gradient(inputs, scratch.integral)
                                                    : slices().measure(inputs, scratch.integral);
  if (needs_gradient) slices().add_gradient(by_input, scratch.integral);
  // A volume that consists of a single slice, without outer coordinates, is exact.
  scratch.is_sampled = scratch.is_sampled || !slices().plan().order.outer.empty();
  return by_slices;
}

void ColumnVolume::place_nodes(std::span<const double> inputs, bool for_gradient, Scratch& scratch) const {
  if (place_between_ranges(inputs, false, scratch)) return;
  if (for_gradient)
    slices().measure_for_gradient(inputs, scratch.integral);
  else
    slices().measure(inputs, scratch.integral);
}

/// Places the quadrature nodes that become samples between the critical values of the outer coordinate, which corner
/// curves find.
/// @param is_measured  true: `scratch.corner_curves` holds the volume of this design by corner_curves_
/// @return false if corner curves do not support the slices or the design
bool ColumnVolume::place_between_ranges(std::span<const double> inputs, bool is_measured, Scratch& scratch) const {
  if (shares_ranges_) {
    if (!is_measured && !corner_curves_->find_ranges(inputs, scratch.corner_curves)) return false;
    corner_curves_->find_critical_values(scratch.corner_curves, scratch.critical_values);
  } else {
    if (!ranges_for_nodes_ || !ranges_for_nodes_->find_ranges(inputs, scratch.ranges)) return false;
    ranges_for_nodes_->find_critical_values(scratch.ranges, scratch.critical_values);
  }
  slices().place_nodes(inputs, scratch.critical_values, scratch.integral);
  return true;
}

}  // namespace pkm::generic
