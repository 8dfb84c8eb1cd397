#include "engine/generic/edge_plan.hpp"

#include "engine/expression/polynomial_form.hpp"
#include "engine/expression/reverse_mode.hpp"
#include "engine/generic/constraints.hpp"
#include "engine/generic/edges/quadrics.hpp"

namespace pkm::generic::edges {
namespace {

constexpr std::size_t kCoefficients = 10;
using NodeQuadric = std::array<Node, kCoefficients>;

/// Converts formulas to quadrics in three coordinates, with coefficients that do not depend on these coordinates.
class QuadricConverter {
 public:
  QuadricConverter(Graph& graph, const std::array<Groups, 3>& groups) : graph_(graph), groups_(groups) {}

  bool is_independent(Node node) const { return (graph_[node].groups & (groups_[0] | groups_[1] | groups_[2])) == 0; }

  std::optional<NodeQuadric> quadric(Node node) const {
    NodeQuadric result;
    result.fill(graph_.number(0));
    if (!expand(node, 0, {0, 0, 0}, 3, result)) return {};
    return result;
  }

  /// Converts a constraint to clauses (a conjunction of disjunctions) of quadrics; std::nullopt if it has no such form.
  std::optional<std::vector<std::vector<NodeQuadric>>> clauses(Node constraint) const {
    for (std::size_t first = 0; first < 3; ++first)
      if (auto found = clauses_along(constraint, first)) return found;
    return {};
  }

 private:
  using Exponents = std::array<std::size_t, 3>;

  /// Adds x^i y^j z^k times a node to a quadric, where (i, j, k) are `exponents`. The node is expanded as a polynomial
  /// in the coordinates from index `axis` on, except the coordinate `known`.
  bool expand(Node node, std::size_t axis, const Exponents& exponents, std::size_t known, NodeQuadric& result) const {
    static constexpr std::size_t kPlace[3][3][3] = {
        {{0, 3, 6}, {2, 9, 0}, {5, 0, 0}}, {{1, 8, 0}, {7, 0, 0}, {0, 0, 0}}, {{4, 0, 0}, {0, 0, 0}, {0, 0, 0}}};
    if (axis == 3) {
      const auto [i, j, k] = exponents;
      if (i + j + k > 2) return graph_[node].is_number() && graph_[node].number == 0;
      result[kPlace[i][j][k]] = node;
      return is_independent(node);
    }
    if (axis == known) return expand(node, axis + 1, exponents, known, result);
    const auto parts = polynomial(graph_, node, groups_[axis]);
    if (!parts) return false;
    for (std::size_t i = 0; i < parts->size(); ++i) {
      Exponents of_part = exponents;
      of_part[axis] = i;
      if (!expand((*parts)[i], axis + 1, of_part, known, result)) return false;
    }
    return true;
  }

  std::optional<std::vector<std::vector<NodeQuadric>>> clauses_along(Node constraint, std::size_t axis) const {
    const auto lower = polynomial_clauses(graph_, constraint, groups_[axis], 2, true);
    if (!lower) return {};
    std::vector<std::vector<NodeQuadric>> result;
    for (const expression::Clause& clause : *lower) {
      std::vector<NodeQuadric>& to = result.emplace_back();
      for (const expression::Polynomial& p : clause) {
        to.emplace_back().fill(graph_.number(0));
        for (std::size_t i = 0; i < 3; ++i) {
          Exponents exponents{};
          exponents[axis] = i;
          if (!expand(p.c[i], 0, exponents, axis, to.back())) return {};
        }
      }
    }
    return result;
  }

