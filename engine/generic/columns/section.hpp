// The area of a section, exactly: the conics that bound it cross in places that polynomials of degree four have as
// roots, and between those the ends of columns are arcs whose areas are closed forms.
#pragma once

#include <algorithm>

#include "engine/generic/columns/change_guess.hpp"
#include "engine/generic/columns/conic.hpp"
#include "engine/generic/columns/ends.hpp"
#include "engine/generic/columns/section_plan.hpp"
#include "engine/math/quadrature.hpp"

namespace pkm::generic {

/// What a section overwrites, in coordinates t, s in [-1, 1] for v and z.
struct SectionRoom {
  struct Corner {
    double t;
    std::uint32_t label;
    bool touches = false;  ///< a crossing of conics that touch there
    double s = 0;          ///< of crossings and extremes
  };
  struct Span {
    EndLabel lower, upper;

    bool operator==(const Span&) const = default;
  };
  struct Piece {
    double from, to;
    std::size_t from_corner, to_corner;  ///< the first of those at this place; behind the last: the section's sides
    std::size_t first, count;            ///< of spans
  };
  /// What surfaces stand for: several may be the same, or the same with the other sign.
  struct Meaning {
    Signs same, opposite;
  };
  std::array<Conic, kMostSurfaces> conics;
  std::array<Meaning, kMostSurfaces> meaning;
  std::array<double, 2> v, z;       ///< middle and half width
  std::vector<std::size_t> active;  ///< those that change their sign in the section, each once
  Signs always = 0;                 ///< surfaces that are >= 0 all over the section
  std::vector<Corner> corners;
  std::vector<Piece> pieces;
  std::vector<Span> spans, column;
  Ends ends;
  std::vector<double> before, now, other_adjoints;
  Structure structure = 0;
};

/// An end of columns at t.
inline double end_at(EndLabel end, double t, const SectionRoom& room) {
  return place_on(room.conics[end >> 1U], static_cast<int>(end & 1U), t);
}

/// Ends of pieces and columns of one design (SectionMotion: of designs that move).
struct SectionAtRest {
  using Scalar = double;
  const SectionRoom& room;

  double corner(std::size_t, double t) const { return t; }
  double end(EndLabel end, double t) const { return end_at(end, t, room); }
};

class Section {
 public:
  explicit Section(SectionPlan plan) : plan_(std::move(plan)) {}

  const SectionPlan& plan() const { return plan_; }
  /// The area, its structure and its pieces. @param registers  after all stages but that of v
  double measure(std::span<double> registers, SectionRoom& room) const;
  /// Adds the derivatives of factor * measure(), after it, to the adjoints of the program's registers.
  void add_slopes(double factor, std::span<double> registers, std::span<double> adjoints, SectionRoom& room) const;
  /// Calls visit(v, z, weight) with nodes inside the columns, after measure(). @param ends  SectionAtRest or -Motion
  template <class Ends, class Visit>
  void for_each_node(const GaussRule& along_v, const GaussRule& along_z, const SectionRoom& room, const Ends& ends,
                     const Visit& visit) const {
    using S = typename Ends::Scalar;
    for (const auto& piece : room.pieces) {
      const Piece<S> range{ends.corner(piece.from_corner, piece.from), ends.corner(piece.to_corner, piece.to),
                           is_round(piece.from_corner, room), is_round(piece.to_corner, room)};
      visit_nodes(range, along_v, [&](const S& t, const S& jacobian, double weight_v) {
        for (std::size_t k = piece.first; k < piece.first + piece.count; ++k) {
          const S low = ends.end(room.spans[k].lower, t), high = ends.end(room.spans[k].upper, t);
          const S weight = room.v[1] * room.z[1] * jacobian * weight_v * (high - low);
          for (std::size_t j = 0; j < along_z.node.size(); ++j)
            visit(room.v[0] + room.v[1] * t, room.z[0] + room.z[1] * (low + (high - low) * along_z.node[j]),
                  weight * along_z.weight[j]);
        }
      });
    }
  }

  /// Calls visit(end, first corner there, t) wherever an arc ends, after measure().
  template <class Visit>
  void for_each_arc_end(const SectionRoom& room, const Visit& visit) const {
    const auto goes_on = [&](const SectionRoom::Piece& piece, EndLabel end, bool above) {
      return std::any_of(room.spans.begin() + static_cast<std::ptrdiff_t>(piece.first),
                         room.spans.begin() + static_cast<std::ptrdiff_t>(piece.first + piece.count),
                         [&](const SectionRoom::Span& span) { return (above ? span.upper : span.lower) == end; });
    };
    for (std::size_t p = 0; p < room.pieces.size(); ++p) {
      const auto& piece = room.pieces[p];
      const auto* const before = p > 0 && room.pieces[p - 1].to == piece.from ? &piece - 1 : nullptr;
      const auto* const after =
          p + 1 < room.pieces.size() && room.pieces[p + 1].from == piece.to ? &piece + 1 : nullptr;
      for (std::size_t i = piece.first; i < piece.first + piece.count; ++i)
        for (const bool above : {false, true}) {
          const EndLabel end = above ? room.spans[i].upper : room.spans[i].lower;
          if (!before || !goes_on(*before, end, above)) visit(end, piece.from_corner, piece.from);
          if (!after || !goes_on(*after, end, above)) visit(end, piece.to_corner, piece.to);
        }
    }
  }
  /// Ranges of v in which the columns have the same ends, after measure().
  void add_pieces(const SectionRoom& room, std::vector<Piece<double>>& pieces) const;
  /// Ranges of z that are feasible at v, after measure(), in order.
  std::vector<std::array<double, 2>> columns(double v, std::span<double> registers, SectionRoom& room) const;
  /// The corners that its structure is made of, after measure().
  void find_marks(const SectionRoom& room, Marks& marks) const;
  /// How far a corner is from the surfaces that meet in a corner of a section beside this one, as a share of what they
  /// can be; infinity: it lies on them, or one of the two is no crossing.
  static double distance(const Mark& corner, const Mark& other, const SectionRoom& room);
  /// How much plain condition k changes with v, at t. @param by  as expression::stage_derivative()
  double slope_of_plain(std::size_t k, double t, std::span<double> registers, const SectionRoom& room,
                        std::vector<double>& by) const;

 private:
  bool load(std::span<const double> registers, SectionRoom& room) const;
  void find_corners(SectionRoom& room) const;
  void add_corner(double t, double s, Signs of, std::uint32_t label, SectionRoom& room) const;
  void find_plain_corners(std::span<double> registers, SectionRoom& room) const;
  void find_pieces(bool plain, std::span<double> registers, SectionRoom& room) const;
  void find_column(double t, const double* registers, SectionRoom& room) const;
  /// Computes what depends on v, at t.
  void set_v(double t, std::span<double> registers, const SectionRoom& room) const;
  /// Values of the plain conditions along v at t.
  void run_plain(double t, std::span<double> registers, const SectionRoom& room, std::vector<double>& values) const;
  bool plain_holds(double t, std::span<double> registers, const SectionRoom& room) const;
  /// Integrals of 1, s and s^2 over the columns of a piece at t.
  std::array<double, 3> moments(const SectionRoom::Piece& piece, double t, const SectionRoom& room) const;
  void find_structure(SectionRoom& room) const;
  /// Whether columns close like a root there.
  static bool is_round(std::size_t corner, const SectionRoom& room);
  std::size_t stage_of_v() const { return plan_.program.stages().size() - 1; }

  SectionPlan plan_;
};

}  // namespace pkm::generic
