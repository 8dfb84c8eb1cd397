#include "engine/generic/contracted_box.hpp"

#include <algorithm>
#include <cmath>

#include "engine/generic/interval_constraints.hpp"

namespace pkm::generic {
namespace {

constexpr std::size_t kMaxKnown = 64;

/// The largest of 1, 2 and 5 times a power of ten up to a positive number, as {numerator, denominator}, one of which
/// is 1.
std::array<double, 2> decimal_step(double number) {
  std::array<double, 2> step{1, 1};
  while (step[0] * 10 <= number) step[0] *= 10;
  while (1 / step[1] > number) step[1] *= 10;
  for (const double digit : {5, 2})
    if (digit * step[0] <= number * step[1]) {
      if (step[1] == 1) return {digit * step[0], 1};
      return {1, step[1] / digit};
    }
  return step;
}

/// Rounds the ends of a range outward to multiples of a decimal step that is at most 1/50 of its width.
Interval rounded_outward(const Interval& range) {
  const double width = range.width();
  if (!(width > 0) || !std::isfinite(width)) return range;
  const std::array<double, 2> unit = decimal_step(width / 50);
  const double numerator = unit[0], denominator = unit[1];
  const auto at = [&](double step) { return step * numerator / denominator; };
  double from = std::floor(range.lower / numerator * denominator),
         to = std::ceil(range.upper / numerator * denominator);
  while (at(from) > range.lower) --from;
  while (at(to) < range.upper) ++to;
  return {at(from), at(to)};
}

bounds::FeasibleHull hull_of(const Model& model, const std::vector<Interval>& inputs) {
  IntervalConstraints constraints = interval_constraints(model, inputs, model.reach_constraints);
  std::vector<Node> nodes;
  for (const auto& constraint : constraints.all) nodes.push_back(constraint.node);
  std::vector<std::size_t> axes;
  for (std::size_t i = 0; i < model.inputs.coordinates; ++i) axes.push_back(model.inputs.coordinate(i));
  return {std::move(constraints.graph), std::move(nodes), std::move(axes), model.inputs.count()};
}

/// Values of the model's inputs for the default design, without limits.
std::vector<Interval> inputs_of_default_design(const Model& model) {
  std::vector<Interval> inputs(model.inputs.count());
  for (std::size_t i = 0; i < model.info.parameters.size(); ++i) inputs[i] = model.info.parameters[i].nominal;
  for (std::size_t i = 0; i < model.inputs.limits; ++i) {
    const auto& parameter = model.limit_parameters[i];
    inputs[model.inputs.limit(i)] = parameter ? inputs[*parameter] : Interval(model.info.limits[i].inactive);
  }
  for (std::size_t i = 0; i < model.inputs.signs; ++i) inputs[model.inputs.sign(i)] = model.signs.front()[i];
  return inputs;
}

}  // namespace

ContractedBox::ContractedBox(const Model& model, const std::vector<Interval>& inputs)
    : designs_(inputs.begin(), inputs.begin() + static_cast<std::ptrdiff_t>(model.inputs.parameters)),
      hull_(hull_of(model, inputs)) {
  for (const AxisInfo& axis : model.info.coordinates) turns_.push_back(axis.turns());
  for (std::size_t i = 0; i < model.info.parameters.size(); ++i)
    if (model.info.parameters[i].unit == "m") lengths_.push_back(i);
}

bool ContractedBox::covers(const std::vector<Interval>& inputs) const {
  for (std::size_t i = 0; i < designs_.size(); ++i)
    if (!(designs_[i].lower <= inputs[i].lower && inputs[i].upper <= designs_[i].upper)) return false;
  return true;
}

bounds::IntervalBox ContractedBox::find(const std::vector<Interval>& inputs, const bounds::IntervalBox& start) const {
  std::vector<double> key;
  for (const auto* const values : {inputs.data(), start.data()})
    for (std::size_t i = 0; i < (values == start.data() ? turns_.size() : inputs.size()); ++i)
      key.insert(key.end(), {values[i].lower, values[i].upper});
  {
    const std::lock_guard lock(mutex_);
    const auto known = std::ranges::find(recent_, key, &Known::key);
    if (known != recent_.end()) return known->result;
  }
  const bounds::IntervalBox result = search(inputs, start);
  const std::lock_guard lock(mutex_);
  if (recent_.size() < kMaxKnown) recent_.emplace_back();
  recent_[next_ % recent_.size()] = {std::move(key), result};
  next_ = (next_ + 1) % kMaxKnown;
  return result;
}

double ContractedBox::scale_of(const std::vector<Interval>& inputs) const {
  double scale = 0;
  for (const std::size_t i : lengths_) scale += std::fabs(inputs[i].middle());
  return scale > 0 && std::isfinite(scale) ? scale : 1;
}

bounds::IntervalBox ContractedBox::search(const std::vector<Interval>& inputs, const bounds::IntervalBox& start) const {
  bounds::IntervalBox box = hull_.find(inputs, start, scale_of(inputs));
  for (std::size_t i = 0; i < turns_.size(); ++i) {
    const double unit = turns_[i] ? kPi / 180 : 1;  // angles are rounded in degrees
    const Interval rounded = rounded_outward({box[i].lower / unit, box[i].upper / unit});
    box[i] = {std::max(start[i].lower, std::min(rounded.lower * unit, box[i].lower)),
              std::min(start[i].upper, std::max(rounded.upper * unit, box[i].upper))};
  }
  return box;
}

bounds::IntervalBox ContractedBox::bound(const Model& model) const {
  bounds::IntervalBox start;
  const std::vector<Interval> inputs = inputs_of_default_design(model);
  std::vector<Node> ends;
  for (const auto& range : model.box) ends.insert(ends.end(), range->begin(), range->end());
  const expression::Program program(model.graph, ends);
  std::vector<Interval> registers;
  program.run_all<Interval>(inputs, registers);
  const auto value = [&](std::size_t i, std::size_t side) { return registers[program.outputs()[2 * i + side]]; };
  for (std::size_t i = 0; i < turns_.size(); ++i)
    start[i] = model.is_contracted[i] ? widest_range(model, i) : Interval(value(i, 0).lower, value(i, 1).upper);
  return hull_.bound(inputs, start, scale_of(inputs));
}

std::vector<Interval> inputs_of_all_designs(const Model& model) {
  std::vector<Interval> inputs = inputs_of_default_design(model);
  for (std::size_t i = 0; i < model.info.parameters.size(); ++i)
    inputs[i] = {model.info.parameters[i].lower, model.info.parameters[i].upper};
  for (std::size_t i = 0; i < model.inputs.limits; ++i)
    inputs[model.inputs.limit(i)] = Interval::everything(Decoration::continuous);
  for (std::size_t i = 0; i < model.inputs.signs; ++i) inputs[model.inputs.sign(i)] = {-1, 1};
  return inputs;
}

Interval widest_range(const Model& model, std::size_t coordinate) {
  return model.rotation_axes[coordinate] ? Interval(-kPi, kPi) : Interval::everything(Decoration::continuous);
}

std::string advice_for_box(const std::string& coordinate) {
  return "give [survey] box = { " + coordinate + " = [from, to] }, or limit the drives by `range`";
}

}  // namespace pkm::generic