  Graph& graph_;
  std::array<Groups, 3> groups_;
};

/// An upper bound of direction . p over the points p of a body.
/// @param direction  unit vector
double extent(const Body& body, const Vector3& direction) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity(), kParallel = 1e-14;
  const double cosine = dot(body.axis, direction), sine = std::sqrt(std::max(1 - cosine * cosine, 0.0));
  const double centre = dot(body.centre, direction);
  switch (body.kind) {
    case Body::Kind::plane:
      return norm(body.axis - direction) < kParallel ? body.radius : kInfinity;
    case Body::Kind::sphere:
      return body.side > 0 ? centre + body.radius : kInfinity;
    case Body::Kind::cylinder:
      return body.side > 0 && std::fabs(cosine) < kParallel ? centre + body.radius : kInfinity;
    case Body::Kind::slide: {
      // The end of the rod that moves with the platform is on a half sphere about E, the end of the slide: ahead of E
      // for the first root, behind E for the second one.
      const bool is_whole = (cosine >= 0) == body.is_first_root;
      return centre + std::max(body.from * cosine, body.to * cosine) + body.radius * (is_whole ? 1 : sine);
    }
    case Body::Kind::crank:
      return centre + body.crank * sine + body.radius;
  }
  return kInfinity;
}

}  // namespace

EdgePlan::EdgePlan(const Evaluation& evaluation, std::size_t mode, const std::vector<int>& swept,
                   const std::vector<std::optional<std::array<double, 2>>>& box, double tolerance)
    : tolerance_(tolerance) {
  if (swept.size() != 3) {
    why_not_ = "it does not sweep three coordinates";
    return;
  }
  const Model& model = evaluation.model;
  PoseConstraints known = constraints_of(model, mode);
  Graph& graph = known.graph;
  std::array<std::size_t, 3> coordinates{};
  std::array<Groups, 3> groups{};
  for (std::size_t i = 0; i < 3; ++i) {
    coordinates[i] = static_cast<std::size_t>(swept[i]);
    groups[i] = Inputs::coordinate_group(coordinates[i]);
  }
  const QuadricConverter converter(graph, groups);
  std::vector<Node> constants, outputs;
  std::vector<bool> is_covered(known.all.size());
  for (const RodAndPathNodes& path : known.paths) {
    // Vector such that the vector v from the joint on the base to the joint on the platform is p + offset, where p
    // consists of the swept coordinates.
    std::array<Node, 3> offset{};
    bool is_translation = graph[path.branch].is_number();
    for (std::size_t i = 0; i < 3 && is_translation; ++i) {
      const auto v = converter.quadric(path.v[i]);
      for (std::size_t k = 1; v && k < kCoefficients; ++k) {
        const expression::Entry& entry = graph[(*v)[k]];
        is_translation = is_translation && entry.is_number() && entry.number == (k == i + 1 ? 1 : 0);
      }
      is_translation =
          is_translation && v && converter.is_independent(path.axis[i]) && converter.is_independent(path.zero[i]);
      if (v) offset[i] = v->front();
    }
    if (!is_translation) continue;
    rods_.push_back({outputs.size(), path.is_circle, graph[path.branch].number < 0});
    for (const std::array<Node, 3>& vector : {offset, path.axis, path.zero})
      outputs.insert(outputs.end(), vector.begin(), vector.end());
    outputs.insert(outputs.end(), {path.rod, path.crank, path.from, path.to});
    for (std::size_t i = 0; i < known.all.size(); ++i)
      is_covered[i] = is_covered[i] || std::ranges::find(path.constraints, known.all[i]) != path.constraints.end();
  }
  for (std::size_t i = 0; i < known.all.size(); ++i) {
    const Node node = known.all[i];
    if (is_covered[i]) continue;
    if (converter.is_independent(node)) {
      constants.push_back(node);
      continue;
    }
    const auto clauses = converter.clauses(node);
    if (!clauses) {
      why_not_ = "'" + constraint_name(model, i) + "' is not a quadric";
      return;
    }
    for (const auto& clause : *clauses) {
      Clause& to = clauses_.emplace_back();
      for (const NodeQuadric& quadric : clause) {
        to.push_back(outputs.size());
        outputs.insert(outputs.end(), quadric.begin(), quadric.end());
      }
    }
    for (const Node finite : finiteness_constraints(graph, node, groups[0] | groups[1] | groups[2]))
      constants.push_back(finite);
  }
  box_ = outputs.size();
  for (const std::size_t i : coordinates) {
    if (box[i]) {
      for (const double end : *box[i]) outputs.push_back(graph.number(end));
    } else if (known.box[i]) {
      outputs.insert(outputs.end(), known.box[i]->begin(), known.box[i]->end());
    } else {
      why_not_ = "it has no [survey] box for " + model.info.coordinates[i].name;
      return;
    }
  }
  constants_ = outputs.size();
  outputs.insert(outputs.end(), constants.begin(), constants.end());
  program_ = expression::Program(graph, outputs);
}

