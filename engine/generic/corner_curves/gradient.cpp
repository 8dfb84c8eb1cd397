// Gradient of a volume by reverse-mode differentiation: the adjoints of the curves' series become adjoints of the
// surfaces' coefficients at the Chebyshev nodes, from which a backward sweep through the program follows, for all nodes
// at once.
//
// The nodes move with the ends of their segment, t = low + (high - low) phi, so that curves that behave like square
// roots at an end have finite derivatives at every node.
#include <algorithm>
#include <utility>

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
  // Number of nodes: the number of coefficients that the series of the curves need, and some more, because derivatives
  // need more.
  std::size_t terms = 1;
  for (const BoundaryCurve& curve : segment.slices.curves) terms = std::max(terms, curve.terms);
  const std::size_t nodes = terms <= 4 ? 8 : terms <= 14 ? 16 : terms <= 22 ? 24 : kNodes;
  scratch.is_active.assign(segment.integral.curves.size(), false);
  for (const ActiveRange& active : segment.integral.decomposition.ranges)
    scratch.is_active[active.first] = scratch.is_active[active.second] = true;
  scratch.by_curve.resize(segment.integral.curves.size());
  for (std::size_t i = 0; i < segment.integral.curves.size(); ++i)
    if (scratch.is_active[i])
      for (Samples& each : scratch.by_curve[i]) each.fill(0);
  add_adjoints(segment.integral, nodes, scratch.by_curve);
  const OuterRange& range = segment.integral.outer;
  SegmentScratch& at_nodes = scratch.segments;
  run_outer_stage(outer_, range, nodes, at_nodes.registers, at_nodes.rows);
  scratch.row_adjoints.resize(at_nodes.rows.size());
  for (std::size_t i = 0; i < segment.slices.curves.size(); ++i)
    if (scratch.is_active[i]) add_curve_gradient(segment, i, nodes, scratch);
  outer_.stage->backward_sweep(at_nodes.registers.data(), at_nodes.rows.data(), nodes,
                               {scratch.row_adjoints.data(), scratch.adjoints.data()});
  double by_lower = -segment.volume() / (range.upper - range.lower), by_upper = -by_lower;
  for (std::size_t n = 0; n < nodes; ++n) {
    const double tau = chebyshev_nodes(nodes)[n];
    double by_t = at_nodes.limits.active.empty() ? 0 : add_limits_gradient(segment, n, tau, scratch);
    for (const std::uint32_t slot : outer_.stage->inputs())
      by_t += std::exchange(scratch.row_adjoints[slot * expression::kRow + n], 0);
    const double phi = (map_node(range, 0.5 * (1 + tau)).point - range.lower) / (range.upper - range.lower);
    by_lower += (1 - phi) * by_t;
    by_upper += phi * by_t;
  }
  add_end_gradient(segment.lower, false, by_lower, scratch);
  add_end_gradient(segment.upper, true, by_upper, scratch);
}

