// The measure of a workspace: its sections' areas, or its columns' lengths, integrated over the outer coordinates.
//
// Along an outer coordinate the measure is smooth as long as the sections' structure stays the same. The structure is
// sampled, each change that is seen is followed to the last bits, and every node of the quadrature is compared with its
// part: where one has another structure, the part is split there.
#pragma once

#include <functional>
#include <memory>
#include <variant>

#include "engine/expression/batch_stage.hpp"
#include "engine/generic/columns/break_motion.hpp"
#include "engine/generic/columns/change_guess.hpp"
#include "engine/generic/columns/column.hpp"
#include "engine/generic/columns/section_search.hpp"
#include "engine/math/quadrature.hpp"

namespace pkm::generic {

/// Of a value of an outer coordinate.
struct Slice {
  double at = 0, measure = 0, error = 0;
  Structure hash = 0;        ///< 0: empty
  std::uint32_t broken = 0;  ///< where it is empty: 1 + the place of the plain condition that is broken
};

/// What closes a part of an outer coordinate: a change of structure, the box, or a plain condition: 1 + its place.
using Closing = std::uint32_t;
inline constexpr Closing kChange = 0, kBox = ~Closing{0};

/// Where the structure changes. @param below, above  just beside it
struct SliceBreak {
  double at;
  bool root;  ///< beside it, measures or their derivatives may behave like roots
  Slice below, above;
  bool is_box = false;
  double overlooked = 0;  ///< error that a jump of the measure tells of
};

/// A part of an outer coordinate in which the structure stays the same.
struct SlicePart {
  Piece<double> piece;
  Slice below, above;  ///< just inside its ends
  Closing lower = kChange, upper = kChange;
  double beyond_lower = 0, beyond_upper = 0;  ///< measures just outside its ends
  std::array<double, NestedRule::kNodes> at{}, weight{};
  double value = 0, error = 0;
  double unresolved = 0;  ///< error that smaller parts do not mend
  double missed = 0;      ///< by the polynomial through its nodes, at its ends; where derivatives will be asked for
  int one_sided = 0;      ///< halvings in a row that left nearly all of a change of the slices in this half
  std::size_t kept = 0;   ///< of what is kept of its nodes, the first
};

inline constexpr int kDeepest = 10;        ///< parts within parts
inline constexpr int kPlacesInLines = 64;  ///< of the outermost coordinate that are compared, where sections are lines
inline constexpr double kSettled = 1e-11;  ///< of the range: beyond a break, where structures can be told
inline constexpr double kJump = 1e-7;      ///< of the greatest slice: what is no rounding

/// What an integral overwrites.
struct IntegralRoom {
  struct Level {
    std::vector<SlicePart> parts;
    std::array<std::vector<SliceBreak>, kDeepest + 1> breaks;  ///< of the range, and of parts by their depth
    double at = 0;                                             ///< the coordinate
    /// Parts of this coordinate at places of the one outside, in their order.
    struct Seen {
      double outside;
      std::vector<std::array<double, 2>> parts;
    };
    std::vector<Seen> seen;
    std::size_t seen_count = 0;
    std::vector<double> hints;   ///< where something may be
    std::vector<double> places;  ///< that are looked at first
    std::vector<Slice> scanned;  ///< there
    double greatest = 0;         ///< slice so far
    double unresolved = 0;       ///< of the parts that were given up
    ChangeGuess guess;           ///< of the change of structure that is closed in on
    Marks marks;                 ///< of the slice that was looked at last
  };
  SectionRoom section;
  ColumnRoom column;
  SearchRoom search;
  std::vector<double> registers, adjoints, own;
  expression::Rows rows;             ///< of registers at several lines side by side
  std::vector<Dual4> moving, along;  ///< registers, where nodes move with the design, and with an outer coordinate
  std::vector<Level> levels;
  bool has_hints = false;    ///< boxes of the search tell the inner coordinates where something may be
  bool is_scanning = false;  ///< the outermost coordinate is looked at first
  bool measured = false;     ///< then what is looked at changes nothing
  bool for_slopes = false;   ///< derivatives will be asked for
  /// Then, where there are two outer coordinates: parts of the inner one at the nodes of the outermost one.
  std::vector<std::vector<SlicePart>> kept;
  std::unique_ptr<IntegralRoom> other;  ///< of the other side of a break
  long sections = 0;
  long most = 0;  ///< sections, after which what is not known counts as error
};

class SectionsIntegral {
 public:
  /// @param tolerance  relative
  SectionsIntegral(SectionPlan plan, double tolerance);