bool EdgePlan::build(std::span<const double> inputs, Design& design) const {
  design.outputs.clear();
  design.solid.bodies.clear();
  design.sources.clear();
  design.is_empty = false;
  design.beyond = 0;
  program_.run_all<double>(inputs, design.registers);
  for (const std::uint32_t output : program_.outputs()) design.outputs.push_back(design.registers[output]);
  const double* const values = design.outputs.data();
  for (std::size_t i = constants_; i < design.outputs.size(); ++i)
    design.is_empty = design.is_empty || !(values[i] >= 0);
  const auto vector = [&](std::size_t at) { return Vector3{{values[at], values[at + 1], values[at + 2]}}; };
  Vector3 half;
  for (std::size_t i = 0; i < 3; ++i) {
    const double low = values[box_ + 2 * i], high = values[box_ + 2 * i + 1];
    design.origin[i] = 0.5 * (low + high);
    half[i] = 0.5 * (high - low);
    design.is_empty = design.is_empty || !(low < high);
  }
  design.solid.bound = norm(half);
  const double margin = 1e-12 * design.solid.bound;
  const auto add = [&](const Body& body, const Source& source) {
    if (body.kind == Body::Kind::plane) {
      double reach = std::numeric_limits<double>::infinity();
      for (const Body& other : design.solid.bodies) reach = std::min(reach, extent(other, body.axis));
      if (reach <= body.radius + margin) {
        // The plane is omitted as a body, because another body hardly extends beyond it: add this distance and more
        // than the rounding error of extent() to `beyond`.
        design.beyond += std::max(reach - body.radius, 0.0) + 0.1 * margin;
        return;
      }
    }
    design.solid.bodies.push_back(body);
    design.sources.push_back(source);
  };

  for (const Rod& rod : rods_) {
    const std::size_t at = rod.output;
    const Body body{.kind = rod.is_crank ? Body::Kind::crank : Body::Kind::slide,
                    .centre = (vector(at) + design.origin) * -1.0,
                    .axis = vector(at + 3),
                    .zero = rod.is_crank ? vector(at + 6) : Vector3{},
                    .radius = values[at + 9],
                    .crank = rod.is_crank ? values[at + 10] : 0,
                    .from = values[at + 11],
                    .to = values[at + 12],
                    .is_first_root = rod.is_first_root};
    if (!(body.from < body.to)) design.is_empty = true;
    // The end faces of a range of a whole revolution would coincide, which edges do not support.
    if (rod.is_crank && body.to - body.from > 2 * kPi - 1e-6) return false;
    add(body, {Source::Kind::rod, at});
  }
  for (const Clause& clause : clauses_) {
    std::optional<Body> only;
    std::size_t from = 0, bodies = 0;
    bool is_satisfied = false;
    for (const std::size_t at : clause) {
      Body body;
      const QuadricKind kind = classify(QuadricCoefficients(values + at, kCoefficients), design.reach(), body);
      if (kind == QuadricKind::other) return false;
      is_satisfied = is_satisfied || kind == QuadricKind::satisfied;
      if (kind != QuadricKind::body) continue;
      ++bodies;
      only = body;
      from = at;
    }
    if (is_satisfied) continue;
    if (bodies > 1) return false;
    if (!only) {
      design.is_empty = true;
      continue;
    }
    if (only->kind == Body::Kind::plane)
      only->radius -= dot(only->axis, design.origin);
    else
      only->centre = only->centre - design.origin;
    add(*only, {Source::Kind::quadric, from});
  }
  for (std::size_t i = 0; i < 3; ++i) {
    for (const double side : {-1.0, 1.0}) {
      Body plane{.radius = half[i]};
      plane.axis[i] = side;
      add(plane, {Source::Kind::box, box_ + 2 * i + (side > 0 ? 1 : 0), side});
    }
  }
  return true;
}