/// Converts the adjoints of a boundary curve's series, scratch.by_curve, to those of the values of its functions u, w
/// and c (see CurveAt) at the nodes, and adds the resulting adjoints of the surface's coefficients there.
void Volume::add_curve_gradient(const Segment& segment, std::size_t curve, std::size_t nodes, Scratch& scratch) const {
  using Kind = CurveSource::Kind;
  const BoundaryCurve& boundary = segment.slices.curves[curve];
  const CurveSource& source = segment.slices.sources[curve];
  auto& by = scratch.by_curve[curve];
  Samples by_values;
  for (Samples& each : std::span(by).first(boundary.is_conic() ? 6 : 3)) {
    transpose_to_values(each, nodes, by_values);
    each = by_values;
  }
  if (source.kind == Kind::limit) return;  // add_limits_gradient()

  // A register at the nodes, with its adjoints; if it does not depend on t, `step` is 0.
  struct AtNodes {
    const double* values;
    double* adjoints;
    std::size_t step;
    double operator[](std::size_t n) const { return values[n * step]; }
    void add(std::size_t n, double adjoint) const { adjoints[n * step] += adjoint; }
  };
  const auto at_nodes = [&](std::uint32_t at) {
    const expression::Operand operand = outer_.stage->operand(at);
    const std::size_t row = operand.index * expression::kRow;
    return operand.row ? AtNodes{&scratch.segments.rows[row], &scratch.row_adjoints[row], 1}
                       : AtNodes{&scratch.segments.registers[at], &scratch.adjoints[at], 0};
  };
  // The curve is given in the coordinates of the frame, in which an area equals the area in (v, z) divided by scale^2.
  const Frame& frame = segment.slices.frame;
  const double s = frame.scale, v = frame.v, z = frame.z;
  if (source.kind == Kind::v_bound) {
    const AtNodes bound = at_nodes(plan_.range[1][source.surface]);
    for (std::size_t n = 0; n < nodes; ++n) bound.add(n, -s * by[2][n]);
    return;
  }
  std::array<AtNodes, 6> c;  // coefficients of the surface
  for (std::size_t i = 0; i < c.size(); ++i) c[i] = at_nodes(plan_.surfaces[source.surface].coefficients[i]);
  for (std::size_t n = 0; n < nodes; ++n) {
    switch (source.kind) {
      case Kind::circle: {
        // The circle has the centre (-c1/(2 c3), -c2/(2 c3)) and the squared radius |centre|^2 - c0/c3.
        const double centre_v = -0.5 * c[1][n] / c[3][n], centre_z = -0.5 * c[2][n] / c[3][n];
        const double square = centre_v * centre_v + centre_z * centre_z;
        const double by_v = s * by[0][n], by_z = s * by[1][n], by_square = by[2][n];
        c[0].add(n, -by_square / c[3][n]);
        c[1].add(n, -(0.5 * by_v + by_square * centre_v) / c[3][n]);
        c[2].add(n, -(0.5 * by_z + by_square * centre_z) / c[3][n]);
        c[3].add(n, -(by_v * centre_v + by_z * centre_z + by_square * (2 * square - c[0][n] / c[3][n])) / c[3][n]);
        break;
      }
      case Kind::line: {
        const double size = source.sign * std::hypot(c[1][n], c[2][n]), of_1 = s * by[2][n] / size;
        c[0].add(n, of_1);
        c[1].add(n, of_1 * v + s * s * by[0][n] / size);
        c[2].add(n, of_1 * z + s * s * by[1][n] / size);
        break;
      }
      case Kind::conic: {
        // Convert the coefficients of the surface to the frame, in which (v, z) = (frame.v, frame.z) + s (x, y).
        const double factor = source.sign * s * s;
        const double of_1 = factor * by[2][n], of_x = factor * s * by[0][n], of_y = factor * s * by[1][n];
        c[0].add(n, of_1);
        c[1].add(n, of_1 * v + of_x);
        c[2].add(n, of_1 * z + of_y);
        c[3].add(n, of_1 * v * v + 2 * of_x * v + factor * s * s * by[3][n]);
        c[4].add(n, of_1 * v * z + of_x * z + of_y * v + factor * s * s * by[4][n]);
        c[5].add(n, of_1 * z * z + 2 * of_y * z + factor * s * s * by[5][n]);
        break;
      }
      case Kind::lower_root:
      case Kind::upper_root: {
        const double tau = chebyshev_nodes(nodes)[n];
        const auto value = [&](std::size_t k) {
          return evaluate_series(boundary.series[k].data(), boundary.terms, tau);
        };
        const bool along_v = std::fabs(value(0)) > 0.5;
        const std::size_t linear = along_v ? 1 : 2, square = along_v ? 3 : 5;
        const double root = (along_v ? v : z) - s * value(2);
        const double adjoint = s * by[2][n] / (c[linear][n] + 2 * root * c[square][n]);
        c[0].add(n, adjoint);
        c[linear].add(n, adjoint * root);
        c[square].add(n, adjoint * root * root);
        break;
      }
      case Kind::v_bound:
      case Kind::limit:
        break;
    }
  }
}

/// Adds the adjoints of the limits' functions at a Chebyshev node.
/// @param tau  coordinate of the node
/// @return     the adjoint of t
double Volume::add_limits_gradient(const Segment& segment, std::size_t node, double tau, Scratch& scratch) const {
  LimitScratch& limits = scratch.segments.limits;
  const Frame& frame = segment.slices.frame;
  evaluate_limits_at_t(plan_, map_node(segment.integral.outer, 0.5 * (1 + tau)).point, limits);
  for (std::size_t i = 0; i < segment.slices.curves.size(); ++i) {
    const CurveSource& source = segment.slices.sources[i];
    if (source.kind != CurveSource::Kind::limit || !scratch.is_active[i]) continue;
    const BoundaryCurve& curve = segment.slices.curves[i];
    const double v = frame.v - frame.scale * evaluate_series(curve.series[2].data(), curve.terms, tau);
    add_limit_gradient(source.surface, v, -frame.scale * scratch.by_curve[i][2][node], scratch);
  }
  return sweep_outer_stage(plan_.limits, limits.registers, limits.adjoints);
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
    std::array<double, 3> arguments{};
    for (std::size_t i = 0; i < function.arguments(); ++i) arguments[i] = registers[function.registers[i]];
    const auto by = function.derivatives(arguments);
    for (std::size_t i = 0; i < function.arguments(); ++i) own[function.registers[i]] += by[i];
  }
  const double by_t = sweep_outer_stage(program, registers, own), factor = -derivative / by_t;
  if (!std::isfinite(factor)) return;
  auto& adjoints = is_fold ? limits.adjoints : scratch.adjoints;
  for (std::size_t i = 0; i < own.size(); ++i) adjoints[i] += factor * own[i];
}

}  // namespace pkm::generic::corner_curves
