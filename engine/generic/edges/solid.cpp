#include "engine/generic/edges/solid.hpp"

#include <algorithm>

#include "engine/generic/edges/edge_search.hpp"
#include "engine/math/quadrature.hpp"

namespace pkm::generic::edges {
namespace {

/// A subinterval of an edge, for quadrature.
struct Panel {
  std::size_t edge;
  Subinterval<double> interval;
  double value = 0, error = 0;
  /// Integrals along this subinterval for the moments of the first and of the second face.
  std::array<Moments, 2> moments{};
};

}  // namespace

/// Computes sums of integrals over the edges of a solid.
class Evaluator {
 public:
  EdgeVolume run(const Solid& solid, double tolerance, std::vector<Body>* gradient) {
    result_ = {};
    result_.is_supported = search_.find(solid);
    if (!result_.is_supported) return result_;
    result_.is_closed = search_.is_complete();
    result_.boxes = search_.boxes();
    close();
    choose_poles();
    integrate(tolerance);
    if (gradient) differentiate(*gradient);
    return result_;
  }

 private:
  /// Checks whether the directed edges of each face form closed curves, and sets `gap` and `is_closed` of the result.
  void close() {
    std::vector<Vector3>& gaps = gaps_;
    gaps.assign(search_.faces().size(), {});
    for (const Edge& edge : search_.edges()) {
      const Vector3 chord = values(EdgeSearch::point_at(edge, edge.to)) - values(EdgeSearch::point_at(edge, edge.from));
      gaps[index(edge, 0)] += chord * edge.sign;
      gaps[index(edge, 1)] += chord * -edge.sign;
    }
    for (const Vector3& gap : gaps) result_.gap = std::max(result_.gap, largest(gap));
    // Where surfaces touch, as those of limbs with a common axis of symmetry do, the ends of edges are known to the
    // square root of the rounding errors. Gap and undecided length are part of the error.
    constexpr double kClosed = 1e-7;
    if (result_.gap > kClosed * search_.size_to_the(1) || search_.undecided() > kClosed * search_.size_to_the(3))
      result_.is_closed = false;
  }

  std::size_t index(const Edge& edge, std::size_t which) const {
    return static_cast<std::size_t>(edge.arc->curve->faces[which] - search_.faces().data());
  }

  /// Chooses for each whole sphere the point at which its differential form is singular (away_from_pole), far from the
  /// edges.
  void choose_poles() {
    for (Face& face : search_.faces()) {
      if (face.body->kind != Body::Kind::sphere) continue;
      double best = -1;
      for (int i = 0; i < 27; ++i) {
        const Vector3 v{{i % 3 - 1.1, i / 3 % 3 - 0.9, i / 9 - 1.2}};
        const Vector3 t = v * (1 / norm(v));
        double least = 2;
        for (const Edge& edge : search_.edges()) {
          if (edge.arc->curve->faces[0] != &face && edge.arc->curve->faces[1] != &face) continue;
          for (int k = 0; k <= 4; ++k) {
            const Vector3 p = values(EdgeSearch::point_at(edge, edge.from + 0.25 * k * (edge.to - edge.from)));
            least = std::min(least, 1 + dot(t, p - face.centre) / face.body->radius);
          }
        }
        if (least <= best) continue;
        best = least;
        face.away_from_pole = t;
      }
    }
  }

  void integrate(double tolerance) {
    moments_.assign(search_.faces().size(), {});
    double sum = 0, error = 0, magnitude = 0;
    for (std::size_t i = 0; i < search_.faces().size(); ++i) {
      const Face& face = search_.faces()[i];
      if (face.body->kind != Body::Kind::sphere) continue;
      const Vector3 pole = face.centre - face.away_from_pole * face.body->radius;
      CurvePoint at{.p = {}, .square = Enclosure(dot(pole, pole))};
      std::ranges::copy(pole, at.p.begin());
      if (!search_.is_in_others(face.number, at)) continue;
      moments_[i].radius[0] = face.side * 4 * kPi * face.body->radius * face.body->radius;
      sum += three_volumes(face, moments_[i]) / 3;
    }
    std::vector<Panel>& panels = panels_;
    panels.clear();
    const std::vector<Edge>& edges = search_.edges();
    for (std::size_t i = 0; i < edges.size(); ++i) panels.push_back({i, {edges[i].from, edges[i].to}});
    for (Panel& panel : panels) evaluate(panel);
    const auto total = [&](auto member) {
      double all = 0;
      for (const Panel& panel : panels) all += std::fabs(panel.*member);
      return all;
    };
    magnitude = std::fabs(sum);
    for (const Panel& panel : panels) sum += panel.value;
    magnitude += total(&Panel::value);
    error = total(&Panel::error);
    constexpr std::size_t kMaxPanels = 2000;
    while (error > std::max(tolerance * std::fabs(sum), 1e-15 * magnitude) && panels.size() < kMaxPanels) {
      const auto worst = std::ranges::max_element(panels, {}, &Panel::error);
      const auto index = static_cast<std::size_t>(worst - panels.begin());
      const double before = worst->value;
      bisect_cell(panels, index, [&](Panel& panel) { evaluate(panel); });
      sum += panels[index].value + panels.back().value - before;
      error = total(&Panel::error);
    }
    for (const Panel& panel : panels)
      for (std::size_t k = 0; k < 2; ++k) moments_[index(edges[panel.edge], k)].add(panel.moments[k], 1);
    result_.value = std::max(sum, 0.0);
    result_.error = error + search_.undecided() + result_.gap * search_.size_to_the(2) + 1e-15 * magnitude;
    if (!std::isfinite(sum + result_.error)) result_.is_closed = false;
  }