std::optional<Integral<double>> EdgePlan::measure(std::span<const double> inputs, Scratch& scratch,
                                                  std::span<double> by_input) const {
  Design& design = scratch.design;
  if (!build(inputs, design)) return {};
  if (design.is_empty) return Integral<double>{};
  const EdgeVolume found =
      volume(design.solid, tolerance_, scratch.volume, by_input.empty() ? nullptr : &scratch.gradient);
  if (!found.is_supported || !found.is_closed) return {};
  if (!by_input.empty()) add_gradient(scratch, by_input);
  return Integral<double>{found.value, found.error, found.nodes};
}

std::optional<Interval> EdgePlan::prove(std::span<const double> inputs, Scratch& scratch) const {
  Design& design = scratch.design;
  if (!build(inputs, design) || design.is_empty) return {};
  const std::vector<Interval> numbers(inputs.begin(), inputs.end());
  std::vector<Interval> registers, values;
  program_.run_all<Interval>(numbers, registers);
  for (const std::uint32_t output : program_.outputs()) values.push_back(registers[output]);
  for (std::size_t i = constants_; i < values.size(); ++i)
    if (!values[i].is_certified_satisfied()) return {};
  if (!are_others_superfluous(design, values)) return {};
  std::vector<IntervalBody> bodies;
  for (std::size_t i = 0; i < design.solid.bodies.size(); ++i) {
    const auto body = enclose(design.solid.bodies[i], design.sources[i], design.origin, values);
    if (!body) return {};
    bodies.push_back(*body);
  }
  const double bound = (1 + 1e-12) * design.solid.bound;
  const auto found = proven_volume(bodies, bound);
  if (!found) return {};
  return *found - Interval(0, design.beyond * 4 * bound * bound);
}

std::optional<IntervalBody> EdgePlan::enclose(const Body& body, const Source& source, const Vector3& origin,
                                              std::span<const Interval> values) {
  IntervalBody made{.kind = body.kind, .side = body.side, .is_first_root = body.is_first_root};
  const std::span<const Interval> f = values.subspan(source.output);
  const auto vector = [&](std::size_t at) { return IntervalVector{{f[at], f[at + 1], f[at + 2]}}; };
  IntervalVector middle;
  for (std::size_t i = 0; i < 3; ++i) middle[i] = origin[i];
  switch (source.kind) {
    case Source::Kind::box:
      made.axis = {};
      for (std::size_t i = 0; i < 3; ++i) made.axis[i] = body.axis[i];
      made.radius = (f[0] - dot(middle, made.axis) * Interval(source.side)) * Interval(source.side);
      return made;
    case Source::Kind::rod:
      made.centre = (vector(0) + middle) * Interval(-1);
      made.axis = vector(3);
      made.radius = f[9];
      if (body.kind == Body::Kind::crank) {
        made.zero = vector(6);
        made.crank = f[10];
      }
      made.from = f[11];
      made.to = f[12];
      return made;
    case Source::Kind::quadric:
      break;
  }
  // The quadric is k + b . p + p . A p, for points p.
  const auto is_number = [](const Interval& x, double number) { return x.lower == number && x.upper == number; };
  const IntervalVector b = vector(1), squares = vector(4), products = vector(7);
  if (!std::ranges::all_of(products, [&](const Interval& x) { return is_number(x, 0); })) return {};
  if (body.kind == Body::Kind::plane) {
    if (!std::ranges::all_of(squares, [&](const Interval& x) { return is_number(x, 0); })) return {};
    const Interval length = sqrt(square(b[0]) + square(b[1]) + square(b[2]));
    made.axis = b * (Interval(-1) / length);
    made.radius = f[0] / length - dot(made.axis, middle);
    return made;
  }
  // A sphere has three squares with the same coefficient, a cylinder along a coordinate axis two.
  const double factor = squares[squares[0].lower != 0 ? 0 : 1].lower;
  IntervalVector centre = b * (Interval(-0.5) / Interval(factor));
  int along = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (is_number(squares[i], factor)) continue;
    if (!is_number(squares[i], 0) || !is_number(b[i], 0)) return {};
    made.axis[i] = 1;
    centre[i] = 0;
    ++along;
  }
  if (along != (body.kind == Body::Kind::cylinder ? 1 : 0)) return {};
  made.radius = sqrt(dot(centre, centre) - f[0] / Interval(factor));
  made.centre = centre - middle;
  return made;
}

