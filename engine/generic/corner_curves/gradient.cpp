// Gradient of a volume by reverse-mode differentiation: the adjoints of the curves' series become adjoints of the
// surfaces' coefficients at the Chebyshev nodes, from which one backward sweep through the program follows for each
// node.
//
// The nodes move with the ends of their segment, t = low + (high - low) phi, so that curves that behave like square
// roots at an end have finite derivatives at every node.
#include <algorithm>

#include "engine/expression/reverse_mode.hpp"
#include "engine/generic/corner_curves/volume.hpp"

namespace pkm::generic::corner_curves {
namespace {

/// Propagates adjoints backwards through the stage of the outer coordinate t. @return the adjoint of t
double sweep_outer_stage(const expression::Program& program, std::span<const double> registers,
                         std::span<double> adjoints) {
  expression::backward_sweep(program, 1, registers, adjoints);
  double by_t = 0;
  for (const auto& input : program.stages()[1].inputs) {
    by_t += adjoints[input.to];
    adjoints[input.to] = 0;
  }
  return by_t;
}

}  // namespace

void Volume::add_gradient(std::span<double> by_input, Scratch& scratch) const {
  SegmentScratch& s = scratch.segments;
  scratch.adjoints.assign(plan_.program.registers(), 0);
  s.limits.adjoints.assign(plan_.limits.registers(), 0);
  for (std::size_t i = 0; i < s.count; ++i) add_segment_gradient(s.segments[i], scratch);
  expression::backward_sweep(plan_.program, 0, s.registers, scratch.adjoints);
  for (const auto& input : plan_.program.stages()[0].inputs) by_input[input.position] += scratch.adjoints[input.to];
  if (s.limits.active.empty()) return;
  expression::backward_sweep(plan_.limits, 0, s.limits.registers, s.limits.adjoints);
  for (const auto& input : plan_.limits.stages()[0].inputs) by_input[input.position] += s.limits.adjoints[input.to];
}

void Volume::add_segment_gradient(const Segment& segment, Scratch& scratch) const {
  auto& by_curve = scratch.by_curve;
  by_curve.resize(segment.integral.curves.size());
  for (auto& curve : by_curve)
    for (Samples& each : curve) each.fill(0);
  // Number of nodes: the number of coefficients that the series of the curves need, and some more, because derivatives
  // need more.
  std::size_t terms = 1;
  for (const BoundaryCurve& curve : segment.slices.curves) terms = std::max(terms, curve.terms);
  const std::size_t nodes = terms <= 4 ? 8 : terms <= 14 ? 16 : terms <= 22 ? 24 : kNodes;
  add_adjoints(segment.integral, nodes, by_curve);
  Samples by_values;
  scratch.is_active.assign(segment.integral.curves.size(), false);
  for (const ActiveRange& range : segment.integral.decomposition.ranges)
    scratch.is_active[range.first] = scratch.is_active[range.second] = true;
  for (std::size_t i = 0; i < segment.slices.curves.size(); ++i) {
    if (!scratch.is_active[i]) continue;
    for (Samples& each : std::span(by_curve[i]).first(segment.slices.curves[i].is_conic() ? 6 : 3)) {
      transpose_to_values(each, nodes, by_values);
      each = by_values;
    }
  }
  auto& registers = scratch.segments.registers;
  LimitScratch& limits = scratch.segments.limits;
  const OuterRange& range = segment.integral.outer;
  double by_lower = -segment.volume() / (range.upper - range.lower), by_upper = -by_lower;
  for (std::size_t n = 0; n < nodes; ++n) {
    const double tau = chebyshev_node(n, nodes), t = map_node(range, 0.5 * (1 + tau)).point;
    run_outer_stage(plan_, t, registers);
    if (!limits.active.empty()) evaluate_limits_at_t(plan_, t, limits);
    add_node_gradient(segment, n, tau, scratch);
    double by_t = sweep_outer_stage(plan_.program, registers, scratch.adjoints);
    if (!limits.active.empty()) by_t += sweep_outer_stage(plan_.limits, limits.registers, limits.adjoints);
    const double phi = (t - range.lower) / (range.upper - range.lower);
    by_lower += (1 - phi) * by_t;
    by_upper += phi * by_t;
  }
  add_end_gradient(segment.lower, false, by_lower, scratch);
  add_end_gradient(segment.upper, true, by_upper, scratch);
}

/// Adds the adjoints of the surfaces' coefficients at a Chebyshev node, which follow from the adjoints of the functions
/// u, w and c of the boundary curves (see CurveAt).
/// @param tau  coordinate of the node
void Volume::add_node_gradient(const Segment& segment, std::size_t node, double tau, Scratch& scratch) const {
  using Kind = CurveSource::Kind;
  const auto& registers = scratch.segments.registers;
  const Frame& frame = segment.slices.frame;
  for (std::size_t i = 0; i < segment.slices.curves.size(); ++i) {
    if (!scratch.is_active[i]) continue;
    const BoundaryCurve& curve = segment.slices.curves[i];
    const auto value = [&](std::size_t k) { return evaluate_series(curve.series[k].data(), curve.terms, tau); };
    const CurveSource& source = segment.slices.sources[i];
    const auto& by = scratch.by_curve[i];
    // The curve is given in the coordinates of the frame, in which an area equals the area in (v, z) divided by
    // scale^2.
    const double u = frame.scale * by[0][node], w = frame.scale * by[1][node], c = by[2][node];
    if (source.kind == Kind::limit) {
      add_limit_gradient(source.surface, frame.v - frame.scale * value(2), -frame.scale * c, scratch);
      continue;
    }
    if (source.kind == Kind::v_bound) {
      scratch.adjoints[plan_.range[1][source.surface]] -= frame.scale * c;
      continue;
    }
    const auto& at = plan_.surfaces[source.surface].coefficients;
    const auto add = [&](std::size_t coefficient, double adjoint) { scratch.adjoints[at[coefficient]] += adjoint; };
    switch (source.kind) {
      case Kind::circle: {
        // With the coefficients c0 .. c3 of the surface, the circle has the centre (-c1/(2 c3), -c2/(2 c3)) and the
        // squared radius |centre|^2 - c0/c3.
        const double c3 = registers[at[3]];
        const double v = -0.5 * registers[at[1]] / c3, z = -0.5 * registers[at[2]] / c3;
        const double square = v * v + z * z - registers[at[0]] / c3;
        add(0, -c / c3);
        add(1, -(0.5 * u + c * v) / c3);
        add(2, -(0.5 * w + c * z) / c3);
        add(3, -(u * v + w * z + c * (v * v + z * z + square)) / c3);
        break;
      }
      case Kind::line: {
        const double size = source.sign * std::hypot(registers[at[1]], registers[at[2]]), by_c = frame.scale * c / size;
        add(0, by_c);
        add(1, by_c * frame.v + frame.scale * u / size);
        add(2, by_c * frame.z + frame.scale * w / size);
        break;
      }
      case Kind::conic: {
        // Convert the coefficients of the surface to the frame, in which (v, z) = (frame.v, frame.z) + scale (x, y).
        const double factor = source.sign * frame.scale * frame.scale, s = frame.scale, v = frame.v, z = frame.z;
        const double of_1 = factor * by[2][node], of_x = factor * s * by[0][node], of_y = factor * s * by[1][node];
        add(0, of_1);
        add(1, of_1 * v + of_x);
        add(2, of_1 * z + of_y);
        add(3, of_1 * v * v + 2 * of_x * v + factor * s * s * by[3][node]);
        add(4, of_1 * v * z + of_x * z + of_y * v + factor * s * s * by[4][node]);
        add(5, of_1 * z * z + 2 * of_y * z + factor * s * s * by[5][node]);
        break;
      }
      case Kind::lower_root:
      case Kind::upper_root: {
        const bool along_v = std::fabs(value(0)) > 0.5;
        const std::size_t linear = along_v ? 1 : 2, square = along_v ? 3 : 5;
        const double root = (along_v ? frame.v : frame.z) - frame.scale * value(2);
        const double by_root = registers[at[linear]] + 2 * root * registers[at[square]];
        const double adjoint = frame.scale * c / by_root;
        add(0, adjoint);
        add(linear, adjoint * root);
        add(square, adjoint * root * root);
        break;
      }
      case Kind::v_bound:
      case Kind::limit:
        break;
    }
  }
}

/// Adds to s.adjoints the contributions of the adjoint of v, a root of the function of a limit, by the implicit
/// function theorem. To be called after evaluate_limits_at_t().
/// @param limit  index of the limit
void Volume::add_limit_gradient(std::size_t limit, double v, double adjoint, Scratch& scratch) const {
  LimitScratch& s = scratch.segments.limits;
  evaluate_limits_at_v(plan_, v, s);
  const std::uint32_t* const outputs = &plan_.limits.outputs()[3 * limit];
  s.adjoints[outputs[0]] -= adjoint / s.registers[outputs[1]];
  expression::backward_sweep(plan_.limits, 2, s.registers, s.adjoints);
  for (const auto& input : plan_.limits.stages()[2].inputs) s.adjoints[input.to] = 0;
}

/// Adds the contribution to the gradient of an endpoint of a segment, which moves with the design, by the implicit
/// function theorem.
/// @param derivative  derivative of the volume with respect to the endpoint
void Volume::add_end_gradient(const SegmentEnd& end, bool upper, double derivative, Scratch& scratch) const {
  auto& own = scratch.own;
  if (end.kind == SegmentEnd::Kind::division || derivative == 0) return;
  if (end.kind == SegmentEnd::Kind::box) {
    scratch.adjoints[plan_.range[0][upper ? 1 : 0]] += derivative;
    return;
  }
  const bool is_fold = end.kind == SegmentEnd::Kind::fold;
  const expression::Program& program = is_fold ? plan_.limits : plan_.program;
  LimitScratch& limits = scratch.segments.limits;
  auto& registers = is_fold ? limits.registers : scratch.segments.registers;
  own.assign(program.registers(), 0);
  if (is_fold) {
    evaluate_limits_at_t(plan_, end.at, limits);
    evaluate_limits_at_v(plan_, end.v, limits);
    own[program.outputs()[3 * end.function]] = 1;
    expression::backward_sweep(program, 2, registers, own);
    for (const auto& input : program.stages()[2].inputs) own[input.to] = 0;
  } else {
    run_outer_stage(plan_, end.at, registers);
    const OuterFunction& function = outer_.functions[end.function];
    const auto by = function.derivatives(registers);
    for (std::size_t i = 0; i < function.arguments(); ++i) own[function.registers[i]] += by[i];
  }
  const double by_t = sweep_outer_stage(program, registers, own), factor = -derivative / by_t;
  if (!std::isfinite(factor)) return;
  auto& adjoints = is_fold ? limits.adjoints : scratch.adjoints;
  for (std::size_t i = 0; i < own.size(); ++i) adjoints[i] += factor * own[i];
}

}  // namespace pkm::generic::corner_curves
