#include "engine/generic/corner_curves/volume.hpp"

#include <algorithm>

#include "engine/math/satisfied.hpp"

namespace pkm::generic::corner_curves {

double Volume::Scratch::work() const {
  // Cost of finding the roots of a function, and of evaluating the outer stage, relative to the cost of a quadrature
  // node.
  constexpr double kFunction = 5, kRun = 1;
  double sum = kRun * static_cast<double>(segments.runs);
  for (std::size_t i = 0; i < segments.count; ++i) {
    const SegmentIntegral& integral = segments.segments[i].integral;
    sum += kFunction * static_cast<double>(integral.decomposition.functions) +
           static_cast<double>(integral.area.evaluations);
  }
  return sum;
}

bool Volume::can_be_feasible(const SegmentScratch& scratch) const {
  return std::ranges::all_of(plan_.independent[0],
                             [&](std::uint32_t at) { return is_satisfied(scratch.registers[at]); });
}

bool Volume::find_ranges(std::span<const double> inputs, Scratch& scratch) const {
  constexpr double kBalanced = 1e-9;  // maximum length in tau on which decisions may contradict each other
  SegmentScratch& s = scratch.segments;
  s.count = 0;
  const expression::Program& program = plan_.program;
  s.registers.resize(program.registers());
  program.start<double>(s.registers);
  program.run<double>(0, inputs, s.registers);
  if (!can_be_feasible(s)) return true;
  const auto range = [&](std::size_t level) {
    const auto [from, to] = plan_.range[level];
    return Interval(std::fmin(s.registers[from], s.registers[to]), std::fmax(s.registers[from], s.registers[to]));
  };
  start_limits(plan_, inputs, {range(0), range(1)}, s.limits);
  return divide(plan_, outer_, s) && std::ranges::all_of(s.filled(), [](const Segment& segment) {
           return segment.integral.decomposition.unbalanced <= kBalanced;
         });
}

void Volume::find_critical_values(Scratch& scratch, std::vector<double>& values) const {
  values.clear();
  for (const Segment& segment : scratch.segments.filled()) {
    const SegmentIntegral& integral = segment.integral;
    for (const ActiveRange& range : integral.decomposition.ranges)
      for (const double tau : {range.low, range.high})
        values.push_back(map_node(integral.outer, 0.5 * (1 + tau)).point);
  }
  std::ranges::sort(values);
}

std::optional<Integral<double>> Volume::measure(std::span<const double> inputs, Scratch& scratch) const {
  constexpr std::size_t kMaxCells = 4000;
  constexpr double kBetter = 0.1;  // fraction of the tolerance that is used as the target of the relative error
  if (!find_ranges(inputs, scratch)) return {};
  if (!can_be_feasible(scratch.segments)) return Integral<double>{};
  const std::span<Segment> segments = scratch.segments.filled();
  std::size_t cells = 0;
  for (Segment& segment : segments) {
    segment.integral.start();
    cells += segment.integral.cells.size();
  }
  const auto scale = [](const Segment& segment) { return segment.slices.frame.scale * segment.slices.frame.scale; };
  Integral<double> total;
  for (;; ++cells) {
    total = {};
    Segment* worst = nullptr;
    double largest = 0;
    for (Segment& segment : segments) {
      const double error = scale(segment) * segment.integral.area.error;
      total.value += segment.volume();
      total.error += error;
      total.evaluations += segment.integral.area.evaluations;
      if (error <= largest) continue;
      largest = error;
      worst = &segment;
    }
    // An error of kBetter times the tolerance costs little if the integrands are smooth, and derivatives need this
    // accuracy.
    const double share = total.error / (tolerance_ * std::fabs(total.value));
    if (!worst || share <= kBetter || cells > kMaxCells) break;
    if (!worst->integral.refine()) break;
  }
  for (const Segment& segment : segments) {
    const Decomposition& decomposition = segment.integral.decomposition;
    // In an undecided interval, three curves miss a common point by about the square root of the rounding error, 1e-7;
    // the area that they enclose is of the order of its square. All three curves are affected by the same decision.
    double per_slice = decomposition.unbalanced + decomposition.undecided * 1e-12;
    // An arc in the frame is shorter than the perimeter of the frame, 8; its centre is displaced by at most sqrt(2)
    // times the error of its functions (the interpolation error `tail`, and `merged`), and a conic by about the errors
    // of its six coefficients, divided by the magnitude of its gradient.
    for (const BoundaryCurve& curve : segment.slices.curves)
      per_slice += (curve.is_conic() ? 200 : 12) * (curve.tail + curve.merged);
    total.error += scale(segment) * per_slice * 0.5 * (segment.upper.at - segment.lower.at);
  }
  // If no feasible point was found, planar slices have to decide whether the workspace is empty or was missed.
  if (!(total.value > 0)) return {};
  return total;
}

}  // namespace pkm::generic::corner_curves