bool EdgePlan::are_others_superfluous(const Design& design, std::span<const Interval> values) const {
  const Interval* const box = values.data() + box_;
  const std::array<Interval, 3> p{Interval(box[0].lower, box[1].upper), Interval(box[2].lower, box[3].upper),
                                  Interval(box[4].lower, box[5].upper)};
  const auto over_box = [&](std::size_t at) {
    const Interval* const f = values.data() + at;
    return f[0] + f[1] * p[0] + f[2] * p[1] + f[3] * p[2] + f[4] * square(p[0]) + f[5] * square(p[1]) +
           f[6] * square(p[2]) + f[7] * p[0] * p[1] + f[8] * p[0] * p[2] + f[9] * p[1] * p[2];
  };
  return std::ranges::all_of(clauses_, [&](const Clause& clause) {
    if (std::ranges::any_of(clause, [&](std::size_t at) { return over_box(at).is_certified_satisfied(); })) return true;
    // At most one quadric of the clause may bound the solid; all others must be violated everywhere.
    std::size_t bodies = 0;
    for (const std::size_t at : clause) {
      Body body;
      const QuadricKind kind =
          classify(QuadricCoefficients(design.outputs.data() + at, kCoefficients), design.reach(), body);
      if (kind == QuadricKind::body)
        ++bodies;
      else if (!over_box(at).is_certified_violated())
        return false;
    }
    return bodies == 1;
  });
}

void EdgePlan::add_gradient(Scratch& scratch, std::span<double> by_input) const {
  const Design& design = scratch.design;
  const std::vector<Body>& gradient = scratch.gradient;
  std::vector<double>& adjoints = scratch.adjoints;
  adjoints.assign(program_.registers(), 0);
  const auto add = [&](std::size_t output, double derivative) { adjoints[program_.outputs()[output]] += derivative; };
  for (std::size_t i = 0; i < gradient.size(); ++i) {
    const auto& [kind, at, side] = design.sources[i];
    Body by = gradient[i];
    switch (kind) {
      case Source::Kind::rod:
        for (std::size_t k = 0; k < 3; ++k) {
          add(at + k, -by.centre[k]);
          add(at + 3 + k, by.axis[k]);
          add(at + 6 + k, by.zero[k]);
        }
        add(at + 9, by.radius);
        add(at + 10, by.crank);
        add(at + 11, by.from);
        add(at + 12, by.to);
        break;
      case Source::Kind::quadric: {
        const QuadricCoefficients f(design.outputs.data() + at, kCoefficients);
        Body body;
        classify(f, design.reach(), body);
        if (body.kind == Body::Kind::plane) by.axis = by.axis - design.origin * by.radius;
        const auto by_f = by_coefficients(f, body, by);
        for (std::size_t k = 0; k < kCoefficients; ++k) add(at + k, by_f[k]);
        break;
      }
      case Source::Kind::box:
        add(at, side * by.radius);
    }
  }
  backward_sweep(program_, 0, design.registers, adjoints);
  for (const auto& input : program_.stages()[0].inputs) by_input[input.position] += adjoints[input.to];
}

}  // namespace pkm::generic::edges
