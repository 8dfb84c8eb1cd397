#include "engine/generic/columns/planar_slice.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "engine/generic/columns/vertices.hpp"
#include "engine/math/hash.hpp"
#include "engine/math/satisfied.hpp"

namespace pkm::generic {
namespace {

/// Whether a quadratic polynomial is positive below all of its roots.
/// @param c, roots  its coefficients, and the number of its roots
bool positive_below(const std::array<double, 3>& c, int roots) {
  if (c[2] != 0) return c[2] > 0;
  return roots > 0 ? c[1] < 0 : c[0] >= 0;
}

}  // namespace

void PlanarSlice::find_column(double t, const double* registers, PlanarSliceScratch& scratch) const {
  Signs signs = scratch.always;
  scratch.ends.clear();
  for (const std::size_t k : scratch.active) {
    const auto c = scratch.conics[k].along(t);
    const Roots roots = roots_of(c);
    signs |= positive_below(c, roots.count) ? scratch.meaning[k].same : scratch.meaning[k].opposite;
    for (int r = 0; r < roots.count; ++r)
      scratch.ends.emplace_back(roots.s[static_cast<std::size_t>(r)], static_cast<EndLabel>(k << 1U) + (r ? 1U : 0U));
  }
  std::sort(scratch.ends.begin(), scratch.ends.end());
  scratch.column.clear();
  bool is_in = false;
  EndLabel lower = 0;
  for (std::size_t i = 0; i < scratch.ends.size();) {
    const double s = scratch.ends[i].first;
    const Signs before = signs;
    std::size_t end = i;
    for (; end < scratch.ends.size() && scratch.ends[end].first <= s + kMergeDistance; ++end) {
      const auto [same, opposite] = scratch.meaning[scratch.ends[end].second >> 1U];
      signs ^= same | opposite;
    }
    if (plan_.formula.holds(signs, registers) != is_in) {
      is_in = !is_in;
      // If the roots of several surfaces coincide at this endpoint of a column, the first surface whose sign changes in
      // the required direction represents them.
      EndLabel label = ~EndLabel{0}, any = ~EndLabel{0};
      for (std::size_t j = i; j < end; ++j) {
        const EndLabel each = scratch.ends[j].second;
        any = std::min(any, each);
        if (((signs & ~before & scratch.meaning[each >> 1U].same) != 0) == is_in) label = std::min(label, each);
      }
      if (label == ~EndLabel{0}) label = any;
      if (is_in)
        lower = label;
      else
        scratch.column.push_back({lower, label});
    }
    i = end;
  }
}

void PlanarSlice::evaluate_stage_of_v(double t, std::span<double> registers, const PlanarSliceScratch& scratch) const {
  const expression::Program& program = plan_.program;
  for (const auto& input : program.stages()[stage_of_v()].inputs) registers[input.to] = scratch.v[0] + scratch.v[1] * t;
  program.run<double>(stage_of_v(), registers);
}

void PlanarSlice::evaluate_independent(double t, std::span<double> registers, const PlanarSliceScratch& scratch,
                                       std::vector<double>& values) const {
  evaluate_stage_of_v(t, registers, scratch);
  values.clear();
  for (const std::uint32_t at : plan_.independent.back()) values.push_back(registers[at]);
}

bool PlanarSlice::independent_constraints_hold(double t, std::span<double> registers,
                                               const PlanarSliceScratch& scratch) const {
  evaluate_stage_of_v(t, registers, scratch);
  return std::ranges::all_of(plan_.independent.back(), [&](std::uint32_t at) { return is_satisfied(registers[at]); });
}

/// Finds the pieces, i.e. the intervals of t between consecutive vertices in which all columns have the same endpoints.
/// @param independent  true: also evaluate the constraints that are independent of z
void PlanarSlice::find_pieces(bool independent, std::span<double> registers, PlanarSliceScratch& scratch) const {
  scratch.pieces.clear();
  scratch.spans.clear();
  std::sort(scratch.vertices.begin(), scratch.vertices.end(), [](const auto& x, const auto& y) { return x.t < y.t; });
  double from = -1;
  std::size_t from_vertex = scratch.vertices.size();
  const auto add = [&](double to, std::size_t to_vertex) {
    const double middle = 0.5 * (from + to);
    scratch.column.clear();
    if (!independent || independent_constraints_hold(middle, registers, scratch))
      find_column(middle, registers.data(), scratch);
    if (scratch.column.empty()) return;
    PlanarSliceScratch::Piece* const last = scratch.pieces.empty() ? nullptr : &scratch.pieces.back();
    if (last && last->to == from && std::ranges::equal(std::span(scratch.spans).subspan(last->first), scratch.column)) {
      last->to = to;
      last->to_vertex = to_vertex;
      return;
    }
    scratch.pieces.push_back({from, to, from_vertex, to_vertex, scratch.spans.size(), scratch.column.size()});
    scratch.spans.insert(scratch.spans.end(), scratch.column.begin(), scratch.column.end());
  };
  for (std::size_t i = 0; i < scratch.vertices.size(); ++i) {
    const double t = scratch.vertices[i].t;
    if (t <= -1 + kMergeDistance || t - from <= kMergeDistance) continue;
    if (t >= 1 - kMergeDistance) break;
    add(t, i);
    from = t;
    from_vertex = i;
  }
  add(1, scratch.vertices.size());
}

void PlanarSlice::find_combinatorial_type(PlanarSliceScratch& scratch) const {
  SliceType& type = scratch.type;
  // round: set of the surfaces with an arc that ends at a turning point; cut: set of the surfaces with an arc that ends
  // at another vertex
  Signs round = 0, cut = 0;
  const auto add = [&](std::size_t surface, std::size_t first, double t) {
    const std::uint32_t label = vertex_of(surface, first, t, scratch);
    if ((label & kKind) == kTurningPoint) {
      round |= bit(surface);
      return;
    }
    cut |= bit(surface);
    Fnv1a vertex;
    vertex.add(surface);
    vertex.add(label);
    type += vertex.value();
  };
  for_each_arc_end(scratch, [&](EndLabel end, std::size_t first, double t) { add(end >> 1U, first, t); });
  for (Signs whole = round & ~cut; whole != 0; whole &= whole - 1) {
    Fnv1a conic;
    conic.add(static_cast<std::uint64_t>(std::countr_zero(whole)));
    type += conic.value();
  }
  if (!scratch.pieces.empty() && type == 0) type = 1;
}

void PlanarSlice::find_features(const PlanarSliceScratch& scratch, BoundaryFeatures& features) const {
  for_each_arc_end(scratch, [&](EndLabel end, std::size_t first, double t) {
    const std::uint64_t surface = end >> 1U;
    const std::uint32_t label = vertex_of(end >> 1U, first, t, scratch);
    const auto vertex =
        std::find_if(scratch.vertices.begin() + static_cast<std::ptrdiff_t>(first), scratch.vertices.end(),
                     [&](const PlanarSliceScratch::Vertex& each) { return each.label == label; });
    if (vertex != scratch.vertices.end() && ((label & kKind) == kCrossing || (label & kKind) == kTurningPoint)) {
      // Two arcs share this vertex, which is listed only once.
      const BoundaryFeature feature{label, label, vertex->t, vertex->s};
      if (std::ranges::none_of(features, [&](const BoundaryFeature& m) {
            return m.key == label && m.t == feature.t && m.s == feature.s;
          }))
        features.push_back(feature);
    } else {
      features.push_back({surface << 32U | label, label, t, end_at(end, t, scratch)});
    }
  });
}

double PlanarSlice::distance(const BoundaryFeature& vertex, const BoundaryFeature& other,
                             const PlanarSliceScratch& scratch) {
  const auto surfaces = [](const BoundaryFeature& feature) {
    const auto place = static_cast<std::uint32_t>(feature.of) & ~kKind;
    return std::array<std::size_t, 2>{place & 255U, place >> 8U};
  };
  const auto crosses = [](const BoundaryFeature& feature) { return (feature.of & kKind) == kCrossing; };
  double least = std::numeric_limits<double>::infinity();
  if (!crosses(vertex) || !crosses(other)) return least;
  const auto lies_on = [own = surfaces(vertex)](std::size_t k) { return own[0] == k || own[1] == k; };
  for (const std::size_t k : surfaces(other)) {
    const Conic& conic = scratch.conics[k];
    if (!lies_on(k)) least = std::fmin(least, std::fabs(conic.at(vertex.t, vertex.s)) / conic.scale);
  }
  return least;
}

double PlanarSlice::measure(std::span<double> registers, PlanarSliceScratch& scratch,
                            const std::vector<SignChange>* changes) const {
  scratch.type = 0;
  scratch.pieces.clear();
  scratch.spans.clear();
  if (!load(registers, scratch)) return 0;
  find_vertices(scratch);
  find_pieces(false, registers, scratch);
  if (!plan_.independent.back().empty() && !scratch.pieces.empty()) {
    if (changes)
      for (const SignChange& change : *changes)
        scratch.vertices.push_back(
            {(change.at - scratch.v[0]) / scratch.v[1], kIndependent | static_cast<std::uint32_t>(change.constraint)});
    else
      find_independent_vertices(registers, scratch);
    find_pieces(true, registers, scratch);
  }
  double sum = 0;
  for (const auto& piece : scratch.pieces)
    for (std::size_t i = piece.first; i < piece.first + piece.count; ++i) {
      const auto [lower, upper] = scratch.spans[i];
      const auto area = [&](EndLabel end) {
        return area_below(scratch.conics[end >> 1U], {static_cast<int>(end & 1U), piece.from, piece.to});
      };
      sum += area(upper) - area(lower);
    }
  find_combinatorial_type(scratch);
  return sum * scratch.v[1] * scratch.z[1];
}

std::array<double, 3> PlanarSlice::moments(const PlanarSliceScratch::Piece& piece, double t,
                                           const PlanarSliceScratch& scratch) const {
  std::array<double, 3> sum{};
  for (std::size_t i = piece.first; i < piece.first + piece.count; ++i) {
    const double a = end_at(scratch.spans[i].lower, t, scratch), b = end_at(scratch.spans[i].upper, t, scratch);
    sum[0] += b - a;
    sum[1] += (b * b - a * a) / 2;
    sum[2] += (b * b * b - a * a * a) / 3;
  }
  return sum;
}

void PlanarSlice::append_smooth_intervals(const PlanarSliceScratch& scratch,
                                          std::vector<Subinterval<double>>& pieces) const {
  for (const auto& piece : scratch.pieces)
    pieces.push_back({scratch.v[0] + scratch.v[1] * piece.from, scratch.v[0] + scratch.v[1] * piece.to,
                      has_sqrt_singularity(piece.from_vertex, scratch),
                      has_sqrt_singularity(piece.to_vertex, scratch)});
}

std::vector<std::array<double, 2>> PlanarSlice::columns(double v, std::span<double> registers,
                                                        PlanarSliceScratch& scratch) const {
  std::vector<std::array<double, 2>> found;
  const double t = (v - scratch.v[0]) / scratch.v[1];
  const bool holds = plan_.independent.back().empty() || independent_constraints_hold(t, registers, scratch);
  if (!holds || scratch.pieces.empty() || t < scratch.pieces.front().from || t > scratch.pieces.back().to) return found;
  find_column(t, registers.data(), scratch);
  for (const auto& [lower, upper] : scratch.column)
    found.push_back({scratch.z[0] + scratch.z[1] * end_at(lower, t, scratch),
                     scratch.z[0] + scratch.z[1] * end_at(upper, t, scratch)});
  return found;
}

bool PlanarSlice::has_sqrt_singularity(std::size_t vertex, const PlanarSliceScratch& scratch) {
  // A vertex within this distance in t of a turning point counts as a turning point: near a tangency, intersections can
  // lie on either side of it.
  constexpr double kNearTurningPoint = 1e-7;
  return vertex < scratch.vertices.size() &&
         std::ranges::any_of(scratch.vertices, [&](const PlanarSliceScratch::Vertex& other) {
           return (other.label & kKind) == kTurningPoint &&
                  std::fabs(other.t - scratch.vertices[vertex].t) <= kNearTurningPoint;
         });
}

}  // namespace pkm::generic