  void evaluate(Panel& panel) {
    const Edge& edge = search_.edges()[panel.edge];
    const NestedRule& rule = kronrod_rule();
    const NestedRule::Level& level = rule.level.front();
    const auto& faces = edge.arc->curve->faces;
    std::array<double, NestedRule::kNodes> f{};
    const double length = panel.interval.upper - panel.interval.lower;
    panel.value = 0;
    panel.moments = {};
    for (std::size_t i = 0; i < level.nodes; ++i) {
      const Enclosure3 at = EdgeSearch::point_at(edge, panel.interval.lower + length * rule.node[i]);
      const Vector3 p = values(at), dp = slopes(at) * (length * edge.sign);
      for (std::size_t k = 0; k < 2; ++k) {
        const double sign = k == 0 ? 1 : -1;
        const Moments m = forms(*faces[k], p, dp);
        panel.moments[k].add(m, sign * level.weight[i]);
        f[i] += sign * three_volumes(*faces[k], m) / 3;
      }
      panel.value += level.weight[i] * f[i];
    }
    panel.error = rule_error(level, f, panel.value);
    result_.nodes += static_cast<long>(level.nodes);
  }

  /// Computes the derivatives of the volume. The derivative with respect to a parameter is the integral of the normal
  /// speed of the faces.
  void differentiate(std::vector<Body>& gradient) const {
    gradient.assign(search_.bodies().size(), Body{});
    for (std::size_t i = 0; i < search_.bodies().size(); ++i) gradient[i].side = gradient[i].radius = 0;
    for (std::size_t i = 0; i < search_.faces().size(); ++i) {
      const Face& face = search_.faces()[i];
      const PreparedBody& body = *face.body;
      const Moments& m = moments_[i];
      Body& by = gradient[face.number];
      // The normal speed of a plane is the change of `radius` minus (change of `axis`) . p.
      if (face.surface == Surface::plane) {
        const double area = dot(body.axis, m.normal);
        by.radius = area;
        by.axis = cross(m.rotation, body.axis) - body.axis * (area * body.radius);
        continue;
      }
      by.centre += m.normal;
      by.radius += m.radius[0];
      if (face.surface == Surface::cylinder || face.surface == Surface::torus) {
        by.axis += cross(m.rotation, body.axis);
        by.crank += m.radius[1];
      } else if (body.kind == Body::Kind::slide || body.kind == Body::Kind::crank) {
        const auto e = static_cast<std::size_t>(face.part);
        const double q = e == 0 ? body.from : body.to, by_q = dot(body.along[e], m.normal);
        if (body.kind == Body::Kind::slide) {
          (e == 0 ? by.from : by.to) = by_q;
          by.axis += m.normal * q;
        } else {
          (e == 0 ? by.from : by.to) = by_q * body.crank;
          const auto [s, c] = portable::sincos(q);
          by.crank += dot(body.zero * c + body.beside * s, m.normal);
          by.zero += (m.normal * c + cross(m.normal, body.axis) * s) * body.crank;
          by.axis += cross(body.zero, m.normal) * (s * body.crank);
        }
      }
    }
  }

  EdgeSearch search_;
  std::vector<Moments> moments_;  ///< of each face
  std::vector<Vector3> gaps_;     ///< of each face, the sum of the vectors along its edges
  std::vector<Panel> panels_;
  EdgeVolume result_;
};

VolumeScratch::VolumeScratch() : evaluator_(std::make_unique<Evaluator>()) {}
VolumeScratch::~VolumeScratch() = default;

EdgeVolume volume(const Solid& solid, double tolerance, VolumeScratch& scratch, std::vector<Body>* gradient) {
  return scratch.evaluator_->run(solid, tolerance, gradient);
}

}  // namespace pkm::generic::edges
