// The area of a section, exactly: the conics that bound it cross in places that polynomials of degree four have as
// roots, and between those the ends of columns are arcs whose areas are closed forms.
#pragma once

#include "engine/math/quadrature.hpp"
#include "engine/mechanisms/described/columns/conic.hpp"
#include "engine/mechanisms/described/columns/ends.hpp"
#include "engine/mechanisms/described/columns/section_plan.hpp"

namespace pkm::described {

/// Whether a corner is at an upright side, where it counts once.
bool is_upright(std::uint32_t corner);

/// What a section overwrites, in coordinates t, s in [-1, 1] for v and z.
struct SectionRoom {
  struct Corner {
    double t;
    std::uint32_t label;
    bool touches = false;  ///< a crossing of conics that touch there
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
  Structure structure;
};

class Section {
 public:
  explicit Section(SectionPlan plan) : plan_(std::move(plan)) {}

  const SectionPlan& plan() const { return plan_; }
  /// The area, its structure and its pieces. @param registers  after all stages but that of v
  double measure(std::span<double> registers, SectionRoom& room) const;
  /// Adds the derivatives of factor * measure(), after it, to the adjoints of the program's registers.
  void add_slopes(double factor, std::span<double> registers, std::span<double> adjoints, SectionRoom& room) const;
  /// Calls visit(v, z, weight) with nodes inside the columns, after measure().
  template <class Visit>
  void for_each_node(const GaussRule& along_v, const GaussRule& along_z, const SectionRoom& room,
                     const Visit& visit) const {
    for (const auto& piece : room.pieces) {
      const Piece<double> range{piece.from, piece.to, is_round(piece.from_corner, room),
                                is_round(piece.to_corner, room)};
      for (std::size_t i = 0; i < along_v.node.size(); ++i) {
        const auto [t, jacobian] = map_node(range, along_v.node[i]);
        for (std::size_t k = piece.first; k < piece.first + piece.count; ++k) {
          const double low = end_at(room.spans[k].lower, t, room), high = end_at(room.spans[k].upper, t, room);
          const double weight = room.v[1] * room.z[1] * jacobian * along_v.weight[i] * (high - low);
          for (std::size_t j = 0; j < along_z.node.size(); ++j)
            visit(room.v[0] + room.v[1] * t, room.z[0] + room.z[1] * (low + (high - low) * along_z.node[j]),
                  weight * along_z.weight[j]);
        }
      }
    }
  }

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
  double length(const SectionRoom::Piece& piece, double t, const SectionRoom& room) const;
  void find_structure(SectionRoom& room) const;
  /// Whether columns close like a root there.
  static bool is_round(std::size_t corner, const SectionRoom& room);
  static double end_at(EndLabel end, double t, const SectionRoom& room) {
    return place_on(room.conics[end >> 1U], static_cast<int>(end & 1U), t);
  }
  std::size_t stage_of_v() const { return plan_.program.stages().size() - 1; }

  SectionPlan plan_;
};

}  // namespace pkm::described