  const SectionPlan& plan() const {
    return std::visit([](const auto& each) -> const SectionPlan& { return each.plan(); }, innermost_);
  }
  /// @param inputs  of the graph, with held coordinates
  /// @param most    sections, after which what is not known counts as error; 0: more than are usually of use
  Integral<double> measure(std::span<const double> inputs, IntegralRoom& room, long most = 0) const;
  /// The same with breaks that are known well enough for derivatives, and with what makes add_slopes() faster.
  Integral<double> measure_for_slopes(std::span<const double> inputs, IntegralRoom& room) const;
  /// Adds derivatives of the measure, after measure_for_slopes(), by the graph's inputs.
  void add_slopes(std::span<double> by_input, IntegralRoom& room) const;
  /// Calls visit(place of the outer coordinates, v, z, weight) with nodes inside the columns, after measure(). S is
  /// double or Dual4: nodes move along with their columns, so that sums over them have derivatives.
  template <class S, class Visit>
  void for_each_node(std::span<const S> inputs, const GaussRule& outer, const GaussRule& inner, IntegralRoom& room,
                     const Visit& visit) const {
    if constexpr (Derivative<S>) start_moving(inputs, room);
    std::vector<S> place;
    visit_nodes(0, S(1.0), outer, inner, place, room, visit);
  }

 private:
  using Breaks = std::vector<SliceBreak>;

  std::size_t levels() const { return plan().order.outer.size(); }
  bool ends_in_lines() const { return std::holds_alternative<Column>(innermost_); }
  Integral<double> measure_all(std::span<const double> inputs, IntegralRoom& room, long most) const;
  void set(std::size_t level, double at, IntegralRoom& room) const;
  /// With the coordinates before `level` set.
  Slice inside(std::size_t level, IntegralRoom& room) const;
  Slice slice(std::size_t level, double at, IntegralRoom& room) const;
  /// The same with the coordinate set.
  Slice set_slice(std::size_t level, double at, IntegralRoom& room) const;
  /// Of several places. @param slices  as many
  void find_slices(std::size_t level, std::span<const double> places, std::span<Slice> slices,
                   IntegralRoom& room) const;
  void find_places(std::size_t level, double low, double high, IntegralRoom& room) const;
  static void add_expected_places(double outside, IntegralRoom::Level& own);
  static void remember(double outside, IntegralRoom::Level& own);
  Slice integrate(std::size_t level, IntegralRoom& room) const;
  bool jumps(const Slice& low, const Slice& high, std::size_t level, const IntegralRoom& room) const;
  void look_between(IntegralRoom& room) const;
  void look_beside(IntegralRoom& room) const;
  void look_closer(IntegralRoom& room) const;
  void give_hints(double at, IntegralRoom& room) const;
  void look_again(std::size_t level, IntegralRoom& room) const;
  void find_breaks(std::size_t level, Slice from, Slice& to, double whole, Breaks& breaks, IntegralRoom& room) const;
  /// What bounds the slice that was looked at last.
  void find_marks(std::size_t level, Marks& marks, const IntegralRoom& room) const;
  /// Brings two slices of different structures near to each other, to a place where the structure changes.
  /// @param guesses  else they are halved
  void close_in(std::size_t level, Slice& low, Slice& high, double whole, bool guesses, IntegralRoom& room) const;
  void add_parts(std::size_t level, const Breaks& breaks, double whole, int depth, IntegralRoom& room) const;
  void add_part(std::size_t level, SlicePart part, double whole, int depth, IntegralRoom& room) const;
  void refine(std::size_t level, double whole, IntegralRoom& room) const;

  void add_slopes(std::size_t level, double factor, IntegralRoom& room) const;
  void add_side(std::size_t level, const SlicePart& part, bool upper, double factor, IntegralRoom& room) const;
  double slope_of_plain(std::size_t level, Closing closing, double at, IntegralRoom& room) const;

  struct Lost;
  /// visit(weight, slope): of a point, and how much the constraint that is violated beyond the break changes there with
  /// the coordinate; room.own: with the registers.
  using LostVisitor = std::function<void(double, double)>;
  static bool may_jump(std::size_t level, const SlicePart& part, bool upper, const IntegralRoom& room);
  /// Visits quadrature nodes in what is feasible on one side of an end of a part alone, if the measure jumps there.
  /// @param side  1: above the end, -1: below it
  void visit_lost(std::size_t level, const SlicePart& part, bool upper, double side, IntegralRoom& room,
                  const LostVisitor& visit) const;
  /// How much of a jump of the measure is of points that violate no condition on the other side.
  double unexplained(std::size_t level, const SliceBreak& at, IntegralRoom& room) const;
  void visit_lost(std::size_t level, double weight, bool in_is_empty, bool out_is_empty, const Lost& lost) const;
  void visit_columns(const std::vector<std::array<double, 2>>& columns, double v, double weight,
                     const Lost& lost) const;
  double slope_of_violated(double v, double z, const Lost& lost) const;

  void start_moving(std::span<const Dual4> inputs, IntegralRoom& room) const;
  void set_moving(std::size_t level, const Dual4& at, IntegralRoom& room) const;
  /// Those that halving made of one are one: sums over nodes change with the design without jumps.
  static std::vector<SlicePart> whole_parts(std::size_t level, const IntegralRoom& room);
  /// @param below  where the part before ends; null: there is none
  Piece<Dual4> moving_piece(std::size_t level, const SlicePart& part, const Dual4* below, IntegralRoom& room) const;
  Dual4 moving_end(std::size_t level, const SlicePart& part, bool upper, IntegralRoom& room) const;

  /// After inside(level).
  template <class S, class Visit>
  void visit_nodes(std::size_t level, const S& weight, const GaussRule& outer, const GaussRule& inner,
                   std::vector<S>& place, IntegralRoom& room, const Visit& visit) const {
    if (level == levels()) {
      if (const auto* const section = std::get_if<Section>(&innermost_)) {
        const auto ends = [&] {
          if constexpr (Derivative<S>)
            return SectionMotion(*section, room.section, room.moving, room.registers);
          else
            return SectionAtRest{room.section};
        }();
        section->for_each_node(outer, inner, room.section, ends,
                               [&](const S& v, const S& z, const S& own) { visit(place, v, z, weight * own); });
      } else {
        const Column& column = std::get<Column>(innermost_);
        const auto end_of = [&](const std::pair<double, EndLabel>& end) -> S {
          if constexpr (Derivative<S>)
            return column.moving_end(end, room.moving);
          else
            return end.first;
        };
        column.for_each_node<S>(inner, room.column, end_of,
                                [&](const S& z, const S& own) { visit(place, S(0), z, weight * own); });
      }
      return;
    }
    Piece<S> piece;
    const S* below = nullptr;
    for (const SlicePart& part : whole_parts(level, room)) {
      if constexpr (Derivative<S>)
        piece = moving_piece(level, part, below, room);
      else
        piece = part.piece;
      below = &piece.upper;
      pkm::visit_nodes(piece, outer, [&](const S& at, const S& jacobian, double own) {
        slice(level, value_of(at), room);
        if constexpr (Derivative<S>) set_moving(level, at, room);
        place.push_back(at);
        visit_nodes<S>(level + 1, weight * jacobian * own, outer, inner, place, room, visit);
        place.pop_back();
      });
    }
  }

  std::variant<Section, Column> innermost_;
  std::optional<expression::BatchStage> lines_;  ///< where sections are lines: what differs from one to the next
  std::vector<std::uint32_t> line_registers_;    ///< its registers that columns are made of
  double tolerance_;
};

}  // namespace pkm::generic
